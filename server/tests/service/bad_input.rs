//! Everything a client can get wrong has a problem document; nothing is stored by halves.

use axum::body::Body;
use axum::http::{Method, Request};
use serde_json::{Value, json};

use crate::support::{Coordinator, completion, definition, heartbeat, registration};

fn broken(change: impl FnOnce(&mut Value)) -> Value {
    let mut sweep = definition("broken", &[1e6], &[1]);
    change(&mut sweep);
    sweep
}

#[tokio::test]
async fn mistakes_in_a_sweep_name_the_field_and_a_remedy() {
    let service = Coordinator::new().await;
    let cases = [
        ("unknown key", broken(|sweep| sweep["colour"] = json!("red")), "colour"),
        ("unknown scene key", broken(|sweep| sweep["base"]["sigma_x"] = json!(1)), "base.sigma_x"),
        ("wrong type", broken(|sweep| sweep["base"]["p"] = json!("high")), "base.p"),
        ("negative mass", broken(|sweep| sweep["base"]["mw"] = json!(-96)), "base.mw"),
        ("unknown model", broken(|sweep| sweep["model"] = json!("jelly")), "model"),
        (
            "empty grid",
            broken(|sweep| sweep["blocks"][0]["grid"]["sigma_c"] = json!([])),
            "blocks[0].grid.sigma_c",
        ),
        ("no block", broken(|sweep| sweep["blocks"] = json!(0)), "blocks"),
        (
            "a thousand million points",
            broken(|sweep| {
                let seeds: Vec<u64> = (1..=1000).collect();
                let axis = json!({ "log": [1e3, 1e8, 1000] });
                sweep["blocks"][0]["grid"] = json!({ "sigma_c": axis, "p": axis, "seed": seeds });
            }),
            "",
        ),
    ];
    for (what, sweep, field) in cases {
        for path in ["/v1/sweeps", "/v1/sweeps?dry_run=true"] {
            let problem = service.post(path, &sweep).await.expect(422, "invalid-sweep");
            let errors = problem["errors"].as_array().unwrap();
            assert!(!errors.is_empty(), "{what}");
            let named = errors.iter().any(|error| error["field"].as_str().unwrap().starts_with(field));
            assert!(named, "{what}: {problem}");
        }
    }
    let listed = service.get("/v1/sweeps").await.expect(200, "");
    assert_eq!(listed["items"], json!([]));
    service.audit().await;
}

#[tokio::test]
async fn every_mistake_of_a_sweep_is_told_at_once() {
    let service = Coordinator::new().await;
    let sweep = broken(|sweep| {
        sweep["base"]["mw"] = json!(-1);
        sweep["base"]["nonsense"] = json!(1);
        sweep["blocks"][0]["grid"]["sigma_c"] = json!([]);
    });
    let problem = service.post("/v1/sweeps", &sweep).await.expect(422, "invalid-sweep");
    assert!(problem["errors"].as_array().unwrap().len() >= 3, "{problem}");
}

async fn raw(service: &Coordinator, kind: &str, body: impl Into<Body>) -> crate::support::Reply {
    let request = Request::post("/v1/sweeps").header("content-type", kind).body(body.into()).unwrap();
    service.send(request).await
}

#[tokio::test]
async fn bodies_that_are_no_documents() {
    let service = Coordinator::new().await;
    let problem = raw(&service, "application/json", "{\"name\": NaN}").await.expect(400, "malformed-json");
    let told = problem["errors"][0]["problem"].as_str().unwrap();
    assert!(told.contains("line 1 column"), "{problem}");
    let twice = "{\"name\": \"a\", \"name\": \"b\"}";
    let problem = raw(&service, "application/json", twice).await.expect(400, "malformed-json");
    assert_eq!(problem["errors"][0]["field"], "name");
    raw(&service, "application/json", "").await.expect(400, "malformed-json");
    raw(&service, "application/json", "[1, 2").await.expect(400, "malformed-json");
    raw(&service, "application/json", "{\"base\": {\"p\": 1e999}}").await.expect(400, "malformed-json");
    raw(&service, "text/plain", "{}").await.expect(415, "unsupported-media-type");
    raw(&service, "application/x-www-form-urlencoded", "{}").await.expect(415, "unsupported-media-type");
    raw(&service, "application/json", "[]").await.expect(422, "invalid-sweep");
    raw(&service, "application/json", "null").await.expect(422, "invalid-sweep");
}

