//! Fractal dimension, correlation length and pore size of the consolidation states.

use serde::{Deserialize, Serialize};

use super::DiscState;
use super::series::{CurvePoint, Series, average, split};
use crate::fit::{Datum, Sigma, least_squares};
use crate::{Estimate, Fit, FitError};

/// Structure of one kind of sample against P*.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct StructureCurve {
    /// Assembling procedure.
    pub assembly: String,
    /// Rolling friction μ_R/a [1].
    pub mu_r: f64,
    /// Remaining scene keys.
    pub variant: String,
    /// Fractal dimension d_F where the state has a fractal range [1].
    pub fractal_dimension: Vec<CurvePoint>,
    /// Correlation length ξ [a].
    pub correlation_length: Vec<CurvePoint>,
    /// Mass-averaged radius of gyration of the pores ξ' [a].
    pub pore_radius: Vec<CurvePoint>,
    /// States of first loading.
    pub states: usize,
    /// States of first loading without a fractal range (dense packings have none).
    pub without_fractal_range: usize,
}

/// Structure of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Structure {
    /// One per assembling procedure, μ_R and remaining keys.
    pub curves: Vec<StructureCurve>,
}

/// Structure of the states on first loading.
///
/// # Errors
/// [`FitError::TooFew`] when no state has a correlation length or a pore radius.
pub fn structure(states: &[DiscState]) -> Result<Structure, FitError> {
    if !states.iter().any(|state| state.correlation_length.is_some() || state.pore_radius.is_some()) {
        return Err(FitError::too_few("structure", "states with correlation length or pore radius", 1, 0));
    }
    Ok(Structure { curves: split(states).iter().map(curve).collect() })
}

fn curve(series: &Series<'_>) -> StructureCurve {
    let of = |get: fn(&DiscState) -> Option<f64>| average(&series.states, DiscState::is_loading, get);
    let loaded = || series.states.iter().filter(|state| state.is_loading());
    StructureCurve {
        assembly: series.assembly.clone(),
        mu_r: series.mu_r,
        variant: series.variant.clone(),
        fractal_dimension: of(|state| state.fractal_dimension),
        correlation_length: of(|state| state.correlation_length),
        pore_radius: of(|state| state.pore_radius),
        states: loaded().count(),
        without_fractal_range: loaded().filter(|state| state.fractal_dimension.is_none()).count(),
    }
}

/// One shell of the scattering intensity, averaged over samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Intensity {
    /// Wavenumber k [1/a].
    pub k: f64,
    /// I(k) = |χ̂|²/A [a²].
    pub intensity: f64,
    /// Weight: number of wave vectors behind it; ln I has a variance inverse to it.
    pub weight: f64,
}

/// Fit of I(k) = I_0 [1 + (kξ/2π)²]^(−d_F/2): constant below 2π/ξ, slope −d_F above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct IntensityFit {
    /// Plateau I_0 [a²].
    pub plateau: Estimate,
    /// Correlation length ξ [a].
    pub correlation_length: Estimate,
    /// Fractal dimension d_F [1].
    pub fractal_dimension: Estimate,
    /// The fit in ln I: parameters ln_i0, ln_xi, d_f; abscissa k [1/a].
    pub fit: Fit,
}

