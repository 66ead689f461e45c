use super::*;

/// analysis.md: the paper's curve gives e = 0.957, 1.172, 1.368, 1.404 at σc = 1, 3, 10, 100 MPa, p = 0.1 MPa,
/// σe = 1e4 MPa.
#[test]
fn the_papers_curve_at_known_points() {
    let e_max = crate::plateau::e_max(1e5, 0.76, 1.0, 0.24, 1e4).unwrap();
    for (sigma_c, expected) in [(1e6, 0.957), (3e6, 1.172), (1e7, 1.368), (1e8, 1.404)] {
        let e_r = MasterCurve::PAPER.e_r(sigma_c / (1e5_f64 * 1e10).sqrt());
        let e = 0.76 + e_r * (e_max - 0.76);
        assert!((e - expected).abs() < 1e-3, "{sigma_c}: {e}");
    }
    let inverse = MasterCurve::PAPER.inverse_s(ETA_STAR_M);
    assert!((1.0 / inverse - 1.55).abs() < 1e-12);
    assert_eq!(MasterCurve::PAPER.e_r(1e300), 1.0);
    assert_eq!(MasterCurve::PAPER.e_r(0.0), 0.0);
}

fn exact_points(curve: MasterCurve, low: f64, high: f64, n: u32) -> Vec<MasterPoint> {
    (0..n)
        .map(|i| {
            let eta_star = low * (high / low).powf(f64::from(i) / f64::from(n - 1));
            MasterPoint { eta_star, e_r: curve.e_r(eta_star), sigma: 1.0 }
        })
        .collect()
}

#[test]
fn exact_data_give_the_exact_curve() {
    for curve in [MasterCurve::PAPER, MasterCurve { a: 0.3, alpha: 1.0, b: 0.4, beta: 1.7 }] {
        let core = fit_points(&exact_points(curve, 1e-3, 1.0, 40), Sigma::Relative, None).unwrap();
        for (found, truth) in core.curve.theta().iter().zip(curve.theta()) {
            assert!((found - truth).abs() < 1e-4, "{found} against {truth}");
        }
    }
}

/// Data of one regime only leave the other power law free: an error, never a number.
#[test]
fn one_regime_alone_is_refused() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    let noise = Normal::new(0.0, 0.004).unwrap();
    let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
    let mut points = exact_points(MasterCurve::PAPER, 1e-3, 1e-2, 20);
    for point in &mut points {
        point.e_r += noise.sample(&mut rng);
    }
    assert!(fit_points(&points, Sigma::Relative, None).is_err());
    assert!(matches!(fit_points(&points[..4], Sigma::Relative, None), Err(FitError::TooFew { .. })));
}