#[tokio::test]
async fn a_body_of_a_hundred_megabytes_is_refused() {
    let service = Coordinator::new().await;
    let problem =
        raw(&service, "application/json", vec![b' '; 100 << 20]).await.expect(413, "body-too-large");
    assert!(problem["detail"].as_str().unwrap().contains("1048576 bytes"), "{problem}");
}

#[tokio::test]
async fn routes_methods_ids_and_queries() {
    let service = Coordinator::new().await;
    service.get("/v2/sweeps").await.expect(404, "no-route");
    let reply = service.call(Method::DELETE, "/v1/sweeps", &json!({})).await;
    assert!(reply.headers.contains_key("allow"));
    reply.expect(405, "method-not-allowed");
    service.get("/v1/sweeps/not-an-id").await.expect(404, "not-found");
    let nobody = uuid::Uuid::nil();
    for path in ["", "/results", "/states", "/points", "/collapse", "/fit", "/bonds.svg", "/variation?of=ei"]
    {
        service.get(&format!("/v1/sweeps/{nobody}{path}")).await.expect(404, "not-found");
    }
    for path in ["", "/series", "/snapshot"] {
        service.get(&format!("/v1/jobs/{nobody}{path}")).await.expect(404, "not-found");
    }
    for control in ["cancel", "pause", "resume", "retry"] {
        service.post(&format!("/v1/sweeps/{nobody}/{control}"), &json!({})).await.expect(404, "not-found");
    }
    for query in ["limit=0", "limit=100000", "limit=many", "cursor=xyz", "page=2", "state=asleep"] {
        service.get(&format!("/v1/sweeps?{query}")).await.expect(400, "invalid-query");
    }
    service.get("/v1/points/short/explain").await.expect(400, "invalid-query");
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    for query in ["limit=0", "limit=x", "cursor=x", "p.min=much"] {
        service.get(&format!("/v1/sweeps/{sweep}/results?{query}")).await.expect(400, "invalid-query");
    }
    for query in ["", "?of=p"] {
        service.get(&format!("/v1/sweeps/{sweep}/variation{query}")).await.expect(400, "invalid-query");
    }
    for format in ["parquet", "xls"] {
        service
            .get(&format!("/v1/sweeps/{sweep}/results?format={format}"))
            .await
            .expect(406, "not-acceptable");
    }
}

#[tokio::test]
async fn a_filter_on_a_column_that_is_not_there_is_an_error() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    service.run_all(worker).await;
    let problem =
        service.get(&format!("/v1/sweeps/{sweep}/results?colour=red")).await.expect(400, "invalid-query");
    assert_eq!(problem["errors"][0]["field"], "colour");
}

