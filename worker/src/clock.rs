//! Wall-clock time, passed in. Only `available_until` needs it: leases live by the coordinator's clock.

use std::time::SystemTime;

/// Tells the time.
pub trait Clock: Send + Sync {
    /// Now.
    fn now(&self) -> SystemTime;
}

/// The clock of this machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct SystemClock;

impl Clock for SystemClock {
    #[expect(clippy::disallowed_methods, reason = "the one place where the worker reads the wall clock")]
    fn now(&self) -> SystemTime {
        SystemTime::now()
    }
}
