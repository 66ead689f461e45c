//! How long a failed job rests.

use std::time::Duration;

/// Longest rest.
const LONGEST: Duration = Duration::from_secs(600);

/// Rest after the `failures`-th failure: `first` · 2^(failures − 1), at most ten minutes.
#[must_use]
pub fn rest(first: Duration, failures: u32) -> Duration {
    let doublings = failures.saturating_sub(1).min(20);
    first.saturating_mul(1 << doublings).min(LONGEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_up_to_a_limit() {
        let first = Duration::from_secs(5);
        assert_eq!(rest(first, 1), first);
        assert_eq!(rest(first, 3), Duration::from_secs(20));
        assert_eq!(rest(first, 1000), LONGEST);
    }
}
