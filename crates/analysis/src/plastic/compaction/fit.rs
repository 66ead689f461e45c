//! The fits of one curve.

use super::{CompactionCurve, CompactionOptions, Jamming, ModelSample};
use crate::fit::{Datum, Sigma, least_squares};
use crate::plastic::curve::{PlasticCurve, PlasticState};
use crate::plastic::model::Constants;
use crate::point::count;
use crate::{Estimate, Fit, FitError};

/// States from jamming on, up to the largest Φ, that have Z.
fn jammed<'a>(
    curve: &'a PlasticCurve,
    options: &CompactionOptions,
) -> Result<Vec<&'a PlasticState>, FitError> {
    let onset = curve.jamming()?;
    Ok(curve.states[onset..]
        .iter()
        .filter(|state| state.phi <= options.largest_phi && state.z.is_some_and(|z| z > 0.0))
        .collect())
}

/// The constants that jamming fixes: p_c = 1 − Φ_c, c2 = −ln Φ_c.
fn at_jamming(phi_c: f64) -> Constants {
    Constants { p_c: 1.0 - phi_c, c2: -phi_c.ln(), phi_c, ..Constants::PAPER }
}

/// Fit of (6) to an elastic curve: its constants and the fit.
pub(super) fn constants(
    curve: &PlasticCurve,
    options: &CompactionOptions,
) -> Result<(Constants, Fit), FitError> {
    let states = jammed(curve, options)?;
    let base = at_jamming(curve.states[curve.jamming()?].phi);
    let data = data(&states);
    let apply = |t: &[f64]| Constants { f_e: t[0], f_g: t[1], ..base };
    let fit = least_squares(
        "elastic compaction (6)",
        &data,
        &["f_e", "f_g"],
        &[1.2, 0.2],
        Sigma::Relative,
        |index, t| {
            let state = states[index_of(index)];
            let sigma = apply(t).sigma_elastic(&curve.material, state.phi, state.z.unwrap_or(0.0));
            if sigma.is_finite() { sigma } else { f64::NAN }
        },
    )?;
    Ok((apply(&fit.values()), fit))
}

/// Fit of (10) to a plastic curve for f_ep, the elastic constants held; f_p as measured where it is, else by (11).
fn plastic(
    curve: &PlasticCurve,
    held: Option<Constants>,
    alpha: Option<f64>,
    options: &CompactionOptions,
) -> Result<(Constants, Fit), FitError> {
    const WHAT: &str = "plastic compaction (10)";
    if curve.material.h.is_some_and(|h| h <= 0.0) {
        return Err(FitError::underdetermined(
            WHAT,
            "for H = 0 the plastic stress is σ_y: nothing is left to fit",
        ));
    }
    let states = jammed(curve, options)?;
    let phi_c = curve.states[curve.jamming()?].phi;
    let elastic = held.unwrap_or(Constants::PAPER);
    let base =
        Constants { f_e: elastic.f_e, f_g: elastic.f_g, alpha: alpha.unwrap_or(2.5), ..at_jamming(phi_c) };
    let apply = |t: &[f64]| Constants { f_ep: t[0], ..base };
    let data = data(&states);
    let stress = |index: f64, t: &[f64]| blend(&apply(t), curve, states[index_of(index)]);
    let fit = least_squares(WHAT, &data, &["f_ep"], &[1.2], Sigma::Relative, stress)?;
    // f_ep → ∞ leaves the least stress that (10) can give; data that it describes as well do not bound f_ep
    let square = |d: &Datum| ((d.y - stress(d.x, &[f64::INFINITY])) / d.sigma).powi(2);
    let excess = data.iter().map(square).sum::<f64>() - fit.reduced_chi2 * count(fit.degrees_of_freedom);
    if excess <= LIMIT * fit.reduced_chi2 {
        return Err(FitError::underdetermined(
            WHAT,
            "any large f_ep describes the data as well: they lie at or below f_p σ_y and no hardening is left to fit",
        ));
    }
    Ok((apply(&fit.values()), fit))
}

/// χ² over the reduced one by which an unbounded f_ep must be worse: the 95 % point of χ² with one degree of freedom.
const LIMIT: f64 = 3.84;

/// (10) with the measured plastic share where the state has one.
fn blend(constants: &Constants, curve: &PlasticCurve, state: &PlasticState) -> f64 {
    let z = state.z.unwrap_or(0.0);
    let elastic = constants.sigma_elastic(&curve.material, state.phi, z);
    let Some(plastic) = constants.sigma_plastic(&curve.material, state.phi, z) else { return elastic };
    let share = state.f_p.unwrap_or_else(|| constants.plastic_share(state.phi));
    (1.0 - share) * elastic + share * plastic
}

/// Stress over the number of the state.
fn data(states: &[&PlasticState]) -> Vec<Datum> {
    let top = states.iter().map(|state| state.sigma.abs()).fold(f64::MIN_POSITIVE, f64::max);
    states
        .iter()
        .enumerate()
        .map(|(i, state)| Datum { x: count(i), y: state.sigma, sigma: 0.01 * top })
        .collect()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "made from an index by `data`")]
fn index_of(x: f64) -> usize {
    x as usize
}

