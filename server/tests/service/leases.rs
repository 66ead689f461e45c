//! Leases: fencing, loss, budgets, restarts.

use axum::body::Body;
use axum::http::{Method, Request};
use protocol::{Grant, WorkerId};
use serde_json::{Value, json};

use crate::support::{Coordinator, Reply, definition, heartbeat};

async fn beat(service: &Coordinator, worker: WorkerId, grant: &Grant) -> Reply {
    let path = format!("/v1/leases/{}", grant.job);
    service.call(Method::PUT, &path, &heartbeat(worker, grant.attempt, 0.5)).await
}

async fn fail(service: &Coordinator, worker: WorkerId, grant: &Grant, kind: &str) -> Value {
    let body = json!({
        "worker": worker, "attempt": grant.attempt, "kind": kind, "class": "panic", "message": "index out of bounds",
    });
    service.post(&format!("/v1/leases/{}/failure", grant.job), &body).await.expect(200, "")
}

async fn checkpoint(
    service: &Coordinator,
    worker: WorkerId,
    grant: &Grant,
    steps: u64,
    bytes: &[u8],
) -> Reply {
    let path = format!(
        "/v1/leases/{}/checkpoint?worker={worker}&attempt={}&steps={steps}",
        grant.job, grant.attempt
    );
    service.send(Request::put(path).body(Body::from(bytes.to_vec())).unwrap()).await
}

#[tokio::test]
async fn a_worker_that_lost_its_lease_changes_nothing_and_its_result_is_evidence() {
    let service = Coordinator::new().await;
    let (first, second) = (service.register("a").await, service.register("b").await);
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    let lost = service.claim(first, 1, &[]).await.remove(0);
    assert!(service.claim(second, 1, &[]).await.is_empty());
    service.pass(91.0);
    assert_eq!(service.app.reap().await.unwrap(), 1);
    let grant = service.claim(second, 1, &[]).await.remove(0);
    assert_eq!((grant.job, grant.attempt), (lost.job, 2));
    beat(&service, first, &lost).await.expect(409, "stale-lease");
    service.complete(first, &lost, 0.8).await.expect(409, "stale-lease");
    checkpoint(&service, first, &lost, 10, b"late").await.expect(409, "stale-lease");
    let rows = service.get(&format!("/v1/sweeps/{sweep}/results")).await.expect(200, "");
    assert_eq!(rows["items"], json!([]));
    // The result that counts differs from the late one: on one hardware class that is a fault, kept and shown.
    service.complete(second, &grant, 0.9).await.expect(200, "");
    let job = service.get(&format!("/v1/jobs/{}", grant.job)).await.expect(200, "");
    assert_eq!((&job["result"]["record"]["e"], &job["result"]["alarm"]), (&json!(0.9), &json!(true)));
    assert_eq!(job["other_results"][0]["record"]["e"], 0.8);
    assert_eq!(job["losses"], 1);
    let metrics = service.get("/metrics").await.text();
    assert!(metrics.contains("tamp_determinism_alarms_total 1"), "{metrics}");
    assert!(metrics.contains("tamp_jobs{state=\"done\"} 1"), "{metrics}");
    service.audit().await;
}

#[tokio::test]
async fn the_same_result_twice_is_one() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    assert_eq!(service.complete(worker, &grant, 0.9).await.expect(200, "")["duplicate"], false);
    assert_eq!(service.complete(worker, &grant, 0.9).await.expect(200, "")["duplicate"], true);
    service.complete(worker, &grant, 0.8).await.expect(409, "stale-lease");
    let job = service.get(&format!("/v1/jobs/{}", grant.job)).await.expect(200, "");
    assert_eq!((&job["result"]["record"]["e"], &job["result"]["alarm"]), (&json!(0.9), &json!(true)));
}

#[tokio::test]
async fn heartbeats_keep_the_lease_and_show_progress() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    for _ in 0..5 {
        service.pass(60.0);
        assert_eq!(beat(&service, worker, &grant).await.expect(200, "")["directive"], "continue");
        // Not written yet, but the reaper hears it.
        assert_eq!(service.app.reap().await.unwrap(), 0);
        service.app.flush().await.unwrap();
    }
    let view = service.sweep(&sweep).await;
    assert_eq!(view["progress"], 0.5);
    // Half of the work took one second; round-off of a few operations.
    assert!((view["eta_seconds"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{view}");
    let job = service.get(&format!("/v1/jobs/{}", grant.job)).await.expect(200, "");
    assert_eq!(job["attempts"][0]["live"]["e"], 1.2);
}

#[tokio::test]
async fn heartbeats_not_yet_written_count_when_leases_are_reaped() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    service.pass(80.0);
    beat(&service, worker, &grant).await.expect(200, "");
    service.pass(20.0);
    service.app.reap().await.unwrap();
    service.complete(worker, &grant, 0.9).await.expect(200, "");
}

#[tokio::test]
async fn a_restart_gives_leases_a_grace_period() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    // Away for hours; the worker went on.
    service.pass(7200.0);
    let service = service.restarted().await;
    assert_eq!(service.app.reap().await.unwrap(), 0);
    service.pass(100.0);
    assert_eq!(service.app.reap().await.unwrap(), 0);
    service.complete(worker, &grant, 0.9).await.expect(200, "");
    service.audit().await;
}

