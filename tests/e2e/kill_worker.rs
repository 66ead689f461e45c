//! A worker ends in the middle of a job: the job goes on elsewhere, and its result is that of a run that nobody
//! disturbed.

use protocol::api::AttemptEnd;
use rustix::process::Signal;

use crate::lab::{Lab, undisturbed};
use crate::scenes;

#[test]
fn a_killed_worker_costs_at_most_the_time_since_its_last_checkpoint() {
    let lab = Lab::with(&["--lease-seconds", "4"]);
    let first = lab.worker("first");
    let sweep = lab.submit(&scenes::sweep_of_one("killed", scenes::LONG));
    let job = lab.jobs(sweep)[0];
    let saved = lab.wait_for_checkpoint(job);
    first.kill();
    let _second = lab.worker("second");
    lab.wait_until_done(sweep);

    let view = lab.job(job);
    let ends: Vec<Option<AttemptEnd>> = view.attempts.iter().map(|attempt| attempt.end).collect();
    assert_eq!(ends, [Some(AttemptEnd::Lost), Some(AttemptEnd::Done)]);
    let result = view.result.expect("done");
    let resumed = result.execution.real("resumed_at_step").expect("a resumed run says where");
    assert!(resumed >= saved as f64, "resumed at {resumed}, saved at {saved}");
    assert_eq!(result.digest, undisturbed(scenes::LONG));
}

#[test]
fn a_worker_told_to_stop_gives_its_job_back_with_its_state() {
    let lab = Lab::new();
    let first = lab.worker("first");
    let sweep = lab.submit(&scenes::sweep_of_one("stopped", scenes::LONG));
    let job = lab.jobs(sweep)[0];
    let saved = lab.wait_for_checkpoint(job);
    first.signal(Signal::TERM);
    assert!(first.end().success(), "a clean end is status 0");
    let handed_over = lab.job(job).checkpoint.expect("uploaded").steps;
    assert!(handed_over >= saved);

    let _second = lab.worker("second");
    lab.wait_until_done(sweep);
    let view = lab.job(job);
    let ends: Vec<Option<AttemptEnd>> = view.attempts.iter().map(|attempt| attempt.end).collect();
    assert_eq!(ends, [Some(AttemptEnd::Released), Some(AttemptEnd::Done)]);
    assert_eq!((view.losses, view.failures), (0, 0));
    let result = view.result.expect("done");
    assert_eq!(result.execution.real("resumed_at_step"), Some(handed_over as f64));
    assert_eq!(result.digest, undisturbed(scenes::LONG));
}