pub(super) fn curve(
    curve: &PlasticCurve,
    elastic: Option<&PlasticCurve>,
    held: Option<Constants>,
    options: &CompactionOptions,
) -> CompactionCurve {
    let alpha = alpha(curve, options);
    let slope = alpha.as_ref().ok().map(|estimate| estimate.value);
    let fitted = match curve.material.h {
        None => constants(curve, options),
        Some(_) => plastic(curve, held, slope, options),
    };
    let model = model(curve, fitted.as_ref().ok().map(|(constants, _)| *constants));
    CompactionCurve {
        id: curve.id.clone(),
        name: curve.name(),
        material: curve.material,
        states: curve.states.clone(),
        jamming: jamming(curve).into(),
        fit: fitted.map(|(_, fit)| fit).into(),
        alpha: alpha.into(),
        parts_at: parts_at(curve, elastic, options).into(),
        model,
    }
}

fn jamming(curve: &PlasticCurve) -> Result<Jamming, FitError> {
    let onset = curve.jamming()?;
    let state = &curve.states[onset];
    let data: Vec<Datum> = curve.states[onset..]
        .iter()
        .filter(|later| later.phi <= state.phi + 0.03)
        .map(|later| Datum { x: later.phi, y: later.sigma / curve.material.young, sigma: 1.0 })
        .collect();
    let extrapolated = least_squares(
        "back-extrapolation of σ(Φ)",
        &data,
        &["phi_c", "slope"],
        &[state.phi, 1.0],
        Sigma::Relative,
        |phi, t| t[1] * (phi - t[0]),
    )
    .map(|fit| fit.parameter("phi_c").expect("fitted"));
    Ok(Jamming {
        phi_c: state.phi,
        sigma_c: state.sigma,
        strain_c: state.strain,
        z_c: state.z,
        phi_c_extrapolated: extrapolated.into(),
    })
}

/// α of (11): f_p against ln(Φ/Φ_c) through the origin, from jamming to f_p = 0.9, where (11) would be cut off.
fn alpha(curve: &PlasticCurve, options: &CompactionOptions) -> Result<Estimate, FitError> {
    const WHAT: &str = "plastic share (11)";
    if curve.material.h.is_none() {
        return Err(FitError::underdetermined(WHAT, "elastic discs have no plastic share"));
    }
    let onset = curve.jamming()?;
    let phi_c = curve.states[onset].phi;
    let data: Vec<Datum> = curve.states[onset..]
        .iter()
        .filter(|state| state.phi <= options.largest_phi)
        .filter_map(|state| Some(Datum { x: (state.phi / phi_c).ln(), y: state.f_p?, sigma: 1.0 }))
        .filter(|datum| datum.y < 0.9 && datum.x > 0.0)
        .collect();
    let fit = least_squares(WHAT, &data, &["alpha"], &[2.5], Sigma::Relative, |x, t| t[0] * x)?;
    Ok(fit.parameter("alpha").expect("fitted"))
}

/// Elastic stress from which on the plastic curve stays more than the given share below it at equal Φ.
fn parts_at(
    curve: &PlasticCurve,
    elastic: Option<&PlasticCurve>,
    options: &CompactionOptions,
) -> Result<f64, FitError> {
    const WHAT: &str = "stress where plastic and elastic curves part";
    if curve.material.h.is_none() {
        return Err(FitError::underdetermined(WHAT, "this is the elastic curve"));
    }
    let elastic = elastic.ok_or_else(|| FitError::too_few(WHAT, "elastic runs", 1, 0))?;
    let onset = curve.jamming()?.max(1);
    let pairs: Vec<(f64, f64)> = curve.states[onset..]
        .iter()
        .filter_map(|state| Some((interpolate(&elastic.states, state.phi)?, state.sigma)))
        .filter(|(reference, _)| *reference > 0.0)
        .collect();
    let together = pairs.iter().rposition(|(reference, sigma)| 1.0 - sigma / reference <= options.parted);
    let first = together.map_or(0, |last| last + 1);
    pairs.get(first).map(|(reference, _)| *reference).ok_or_else(|| {
        FitError::out_of_range(WHAT, format!("within {} % of each other to the end", 100.0 * options.parted))
    })
}

/// σ(Φ) of a curve by linear interpolation.
fn interpolate(states: &[PlasticState], phi: f64) -> Option<f64> {
    let pair = states.windows(2).find(|pair| pair[0].phi <= phi && phi <= pair[1].phi)?;
    let width = pair[1].phi - pair[0].phi;
    let share = if width > 0.0 { (phi - pair[0].phi) / width } else { 0.0 };
    Some(pair[0].sigma + share * (pair[1].sigma - pair[0].sigma))
}

fn model(curve: &PlasticCurve, fitted: Option<Constants>) -> Vec<ModelSample> {
    let Ok(onset) = curve.jamming() else { return Vec::new() };
    let start = curve.states[onset].strain;
    let sample = |state: &PlasticState| {
        let z = state.z.filter(|z| *z > 0.0)?;
        let constants = fitted.unwrap_or(Constants::PAPER);
        let excess = state.strain.zip(start).map(|(strain, start)| strain - start);
        Some(ModelSample {
            phi: state.phi,
            paper: Constants::PAPER.sigma(&curve.material, state.phi, z),
            fitted: fitted.map(|constants| blend(&constants, curve, state)),
            excess_strain: excess,
            by_strain: excess.map(|excess| {
                let elastic = constants.excess_stress(&curve.material, state.phi, excess);
                let Some(plastic) = constants.excess_stress_plastic(&curve.material, state.phi, excess)
                else {
                    return elastic;
                };
                let share = state.f_p.unwrap_or_else(|| constants.plastic_share(state.phi));
                (1.0 - share) * elastic + share * plastic
            }),
        })
    };
    curve.states[onset..].iter().filter_map(sample).collect()
}