#[tokio::test]
async fn workers_that_say_nonsense() {
    let service = Coordinator::new().await;
    let with = |field: &str, value: Value| {
        let mut body = registration("a");
        body[field] = value;
        body
    };
    let problem =
        service.post("/v1/workers", &with("protocol", json!(99))).await.expect(426, "protocol-version");
    assert!(problem["detail"].as_str().unwrap().contains("protocol 1"), "{problem}");
    for (field, value) in [("slots", json!(0)), ("host", json!("")), ("models", json!([]))] {
        let problem = service.post("/v1/workers", &with(field, value)).await.expect(422, "invalid-request");
        assert_eq!(problem["errors"][0]["field"], field);
    }
    let problem =
        service.post("/v1/workers", &with("slots", json!("two"))).await.expect(422, "invalid-request");
    assert_eq!(problem["errors"][0]["field"], "slots");
    let problem = service.post("/v1/workers", &with("mood", json!(1))).await.expect(422, "invalid-request");
    assert!(problem["errors"][0]["problem"].as_str().unwrap().contains("mood"), "{problem}");

    let stranger = uuid::Uuid::nil();
    service.post("/v1/claims", &json!({ "worker": stranger, "slots": 1 })).await.expect(404, "not-found");
    let worker = service.register("a").await;
    let claim = json!({ "worker": worker, "slots": 1, "wait_seconds": -1.0 });
    service.post("/v1/claims", &claim).await.expect(422, "invalid-request");
}

#[tokio::test]
async fn results_that_are_not_to_be_taken() {
    let service = Coordinator::new().await;
    let (worker, other) = (service.register("a").await, service.register("b").await);
    let sweep = service.submit(&definition("one", &[1e6], &[1])).await;
    let grant = service.claim(worker, 1, &[]).await.remove(0);
    let path = format!("/v1/leases/{}/result", grant.job);
    let with = |change: &dyn Fn(&mut Value)| {
        let mut body = completion(worker, &grant, 0.9);
        change(&mut body);
        body
    };
    let empty = with(&|body| body["outcome"]["record"] = json!({}));
    service.post(&path, &empty).await.expect(422, "invalid-result");
    let key = with(&|body| body["scene_key"] = json!("00000000000000000000000000000000"));
    service.post(&path, &key).await.expect(422, "invalid-result");
    let null = with(&|body| body["outcome"]["record"]["e"] = Value::Null);
    let problem = service.post(&path, &null).await.expect(422, "invalid-request");
    assert_eq!(problem["errors"][0]["field"], "outcome.record.e");
    let request = Request::post(&path)
        .header("content-type", "application/json")
        .body(Body::from(completion(worker, &grant, 0.9).to_string().replace("0.9", "NaN")))
        .unwrap();
    service.send(request).await.expect(400, "malformed-json");
    service.complete(other, &grant, 0.9).await.expect(409, "stale-lease");
    let later = with(&|body| body["attempt"] = json!(2));
    service.post(&path, &later).await.expect(409, "stale-lease");
    let beat = format!("/v1/leases/{}", grant.job);
    service.call(Method::PUT, &beat, &heartbeat(worker, 1, 1.5)).await.expect(422, "invalid-request");
    service.call(Method::PUT, &beat, &heartbeat(worker, 2, 0.5)).await.expect(409, "stale-lease");
    service.call(Method::PUT, &beat, &heartbeat(other, 1, 0.5)).await.expect(409, "stale-lease");
    let view = service.sweep(&sweep).await;
    assert_eq!(view["counts"]["leased"], 1);
    let rows = service.get(&format!("/v1/sweeps/{sweep}/results")).await.expect(200, "");
    assert_eq!(rows["items"], json!([]));
    service.audit().await;
    // What was refused does not spoil what is right.
    service.complete(worker, &grant, 0.9).await.expect(200, "");
}

#[tokio::test]
async fn a_wrong_token_opens_nothing_but_health() {
    let service = Coordinator::with(|config| config.token = Some("a long secret".to_owned())).await;
    service.get("/v1/sweeps").await.expect(401, "unauthorized");
    let asked = |token: &str| {
        Request::get("/v1/sweeps").header("authorization", token.to_owned()).body(Body::empty()).unwrap()
    };
    service.send(asked("Bearer another secret")).await.expect(401, "unauthorized");
    service.send(asked("Basic a long secret")).await.expect(401, "unauthorized");
    service.send(asked("Bearer a long secret")).await.expect(200, "");
    service.get("/healthz").await.expect(200, "");
    service.get("/readyz").await.expect(200, "");
}
