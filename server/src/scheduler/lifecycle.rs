//! The life of one job: who may write, which counter grows, when a job is set aside. Pure; the store applies these
//! decisions inside its transactions, and the tests run them against it.

use protocol::{FailureKind, JobEvent, JobState, TransitionRefused};

/// What decides about a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Job {
    /// State.
    pub state: JobState,
    /// Fencing number: grows with every claim, never falls.
    pub attempt: u32,
    /// Attempts that ended by the program's fault, since the last retry by a user.
    pub failures: u32,
    /// Leases that expired, in all.
    pub losses: u32,
    /// Leases that expired since the last new checkpoint: a job that makes progress is no killer.
    pub losses_in_a_row: u32,
}

impl Job {
    /// A job nobody has touched.
    pub const FRESH: Self =
        Self { state: JobState::Queued, attempt: 0, failures: 0, losses: 0, losses_in_a_row: 0 };
}

/// What the budgets are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Failures after which a job is set aside.
    pub max_failures: u32,
    /// Losses in a row beyond which a job is set aside.
    pub max_losses: u32,
}

/// What happens to a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    /// A worker takes it.
    Claim,
    /// A result arrives under an attempt.
    Complete(u32),
    /// A failure arrives under an attempt.
    Fail(u32, FailureKind),
    /// A newer checkpoint arrives under an attempt.
    Checkpoint(u32),
    /// The worker gives it back under an attempt.
    Release(u32),
    /// The lease of an attempt expired.
    Expire(u32),
    /// The last sweep that wanted it is gone.
    Abandon,
    /// A user asks for another try, or a new sweep wants a cancelled job.
    Retry,
}

/// Why a happening does not apply.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refused {
    /// The attempt is not the current one, or nobody holds the job.
    #[error("attempt {given} does not hold the job: it is {state:?} at attempt {current}")]
    Stale {
        /// Attempt of the message.
        given: u32,
        /// Attempt of the job.
        current: u32,
        /// State of the job.
        state: JobState,
    },
    /// The state does not admit it.
    #[error(transparent)]
    Transition(#[from] TransitionRefused),
}

impl Job {
    /// The job after `happening`.
    ///
    /// # Errors
    /// [`Refused`] when the message is stale or the state does not admit it; the job is unchanged then.
    pub fn after(self, happening: Happening, limits: Limits) -> Result<Self, Refused> {
        let mut next = self;
        let event = match happening {
            Happening::Claim => {
                next.attempt += 1;
                JobEvent::Claim
            }
            Happening::Complete(attempt) => {
                self.fence(attempt)?;
                JobEvent::Complete
            }
            Happening::Fail(attempt, kind) => {
                self.fence(attempt)?;
                next.failures += 1;
                if kind == FailureKind::Permanent || next.failures >= limits.max_failures {
                    JobEvent::FailPermanent
                } else {
                    JobEvent::FailRetryable
                }
            }
            Happening::Checkpoint(attempt) => {
                self.fence(attempt)?;
                next.losses_in_a_row = 0;
                return Ok(next);
            }
            Happening::Release(attempt) => {
                self.fence(attempt)?;
                JobEvent::Lose
            }
            Happening::Expire(attempt) => {
                self.fence(attempt)?;
                next.losses += 1;
                next.losses_in_a_row += 1;
                if next.losses_in_a_row > limits.max_losses { JobEvent::LoseTooOften } else { JobEvent::Lose }
            }
            Happening::Abandon => JobEvent::Cancel,
            Happening::Retry => {
                next.failures = 0;
                next.losses_in_a_row = 0;
                JobEvent::Retry
            }
        };
        next.state = self.state.after(event)?;
        Ok(next)
    }

    fn fence(self, attempt: u32) -> Result<(), Refused> {
        if self.state == JobState::Leased && self.attempt == attempt {
            Ok(())
        } else {
            Err(Refused::Stale { given: attempt, current: self.attempt, state: self.state })
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LIMITS: Limits = Limits { max_failures: 3, max_losses: 8 };

    fn happening() -> impl Strategy<Value = Happening> {
        let attempt = 0_u32..12;
        prop_oneof![
            4 => Just(Happening::Claim),
            2 => attempt.clone().prop_map(Happening::Complete),
            2 => attempt.clone().prop_map(|at| Happening::Fail(at, FailureKind::Retryable)),
            1 => attempt.clone().prop_map(|at| Happening::Fail(at, FailureKind::Permanent)),
            1 => attempt.clone().prop_map(Happening::Checkpoint),
            2 => attempt.clone().prop_map(Happening::Release),
            4 => attempt.prop_map(Happening::Expire),
            1 => Just(Happening::Abandon),
            1 => Just(Happening::Retry),
        ]
    }

    proptest! {
        #[test]
        fn one_result_growing_attempts_and_separate_budgets(
            happenings in prop::collection::vec(happening(), 1..200)
        ) {
            let mut job = Job::FRESH;
            let mut accepted = 0;
            for happening in happenings {
                let Ok(next) = job.after(happening, LIMITS) else { continue };
                prop_assert!(next.attempt >= job.attempt);
                if happening == Happening::Claim {
                    prop_assert_eq!(next.attempt, job.attempt + 1);
                }
                if matches!(happening, Happening::Complete(_)) {
                    accepted += 1;
                }
                if matches!(happening, Happening::Expire(_) | Happening::Release(_)) {
                    prop_assert_eq!(next.failures, job.failures);
                }
                if job.state.is_terminal() {
                    prop_assert_eq!(happening, Happening::Retry);
                }
                // Only its own budget, or a permanent failure, sets a job aside.
                if next.state == JobState::Failed && job.state != JobState::Failed {
                    let why = match happening {
                        Happening::Fail(_, kind) => {
                            kind == FailureKind::Permanent || next.failures == LIMITS.max_failures
                        }
                        Happening::Expire(_) => next.losses_in_a_row == LIMITS.max_losses + 1,
                        _ => false,
                    };
                    prop_assert!(why);
                }
                job = next;
            }
            prop_assert!(accepted <= 1, "done absorbs everything");
        }
    }

    #[test]
    fn a_worker_that_lost_its_lease_changes_nothing() {
        let first = Job::FRESH.after(Happening::Claim, LIMITS).unwrap();
        let lost = first.after(Happening::Expire(1), LIMITS).unwrap();
        assert!(matches!(lost.after(Happening::Complete(1), LIMITS), Err(Refused::Stale { .. })));
        let second = lost.after(Happening::Claim, LIMITS).unwrap();
        assert!(matches!(second.after(Happening::Complete(1), LIMITS), Err(Refused::Stale { .. })));
        assert_eq!(second.after(Happening::Complete(2), LIMITS).unwrap().state, JobState::Done);
    }

    #[test]
    fn progress_forgives_losses_but_not_failures() {
        let mut job = Job::FRESH;
        for round in 1..=100 {
            job = job.after(Happening::Claim, LIMITS).unwrap();
            job = job.after(Happening::Checkpoint(round), LIMITS).unwrap();
            job = job.after(Happening::Expire(round), LIMITS).unwrap();
        }
        assert_eq!((job.state, job.losses, job.failures), (JobState::Queued, 100, 0));
    }
}
