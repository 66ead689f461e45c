//! When the machine may be used: spare time only, and until a set time. Pure functions over observations.

use std::time::{Duration, SystemTime};

/// What may be done now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leave {
    /// Claim and run.
    Work,
    /// Claim nothing, suspend what runs, keep its state in memory.
    Pause,
    /// Others need the machine for long: give the jobs back with their checkpoints, claim nothing.
    Yield,
    /// The time is over: give the jobs back and end.
    End,
}

/// The rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Work only while others leave the machine alone.
    pub idle_only: bool,
    /// Others are here from this load on [cores].
    pub busy_above: f64,
    /// Others are gone below this load [cores]; the distance to `busy_above` keeps us from flapping.
    pub idle_below: f64,
    /// The machine must have been left alone for this long before work begins.
    pub quiet_for: Duration,
    /// A suspended job is given back after this long.
    pub yield_after: Duration,
    /// End before this time.
    pub until: Option<SystemTime>,
    /// Time kept free before `until` for the last checkpoints.
    pub margin: Duration,
}

/// Remembers since when others are here or gone.
#[derive(Clone, Copy, Debug)]
pub struct Gate {
    rules: Rules,
    open: bool,
    busy_since: Option<Duration>,
    quiet_since: Option<Duration>,
}

impl Gate {
    /// A gate that is closed at first if the machine must be idle: unknown is not idle.
    #[must_use]
    pub fn new(rules: Rules) -> Self {
        Self { rules, open: !rules.idle_only, busy_since: None, quiet_since: None }
    }

    /// Decides. `elapsed` is a monotonic time, `foreign` the load of others [cores], `None` when unknown.
    pub fn observe(&mut self, elapsed: Duration, now: SystemTime, foreign: Option<f64>) -> Leave {
        if self.rules.until.is_some_and(|until| now + self.rules.margin >= until) {
            return Leave::End;
        }
        if !self.rules.idle_only {
            return Leave::Work;
        }
        self.follow(elapsed, foreign);
        if self.open {
            return Leave::Work;
        }
        let since = *self.busy_since.get_or_insert(elapsed);
        if elapsed.saturating_sub(since) >= self.rules.yield_after { Leave::Yield } else { Leave::Pause }
    }

    fn follow(&mut self, elapsed: Duration, foreign: Option<f64>) {
        match foreign {
            Some(load) if load < self.rules.idle_below => {
                let since = *self.quiet_since.get_or_insert(elapsed);
                if elapsed.saturating_sub(since) >= self.rules.quiet_for {
                    self.open = true;
                    self.busy_since = None;
                }
            }
            // between the limits nothing changes, but it is no quiet either
            Some(load) if load <= self.rules.busy_above => self.quiet_since = None,
            Some(_) | None => {
                self.quiet_since = None;
                self.open = false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: Rules = Rules {
        idle_only: true,
        busy_above: 0.5,
        idle_below: 0.25,
        quiet_for: Duration::from_secs(60),
        yield_after: Duration::from_secs(300),
        until: None,
        margin: Duration::from_secs(60),
    };

    /// The answers to a load every ten seconds.
    fn answers(rules: Rules, loads: &[Option<f64>]) -> Vec<Leave> {
        let mut gate = Gate::new(rules);
        let at = |index: usize| Duration::from_secs(10 * index as u64);
        loads
            .iter()
            .enumerate()
            .map(|(index, &load)| gate.observe(at(index), SystemTime::UNIX_EPOCH + at(index), load))
            .collect()
    }

    #[test]
    fn works_only_after_a_quiet_time_and_stops_at_once() {
        let mut loads = vec![Some(0.0); 8];
        loads.push(Some(2.0));
        loads.push(Some(0.0));
        let told = answers(RULES, &loads);
        assert_eq!(told[..6], [Leave::Pause; 6]);
        assert_eq!(told[6..], [Leave::Work, Leave::Work, Leave::Pause, Leave::Pause]);
    }

    #[test]
    fn a_load_between_the_limits_changes_nothing() {
        let mut loads = vec![Some(0.0); 7];
        loads.extend([Some(0.4), Some(0.3), Some(0.45)]);
        assert_eq!(answers(RULES, &loads)[6..], [Leave::Work; 4]);
        let hovering = vec![Some(0.4); 20];
        assert!(answers(RULES, &hovering).iter().all(|told| *told == Leave::Pause));
    }

    #[test]
    fn unknown_is_busy_and_a_long_wait_gives_the_job_back() {
        let told = answers(RULES, &[None; 32]);
        assert_eq!(told[29], Leave::Pause);
        assert_eq!(told[30..], [Leave::Yield; 2]);
    }

    #[test]
    fn ends_before_the_set_time_even_when_not_asked_to_be_idle() {
        let rules = Rules {
            idle_only: false,
            until: Some(SystemTime::UNIX_EPOCH + Duration::from_secs(100)),
            ..RULES
        };
        let told = answers(rules, &[None; 6]);
        assert_eq!(told[..4], [Leave::Work; 4]);
        assert_eq!(told[4..], [Leave::End; 2]);
    }
}
