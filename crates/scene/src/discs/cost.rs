//! Expected steps of `cohesive_discs`.

use super::{Assembly, ReducedDiscs};
use crate::Cost;

/// Wall time of one particle-step on one core [ns].
const NANOSECONDS: f64 = 12.0;

/// Observables of one state of one disc: mesh transforms and the stiffness matrix [s].
const OVERHEAD_PER_STATE: f64 = 2e-4;

impl ReducedDiscs {
    /// Steps until the end of the path, from measured courses of N = 1400: aggregation 150–430 T0, the first
    /// pressure 60–120 T0 (300 T0 with the heavy cell of type 1), a state 30 T0 on compression and 8 T0 on unloading.
    #[must_use]
    pub fn expected_steps(&self) -> u64 {
        let assembling = match self.assembly {
            Assembly::Type1 => 300.0,
            Assembly::Type2 => 300.0 + 100.0,
            Assembly::Cohesionless => 100.0,
        };
        let mut time = assembling;
        let mut from = self.p0;
        for leg in &self.path {
            let decades = libm::log10(leg.to / from);
            let states = (decades.abs() * leg.per_decade).max(1.0);
            time += states * if decades > 0.0 { 30.0 } else { 8.0 };
            from = leg.to;
        }
        // T0 = √(a m/F0), or √(m/P) without cohesion, in √(m/K_N).
        let unit = libm::sqrt(1.0 / if self.f0 > 0.0 { self.f0 } else { self.p0 });
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let steps = (time * unit / self.dt).clamp(1.0, 1e12) as u64;
        steps
    }

    pub(crate) fn cost(&self) -> Cost {
        let states: f64 = self.path.iter().map(|leg| 2.0 * leg.per_decade).sum();
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let overhead = self.n as f64 * OVERHEAD_PER_STATE * (1.0 + states);
        Cost::of(self.expected_steps(), self.n, NANOSECONDS, overhead)
    }
}
