//! Expected steps of `cohesive_spheres`.

use super::{Approach, ReducedSpheres, Stop};
use crate::Cost;

/// Wall time of one particle-step on one core [ns].
const NANOSECONDS: f64 = 40.0;

/// Packing and observables of one sphere [s].
const OVERHEAD_PER_SPHERE: f64 = 2e-6;

impl ReducedSpheres {
    /// Expected steps until the stop criterion holds.
    ///
    /// Fits to the measured courses of N = 2207 at η* ≈ 1 (e within 1e-3 of its final value after 2 900, 14 300,
    /// 70 700 steps of 0.1 τ at p/σe = 1e-4, 1e-5, 1e-6; KE/E_el = 1e-4 crossed after 3 300 … 226 000 at 1e-2 … 1e-5
    /// and 2e-7 after 6.5 times as many): time to settle 290 τ (1e-4 σe/p)^0.694, time to equilibrium
    /// 2 150 τ (1e-2 σe/p)^0.612. Both hold within a factor of two or three; the number of spheres hardly matters.
    #[must_use]
    pub fn expected_steps(&self) -> u64 {
        let settling = 290.0 * libm::pow(1e-4 / self.pressure, 0.694);
        let equilibrium = 2150.0 * libm::pow(1e-2 / self.pressure, 0.612);
        let time = match (self.stop, self.approach) {
            (Stop::Settled { .. }, _) => settling,
            (Stop::Evidence { .. }, Approach::RollingKicks) => settling + 0.2 * equilibrium,
            (Stop::Evidence { .. } | Stop::KineticEnergy { .. }, _) => settling + equilibrium,
            (Stop::Steps, _) => f64::INFINITY,
        };
        /// Without other word, runs take steps of 0.1 τ.
        const STEP: f64 = 0.1;
        /// Limit of a run that only a step limit ends and that has none.
        const LONGEST: f64 = 1e8;
        let limit = self.max_steps.unwrap_or(u64::MAX);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 1e8")]
        let steps = (time / self.dt.unwrap_or(STEP)).clamp(1.0, LONGEST) as u64;
        if self.stop == Stop::Steps && self.max_steps.is_some() { limit } else { steps.min(limit) }
    }

    pub(crate) fn cost(&self) -> Cost {
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let overhead = self.n as f64 * OVERHEAD_PER_SPHERE;
        Cost::of(self.expected_steps(), self.n, NANOSECONDS, overhead)
    }
}

#[cfg(test)]
mod tests {
    use crate::Scene;
    use crate::spheres::{ReducedSpheres, Stop};

    fn spheres(p: f64) -> ReducedSpheres {
        let scene = serde_json::json!({"model": "cohesive_spheres", "p": p, "sigma_c": 1e6, "sigma_e": 1e10});
        let crate::Reduced::CohesiveSpheres(reduced) = Scene::from_json(&scene).unwrap().reduce() else {
            panic!("spheres");
        };
        reduced
    }

    #[test]
    fn the_measured_settling_times_come_out() {
        for (p, measured) in [(1e6, 2_900.0), (1e5, 14_300.0), (1e4, 70_700.0)] {
            let settled =
                ReducedSpheres { stop: Stop::Settled { e_drift: 1e-3, wall_imbalance: 0.01 }, ..spheres(p) };
            let ratio = settled.expected_steps() as f64 / measured;
            assert!((0.9..1.1).contains(&ratio), "{p}: {ratio}");
        }
    }

    #[test]
    fn a_step_limit_limits() {
        let limited = ReducedSpheres { max_steps: Some(1000), ..spheres(1e5) };
        assert_eq!(limited.expected_steps(), 1000);
        let only_steps = ReducedSpheres { stop: Stop::Steps, max_steps: Some(1_000_000_000), ..spheres(1e5) };
        assert_eq!(only_steps.expected_steps(), 1_000_000_000);
        assert_eq!(ReducedSpheres { stop: Stop::Steps, ..spheres(1e5) }.expected_steps(), 100_000_000);
    }
}
