//! Equal scenes run once; a job that another sweep wants outlives the sweep that is given up.

use axum::http::Method;
use serde_json::json;

use crate::support::{Coordinator, definition, heartbeat};

#[tokio::test]
async fn results_of_one_sweep_serve_another_at_once() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    service.submit(&definition("first", &[1e6, 2e6], &[1])).await;
    assert_eq!(service.run_all(worker).await, 2);
    let second = service.submit(&definition("second", &[1e6, 2e6], &[1])).await;
    let view = service.sweep(&second).await;
    assert_eq!((&view["state"], &view["reused"]), (&json!("done"), &json!(2)));
    // The same groups in other units are the same runs.
    let mut scaled = definition("scaled", &[1e7, 2e7], &[1]);
    scaled["base"]["p"] = json!(1e6);
    scaled["base"]["sigma_e"] = json!(1e11);
    // Agitation is measured against a fixed pressure: scale it too.
    scaled["base"]["agitation"] = json!(10_f64.sqrt());
    let scaled = service.submit(&scaled).await;
    let view = service.sweep(&scaled).await;
    assert_eq!((&view["state"], &view["reused"]), (&json!("done"), &json!(2)));
    let rows = service.get(&format!("/v1/sweeps/{scaled}/results")).await.expect(200, "");
    assert_eq!(rows["items"][0]["p"], 1e6);
    let key = rows["items"][0]["scene_key"].as_str().unwrap();
    let why = service.get(&format!("/v1/points/{key}/explain")).await.expect(200, "");
    assert_eq!((&why["verdict"], why["sweeps"].as_array().unwrap().len()), (&json!("hit"), 3));
    let why = service.get(&format!("/v1/points/{}/explain", "0".repeat(32))).await.expect(200, "");
    assert_eq!(why["verdict"], "miss");
    service.audit().await;
}

#[tokio::test]
async fn a_cancelled_sweep_takes_only_its_own_jobs_along() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let first = service.submit(&definition("first", &[1e6, 2e6], &[1])).await;
    let second = service.submit(&definition("second", &[2e6, 3e6], &[1])).await;
    let grants = service.claim(worker, 3, &[]).await;
    let reply = service.post(&format!("/v1/sweeps/{first}/cancel"), &json!({})).await.expect(200, "");
    assert_eq!(reply["jobs_changed"], 1);
    let view = service.sweep(&first).await;
    assert_eq!(view["counts"], json!({ "queued": 0, "leased": 1, "done": 0, "failed": 0, "cancelled": 1 }));
    let mut dropped = 0;
    for grant in &grants {
        let path = format!("/v1/leases/{}", grant.job);
        let reply =
            service.call(Method::PUT, &path, &heartbeat(worker, grant.attempt, 0.1)).await.expect(200, "");
        if reply["directive"] == "drop" {
            dropped += 1;
            service.complete(worker, grant, 0.9).await.expect(409, "stale-lease");
        } else {
            service.complete(worker, grant, 0.9).await.expect(200, "");
        }
    }
    assert_eq!(dropped, 1);
    assert_eq!(service.sweep(&second).await["state"], "done");
    service.post(&format!("/v1/sweeps/{first}/cancel"), &json!({})).await.expect(200, "");
    service.post(&format!("/v1/sweeps/{first}/resume"), &json!({})).await.expect(409, "conflict");
    service.post(&format!("/v1/sweeps/{second}/pause"), &json!({})).await.expect(409, "conflict");
    service.audit().await;
    // Asked for again, it is run again.
    let third = service.submit(&definition("third", &[1e6], &[1])).await;
    assert_eq!(service.run_all(worker).await, 1);
    assert_eq!(service.sweep(&third).await["state"], "done");
    service.audit().await;
    service.post(&format!("/v1/sweeps/{first}/retry"), &json!({})).await.expect(200, "");
    assert_eq!(service.sweep(&first).await["state"], "done");
    service.audit().await;
}

#[tokio::test]
async fn a_paused_sweep_starts_nothing_and_its_workers_yield() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let first = service.submit(&definition("first", &[1e6, 2e6, 3e6], &[1])).await;
    let running = service.claim(worker, 1, &[]).await.remove(0);
    service.post(&format!("/v1/sweeps/{first}/pause"), &json!({})).await.expect(200, "");
    assert!(service.claim(worker, 2, &[running.job]).await.is_empty());
    let beat = heartbeat(worker, running.attempt, 0.1);
    let path = format!("/v1/leases/{}", running.job);
    assert_eq!(service.call(Method::PUT, &path, &beat).await.expect(200, "")["directive"], "yield");
    // Another sweep wants all of it: it runs on that one's behalf.
    let second = service.submit(&definition("second", &[1e6, 2e6, 3e6], &[1])).await;
    assert_eq!(service.call(Method::PUT, &path, &beat).await.expect(200, "")["directive"], "continue");
    service.audit().await;
    service.complete(worker, &running, 0.9).await.expect(200, "");
    service.run_all(worker).await;
    assert_eq!(service.sweep(&second).await["state"], "done");
    assert_eq!(service.sweep(&first).await["state"], "done");
    service.audit().await;
}
