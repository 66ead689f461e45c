//! Counters for Prometheus.

use std::time::Duration;

use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::registry::Registry;

/// Labels of a request.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
pub struct RequestLabels {
    /// Method.
    pub method: String,
    /// Route as registered, not the path: no ids.
    pub route: String,
    /// Status code.
    pub status: u32,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct StateLabel {
    state: &'static str,
}

/// Everything counted.
pub struct Metrics {
    registry: Registry,
    requests: Family<RequestLabels, Counter>,
    latency: Histogram,
    jobs: Family<StateLabel, Gauge>,
    open_sweeps: Gauge,
    workers: Gauge,
    contradictions: Gauge,
    /// Sweeps submitted.
    pub sweeps: Counter,
    /// Jobs leased.
    pub claims: Counter,
    /// Heartbeats heard.
    pub heartbeats: Counter,
    /// Checkpoints stored.
    pub checkpoints: Counter,
    /// Results accepted.
    pub results: Counter,
    /// Results that arrived a second time.
    pub duplicates: Counter,
    /// Results refused because the lease was lost.
    pub late: Counter,
    /// Runs that failed.
    pub failures: Counter,
    /// Leases that expired.
    pub losses: Counter,
    /// Results that contradict another one of the same scene and hardware class.
    pub alarms: Counter,
    /// Reconciler passes that failed.
    pub reconcile_errors: Counter,
}

impl Default for Metrics {
    fn default() -> Self {
        let mut registry = Registry::with_prefix("tamp");
        let counter = |registry: &mut Registry, name: &str, help: &str| {
            let counter = Counter::default();
            registry.register(name, help, counter.clone());
            counter
        };
        let requests = Family::default();
        registry.register("http_requests", "Requests by method, route and status", requests.clone());
        let latency = Histogram::new(exponential_buckets(0.000_5, 2.0, 16));
        registry.register(
            "http_request_seconds",
            "Time to the head of the answer, long polls and event streams left out",
            latency.clone(),
        );
        let jobs = Family::default();
        registry.register("jobs", "Jobs by state", jobs.clone());
        let open_sweeps = Gauge::default();
        registry.register("open_sweeps", "Sweeps that are not over", open_sweeps.clone());
        let workers = Gauge::default();
        registry.register("workers_alive", "Workers heard within two leases", workers.clone());
        let contradictions = Gauge::default();
        registry.register(
            "contradictory_results",
            "Stored results that differ from another one of the same scene and hardware class",
            contradictions.clone(),
        );
        Self {
            contradictions,
            requests,
            latency,
            jobs,
            open_sweeps,
            workers,
            sweeps: counter(&mut registry, "sweeps_submitted", "Sweeps submitted"),
            claims: counter(&mut registry, "jobs_leased", "Jobs leased"),
            heartbeats: counter(&mut registry, "heartbeats", "Heartbeats heard"),
            checkpoints: counter(&mut registry, "checkpoints_stored", "Checkpoints stored"),
            results: counter(&mut registry, "results_accepted", "Results accepted"),
            duplicates: counter(&mut registry, "results_duplicate", "Results that arrived a second time"),
            late: counter(&mut registry, "results_late", "Results refused because the lease was lost"),
            failures: counter(&mut registry, "run_failures", "Runs that failed"),
            losses: counter(&mut registry, "leases_lost", "Leases that expired"),
            alarms: counter(
                &mut registry,
                "determinism_alarms",
                "Results that contradict another one of the same scene and hardware class",
            ),
            reconcile_errors: counter(&mut registry, "reconcile_errors", "Reconciler passes that failed"),
            registry,
        }
    }
}

impl Metrics {
    /// Counts a request.
    pub fn request(&self, labels: &RequestLabels, took: Option<Duration>) {
        self.requests.get_or_create(labels).inc();
        if let Some(took) = took {
            self.latency.observe(took.as_secs_f64());
        }
    }

    /// The text for Prometheus, with the gauges read now.
    ///
    /// # Errors
    /// Never in practice: writing to a string does not fail.
    pub fn text(&self, totals: &crate::store::Totals, workers: u64) -> Result<String, std::fmt::Error> {
        let counts = totals.jobs;
        let states = [
            ("queued", counts.queued),
            ("leased", counts.leased),
            ("done", counts.done),
            ("failed", counts.failed),
            ("cancelled", counts.cancelled),
        ];
        for (state, count) in states {
            self.jobs.get_or_create(&StateLabel { state }).set(i64::try_from(count).unwrap_or(i64::MAX));
        }
        self.open_sweeps.set(i64::try_from(totals.open_sweeps).unwrap_or(i64::MAX));
        self.contradictions.set(i64::try_from(totals.alarms).unwrap_or(i64::MAX));
        self.workers.set(i64::try_from(workers).unwrap_or(i64::MAX));
        let mut text = String::new();
        encode(&mut text, &self.registry)?;
        Ok(text)
    }
}