/// Fits the intensity for k ≤ `largest` (lengths above two largest diameters: π/a).
///
/// # Errors
/// [`FitError`] with fewer than four shells, when the fit does not converge, or when no crossover lies inside the
/// measured range: the packing then has no fractal range.
pub fn fit_intensity(shells: &[Intensity], largest: f64) -> Result<IntensityFit, FitError> {
    const WHAT: &str = "scattering intensity I(k)";
    let data: Vec<Datum> = shells
        .iter()
        .filter(|shell| shell.k > 0.0 && shell.k <= largest && shell.intensity > 0.0 && shell.weight > 0.0)
        .map(|shell| Datum { x: shell.k, y: shell.intensity.ln(), sigma: shell.weight.powf(-0.5) })
        .collect();
    let lowest = data.iter().map(|d| d.x).fold(f64::INFINITY, f64::min);
    let top = data.iter().map(|d| d.y).fold(f64::NEG_INFINITY, f64::max);
    let two_pi = std::f64::consts::TAU;
    let model = |k: f64, t: &[f64]| t[0] - 0.5 * t[2] * (k * t[1].exp() / two_pi).powi(2).ln_1p();
    let mut best: Option<Fit> = None;
    let mut failure = FitError::too_few(WHAT, "shells", 4, data.len());
    for part in [0.15, 0.3, 0.6] {
        let start = [top, (two_pi / lowest * part).ln(), 1.5];
        match least_squares(WHAT, &data, &["ln_i0", "ln_xi", "d_f"], &start, Sigma::Relative, model) {
            Ok(fit) if best.as_ref().is_none_or(|other| fit.reduced_chi2 < other.reduced_chi2) => {
                best = Some(fit)
            }
            Ok(_) => {}
            Err(error) => failure = error,
        }
    }
    let fit = best.ok_or(failure)?;
    let xi = fit.parameter("ln_xi").expect("fitted").exp();
    let d_f = fit.parameter("d_f").expect("fitted");
    if xi.value <= 1.0 || xi.value >= two_pi / lowest || d_f.value <= 0.0 || d_f.value >= 4.0 {
        return Err(FitError::out_of_range(
            WHAT,
            format!("ξ = {:.2} a, d_F = {:.2}: no fractal range inside the cell", xi.value, d_f.value),
        ));
    }
    Ok(IntensityFit {
        plateau: fit.parameter("ln_i0").expect("fitted").exp(),
        correlation_length: xi,
        fractal_dimension: d_f,
        fit,
    })
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use rand_pcg::Pcg64;

    use super::*;

    fn shells(noise: f64, seed: u64) -> Vec<Intensity> {
        let normal = Normal::new(0.0, noise).unwrap();
        let mut rng = Pcg64::seed_from_u64(seed);
        (1..=24)
            .map(|i| 0.126 * f64::from(i))
            .map(|k| {
                let weight = 40.0 * k;
                let exact = 3.0 * (1.0 + (k * 5.1 / std::f64::consts::TAU).powi(2)).powf(-0.76);
                Intensity { k, intensity: exact * (normal.sample(&mut rng) / weight.sqrt()).exp(), weight }
            })
            .collect()
    }

    #[test]
    fn the_paper_like_intensity_is_recovered_within_its_intervals() {
        let (mut xi, mut d_f) = (0, 0);
        for seed in 0..200 {
            let found = fit_intensity(&shells(0.15, seed), std::f64::consts::PI).unwrap();
            xi += u32::from(found.correlation_length.covers(5.1));
            d_f += u32::from(found.fractal_dimension.covers(1.52));
        }
        assert!(xi >= 180 && d_f >= 180, "ξ {xi}, d_F {d_f} of 200");
    }

    #[test]
    fn a_flat_intensity_has_no_fractal_range() {
        let flat: Vec<Intensity> =
            shells(0.0, 1).iter().map(|shell| Intensity { intensity: 0.3, ..*shell }).collect();
        assert!(fit_intensity(&flat, std::f64::consts::PI).is_err());
        assert!(fit_intensity(&flat[..3], std::f64::consts::PI).is_err());
    }

    #[test]
    fn states_without_fractal_range_are_counted() {
        let state = |p_star: f64, d_f: Option<f64>| DiscState {
            p_star,
            phi: 0.6,
            branch: "compression".to_owned(),
            fractal_dimension: d_f,
            correlation_length: d_f.map(|_| 5.0),
            pore_radius: Some(2.0),
            ..DiscState::default()
        };
        let found = structure(&[state(0.01, Some(1.5)), state(1.0, None)]).unwrap();
        let curve = &found.curves[0];
        assert_eq!((curve.states, curve.without_fractal_range, curve.pore_radius.len()), (2, 1, 2));
        assert!(structure(&[DiscState::default()]).is_err());
    }
}
