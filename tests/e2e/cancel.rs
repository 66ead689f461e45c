//! A cancelled sweep stops its jobs; a paused one gives them back.

use protocol::JobState;
use protocol::api::{AttemptEnd, ControlReply};
use serde_json::Value;

use crate::lab::Lab;
use crate::scenes;
use crate::wait::until;

/// Longer than any test waits: it ends only if it is told to.
const ENDLESS: u64 = 1_000_000_000;

#[test]
fn a_cancelled_job_is_dropped_and_the_worker_takes_the_next() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let endless = lab.submit(&scenes::sweep_of_one("endless", ENDLESS));
    let job = lab.jobs(endless)[0];
    until("the start of the job", || match lab.job(job) {
        job if job.state == JobState::Leased => Ok(()),
        job => Err(job),
    });
    let _: ControlReply =
        lab.ask(async |client| client.post(&format!("/v1/sweeps/{endless}/cancel"), None).await);
    assert_eq!(lab.sweep(endless).state.name(), "cancelled");
    // the only slot is free again
    let next = lab.submit(&scenes::quick("next", &[1e5]));
    lab.wait_until_done(next);
    assert_eq!(lab.job(job).state, JobState::Cancelled);
}

#[test]
fn a_paused_sweep_gives_its_job_back_and_goes_on_when_resumed() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let sweep = lab.submit(&scenes::sweep_of_one("paused", scenes::LONG));
    let job = lab.jobs(sweep)[0];
    lab.wait_for_checkpoint(job);
    let _: Value = lab.ask(async |client| client.post(&format!("/v1/sweeps/{sweep}/pause"), None).await);
    until("the release of the job", || match lab.job(job) {
        job if job.state == JobState::Queued => Ok(()),
        job => Err(job),
    });
    let _: Value = lab.ask(async |client| client.post(&format!("/v1/sweeps/{sweep}/resume"), None).await);
    lab.wait_until_done(sweep);
    let view = lab.job(job);
    let ends: Vec<Option<AttemptEnd>> = view.attempts.iter().map(|attempt| attempt.end).collect();
    assert_eq!(ends, [Some(AttemptEnd::Released), Some(AttemptEnd::Done)]);
    assert!(view.result.expect("done").execution.real("resumed_at_step").is_some_and(|step| step > 0.0));
}
