//! Estimates made before a run: how much e scatters between replicates. How long a run takes is estimated beside the
//! scene ([`ReducedSpheres::steps`]), where the coordinator needs it too.

use scene::spheres::ReducedSpheres;

/// What is left of e beyond the end of a run over its drift in the last fifth: e − e∞ ∝ 1/t leaves four drifts.
pub(crate) const DRIFT_TO_REST: f64 = 4.0;

/// Standard deviation of e between replicates (seeds) of one scene [1].
///
/// A model of what was measured at n = 250 … 2000 without wall adhesion (docs/accuracy.md): at N = 2207 0.007 without
/// cohesion, 0.015 on the plateau of high adhesion, √(2207/n) elsewhere. Adhesive walls scatter more at high adhesion:
/// 0.02 at N = 2207 (three seeds).
#[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
pub(crate) fn e_scatter(scene: &ReducedSpheres) -> f64 {
    /// η* at which the scatter is half way between its ends [1].
    const CROSSOVER: f64 = 0.05;
    let eta_star = scene.adhesion / scene.pressure.sqrt();
    let plateau = eta_star / (CROSSOVER + eta_star);
    let walls = 1.0 + scene.wall_adhesion.min(1.0);
    (0.007 + 0.0085 * walls * plateau) * (2207.0 / scene.n as f64).sqrt()
}
