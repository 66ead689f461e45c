//! Expected steps of `cohesive_spheres`: one formula for scheduling, dry runs, progress and step limits.

use super::{Approach, ReducedSpheres, Stop};
use crate::Cost;

/// Wall time of one particle-step on one core [ns].
const NANOSECONDS: f64 = 35.0;

/// The same in mixed precision: two thirds (docs/performance.md).
const NANOSECONDS_MIXED: f64 = 23.0;

/// Packing and observables of one sphere [s].
const OVERHEAD_PER_SPHERE: f64 = 2e-6;

/// Time step assumed before the contact network is known [τ].
const STEP: f64 = 0.13;

impl ReducedSpheres {
    /// Time until e is within 1e-3 of its final value [τ]: 0.452 (σe/p)^0.7, a fit to measured runs at N = 2207
    /// (285, 1430, 7070, 30 000 τ at p/σe = 1e-4, 1e-5, 1e-6, 1e-7); the number of spheres hardly matters.
    #[must_use]
    pub fn settling_time(&self) -> f64 {
        0.452 * libm::pow(1.0 / self.pressure, 0.7)
    }

    /// Multiples of the settling time that the stop rule takes: typical, and the limit at which a run ends with
    /// status `e_converged` or `step_limit`.
    fn settling_times(&self) -> (f64, f64) {
        match (self.approach, self.stop) {
            (Approach::RollingKicks, _) => (4.5, 20.0),
            (Approach::Natural, Stop::Settled { .. }) => (2.0, 20.0),
            (Approach::Natural, Stop::Evidence { .. }) => (6.0, 20.0),
            (Approach::Natural, Stop::KineticEnergy { .. }) => (40.0, 60.0),
            (Approach::Natural, Stop::Steps) => (20.0, 20.0),
        }
    }

    /// Expected steps and step limit of a run with time step `dt` [τ]. The limit can end a run, so a change of it raises
    /// the physics version.
    #[must_use]
    pub fn steps(&self, dt: f64) -> (u64, u64) {
        let unit = self.settling_time() / dt;
        let (typical, limit) = self.settling_times();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1e3 and 1e12")]
        let whole = |steps: f64| steps.ceil().clamp(1e3, 1e12) as u64;
        let most = self.max_steps.unwrap_or_else(|| whole(unit * limit));
        (whole(unit * typical).min(most), most)
    }

    /// The estimated work of a run.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let (steps, _) = self.steps(self.dt.unwrap_or(STEP));
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let overhead = self.n as f64 * OVERHEAD_PER_SPHERE;
        let nanoseconds = if self.precision.is_double() { NANOSECONDS } else { NANOSECONDS_MIXED };
        Cost::of(steps, self.n, nanoseconds, overhead)
    }
}

#[cfg(test)]
mod tests {
    use crate::Scene;
    use crate::spheres::{ReducedSpheres, Stop};

    fn spheres(p: f64) -> ReducedSpheres {
        let scene = serde_json::json!({"model": "cohesive_spheres", "p": p, "sigma_c": 1e6, "sigma_e": 1e10});
        let crate::Reduced::CohesiveSpheres(reduced) = Scene::from_json(&scene).unwrap().reduce() else {
            panic!("spheres")
        };
        reduced
    }

    #[test]
    fn the_measured_settling_times_come_out() {
        for (p, measured) in [(1e6, 290.0), (1e5, 1_430.0), (1e4, 7_070.0)] {
            let ratio = spheres(p).settling_time() / measured;
            assert!((0.9..1.1).contains(&ratio), "{p}: {ratio}");
        }
    }

    #[test]
    fn a_step_limit_limits() {
        let limited = ReducedSpheres { max_steps: Some(700), ..spheres(1e5) };
        assert_eq!(limited.steps(0.1), (700, 700));
        let settled =
            ReducedSpheres { stop: Stop::Settled { e_drift: 1e-3, wall_imbalance: 0.01 }, ..spheres(1e5) };
        assert!(settled.cost().steps < spheres(1e5).cost().steps);
        assert!(
            ReducedSpheres { dt: Some(0.01), ..spheres(1e5) }.cost().seconds > spheres(1e5).cost().seconds
        );
    }
}
