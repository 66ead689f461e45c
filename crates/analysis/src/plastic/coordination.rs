//! Z above jamming: (Z − Z_c)/(Z_1 − Z_c) = √((Φ − Φ_c)/(Φ_1 − Φ_c)) (17), and its exponent as a question.

use serde::{Deserialize, Serialize};

use super::curve::PlasticCurve;
use crate::estimate::mean_of;
use crate::fit::{Datum, Sigma, least_squares};
use crate::{Determined, Estimate, Fit, FitError};

/// One state above jamming.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ExcessPoint {
    /// Φ − Φ_c [1].
    pub excess_phi: f64,
    /// Z − Z_c of the square-root fit [1].
    pub excess_z: f64,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CoordinationCurve {
    /// Id of the run.
    pub id: String,
    /// `elastic` or the value of H.
    pub name: String,
    /// Φ_c from the onset of sustained stress [1].
    pub phi_c: Determined<f64>,
    /// Fit of Z = Z_c + ψ (Φ − Φ_c)^(1/2) for Φ within 0.08 of jamming: parameters z_c, psi; abscissa Φ − Φ_c.
    pub square_root: Determined<Fit>,
    /// Fit with a free exponent up to Φ = 0.95: parameters z_c, psi, gamma.
    pub free: Determined<Fit>,
    /// The state (Φ_1, Z_1) nearest to Φ = 0.95 that (17) is scaled with [1].
    pub later: Option<[f64; 2]>,
    /// States above jamming.
    pub points: Vec<ExcessPoint>,
}

/// Coordination numbers of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Coordination {
    /// One per run, elastic ones first, then by rising H.
    pub curves: Vec<CoordinationCurve>,
    /// Mean exponent of the free fits [1]; the paper has 1/2.
    pub gamma: Determined<Estimate>,
}

/// Range above Φ_c of the square-root fit [1].
const NEAR: f64 = 0.08;
/// Φ_1 of (17), and the end of the free fit [1].
const LATER: f64 = 0.95;

/// Fits (17) to every run.
///
/// # Errors
/// [`FitError::TooFew`] when no run has Z.
pub fn coordination(curves: &[PlasticCurve]) -> Result<Coordination, FitError> {
    let mut with_z: Vec<&PlasticCurve> =
        curves.iter().filter(|curve| curve.states.iter().any(|state| state.z.is_some())).collect();
    with_z.sort_by(|a, b| a.order(b));
    if with_z.is_empty() {
        return Err(FitError::too_few("coordination (17)", "runs with z", 1, 0));
    }
    let curves: Vec<CoordinationCurve> = with_z.iter().map(|curve| one(curve)).collect();
    let exponents: Vec<f64> = curves
        .iter()
        .filter_map(|curve| curve.free.value()?.parameter("gamma"))
        .map(|estimate| estimate.value)
        .collect();
    let gamma = mean_of(&exponents).filter(|_| exponents.len() > 1).ok_or_else(|| {
        FitError::too_few("mean exponent of (17)", "runs with a free fit", 2, exponents.len())
    });
    Ok(Coordination { curves, gamma: gamma.into() })
}

fn one(curve: &PlasticCurve) -> CoordinationCurve {
    let onset = curve.jamming();
    let phi_c = onset.clone().map(|onset| curve.states[onset].phi);
    let above: Vec<(f64, f64)> = match (&onset, &phi_c) {
        (Ok(onset), Ok(phi_c)) => {
            curve.states[*onset..].iter().filter_map(|s| Some((s.phi - phi_c, s.z?))).collect()
        }
        _ => Vec::new(),
    };
    let data = |reach: f64| -> Vec<Datum> {
        let inside = above.iter().filter(|(excess, _)| *excess >= 0.0 && *excess <= reach);
        inside.map(|&(x, y)| Datum { x, y, sigma: 1.0 }).collect()
    };
    let reason = || onset.clone().map(|_| ());
    let square_root = reason().and_then(|()| {
        least_squares(
            "coordination (17)",
            &data(NEAR),
            &["z_c", "psi"],
            &[4.0, 5.0],
            Sigma::Relative,
            |x, t| t[0] + t[1] * x.sqrt(),
        )
    });
    let free = reason().and_then(|()| free_fit(&data(LATER - phi_c.clone().unwrap_or(0.8))));
    let z_c = square_root.as_ref().map_or(0.0, |fit| fit.values()[0]);
    let later = curve
        .states
        .iter()
        .filter_map(|state| Some([state.phi, state.z?]))
        .min_by(|a, b| (a[0] - LATER).abs().total_cmp(&(b[0] - LATER).abs()));
    CoordinationCurve {
        id: curve.id.clone(),
        name: curve.name(),
        points: if square_root.is_ok() {
            above.iter().map(|&(excess_phi, z)| ExcessPoint { excess_phi, excess_z: z - z_c }).collect()
        } else {
            Vec::new()
        },
        phi_c: phi_c.into(),
        square_root: square_root.into(),
        free: free.into(),
        later,
    }
}

