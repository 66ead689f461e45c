//! From a definition to rows.

use axum::body::Body;
use axum::http::Request;
use serde_json::{Value, json};

use crate::support::{Coordinator, definition};

#[tokio::test]
async fn a_sweep_runs_to_its_rows() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("study", &[1e6, 2e6], &[1, 2])).await;
    let view = service.sweep(&sweep).await;
    assert_eq!((&view["state"], &view["points"]), (&json!("running"), &json!(4)));
    assert_eq!(view["counts"]["queued"], 4);
    assert_eq!(service.run_all(worker).await, 4);
    let view = service.sweep(&sweep).await;
    assert_eq!((&view["state"], &view["progress"]), (&json!("done"), &json!(1.0)));
    assert_eq!(view["counts"]["done"], 4);
    service.audit().await;

    let page = service.get(&format!("/v1/sweeps/{sweep}/results")).await.expect(200, "");
    let rows = page["items"].as_array().unwrap();
    assert_eq!(rows.len(), 4);
    let row = &rows[0];
    assert_eq!((&row["p"], &row["sigma_c"], &row["seed"]), (&json!(1e5), &json!(1e6), &json!(1)));
    assert_eq!((&row["e"], &row["status"]), (&json!(0.9), &json!("equilibrium")));
    assert_eq!((&row["kernel"], &row["attempt"]), (&json!("test"), &json!(1)));
    assert_eq!(row["reduced.adhesion"], json!(1e-4));

    let count = async |query: &str| {
        let page = service.get(&format!("/v1/sweeps/{sweep}/results?{query}")).await.expect(200, "");
        page["items"].as_array().unwrap().len()
    };
    assert_eq!(count("sigma_c=1e6").await, 2);
    assert_eq!(count("sigma_c.min=1.5e6&seed=2").await, 1);
    assert_eq!(count("sigma_c.max=1e5").await, 0);
    assert_eq!(count("status=equilibrium").await, 4);

    let csv = service.get(&format!("/v1/sweeps/{sweep}/results?format=csv")).await;
    assert!(csv.headers["content-type"].to_str().unwrap().starts_with("text/csv"));
    let text = csv.text();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let at = reader.headers().unwrap().iter().position(|name| name == "e").unwrap();
    let values: Vec<String> = reader.records().map(|row| row.unwrap()[at].to_owned()).collect();
    assert_eq!(values, ["0.9"; 4]);

    let request = Request::get(format!("/v1/sweeps/{sweep}/results"))
        .header("accept", "application/x-ndjson")
        .body(Body::empty())
        .unwrap();
    let lines = service.send(request).await.text();
    assert_eq!(lines.lines().filter(|line| serde_json::from_str::<Value>(line).is_ok()).count(), 4);

    let job = row["job"].as_str().unwrap();
    let view = service.get(&format!("/v1/jobs/{job}")).await.expect(200, "");
    assert_eq!((&view["state"], &view["attempts"][0]["end"]), (&json!("done"), &json!("done")));
    assert_eq!(view["result"]["record"]["e"], 0.9);
    let series = service.get(&format!("/v1/jobs/{job}/series")).await.expect(200, "");
    assert_eq!(series["columns"][1]["values"], json!([1.5, 0.9]));
    let series = service.get(&format!("/v1/jobs/{job}/series?format=csv")).await.text();
    assert_eq!(series.lines().count(), 3);
    let packing = service.get(&format!("/v1/jobs/{job}/snapshot")).await.expect(200, "");
    assert_eq!(packing["contacts"]["columns"][2]["name"], "fn");
    let vtk = service.get(&format!("/v1/jobs/{job}/snapshot?format=vtk")).await.text();
    assert!(vtk.starts_with("# vtk DataFile Version 3.0"), "{vtk}");
}

