//! What the world tells a running job, and what the job tells the world.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use sim_core::Progress;

/// What a job is told to do. The order is the rank: a later command never takes back an earlier, higher one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Command {
    /// Go on.
    Run,
    /// Save the state and stop.
    Yield,
    /// Stop at once, save nothing: nobody wants the job, or the lease is lost.
    Drop,
}

/// How far a job is.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Newest progress; `None` before the first slice.
    pub progress: Option<Progress>,
    /// Wall time of this attempt spent computing.
    pub wall: Duration,
}

/// Shared between the thread that computes and the tasks that talk.
#[derive(Debug)]
pub struct Control {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug)]
struct State {
    command: Command,
    paused: bool,
    report: Report,
}

impl Default for Control {
    fn default() -> Self {
        let state = State { command: Command::Run, paused: false, report: Report::default() };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }
}

impl Control {
    /// A job that runs.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Tells the job what to do; a command of lower rank than the present one is ignored.
    pub fn command(&self, command: Command) {
        let mut state = self.lock();
        state.command = state.command.max(command);
        self.changed.notify_all();
    }

    /// Suspends or wakes the job; a paused job holds its state in memory and uses no processor.
    pub fn pause(&self, paused: bool) {
        self.lock().paused = paused;
        self.changed.notify_all();
    }

    /// The present command, without waiting.
    #[must_use]
    pub fn now(&self) -> Command {
        self.lock().command
    }

    /// The present command; waits while the job is paused and has nothing else to do.
    #[must_use]
    pub fn next(&self) -> Command {
        let mut state = self.lock();
        while state.paused && state.command == Command::Run {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.command
    }

    /// Notes how far the job is.
    pub fn report(&self, report: Report) {
        self.lock().report = report;
    }

    /// How far the job is.
    #[must_use]
    pub fn latest(&self) -> Report {
        self.lock().report.clone()
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // a panic elsewhere leaves plain values behind: always usable
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_higher_command_stays() {
        let control = Control::new();
        control.command(Command::Drop);
        control.command(Command::Yield);
        assert_eq!(control.now(), Command::Drop);
    }

    #[test]
    fn a_paused_job_still_yields() {
        let control = Control::new();
        control.pause(true);
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| control.next());
            control.command(Command::Yield);
            assert_eq!(waiting.join().unwrap(), Command::Yield);
        });
    }

    #[test]
    fn waking_goes_on() {
        let control = Control::new();
        control.pause(true);
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| control.next());
            control.pause(false);
            assert_eq!(waiting.join().unwrap(), Command::Run);
        });
    }
}
