//! At which steps a run is sampled: regularly at first, then geometrically, so that the memory is bounded and the
//! cost stays at about 2 % of the run and falls.

use serde::{Deserialize, Serialize};

/// Growth of the sampled step numbers once they are large [1].
const GROWTH: f64 = 1.025;
/// Fewest steps between samples: one costs about five steps.
const LEAST_STRIDE: u64 = 100;
/// Steps between samples at the start of a long run.
const FIRST_STRIDE: u64 = 250;

/// The sampling rule of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Plan {
    stride: u64,
}

impl Plan {
    /// The rule for a run whose e settles in about `settling_steps`.
    pub(crate) fn new(settling_steps: u64) -> Self {
        Self { stride: (settling_steps / 50).clamp(LEAST_STRIDE, FIRST_STRIDE) }
    }

    /// The sampled step that follows sampled step `step`: max(step + stride, ⌊1.025 step⌋).
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "steps stay far below 2^53"
    )]
    pub(crate) fn after(self, step: u64) -> u64 {
        (step + self.stride).max((step as f64 * GROWTH).floor() as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundred_million_steps_are_a_few_hundred_samples() {
        let plan = Plan::new(14_300);
        let mut step = 0;
        let mut samples = 0;
        while step < 100_000_000 {
            let next = plan.after(step);
            assert!(next > step);
            step = next;
            samples += 1;
        }
        assert!(samples < 600, "{samples}");
    }
}
