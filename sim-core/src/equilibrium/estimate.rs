//! Estimates made before a run: how much e scatters between replicates. How long a run takes is estimated beside the
//! scene ([`ReducedSpheres::steps`]), where the coordinator needs it too.

use scene::spheres::ReducedSpheres;

/// What is left of e beyond the end of a run over its drift in the last fifth: e − e∞ ∝ 1/t leaves four drifts.
pub(crate) const DRIFT_TO_REST: f64 = 4.0;

/// Standard deviation of e between replicates (seeds) of one scene [1].
///
/// Scatter measured at N = 2207: 0.01 in the intermediate regime (η* ≈ 0.1), 0.05 on the plateau (η* ≥ 1); a fourth
/// or a fifth of it at N = 17 657, where volume fluctuations of independent regions would give N^(−1/2), a third.
#[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
pub(crate) fn e_scatter(scene: &ReducedSpheres) -> f64 {
    let eta_star = scene.adhesion / scene.pressure.sqrt();
    let plateau = eta_star / (1.0 + eta_star);
    (0.005 + 0.09 * plateau) * (2207.0 / scene.n as f64).sqrt()
}
