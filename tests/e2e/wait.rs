//! Waiting on conditions.

use std::fmt::Debug;
use std::time::{Duration, Instant};

/// Longest wait for anything: far beyond what a loaded machine needs, so that it ends only a test that hangs.
const LONGEST: Duration = Duration::from_secs(120);
/// Time between two looks.
const BETWEEN: Duration = Duration::from_millis(20);

/// Looks until `look` finds something.
///
/// # Panics
/// With `what` and the last thing seen, after two minutes.
pub fn until<T, S: Debug>(what: &str, mut look: impl FnMut() -> Result<T, S>) -> T {
    let begun = Instant::now();
    loop {
        match look() {
            Ok(found) => return found,
            Err(seen) if begun.elapsed() > LONGEST => {
                panic!("waited in vain for {what}; last seen: {seen:?}")
            }
            Err(_) => std::thread::sleep(BETWEEN),
        }
    }
}
