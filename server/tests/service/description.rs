//! The committed API description, the pages, the metrics.

use crate::support::{Coordinator, definition};

#[test]
fn api_yaml_is_what_the_handlers_say() {
    let committed = include_str!("../../../api.yaml");
    assert!(
        committed == server::description(),
        "api.yaml differs from the handlers; write it anew: cargo run -p server -- --print-api > api.yaml"
    );
}

#[tokio::test]
async fn pages_need_no_network() {
    let service = Coordinator::new().await;
    for path in ["/", "/docs"] {
        let reply = service.get(path).await;
        assert_eq!(reply.status, 200);
        let text = reply.text();
        assert!(text.starts_with("<!doctype html>"));
        assert!(
            !text.contains("http://") && !text.contains("https://") && !text.contains("<script"),
            "{path}"
        );
    }
    let docs = service.get("/docs").await.text();
    for route in ["/v1/sweeps/{id}/collapse", "/v1/claims", "/v1/leases/{job}/checkpoint"] {
        assert!(docs.contains(route), "{route}");
    }
    assert_eq!(service.get("/openapi.yaml").await.text(), server::description());
}

#[tokio::test]
async fn requests_are_counted_by_route() {
    let service = Coordinator::new().await;
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    service.sweep(&sweep).await;
    let text = service.get("/metrics").await.text();
    let line = "tamp_http_requests_total{method=\"GET\",route=\"/v1/sweeps/{id}\",status=\"200\"} 1";
    assert!(text.contains(line), "{text}");
    assert!(text.contains("tamp_jobs{state=\"queued\"} 1"), "{text}");
}

#[tokio::test]
async fn events_are_followed_and_taken_up_again() {
    use futures_util::StreamExt;
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    service.run_all(worker).await;
    let stored = service.app.store().events(0, Some(sweep.parse().unwrap()), 100).await.unwrap();
    let kinds: Vec<&str> = stored.iter().map(|event| event.kind.as_str()).collect();
    assert_eq!(kinds, ["sweep_submitted", "sweep_state", "job_done", "sweep_state"]);
    // A client that saw the first one gets the rest.
    use tower::ServiceExt;
    let request = axum::http::Request::get(format!("/v1/events?sweep={sweep}"))
        .header("last-event-id", stored[0].seq.to_string())
        .body(axum::body::Body::empty())
        .unwrap();
    let response = server::build(service.app.clone()).oneshot(request).await.unwrap();
    assert_eq!(response.headers()["content-type"], "text/event-stream");
    let mut stream = response.into_body().into_data_stream();
    let mut text = String::new();
    while !text.contains("\"done\"") {
        text.push_str(std::str::from_utf8(&stream.next().await.unwrap().unwrap()).unwrap());
    }
    assert!(!text.contains("sweep_submitted"));
    assert!(text.contains(&format!("id: {}", stored[2].seq)), "{text}");
}