#[tokio::test]
async fn a_worker_that_asks_again_gets_the_job_it_holds() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    assert_eq!(service.register("a").await, worker);
    service.submit(&definition("two", &[1e6], &[1, 2])).await;
    let first = service.claim(worker, 1, &[]).await.remove(0);
    let again = service.claim(worker, 1, &[]).await.remove(0);
    assert_eq!(first, again);
    let other = service.claim(worker, 1, &[first.job]).await.remove(0);
    assert_ne!(other.job, first.job);
}

#[tokio::test]
async fn three_failures_set_a_job_aside_with_evidence_and_a_retry_brings_it_back() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    for round in 1..=3 {
        let grant = service.claim(worker, 1, &[]).await.remove(0);
        let state = fail(&service, worker, &grant, "retryable").await["state"].clone();
        assert_eq!(state, if round < 3 { "queued" } else { "failed" });
    }
    assert!(service.claim(worker, 1, &[]).await.is_empty());
    let view = service.sweep(&sweep).await;
    assert_eq!((&view["state"], &view["counts"]["failed"]), (&json!("failed"), &json!(1)));
    let points = service.get(&format!("/v1/sweeps/{sweep}/points?state=failed")).await.expect(200, "");
    let job = points["items"][0]["job"].as_str().unwrap();
    let job = service.get(&format!("/v1/jobs/{job}")).await.expect(200, "");
    assert_eq!(job["attempts"][2]["message"], "index out of bounds");
    let reply = service.post(&format!("/v1/sweeps/{sweep}/retry"), &json!({})).await.expect(200, "");
    assert_eq!((&reply["jobs_changed"], &reply["sweep"]["state"]), (&json!(1), &json!("running")));
    assert_eq!(service.run_all(worker).await, 1);
    assert_eq!(service.sweep(&sweep).await["state"], "done");
    service.audit().await;
}

#[tokio::test]
async fn a_permanent_failure_is_not_tried_again() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    assert_eq!(fail(&service, worker, &grant, "permanent").await["state"], "failed");
}

#[tokio::test]
async fn losses_and_releases_never_eat_the_failure_budget() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("one", &[1e6], &[1])).await;
    for _ in 0..8 {
        service.claim(worker, 1, &[]).await.remove(0);
        service.pass(91.0);
        service.app.reap().await.unwrap();
    }
    for _ in 0..20 {
        let grant = service.claim(worker, 1, &[]).await.remove(0);
        let body = json!({ "worker": worker, "attempt": grant.attempt, "reason": "drain" });
        service.post(&format!("/v1/leases/{}/release", grant.job), &body).await.expect(200, "");
    }
    // The ninth worker killed in a row is one too many.
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    service.pass(91.0);
    service.app.reap().await.unwrap();
    let job = service.get(&format!("/v1/jobs/{}", grant.job)).await.expect(200, "");
    assert_eq!((&job["state"], &job["losses"], &job["failures"]), (&json!("failed"), &json!(9), &json!(0)));
    service.audit().await;
}

#[tokio::test]
async fn a_job_goes_on_elsewhere_from_its_newest_checkpoint() {
    let service = Coordinator::new().await;
    let (first, second) = (service.register("a").await, service.register("b").await);
    service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(first, 1, &[]).await.remove(0);
    assert_eq!(grant.checkpoint, None);
    checkpoint(&service, first, &grant, 100, b"state at 100").await.expect(200, "");
    checkpoint(&service, first, &grant, 200, b"state at 200").await.expect(200, "");
    // One that comes late by another way does not go back.
    checkpoint(&service, first, &grant, 150, b"state at 150").await.expect(200, "");
    checkpoint(&service, first, &grant, 300, b"").await.expect(422, "invalid-request");
    service.pass(91.0);
    service.app.reap().await.unwrap();
    let grant = service.claim(second, 1, &[]).await.remove(0);
    let newest = grant.checkpoint.clone().unwrap();
    assert_eq!((newest.steps, newest.bytes), (200, 12));
    let path = format!("/v1/leases/{}/checkpoint?worker={second}&attempt={}", grant.job, grant.attempt);
    let reply = service.get(&path).await;
    assert_eq!(reply.bytes, b"state at 200");
    assert_eq!(reply.headers["etag"].to_str().unwrap(), format!("\"{}\"", newest.hash));
    service.complete(second, &grant, 0.9).await.expect(200, "");
    // Nobody needs the files any more; the outcome stays.
    service.pass(3600.0);
    service.app.tidy().await.unwrap();
    assert!(service.app.blobs().get(&newest.hash).is_err());
    service.get(&format!("/v1/jobs/{}/series", grant.job)).await.expect(200, "");
}

#[tokio::test]
async fn waiting_for_work_ends_when_there_is_some() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let waiting = {
        let app = service.app.clone();
        let request = protocol::ClaimRequest { worker, slots: 1, holding: Vec::new(), wait_seconds: 60.0 };
        tokio::spawn(async move { app.claim(request).await })
    };
    service.submit(&definition("one", &[1e6], &[1])).await;
    let reply = tokio::time::timeout(std::time::Duration::from_secs(30), waiting).await.unwrap();
    assert_eq!(reply.unwrap().unwrap().grants.len(), 1);
}

#[tokio::test]
async fn a_worker_of_another_physics_version_gets_nothing() {
    let service = Coordinator::new().await;
    let mut registration = crate::support::registration("a");
    registration["models"] = json!([["cohesive_spheres", 999_999], ["cohesive_discs", 1]]);
    let reply = service.post("/v1/workers", &registration).await.expect(201, "");
    let worker: WorkerId = reply["worker"].as_str().unwrap().parse().unwrap();
    service.submit(&definition("one", &[1e6], &[1])).await;
    assert!(service.claim(worker, 1, &[]).await.is_empty());
}
