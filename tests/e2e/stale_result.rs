//! A worker that lost its lease is refused, never merged.

use protocol::client::ClientError;
use protocol::{ClaimRequest, Completion, Grant, Heartbeat, PROTOCOL_VERSION, Registration, WorkerId};
use record::{Outcome, Row};

use crate::lab::Lab;
use crate::scenes;
use crate::wait::until;

/// A worker played by the test.
fn register(lab: &Lab) -> WorkerId {
    let registration = Registration {
        protocol: PROTOCOL_VERSION,
        host: "played".to_owned(),
        boot: uuid::Uuid::new_v4(),
        slots: 1,
        hardware: "test".to_owned(),
        code_version: "0".to_owned(),
        models: vec![("cohesive_spheres".to_owned(), scene::Model::CohesiveSpheres.physics_version())],
    };
    lab.ask(async |client| client.register(&registration).await).worker
}

fn claim(lab: &Lab, worker: WorkerId) -> Option<Grant> {
    let request = ClaimRequest { worker, slots: 1, holding: Vec::new(), wait_seconds: 0.0 };
    lab.ask(async |client| client.claim(&request).await).grants.pop()
}

fn completion(worker: WorkerId, grant: &Grant, e: f64) -> Completion {
    let mut outcome = Outcome::default();
    outcome.record.put("status", "equilibrium").number("e", e).unwrap();
    let (attempt, scene_key) = (grant.attempt, grant.scene_key.clone());
    Completion { worker, attempt, scene_key, outcome, execution: Row::new() }
}

#[test]
fn a_late_result_is_refused() {
    let lab = Lab::with(&["--lease-seconds", "0.5"]);
    let sweep = lab.submit(&scenes::quick("late", &[1e6]));
    let slow = register(&lab);
    let lost = until("the first grant", || claim(&lab, slow).ok_or(()));
    // the slow worker falls silent until somebody else has the job
    let quick = register(&lab);
    let granted = until("the second grant", || claim(&lab, quick).ok_or(()));
    assert_eq!((granted.job, granted.attempt), (lost.job, lost.attempt + 1));

    let late = lab.try_ask(async |client| client.complete(lost.job, &completion(slow, &lost, 9.0)).await);
    assert!(matches!(late, Err(ClientError::LeaseLost(_))), "{late:?}");
    let beat = Heartbeat {
        worker: slow,
        attempt: lost.attempt,
        steps: 1,
        expected_steps: 2,
        fraction: 0.5,
        wall_s: 1.0,
        live: Row::new(),
    };
    let beaten = lab.try_ask(async |client| client.heartbeat(lost.job, &beat).await);
    assert!(matches!(beaten, Err(ClientError::LeaseLost(_))), "{beaten:?}");

    let good = completion(quick, &granted, 1.5);
    lab.ask(async |client| client.complete(granted.job, &good).await);
    // the same result twice is one result
    lab.ask(async |client| client.complete(granted.job, &good).await);
    lab.wait_until_done(sweep);
    assert_eq!(lab.job(granted.job).result.expect("done").record.real("e"), Some(1.5));
}
