use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

use super::*;

const E_MIN: f64 = 0.76;

fn exact(p: f64) -> f64 {
    e_max(p, E_MIN, 1.0, 0.24, P0).unwrap()
}

fn p0(fitted: &PlateauFit) -> f64 {
    fitted.p0.value().unwrap().value
}

/// A plateau that does not fall with p reaches Δe = 1 nowhere; its answer is still plain JSON, without nulls.
#[test]
fn a_flat_plateau_has_no_p0_and_says_so() {
    let levels: Vec<Level> = [1e4, 5e4, 1e5, 1e6]
        .iter()
        .zip([0.001, -0.0012, 0.0004, 0.0003])
        .map(|(&p, noise)| Level { p, e_max: 1.45 + noise, se: 0.01 })
        .collect();
    let fitted = fit(&levels, 0.89, 0.003, 1e5).unwrap();
    assert!(fitted.p0.reason().unwrap().contains("does not exclude zero"), "{:?}", fitted.p0);
    let text = serde_json::to_string(&fitted).unwrap();
    assert!(!text.contains("null"), "{text}");
    assert_eq!(serde_json::from_str::<PlateauFit>(&text).unwrap(), fitted);
}

#[test]
fn formula_at_the_papers_points() {
    // p_Δ = 10 p0: Δe = 0.64, e_max(0.1 MPa) = 1.40 (text below eq. 16)
    assert!((delta_e(0.24, 1e5, P0) - 0.644).abs() < 5e-4);
    assert!((exact(1e5) - 1.404).abs() < 5e-4);
    assert!((exact(P0) - 1.76).abs() < 1e-12);
}

/// (15) must not depend on the choice of p_Δ when Δe follows from (16).
#[test]
fn prediction_is_invariant_under_the_choice_of_p_delta() {
    for p_delta in [2e3, 1e4, 7e4, 1e6, 3e7] {
        let delta = delta_e(0.24, p_delta, P0);
        for p in [1e4, 5e4, 1e5, 1e6] {
            let found = e_max(p, E_MIN, delta, 0.24, p_delta).unwrap();
            assert!((found - exact(p)).abs() < 1e-13, "p_delta {p_delta}, p {p}: {found}");
        }
    }
}

#[test]
fn the_fit_is_invariant_under_the_choice_of_p_delta() {
    let levels: Vec<Level> = [1e4, 5e4, 1e5, 1e6]
        .iter()
        .zip([0.01, -0.012, 0.004, -0.003])
        .map(|(&p, noise)| Level { p, e_max: exact(p) + noise, se: 0.01 })
        .collect();
    let reference = fit(&levels, E_MIN, 0.003, P0).unwrap();
    for p_delta in [3e3, 1e5, 2e6] {
        let other = fit(&levels, E_MIN, 0.003, p_delta).unwrap();
        assert!((other.c.value - reference.c.value).abs() < 1e-6);
        assert!((other.c.se / reference.c.se - 1.0).abs() < 1e-3);
        assert!((p0(&other) / p0(&reference) - 1.0).abs() < 1e-5);
        // (16) ties the two Δe
        assert!((delta_e(other.c.value, p_delta, p0(&other)) - other.delta_e.value).abs() < 1e-8);
        for p in [2e4, 3e5] {
            let (a, b) = (other.predict(p).unwrap(), reference.predict(p).unwrap());
            assert!((a.value - b.value).abs() < 1e-7 && (a.se / b.se - 1.0).abs() < 1e-2);
        }
    }
}

#[test]
fn diverges_only_with_an_error() {
    // 0.016 p0 for C = 0.24
    let limit = P0 * (-1.0_f64 / 0.24).exp();
    assert!((limit / P0 - 0.0155).abs() < 1e-3);
    assert!(e_max(limit * 1.001, E_MIN, 1.0, 0.24, P0).is_ok());
    for p in [limit * 0.999, 0.0, -1.0] {
        assert!(matches!(e_max(p, E_MIN, 1.0, 0.24, P0), Err(FitError::OutOfRange { .. })));
    }
    let two = [Level { p: 1e4, e_max: 1.7, se: 0.0 }, Level { p: 1e5, e_max: 1.4, se: 0.0 }];
    assert!(matches!(fit(&two, E_MIN, 0.0, P0), Err(FitError::TooFew { needed: 3, .. })));
}

/// 200 seeded trials: known errors and, in the second half, errors estimated from the residuals.
#[test]
fn recovers_known_parameters_within_the_stated_interval() {
    let pressures = [1e4, 2e4, 5e4, 1e5, 2e5, 5e5, 1e6];
    let (mut c_hits, mut delta_hits, mut p0_hits) = (0, 0, 0);
    for seed in 0..200 {
        let mut rng = Pcg64::seed_from_u64(seed);
        let noise = Normal::new(0.0, 0.012).unwrap();
        let se = if seed % 2 == 0 { 0.012 } else { 0.0 };
        let levels: Vec<Level> =
            pressures.iter().map(|&p| Level { p, e_max: exact(p) + noise.sample(&mut rng), se }).collect();
        let fitted = fit(&levels, E_MIN, 0.0, 5e4).unwrap();
        c_hits += u32::from(fitted.c.covers(0.24));
        delta_hits += u32::from(fitted.delta_e.covers(delta_e(0.24, 5e4, P0)));
        p0_hits += u32::from(fitted.p0.value().unwrap().covers(P0));
    }
    for (name, hits) in [("C", c_hits), ("delta_e", delta_hits), ("p0", p0_hits)] {
        assert!((180..=200).contains(&hits), "{name}: {hits} of 200");
    }
}
