//! How busy other people keep this machine.

use std::time::{Duration, Instant};

/// Measures the load that is not ours.
pub trait LoadMeter: Send {
    /// Cores kept busy by others since the last call; `None` when it cannot be known (first call, other systems).
    fn foreign_cores(&mut self) -> Option<f64>;
}

/// Reads `/proc/stat` and `/proc/self/stat`: unlike the load average it answers at once and can leave out our own
/// share. Other worker processes on the machine count as others, unless they are nice: time spent at a lower
/// priority is nobody's hurry.
#[derive(Debug, Default)]
pub struct ProcStat {
    last: Option<Sample>,
}

/// Shortest interval that gives a meaningful share.
const SHORTEST: Duration = Duration::from_millis(500);
/// Unit of the times in `/proc` [1/s], fixed by the interface on every Linux.
const TICKS: f64 = 100.0;

#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Instant,
    /// Ticks of all processors in user, system, irq and softirq.
    hurried: u64,
    /// Ticks at low priority.
    nice: u64,
    /// Ticks of this process.
    own: u64,
}

impl LoadMeter for ProcStat {
    fn foreign_cores(&mut self) -> Option<f64> {
        let all = std::fs::read_to_string("/proc/stat").ok()?;
        let own = std::fs::read_to_string("/proc/self/stat").ok()?;
        let (hurried, nice) = machine_ticks(&all)?;
        let sample = Sample { at: Instant::now(), hurried, nice, own: process_ticks(&own)? };
        let last = self.last.replace(sample)?;
        let elapsed = sample.at.duration_since(last.at);
        (elapsed >= SHORTEST).then(|| foreign(&last, &sample, elapsed.as_secs_f64()))
    }
}

/// Cores busy in a hurry, less our own share of them.
fn foreign(last: &Sample, now: &Sample, seconds: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "tick counts of an interval")]
    let ticks = |from: u64, to: u64| to.saturating_sub(from) as f64;
    // if we are nice our time is counted there, otherwise among the hurried
    let nice = ticks(last.nice, now.nice);
    let own_hurried = (ticks(last.own, now.own) - nice).max(0.0);
    ((ticks(last.hurried, now.hurried) - own_hurried) / (TICKS * seconds)).max(0.0)
}

/// The first line of `/proc/stat`: `cpu user nice system idle iowait irq softirq …`.
fn machine_ticks(text: &str) -> Option<(u64, u64)> {
    let line = text.lines().next()?.strip_prefix("cpu ")?;
    let ticks: Vec<u64> = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
    let [user, nice, system, _idle, _iowait, irq, softirq, ..] = ticks[..] else { return None };
    Some((user + system + irq + softirq, nice))
}

/// `utime + stime` of `/proc/self/stat`, behind the name in parentheses, which may hold anything.
fn process_ticks(text: &str) -> Option<u64> {
    let fields: Vec<&str> = text[text.rfind(')')? + 1..].split_whitespace().collect();
    Some(fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_files_of_the_kernel() {
        assert_eq!(machine_ticks("cpu  10 20 30 40 50 6 7 0 0 0\ncpu0 1 2"), Some((53, 20)));
        let text = "1 (a) b) R 0 0 0 0 0 0 0 0 0 0 70 8 0 0 20 0 1 0";
        assert_eq!(process_ticks(text), Some(78));
        assert_eq!(machine_ticks("something else"), None);
    }

    #[test]
    fn our_own_time_is_not_the_load_of_others() {
        let at = Instant::now();
        let last = Sample { at, hurried: 1000, nice: 500, own: 100 };
        // ten seconds: we used one core, somebody else a half
        let hurried = Sample { at, hurried: 2500, nice: 500, own: 1100 };
        assert!((foreign(&last, &hurried, 10.0) - 0.5).abs() < 1e-12);
        let nice = Sample { at, hurried: 1500, nice: 1500, own: 1100 };
        assert!((foreign(&last, &nice, 10.0) - 0.5).abs() < 1e-12);
    }
}
