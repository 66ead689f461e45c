use super::*;

fn line(points: usize, noise: impl Fn(usize) -> f64) -> Vec<Datum> {
    (0..points)
        .map(|i| {
            let x = i as f64;
            Datum { x, y: 2.0 - 0.5 * x + noise(i), sigma: 1.0 + 0.1 * x }
        })
        .collect()
}

/// The normal equations of a weighted straight line have a closed form.
#[test]
fn straight_line_has_the_covariance_of_the_normal_equations() {
    let data = line(12, |i| if i % 2 == 0 { 0.3 } else { -0.2 });
    let fit = least_squares("line", &data, &["a", "b"], &[0.0, 0.0], Sigma::Relative, |x, t| t[0] + t[1] * x)
        .unwrap();
    let (mut s, mut sx, mut sxx, mut sy, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for d in &data {
        let w = d.sigma.powi(-2);
        s += w;
        sx += w * d.x;
        sxx += w * d.x * d.x;
        sy += w * d.y;
        sxy += w * d.x * d.y;
    }
    let delta = s * sxx - sx * sx;
    let (a, b) = ((sxx * sy - sx * sxy) / delta, (s * sxy - sx * sy) / delta);
    let chi2: f64 = data.iter().map(|d| ((d.y - a - b * d.x) / d.sigma).powi(2)).sum::<f64>() / 10.0;
    assert!((fit.parameters[0].estimate.value - a).abs() < 1e-9);
    assert!((fit.parameters[1].estimate.value - b).abs() < 1e-9);
    assert!((fit.reduced_chi2 / chi2 - 1.0).abs() < 1e-9);
    for (found, exact) in [
        (fit.covariance[0][0], sxx / delta * chi2),
        (fit.covariance[0][1], -sx / delta * chi2),
        (fit.covariance[1][1], s / delta * chi2),
    ] {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} against {exact}");
    }
    let sum = fit.derived(|t| t[0] + t[1]);
    let variance = fit.covariance[0][0] + 2.0 * fit.covariance[0][1] + fit.covariance[1][1];
    assert!((sum.se - variance.sqrt()).abs() < 1e-9);
}

#[test]
fn no_degree_of_freedom_is_an_error() {
    let error =
        least_squares("line", &line(2, |_| 0.0), &["a", "b"], &[0.0, 0.0], Sigma::Relative, |x, t| {
            t[0] + t[1] * x
        })
        .unwrap_err();
    assert!(matches!(error, FitError::TooFew { needed: 3, found: 2, .. }));
    assert_eq!(error.to_string(), "line needs at least 3 points, found 2");
}

#[test]
fn a_free_combination_is_an_error_that_names_it() {
    let error = least_squares(
        "line",
        &line(9, |_| 0.0),
        &["a", "b", "c"],
        &[0.5, 0.5, 0.0],
        Sigma::Relative,
        |x, t| t[0] + t[1] + t[2] * x,
    )
    .unwrap_err();
    let FitError::Underdetermined { reason, .. } = error else { panic!("{error}") };
    assert!(reason.contains("a, b"), "{reason}");
    let dead =
        least_squares("line", &line(9, |_| 0.0), &["a", "b"], &[0.0, 0.0], Sigma::Relative, |_, t| t[0]);
    assert!(matches!(dead, Err(FitError::Underdetermined { .. } | FitError::NotConverged { .. })));
}

#[test]
fn bad_data_and_bad_models_are_errors() {
    let nan = [Datum { x: 0.0, y: f64::NAN, sigma: 1.0 }; 5];
    let constant = |_: f64, t: &[f64]| t[0];
    assert!(matches!(
        least_squares("mean", &nan, &["a"], &[0.0], Sigma::Relative, constant),
        Err(FitError::OutOfRange { .. })
    ));
    let fine = line(5, |_| 0.0);
    assert!(matches!(
        least_squares("log", &fine, &["a"], &[-1.0], Sigma::Relative, |_, t| t[0].ln()),
        Err(FitError::NotConverged { .. })
    ));
}

#[test]
fn absolute_errors_are_never_made_smaller_by_a_lucky_chi2() {
    let data = line(12, |i| if i % 2 == 0 { 0.03 } else { -0.02 });
    let model = |x: f64, t: &[f64]| t[0] + t[1] * x;
    let absolute = least_squares("line", &data, &["a", "b"], &[0.0, 0.0], Sigma::Absolute, model).unwrap();
    let relative = least_squares("line", &data, &["a", "b"], &[0.0, 0.0], Sigma::Relative, model).unwrap();
    assert!(absolute.reduced_chi2 < 1.0);
    assert!(absolute.parameters[0].estimate.se > relative.parameters[0].estimate.se);
}