#[tokio::test]
async fn a_dry_run_stores_nothing() {
    let service = Coordinator::new().await;
    let sweep = definition("dry", &[1e6, 2e6, 4e8], &[1, 1]);
    let mut filtered = sweep.clone();
    filtered["where"] = json!([{ "quantity": "sigma_c_over_sigma_e", "max": 0.03 }]);
    let counted = service.post("/v1/sweeps?dry_run=true", &filtered).await.expect(200, "");
    assert_eq!((&counted["points"], &counted["distinct"]), (&json!(4), &json!(2)));
    assert_eq!((&counted["duplicates"], &counted["to_run"]), (&json!(2), &json!(2)));
    assert_eq!(counted["left_out"][0]["points"], 2);
    assert!(counted["estimate"]["core_seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(service.get("/v1/sweeps").await.expect(200, "")["items"], json!([]));

    let worker = service.register("a").await;
    service.submit(&filtered).await;
    assert_eq!(service.run_all(worker).await, 2);
    let counted = service.post("/v1/sweeps?dry_run=true", &sweep).await.expect(200, "");
    assert_eq!((&counted["known"], &counted["to_run"]), (&json!(2), &json!(1)));
}

#[tokio::test]
async fn a_request_with_a_key_is_answered_once() {
    let service = Coordinator::new().await;
    let send = async |key: &str, body: &Value| {
        let request = Request::post("/v1/sweeps")
            .header("content-type", "application/json")
            .header("idempotency-key", key.to_owned())
            .body(Body::from(body.to_string()))
            .unwrap();
        service.send(request).await
    };
    let one = definition("one", &[1e6], &[1]);
    let first = send("k1", &one).await.expect(201, "");
    let again = send("k1", &one).await;
    assert_eq!(again.headers["idempotent-replayed"], "true");
    assert_eq!(again.expect(201, "")["id"], first["id"]);
    send("k1", &definition("two", &[1e6], &[1])).await.expect(422, "idempotency-key-reused");
    assert_ne!(send("k2", &one).await.expect(201, "")["id"], first["id"]);
    assert_eq!(service.get("/v1/sweeps").await.expect(200, "")["items"].as_array().unwrap().len(), 2);
}

#[tokio::test]
async fn lists_come_in_pages_that_neither_miss_nor_repeat() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let seeds: Vec<u64> = (1..=25).collect();
    let sweep = service.submit(&definition("long", &[1e6], &seeds)).await;
    for name in ["a", "b", "c", "d"] {
        service.submit(&definition(name, &[1e6], &[1])).await;
    }
    service.run_all(worker).await;
    let walk = async |path: &str, field: &str| {
        let mut seen = Vec::new();
        let mut cursor = String::new();
        loop {
            let page = service.get(&format!("{path}limit=4{cursor}")).await.expect(200, "");
            let items = page["items"].as_array().unwrap();
            assert!(items.len() <= 4 && !items.is_empty());
            seen.extend(items.iter().map(|item| item[field].clone()));
            match page["next"].as_str() {
                Some(next) => cursor = format!("&cursor={next}"),
                None => return seen,
            }
        }
    };
    let points: Vec<Value> = (0..25).map(|point| json!(point)).collect();
    assert_eq!(walk(&format!("/v1/sweeps/{sweep}/results?"), "point").await, points);
    assert_eq!(walk(&format!("/v1/sweeps/{sweep}/points?state=done&"), "point").await, points);
    assert_eq!(walk("/v1/sweeps?", "name").await, ["d", "c", "b", "a", "long"].map(|name| json!(name)));
}

#[tokio::test]
async fn an_analysis_that_cannot_be_made_says_why() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let sweep = service.submit(&definition("few", &[1e6], &[1])).await;
    for _ in 0..2 {
        for route in
            ["collapse", "fit", "exponents", "forces", "bonds", "variation?of=mw", "fit.svg", "collapse.svg"]
        {
            let problem =
                service.get(&format!("/v1/sweeps/{sweep}/{route}")).await.expect(422, "analysis-impossible");
            assert!(problem["detail"].as_str().unwrap().len() > 10, "{problem}");
        }
        service.run_all(worker).await;
    }
}

#[tokio::test]
async fn expansion_goes_on_where_a_restart_cut_it_off() {
    let service = Coordinator::new().await;
    // More than is expanded before the answer.
    let seeds: Vec<u64> = (1..=2500).collect();
    let sweep = service.submit(&definition("large", &[1e6], &seeds)).await;
    let view = service.sweep(&sweep).await;
    assert_eq!((&view["state"], &view["expanded"]), (&json!("expanding"), &json!(0)));
    let service = service.restarted().await;
    service.app.expand_all().await.unwrap();
    service.app.expand_all().await.unwrap();
    let view = service.sweep(&sweep).await;
    assert_eq!((&view["state"], &view["counts"]["queued"]), (&json!("running"), &json!(2500)));
    service.audit().await;
}

#[tokio::test]
async fn long_runs_and_high_priority_go_first() {
    let service = Coordinator::new().await;
    let worker = service.register("a").await;
    let mut small = definition("mixed", &[1e6], &[1]);
    small["blocks"] = json!([{ "list": [{ "n": 100, "sigma_c": 1e6 }, { "n": 1000, "sigma_c": 1e6 }] }]);
    service.submit(&small).await;
    let mut urgent = definition("urgent", &[1e6], &[7]);
    urgent["base"]["n"] = json!(50);
    urgent["priority"] = json!(5);
    service.submit(&urgent).await;
    let mut order = Vec::new();
    for _ in 0..3 {
        let grant = service.claim(worker, 1, &[]).await.remove(0);
        order.push(grant.reduced["n"].as_u64().unwrap());
        service.complete(worker, &grant, 0.9).await.expect(200, "");
    }
    assert_eq!(order, [50, 1000, 100]);
}
