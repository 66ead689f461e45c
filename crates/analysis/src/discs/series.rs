//! Samples of one kind averaged at equal pressure.

use serde::{Deserialize, Serialize};

use super::DiscState;
use crate::Estimate;
use crate::estimate::mean_of;
use crate::point::count;

/// Mean of a quantity over samples at one pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CurvePoint {
    /// Reduced pressure P* [1].
    pub p_star: f64,
    /// Mean over samples, standard error from their scatter (0 for a single sample).
    pub mean: Estimate,
    /// Standard deviation of one sample; absent for a single sample.
    pub scatter: Option<f64>,
    /// Number of samples.
    pub samples: usize,
}

/// States of one series.
pub(super) struct Series<'a> {
    pub assembly: String,
    pub mu_r: f64,
    pub variant: String,
    pub states: Vec<&'a DiscState>,
}

/// Groups states by assembly, μ_R and the remaining keys, in that order.
pub(super) fn split(states: &[DiscState]) -> Vec<Series<'_>> {
    let mut sorted: Vec<&DiscState> = states.iter().collect();
    sorted.sort_by(|a, b| {
        a.assembly.cmp(&b.assembly).then(a.mu_r.total_cmp(&b.mu_r)).then(a.variant.cmp(&b.variant))
    });
    sorted
        .chunk_by(|a, b| a.assembly == b.assembly && a.mu_r == b.mu_r && a.variant == b.variant)
        .map(|chunk| Series {
            assembly: chunk[0].assembly.clone(),
            mu_r: chunk[0].mu_r,
            variant: chunk[0].variant.clone(),
            states: chunk.to_vec(),
        })
        .collect()
}

/// Whether two pressures are the same step of a programme.
pub(super) fn same_pressure(a: f64, b: f64) -> bool {
    (a / b).ln().abs() < 1e-3
}

/// Averages a quantity over samples at each pressure, in rising pressure.
pub(super) fn average(
    states: &[&DiscState],
    keep: impl Fn(&DiscState) -> bool,
    get: impl Fn(&DiscState) -> Option<f64>,
) -> Vec<CurvePoint> {
    let mut values: Vec<(f64, f64)> = states
        .iter()
        .filter(|state| state.p_star > 0.0 && keep(state))
        .filter_map(|state| Some((state.p_star, get(state)?)))
        .collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    values
        .chunk_by(|a, b| same_pressure(a.0, b.0))
        .map(|chunk| {
            let sample: Vec<f64> = chunk.iter().map(|(_, value)| *value).collect();
            let mean = mean_of(&sample).expect("a chunk is not empty");
            let scatter = (sample.len() > 1).then(|| mean.se * count(sample.len()).sqrt());
            CurvePoint { p_star: chunk[0].0, mean, scatter, samples: sample.len() }
        })
        .collect()
}
