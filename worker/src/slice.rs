//! How many steps to advance between two looks at the world.

use std::time::Duration;

/// Adapts the steps per call of `advance` so that a call takes about `target`: short enough to answer a stop
/// signal, long enough to cost nothing. Slicing never changes results, so wall time may decide here.
#[derive(Clone, Copy, Debug)]
pub struct Slice {
    steps: u64,
    target: Duration,
}

impl Slice {
    /// Starts carefully: the first call shows how fast the scene is.
    #[must_use]
    pub fn new(target: Duration) -> Self {
        Self { steps: 16, target }
    }

    /// Steps of the next call.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Learns from a call that did `done` steps in `elapsed`.
    pub fn observe(&mut self, done: u64, elapsed: Duration) {
        if done == 0 {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "a rough number of steps")]
        let wanted = done as f64 * self.target.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive; casts saturate"
        )]
        let wanted = wanted as u64;
        // growth is bounded: a call that did little (free flight, a warm cache) says little about the next
        self.steps = wanted.clamp(1, self.steps.saturating_mul(4));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs ten calls of an engine that takes `per_step`.
    fn settled(per_step: Duration) -> Duration {
        let mut slice = Slice::new(Duration::from_millis(400));
        for _ in 0..30 {
            let steps = slice.steps();
            slice.observe(steps, per_step * u32::try_from(steps).unwrap());
        }
        per_step * u32::try_from(slice.steps()).unwrap()
    }

    #[test]
    fn a_call_takes_the_target_whatever_a_step_costs() {
        for per_step in [1_000, 100_000, 10_000_000, 200_000_000].map(Duration::from_nanos) {
            let call = settled(per_step).as_secs_f64();
            assert!((0.19..=0.41).contains(&call), "{per_step:?} per step: {call} s per call");
        }
        let slow = Duration::from_secs(3);
        assert_eq!(settled(slow), slow, "one step at least");
    }

    #[test]
    fn growth_is_bounded() {
        let mut slice = Slice::new(Duration::from_secs(1));
        slice.observe(16, Duration::ZERO);
        assert_eq!(slice.steps(), 64);
    }
}