fn free_fit(data: &[Datum]) -> Result<Fit, FitError> {
    const WHAT: &str = "coordination with a free exponent";
    let fit =
        least_squares(WHAT, data, &["z_c", "psi", "gamma"], &[4.0, 5.0, 0.5], Sigma::Relative, |x, t| {
            // at x = 0 the power is 0 for any positive exponent, and its derivative by the exponent too
            if t[2] <= 0.0 { f64::NAN } else { t[0] + t[1] * if x > 0.0 { x.powf(t[2]) } else { 0.0 } }
        })?;
    let gamma = fit.parameter("gamma").expect("fitted");
    if gamma.ci95[0] <= 0.0 {
        return Err(FitError::underdetermined(
            WHAT,
            format!("γ = {:.2} ± {:.2} may be zero", gamma.value, gamma.se),
        ));
    }
    Ok(fit)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::plastic::PlasticState;
    use crate::plastic::model::Material;

    fn run(noise: f64, seed: u64) -> PlasticCurve {
        let normal = Normal::new(0.0, noise).unwrap();
        let mut rng = Pcg64::seed_from_u64(seed);
        let states = (0..80)
            .map(|i| 0.77 + 0.0025 * f64::from(i))
            .map(|phi| {
                let jammed = phi >= 0.79999;
                let z = if jammed {
                    3.9 + 5.1 * (phi - 0.8).max(0.0).sqrt() + normal.sample(&mut rng)
                } else {
                    1.0
                };
                let sigma = if jammed { 2e3 + 1e6 * (phi - 0.8) } else { 0.0 };
                PlasticState { phi, sigma, z: Some(z), ..PlasticState::default() }
            })
            .collect();
        let material = Material { young: 10e6, nu: 0.45, sigma_y: 0.4e6, h: None };
        PlasticCurve { id: String::new(), setup: "assembly".to_owned(), material, seed, states }
    }

    #[test]
    fn parameters_lie_within_their_intervals() {
        let mut hits = [0_u32; 4];
        for seed in 0..200 {
            let found = coordination(&[run(0.03, seed)]).unwrap();
            let curve = &found.curves[0];
            let (root, free) = (curve.square_root.value().unwrap(), curve.free.value().unwrap());
            hits[0] += u32::from(root.parameter("z_c").unwrap().covers(3.9));
            hits[1] += u32::from(root.parameter("psi").unwrap().covers(5.1));
            hits[2] += u32::from(free.parameter("psi").unwrap().covers(5.1));
            hits[3] += u32::from(free.parameter("gamma").unwrap().covers(0.5));
        }
        assert!(hits.iter().all(|hit| *hit >= 180), "{hits:?}");
    }

    #[test]
    fn unjammed_runs_and_runs_without_z_are_reasons() {
        let mut loose = run(0.0, 1);
        loose.states.truncate(10);
        let found = coordination(&[loose.clone(), run(0.0, 2)]).unwrap();
        assert!(found.curves[0].square_root.reason().unwrap().contains("sustained"));
        assert!(found.curves[0].points.is_empty() && found.gamma.reason().is_some());
        assert_eq!(found.curves[1].later.map(|later| (later[0] * 1000.0).round()), Some(950.0));
        loose.states.iter_mut().for_each(|state| state.z = None);
        assert!(coordination(&[loose]).is_err());
    }
}
