use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

use super::*;
use crate::plastic::PlasticState;

fn truth(phi_c: f64) -> Constants {
    Constants { f_e: 1.1, f_g: 0.3, f_ep: 1.4, p_c: 1.0 - phi_c, c2: -phi_c.ln(), phi_c, ..Constants::PAPER }
}

/// A run made by the model itself, with noise in the stress [Pa].
fn run(h: Option<f64>, noise: f64, seed: u64) -> PlasticCurve {
    let normal = Normal::new(0.0, noise).unwrap();
    let mut rng = Pcg64::seed_from_u64(seed);
    let material = Material { young: 10e6, nu: 0.45, sigma_y: 0.4e6, h };
    let constants = truth(0.8);
    let states = (0..90)
        .map(|i| 0.74 + 0.0025 * f64::from(i))
        .map(|phi| {
            let z = 4.0 + 5.1 * (phi - 0.8_f64).max(0.0).sqrt();
            let exact = constants.sigma(&material, phi, z);
            // jamming is a step: the wall bears 1.5 kPa at once
            let sigma = if phi < 0.79999 { 0.0 } else { (exact + normal.sample(&mut rng)).max(1.5e3) };
            let f_p = h.map(|_| constants.plastic_share(phi));
            PlasticState {
                phi,
                sigma,
                strain: Some((phi / 0.74).ln()),
                z: Some(z),
                f_p,
                ..PlasticState::default()
            }
        })
        .collect();
    PlasticCurve { id: "run".to_owned(), setup: "assembly".to_owned(), material, seed, states }
}

#[test]
fn jamming_is_the_onset_of_sustained_stress() {
    let mut curve = run(None, 0.0, 1);
    // a rattling wall before jamming does not count
    curve.states[5].sigma = 5e4;
    let found = compaction(&[curve.clone()], &CompactionOptions::default()).unwrap();
    let jamming = found.curves[0].jamming.value().unwrap();
    assert!((jamming.phi_c - 0.8).abs() < 1e-9, "{jamming:?}");
    assert!(jamming.phi_c_extrapolated.value().is_some());
    let loose = PlasticCurve { states: curve.states[..20].to_vec(), ..curve };
    let found = compaction(&[loose], &CompactionOptions::default()).unwrap();
    assert!(found.curves[0].jamming.reason().unwrap().contains("no sustained stress"));
    assert!(found.curves[0].fit.reason().is_some() && found.curves[0].model.is_empty());
    assert!(compaction(&[], &CompactionOptions::default()).is_err());
}

#[test]
fn constants_are_recovered_within_their_intervals() {
    let mut hits = [0_u32; 2];
    for seed in 0..200 {
        let found = compaction(&[run(None, 8e3, seed)], &CompactionOptions::default()).unwrap();
        let fit = found.curves[0].fit.value().unwrap();
        hits[0] += u32::from(fit.parameter("f_e").unwrap().covers(1.1));
        hits[1] += u32::from(fit.parameter("f_g").unwrap().covers(0.3));
    }
    assert!(hits.iter().all(|hit| *hit >= 180), "{hits:?}");
}

#[test]
fn plastic_constants_follow_with_the_elastic_ones_held() {
    let runs = [run(Some(1e6), 0.0, 1), run(None, 0.0, 2), run(Some(0.0), 0.0, 3)];
    let found = compaction(&runs, &CompactionOptions::default()).unwrap();
    let names: Vec<&str> = found.curves.iter().map(|curve| curve.name.as_str()).collect();
    assert_eq!(names, ["elastic", "H = 0 MPa", "H = 1 MPa"]);
    let hard = &found.curves[2];
    let f_ep = hard.fit.value().unwrap().parameter("f_ep").unwrap();
    assert!((f_ep.value - 1.4).abs() < 0.02, "{f_ep:?}");
    assert!((hard.alpha.value().unwrap().value - 2.5).abs() < 0.01);
    assert!(found.curves[1].fit.reason().unwrap().contains("σ_y"));
    for (sample, state) in hard.model.iter().zip(&hard.states[24..]) {
        assert!((sample.fitted.unwrap() / state.sigma.max(2e3) - 1.0).abs() < 0.5 || state.sigma < 2e4);
    }
}

#[test]
fn stresses_below_the_yield_term_do_not_fix_the_plastic_exponent() {
    let mut soft = run(Some(1e6), 0.0, 1);
    soft.states.iter_mut().for_each(|state| state.sigma *= 0.5);
    // nor does what lies within noise ten times the hardening
    let noisy = PlasticCurve { seed: 2, ..run(Some(1e6), 3e5, 1) };
    let found = compaction(&[run(None, 0.0, 2), soft, noisy], &CompactionOptions::default()).unwrap();
    for curve in &found.curves[1..] {
        let reason = curve.fit.reason().unwrap();
        assert!(reason.contains("f_ep"), "{reason}");
    }
    // α and the model with the paper's constants are there all the same
    assert!(found.curves[1].alpha.value().is_some() && !found.curves[1].model.is_empty());
}

/// The plastic curves leave the elastic one where f_p (σ_e − σ_p) exceeds a tenth of σ_e.
#[test]
fn the_stress_where_curves_part_is_found() {
    let found =
        compaction(&[run(None, 0.0, 1), run(Some(0.0), 0.0, 2)], &CompactionOptions::default()).unwrap();
    let parts_at = *found.curves[1].parts_at.value().unwrap();
    let (constants, material) = (truth(0.8), found.curves[1].material);
    let gap = |phi: f64| {
        let z = 4.0 + 5.1 * (phi - 0.8_f64).sqrt();
        let elastic = constants.sigma_elastic(&material, phi, z);
        (1.0 - constants.sigma(&material, phi, z) / elastic, elastic)
    };
    let exact =
        (0..20_000).map(|i| 0.8 + 0.000_01 * f64::from(i)).map(gap).rfind(|(gap, _)| *gap <= 0.1).unwrap().1;
    assert!((parts_at / exact - 1.0).abs() < 0.05, "{parts_at} against {exact}");
    assert!(found.curves[0].parts_at.reason().is_some());
}
