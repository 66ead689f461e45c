//! How long a call keeps asking.

use std::time::Duration;

use backon::{BackoffBuilder, ExponentialBuilder};

/// How long a call keeps asking a coordinator that does not answer. Waits grow by a factor of two from `first` to
/// `longest`, each stretched by a random share of itself so that many workers do not ask in step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patience {
    /// First wait.
    pub first: Duration,
    /// Longest wait between two tries.
    pub longest: Duration,
    /// Sum of all waits after which the call gives the error back; `None`: never.
    pub total: Option<Duration>,
}

impl Patience {
    /// One try.
    #[must_use]
    pub fn none() -> Self {
        Self { first: Duration::ZERO, longest: Duration::ZERO, total: Some(Duration::ZERO) }
    }

    /// For a person who waits: gives up after some seconds.
    #[must_use]
    pub fn brief(total: Duration) -> Self {
        Self { first: Duration::from_millis(100), longest: Duration::from_secs(2), total: Some(total) }
    }

    /// For a worker: never gives up, asks at least every `longest`.
    #[must_use]
    pub fn endless(longest: Duration) -> Self {
        Self { first: Duration::from_millis(500).min(longest), longest, total: None }
    }

    /// The waits themselves, for a caller with its own loop.
    pub fn waits(self) -> impl Iterator<Item = Duration> {
        self.backoff().build()
    }

    pub(super) fn backoff(self) -> ExponentialBuilder {
        let growing = ExponentialBuilder::default()
            .with_jitter()
            .with_factor(2.0)
            .with_min_delay(self.first)
            .with_max_delay(self.longest);
        match self.total {
            Some(Duration::ZERO) => growing.with_max_times(0),
            Some(total) => growing.without_max_times().with_total_delay(Some(total)),
            None => growing.without_max_times(),
        }
    }
}
