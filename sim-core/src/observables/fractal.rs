//! Fractal dimension and correlation length from the scattering intensity.

use super::structure_factor::Shell;
use core::f64::consts::PI;
use nalgebra::{Matrix3, Vector3};

/// Parameters of I(k) = I_0 [1 + (k ξ/2π)²]^(−d_F/2): constant below the crossover 2π/ξ, slope −d_F above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FractalFit {
    /// Plateau I_0 [a²].
    pub plateau: f64,
    /// Correlation length ξ [a].
    pub correlation_length: f64,
    /// Fractal dimension d_F [1].
    pub dimension: f64,
    /// Root mean square of the residuals of ln I, shells weighted by their number of wave vectors [1].
    pub rms: f64,
}

/// Largest wavenumber used: lengths above two largest diameters [1/a].
pub const LARGEST_WAVENUMBER: f64 = PI;

/// Least squares in ln I over the shells with |k| ≤ [`LARGEST_WAVENUMBER`], each weighted by its number of wave
/// vectors (the variance of ln I of a shell is inverse to it). `None` with fewer than six shells, or when no
/// crossover lies inside the measured range: ξ outside (a, L) or d_F outside (0, 4) means that the packing has no
/// fractal range, as for dense packings.
#[must_use]
pub fn fit_fractal(shells: &[Shell]) -> Option<FractalFit> {
    let used: Vec<&Shell> = shells
        .iter()
        .filter(|shell| shell.wavenumber <= LARGEST_WAVENUMBER && shell.intensity > 0.0)
        .collect();
    if used.len() < 6 {
        return None;
    }
    let longest = 2.0 * PI / used[0].wavenumber;
    let mut best: Option<(f64, Vector3<f64>)> = None;
    for start in [0.15, 0.3, 0.6] {
        let guess = Vector3::new(libm::log(used[0].intensity), libm::log(longest * start), libm::log(1.5));
        let (cost, found) = levenberg_marquardt(&used, guess);
        if best.is_none_or(|(lowest, _)| cost < lowest) {
            best = Some((cost, found));
        }
    }
    let (cost, found) = best?;
    let weights: f64 = used.iter().map(|shell| shell.vectors as f64).sum();
    let fit = FractalFit {
        plateau: libm::exp(found[0]),
        correlation_length: libm::exp(found[1]),
        dimension: libm::exp(found[2]),
        rms: libm::sqrt(cost / weights),
    };
    let inside = fit.correlation_length > 1.0 && fit.correlation_length < longest && fit.dimension < 4.0;
    inside.then_some(fit)
}

/// ln I and its gradient by (ln I_0, ln ξ, ln d_F).
fn model(wavenumber: f64, parameters: &Vector3<f64>) -> (f64, Vector3<f64>) {
    let dimension = libm::exp(parameters[2]);
    let scaled = wavenumber * libm::exp(parameters[1]) / (2.0 * PI);
    let squared = scaled * scaled;
    let logarithm = libm::log1p(squared);
    let value = parameters[0] - 0.5 * dimension * logarithm;
    (value, Vector3::new(1.0, -dimension * squared / (1.0 + squared), -0.5 * dimension * logarithm))
}

fn cost(shells: &[&Shell], parameters: &Vector3<f64>) -> f64 {
    shells
        .iter()
        .map(|shell| {
            let residual = libm::log(shell.intensity) - model(shell.wavenumber, parameters).0;
            shell.vectors as f64 * residual * residual
        })
        .sum()
}

fn levenberg_marquardt(shells: &[&Shell], start: Vector3<f64>) -> (f64, Vector3<f64>) {
    let mut parameters = start;
    let mut lowest = cost(shells, &parameters);
    let mut damping = 1e-2;
    for _ in 0..200 {
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for shell in shells {
            let (value, gradient) = model(shell.wavenumber, &parameters);
            let weight = shell.vectors as f64;
            normal += gradient * gradient.transpose() * weight;
            right += gradient * (weight * (libm::log(shell.intensity) - value));
        }
        let mut damped = normal;
        for axis in 0..3 {
            damped[(axis, axis)] += damping * (normal[(axis, axis)] + 1e-12);
        }
        let Some(inverse) = damped.try_inverse() else { break };
        let step = inverse * right;
        let tried = parameters + step;
        let reached = cost(shells, &tried);
        if reached < lowest {
            let small = lowest - reached < 1e-13 * lowest;
            parameters = tried;
            lowest = reached;
            damping = (damping * 0.3).max(1e-12);
            if small {
                break;
            }
        } else {
            damping *= 4.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    (lowest, parameters)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn synthetic(xi: f64, dimension: f64) -> Vec<Shell> {
        (1..30)
            .map(|index| {
                let wavenumber = 0.15 * f64::from(index);
                let scaled = wavenumber * xi / (2.0 * PI);
                let intensity = 3.0 * libm::pow(1.0 + scaled * scaled, -0.5 * dimension);
                Shell { wavenumber, intensity, vectors: 3 * index as usize }
            })
            .collect()
    }

    #[test]
    fn recovers_known_parameters() {
        for (xi, dimension) in [(9.3, 1.52), (5.1, 1.55), (7.0, 1.9)] {
            let fit = fit_fractal(&synthetic(xi, dimension)).unwrap();
            assert!((fit.correlation_length / xi - 1.0).abs() < 1e-6, "{fit:?}");
            assert!((fit.dimension / dimension - 1.0).abs() < 1e-6, "{fit:?}");
            assert!((fit.plateau / 3.0 - 1.0).abs() < 1e-6, "{fit:?}");
            assert!(fit.rms < 1e-6);
        }
    }

    #[test]
    fn a_flat_signal_has_no_fractal_range() {
        let flat: Vec<Shell> =
            synthetic(5.0, 1.5).into_iter().map(|shell| Shell { intensity: 0.2, ..shell }).collect();
        assert_eq!(fit_fractal(&flat), None);
    }
}
