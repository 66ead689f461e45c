//! The analyses of loading paths of discs.

use serde_json::{Value, json};

use crate::support::Coordinator;

/// A state of a made-up sample that follows eq. (9) with the parameters of Table III for small rolling resistance.
fn state(p: f64, seed: u64) -> Value {
    let (p0, phi0, lambda, alpha, p1): (f64, f64, f64, f64, f64) = (0.0316, 0.515, 0.194, 1.08, 0.9);
    let ratio = p / p0 * (1.0 - (-(p1 / p).powf(alpha)).exp()).powf(1.0 / alpha);
    let inverse = 1.0 / phi0 - lambda * f64::ln(ratio) + 1e-3 * (seed as f64 - 2.0);
    json!({
        "p": p, "phi": 1.0 / inverse, "z": 3.0, "branch": if p < 0.011 { "assembly" } else { "compression" },
        "leg": 0, "converged": true, "bulk": 0.01 * p.sqrt(), "shear": 0.005 * p.sqrt(), "bulk_voigt": 0.3,
        "shear_voigt": 0.3, "bulk_reuss": 0.004, "stiffness_sign": 1, "pore_radius": 1.0 / p.sqrt(),
    })
}

#[tokio::test]
async fn loading_paths_of_discs_are_analysed() {
    let service = Coordinator::new().await;
    let registration = json!({
        "protocol": 1, "host": "a", "boot": uuid::Uuid::from_u128(7), "slots": 4, "hardware": "x86_64-test",
        "code_version": "0.1.0",
        "models": [["cohesive_discs", scene::Model::CohesiveDiscs.physics_version()]],
    });
    let reply = service.post("/v1/workers", &registration).await.expect(201, "");
    let worker = reply["worker"].as_str().unwrap().parse().unwrap();
    let sweep = service
        .submit(&json!({
            "name": "consolidation", "model": "cohesive_discs",
            "blocks": [{ "grid": { "seed": [1, 2, 3] } }],
        }))
        .await;
    for route in ["consolidation", "moduli", "structure", "consolidation.svg"] {
        service.get(&format!("/v1/sweeps/{sweep}/{route}")).await.expect(422, "analysis-impossible");
    }
    for grant in service.claim(worker, 3, &[]).await {
        let seed = grant.reduced["seed"].as_u64().unwrap();
        let states: Vec<Value> =
            (0..26).map(|k| state(0.01 * 10_f64.powf(f64::from(k) / 8.0), seed)).collect();
        let body = json!({
            "worker": worker, "attempt": grant.attempt, "scene_key": grant.scene_key,
            "outcome": {
                "record": { "status": "equilibrium", "phi": 0.77, "steps": 1000 }, "states": states,
                "series": { "columns": [] }, "packing": {},
            },
            "execution": { "wall_s": 2.0, "kernel": "test" },
        });
        service.post(&format!("/v1/leases/{}/result", grant.job), &body).await.expect(200, "");
    }
    let curves = service.get(&format!("/v1/sweeps/{sweep}/consolidation")).await.expect(200, "");
    assert_eq!(curves["curves"].as_array().unwrap().len(), 1, "{curves}");
    assert_eq!(curves["provenance"]["states"], 78);
    assert!(curves["curves"][0].to_string().contains("0.19"), "{curves}");
    for route in ["moduli", "structure"] {
        let answer = service.get(&format!("/v1/sweeps/{sweep}/{route}")).await.expect(200, "");
        assert_eq!(answer["curves"].as_array().unwrap().len(), 1, "{answer}");
    }
    for route in ["consolidation.svg", "moduli.svg", "structure.svg"] {
        let reply = service.get(&format!("/v1/sweeps/{sweep}/{route}")).await;
        assert!(reply.text().starts_with("<svg"), "{route}");
    }
    // The analyses of spheres say that they are not for discs.
    service.get(&format!("/v1/sweeps/{sweep}/collapse")).await.expect(422, "analysis-impossible");
}
