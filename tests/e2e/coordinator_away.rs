//! The coordinator ends in the middle and comes back: workers go on, and nothing is computed twice.

use protocol::JobState;

use crate::lab::{Lab, undisturbed};
use crate::scenes;
use crate::wait::until;

/// Files in the outbox of a worker.
fn reports(lab: &Lab, worker: &str) -> usize {
    let Ok(entries) = std::fs::read_dir(lab.path(worker).join("worker-outbox")) else { return 0 };
    entries.flatten().filter(|entry| entry.path().extension().is_some_and(|end| end == "report")).count()
}

#[test]
fn a_coordinator_that_comes_back_finds_its_job_running() {
    let mut lab = Lab::new();
    let _worker = lab.worker("worker");
    let sweep = lab.submit(&scenes::sweep_of_one("restart", scenes::LONG));
    let job = lab.jobs(sweep)[0];
    lab.wait_for_checkpoint(job);
    lab.kill_coordinator();
    lab.start_coordinator(&[]);
    lab.wait_until_done(sweep);
    let view = lab.job(job);
    assert_eq!(view.attempts.len(), 1, "{view:?}");
    assert_eq!(view.result.expect("done").digest, undisturbed(scenes::LONG));
}

#[test]
fn a_result_waits_in_the_outbox_and_survives_the_worker() {
    let mut lab = Lab::new();
    let worker = lab.worker("worker");
    let sweep = lab.submit(&scenes::sweep_of_one("outbox", scenes::LONG));
    let job = lab.jobs(sweep)[0];
    lab.wait_for_checkpoint(job);
    lab.kill_coordinator();
    until("the result in the outbox", || if reports(&lab, "worker") == 1 { Ok(()) } else { Err(()) });
    worker.kill();
    lab.start_coordinator(&[]);
    assert_eq!(lab.job(job).state, JobState::Leased);

    let _again = lab.worker("worker");
    lab.wait_until_done(sweep);
    let view = lab.job(job);
    assert_eq!(view.attempts.len(), 1, "the result of the first process was taken: {view:?}");
    assert_eq!(view.result.expect("done").digest, undisturbed(scenes::LONG));
    until("an empty outbox", || if reports(&lab, "worker") == 0 { Ok(()) } else { Err(()) });
}
