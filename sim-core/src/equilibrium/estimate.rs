//! Estimates made before a run: how long until e has settled, and how much e scatters between replicates.

use scene::spheres::{Approach, ReducedSpheres, Stop};

/// Time until e is within 1e-3 of its final value: 0.452 τ (σe/p)^0.7, a fit to measured runs at N = 2207
/// (285, 1430, 7070, 30 000 τ at p/σe = 1e-4, 1e-5, 1e-6, 1e-7).
pub(crate) fn settling_time(pressure: f64) -> f64 {
    0.452 * libm::pow(1.0 / pressure, 0.7)
}

/// Multiples of the settling time a stop rule takes (typical, limit). Typical values are for progress; a limit ends
/// the run with status `e_converged` or `step_limit`.
fn multiples(stop: &Stop, approach: Approach) -> (f64, f64) {
    match (approach, stop) {
        (Approach::RollingKicks, _) => (4.5, 20.0),
        (Approach::Natural, Stop::Settled { .. }) => (2.0, 20.0),
        (Approach::Natural, Stop::Evidence { .. }) => (10.0, 20.0),
        (Approach::Natural, Stop::KineticEnergy { .. }) => (40.0, 60.0),
        (Approach::Natural, Stop::Steps) => (20.0, 20.0),
    }
}

/// (expected steps, step limit) of a run with time step `dt` [τ].
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bounded below 2^53 before the cast"
)]
pub(crate) fn steps(scene: &ReducedSpheres, dt: f64) -> (u64, u64) {
    let unit = settling_time(scene.pressure) / dt;
    let (typical, limit) = multiples(&scene.stop, scene.approach);
    let whole = |steps: f64| steps.ceil().clamp(1000.0, 1.0e12) as u64;
    let most = scene.max_steps.unwrap_or_else(|| whole(unit * limit));
    (whole(unit * typical).min(most), most)
}

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
