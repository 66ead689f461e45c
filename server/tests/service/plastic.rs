//! The analyses of loading paths of plastic discs.

use serde_json::{Value, json};

use crate::support::Coordinator;

/// A state of a made-up run: Z by (17), a stress that grows linearly from Φ = 0.8 on, less steeply for plastic discs.
fn state(phi: f64, elastic: bool) -> Value {
    let excess = (phi - 0.8).max(0.0);
    let slope = if elastic { 0.5 } else { 0.3 };
    let sigma = if excess > 0.0 { 2e-4 + slope * excess } else { 0.0 };
    json!({
        "phi": phi, "sigma": sigma, "strain": 1.0 - 0.75 / phi, "strain_log": (0.75 / phi).ln(),
        "z": 4.0 + 5.0 * excess.sqrt(), "f_p": if elastic { 0.0 } else { 2.0 * excess }, "kappa_d": 2.1 + 8.0 * excess,
        "sigma_contact": 3.0 * sigma, "sigma_volume": sigma, "sigma_centre": 2.0 * sigma,
    })
}

#[tokio::test]
async fn loading_paths_of_plastic_discs_are_analysed() {
    let service = Coordinator::new().await;
    let registration = json!({
        "protocol": 1, "host": "a", "boot": uuid::Uuid::from_u128(9), "slots": 4, "hardware": "x86_64-test",
        "code_version": "0.1.0",
        "models": [["plastic_discs", scene::Model::PlasticDiscs.physics_version()]],
    });
    let reply = service.post("/v1/workers", &registration).await.expect(201, "");
    let worker = reply["worker"].as_str().unwrap().parse().unwrap();
    let sweep = service
        .submit(&json!({
            "name": "compaction", "model": "plastic_discs",
            "blocks": [
                { "grid": { "material": ["elastic"], "setup": ["assembly", "diametrical"] } },
                { "grid": { "h": [1e6] } },
            ],
        }))
        .await;
    let pictures = ["compaction.svg", "coordination.svg", "curvature.svg", "stress-strain.svg"];
    for route in ["compaction", "coordination"].into_iter().chain(pictures) {
        service.get(&format!("/v1/sweeps/{sweep}/{route}")).await.expect(422, "analysis-impossible");
    }
    for grant in service.claim(worker, 3, &[]).await {
        let elastic = grant.reduced["sigma_y"].is_null();
        let states: Vec<Value> = (0..60).map(|k| state(0.76 + 0.003 * f64::from(k), elastic)).collect();
        let body = json!({
            "worker": worker, "attempt": grant.attempt, "scene_key": grant.scene_key,
            "outcome": {
                "record": { "status": "phi_reached", "phi": 0.937, "steps": 1000 }, "states": states,
                "series": { "columns": [] }, "packing": {},
            },
            "execution": { "wall_s": 2.0, "kernel": "test" },
        });
        service.post(&format!("/v1/leases/{}/result", grant.job), &body).await.expect(200, "");
    }
    let found = service.get(&format!("/v1/sweeps/{sweep}/compaction")).await.expect(200, "");
    let curves = found["curves"].as_array().unwrap();
    assert_eq!((curves.len(), &found["provenance"]["runs"]), (2, &json!(2)), "the single disc is no packing");
    assert_eq!(
        (curves[0]["name"].as_str(), curves[1]["name"].as_str()),
        (Some("elastic"), Some("H = 1 MPa"))
    );
    // the curves part by more than a tenth from the first state under load on
    assert!(curves[1].to_string().contains("parts_at"), "{}", curves[1]);
    let found = service.get(&format!("/v1/sweeps/{sweep}/coordination")).await.expect(200, "");
    assert_eq!(found["curves"].as_array().unwrap().len(), 2, "{found}");
    let only =
        service.get(&format!("/v1/sweeps/{sweep}/coordination?material=elastic")).await.expect(200, "");
    assert_eq!(only["curves"].as_array().unwrap().len(), 1, "{only}");
    for route in pictures {
        let reply = service.get(&format!("/v1/sweeps/{sweep}/{route}")).await;
        assert!(reply.text().starts_with("<svg"), "{route}");
    }
    service.get(&format!("/v1/sweeps/{sweep}/collapse")).await.expect(422, "analysis-impossible");
}
