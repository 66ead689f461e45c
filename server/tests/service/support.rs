//! A coordinator without sockets.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderMap, Method, Request, StatusCode};
use http_body_util::BodyExt;
use protocol::{Grant, JobId, WorkerId};
use serde_json::{Value, json};
use server::clock::{ManualClock, Moment};
use server::{App, Config};
use tempfile::TempDir;
use tower::ServiceExt;

pub struct Coordinator {
    pub app: App,
    pub clock: ManualClock,
    pub folder: TempDir,
    config: Config,
}

pub struct Reply {
    pub status: StatusCode,
    pub headers: HeaderMap,
    pub bytes: Vec<u8>,
}

impl Reply {
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.bytes)
            .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&self.bytes)))
    }

    pub fn text(&self) -> String {
        String::from_utf8(self.bytes.clone()).unwrap()
    }

    /// The reply has this status; errors are problem documents of this type.
    #[track_caller]
    pub fn expect(self, status: u16, kind: &str) -> Value {
        let text = String::from_utf8_lossy(&self.bytes);
        assert_eq!(self.status.as_u16(), status, "{text}");
        if status >= 400 {
            assert_eq!(self.headers["content-type"], "application/problem+json", "{text}");
            let problem = self.json();
            assert_eq!(problem["type"], format!("urn:tamp:{kind}"), "{text}");
            assert_eq!(problem["status"], status);
            assert!(problem["title"].is_string() && problem["detail"].is_string(), "{text}");
            for error in problem["errors"].as_array().into_iter().flatten() {
                assert!(error["problem"].as_str().is_some_and(|text| !text.is_empty()), "{problem}");
                assert!(error["remedy"].as_str().is_some_and(|text| !text.is_empty()), "{problem}");
            }
            return problem;
        }
        self.json()
    }
}

impl Coordinator {
    pub async fn new() -> Self {
        Self::with(|_| {}).await
    }

    pub async fn with(change: impl FnOnce(&mut Config)) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut config = Config {
            data_dir: folder.path().to_owned(),
            retry_seconds: 0.0,
            readers: 2,
            max_body_bytes: 1 << 20,
            ..Config::default()
        };
        change(&mut config);
        let clock = ManualClock::at(Moment(1_800_000_000_000));
        let parts = server::parts(config.clone(), Arc::new(clock.clone())).await.unwrap();
        Self { app: App::new(parts), clock, folder, config }
    }

    /// Stops without a goodbye and starts again on the same disk.
    pub async fn restarted(self) -> Self {
        let Self { app, clock, folder, config } = self;
        app.store().close().await;
        drop(app);
        let parts = server::parts(config.clone(), Arc::new(clock.clone())).await.unwrap();
        Self { app: App::new(parts), clock, folder, config }
    }

    pub fn pass(&self, seconds: f64) {
        self.clock.advance(Duration::from_secs_f64(seconds));
    }

    pub async fn send(&self, request: Request<Body>) -> Reply {
        let response = server::build(self.app.clone()).oneshot(request).await.unwrap();
        let (parts, body) = response.into_parts();
        let bytes = body.collect().await.unwrap().to_bytes().to_vec();
        Reply { status: parts.status, headers: parts.headers, bytes }
    }

    pub async fn get(&self, path: &str) -> Reply {
        self.send(Request::get(path).body(Body::empty()).unwrap()).await
    }

    pub async fn post(&self, path: &str, body: &Value) -> Reply {
        self.call(Method::POST, path, body).await
    }

    pub async fn call(&self, method: Method, path: &str, body: &Value) -> Reply {
        let request = Request::builder()
            .method(method)
            .uri(path)
            .header("content-type", "application/json")
            .body(Body::from(body.to_string()))
            .unwrap();
        self.send(request).await
    }

    /// Submits a sweep and returns its id.
    pub async fn submit(&self, definition: &Value) -> String {
        let reply = self.post("/v1/sweeps", definition).await.expect(201, "");
        reply["id"].as_str().unwrap().to_owned()
    }

    pub async fn sweep(&self, id: &str) -> Value {
        self.get(&format!("/v1/sweeps/{id}")).await.expect(200, "")
    }

    pub async fn register(&self, host: &str) -> WorkerId {
        let reply = self.post("/v1/workers", &registration(host)).await.expect(201, "");
        reply["worker"].as_str().unwrap().parse().unwrap()
    }

    pub async fn claim(&self, worker: WorkerId, slots: u32, holding: &[JobId]) -> Vec<Grant> {
        let body = json!({ "worker": worker, "slots": slots, "holding": holding });
        let reply = self.post("/v1/claims", &body).await.expect(200, "");
        serde_json::from_value(reply["grants"].clone()).unwrap()
    }

    pub async fn complete(&self, worker: WorkerId, grant: &Grant, e: f64) -> Reply {
        self.post(&format!("/v1/leases/{}/result", grant.job), &completion(worker, grant, e)).await
    }

    /// Runs whatever is queued to its end.
    pub async fn run_all(&self, worker: WorkerId) -> usize {
        let mut runs = 0;
        loop {
            let grants = self.claim(worker, 16, &[]).await;
            if grants.is_empty() {
                return runs;
            }
            for grant in grants {
                self.complete(worker, &grant, 0.9).await.expect(200, "");
                runs += 1;
            }
        }
    }

    /// No kept count may disagree with the rows.
    pub async fn audit(&self) {
        assert_eq!(self.app.store().audit().await.unwrap(), Vec::<String>::new());
    }
}

pub fn registration(host: &str) -> Value {
    json!({
        "protocol": 1, "host": host, "boot": uuid::Uuid::from_bytes(*blake3::hash(host.as_bytes()).as_bytes().first_chunk().unwrap()),
        "slots": 4, "hardware": "x86_64-test", "code_version": "0.1.0",
        "models": [["cohesive_spheres", scene::Model::CohesiveSpheres.physics_version()]],
    })
}

pub fn completion(worker: WorkerId, grant: &Grant, e: f64) -> Value {
    let column = |name: &str, values: &[f64]| json!({ "name": name, "unit": "1", "values": values });
    json!({
        "worker": worker, "attempt": grant.attempt, "scene_key": grant.scene_key,
        "outcome": {
            "record": { "status": "equilibrium", "e": e, "steps": 1000 },
            "states": [],
            "series": { "columns": [column("t", &[0.0, 1.0]), column("e", &[1.5, e])] },
            "packing": { "particles": { "columns": [
                column("x", &[0.0, 1.0]), column("y", &[0.0, 0.0]), column("z", &[0.0, 0.0]),
            ] }, "contacts": { "columns": [column("i", &[0.0]), column("j", &[1.0]), column("fn", &[0.5])] } },
        },
        "execution": { "wall_s": 2.0, "kernel": "test" },
    })
}

pub fn heartbeat(worker: WorkerId, attempt: u32, fraction: f64) -> Value {
    json!({
        "worker": worker, "attempt": attempt, "steps": 10, "expected_steps": 100, "fraction": fraction,
        "wall_s": 1.0, "live": { "e": 1.2 },
    })
}

/// A sweep over cohesive stresses and seeds.
pub fn definition(name: &str, sigma_c: &[f64], seeds: &[u64]) -> Value {
    json!({
        "name": name, "model": "cohesive_spheres",
        "base": { "n": 200, "p": 1e5, "sigma_e": 1e10 },
        "blocks": [{ "grid": { "sigma_c": sigma_c, "seed": seeds } }],
    })
}
