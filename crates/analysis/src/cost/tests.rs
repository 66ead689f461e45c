use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;

fn grid(n: usize) -> Vec<f64> {
    (0..n).map(|i| -3.0 + 6.0 * i as f64 / (n - 1) as f64).collect()
}

#[test]
fn a_cubic_is_reproduced() {
    let u = grid(40);
    let y: Vec<f64> = u.iter().map(|u| 1.0 + 2.0 * u + 0.1 * u.powi(3)).collect();
    let w = vec![1.0; 40];
    for shape in [Shape::Free, Shape::Increasing] {
        assert!(scatter("test", &u, &y, &w, shape).unwrap().rms < 1e-5, "{shape:?}");
    }
    let falling: Vec<f64> = y.iter().map(|y| -y).collect();
    assert!(scatter("test", &u, &falling, &w, Shape::Decreasing).unwrap().rms < 1e-5);
}

#[test]
fn a_monotone_curve_cannot_follow_a_wave() {
    let u = grid(60);
    let y: Vec<f64> = u.iter().map(|u| (2.0 * u).sin()).collect();
    let w = vec![1.0; 60];
    let free = scatter("test", &u, &y, &w, Shape::Free).unwrap().rms;
    let monotone = scatter("test", &u, &y, &w, Shape::Increasing).unwrap().rms;
    assert!(free < 0.1 && monotone > 0.3, "free {free}, monotone {monotone}");
    // against an increasing curve, the best fit to falling data is its mean
    let falling: Vec<f64> = u.iter().map(|u| -u).collect();
    let rss = residual_sum(&u, &falling, &w, Shape::Increasing).unwrap();
    let about_mean: f64 = u.iter().map(|u| u * u).sum();
    assert!((rss / about_mean - 1.0).abs() < 1e-9);
}

#[test]
fn estimates_the_noise_whatever_the_stretch_of_u() {
    let mut rng = Pcg64::seed_from_u64(7);
    let u = grid(400);
    let y: Vec<f64> =
        u.iter().map(|u| u.tanh() + 0.05 * (rng.random::<f64>() - 0.5) * 12.0_f64.sqrt()).collect();
    let w = vec![1.0; 400];
    let found = scatter("test", &u, &y, &w, Shape::Increasing).unwrap();
    assert!((found.rms / 0.05 - 1.0).abs() < 0.1, "{found:?}");
    let stretched: Vec<f64> = u.iter().map(|u| 7.0 * u + 100.0).collect();
    let other = scatter("test", &stretched, &y, &w, Shape::Increasing).unwrap();
    assert!((other.rms / found.rms - 1.0).abs() < 1e-6);
}

#[test]
fn too_few_points_or_one_abscissa_is_an_error() {
    let u = grid(7);
    assert!(matches!(
        scatter("test", &u, &u, &[1.0; 7], Shape::Free),
        Err(FitError::TooFew { needed: 8, .. })
    ));
    assert!(matches!(
        scatter("test", &[1.0; 20], &grid(20), &[1.0; 20], Shape::Free),
        Err(FitError::Underdetermined { .. })
    ));
}

#[test]
fn a_weight_of_zero_is_absence() {
    let u = grid(30);
    let mut y: Vec<f64> = u.iter().map(|u| u.tanh()).collect();
    let mut w = vec![1.0; 30];
    let before = residual_sum(&u, &y, &w, Shape::Free).unwrap();
    y[11] = 50.0;
    w[11] = 0.0;
    assert!(residual_sum(&u, &y, &w, Shape::Free).unwrap() <= before + 1e-12);
}
