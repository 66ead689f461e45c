//! Progress and time to the end, from work done and work left.

/// What is known about a sweep's work. Costs are estimates in core-seconds on a reference machine; how fast the
/// present workers are is learned from the runs themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Cost of all points.
    pub total: f64,
    /// Cost of the points that have a result.
    pub done: f64,
    /// Cost of the running jobs, each times its share done.
    pub running_done: f64,
    /// Cost of the points that will not get a result (set aside, cancelled).
    pub given_up: f64,
    /// Cost of this service's newest finished runs and running jobs that have wall times …
    pub timed_cost: f64,
    /// … and the wall seconds they took.
    pub timed_wall: f64,
    /// Jobs of this sweep that run now.
    pub running: u32,
    /// Longest remaining cost among the running jobs.
    pub longest_left: f64,
}

/// Share of the work done, 0 … 1.
#[must_use]
pub fn progress(work: &Work) -> f64 {
    if work.total <= 0.0 {
        return 0.0;
    }
    ((work.done + work.running_done) / work.total).clamp(0.0, 1.0)
}

/// Seconds to the end: the work left at the speed measured, spread over the running jobs, but never less than the
/// longest running job needs. `None` while nothing runs or no speed is known.
#[must_use]
pub fn seconds_left(work: &Work) -> Option<f64> {
    if work.total <= 0.0 {
        return None;
    }
    let left = (work.total - work.done - work.running_done - work.given_up).max(0.0);
    if left == 0.0 {
        return Some(0.0);
    }
    if work.running == 0 || work.timed_cost <= 0.0 || work.timed_wall <= 0.0 {
        return None;
    }
    let wall_per_cost = work.timed_wall / work.timed_cost;
    Some((left / f64::from(work.running)).max(work.longest_left) * wall_per_cost)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_workers_halve_the_time_and_speed_is_measured() {
        let work = Work {
            total: 100.0,
            done: 50.0,
            running_done: 10.0,
            timed_cost: 60.0,
            timed_wall: 120.0,
            running: 2,
            longest_left: 5.0,
            ..Work::default()
        };
        assert_eq!(progress(&work), 0.6);
        assert_eq!(seconds_left(&work), Some(40.0));
        assert_eq!(seconds_left(&Work { longest_left: 40.0, ..work }), Some(80.0));
        assert_eq!(seconds_left(&Work { running: 0, ..work }), None);
        assert_eq!(seconds_left(&Work { done: 100.0, ..work }), Some(0.0));
    }
}
