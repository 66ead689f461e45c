//! The store against the pure life cycle: the same random happenings, the same jobs.

use std::collections::BTreeMap;
use std::time::Duration;

use protocol::{Failure, FailureKind, Grant, JobId, JobState, WorkerId};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use server::scheduler::lifecycle::{Happening, Job};
use server::store::{Control, Controlled, LeaseWrite};

use crate::support::{Coordinator, definition};

struct Pair {
    service: Coordinator,
    workers: Vec<WorkerId>,
    jobs: BTreeMap<JobId, (Job, Vec<Grant>, Option<WorkerId>)>,
    sweeps: Vec<(protocol::SweepId, Vec<JobId>)>,
}

impl Pair {
    async fn new() -> Self {
        let service = Coordinator::new().await;
        let mut workers = Vec::new();
        for host in ["a", "b", "c"] {
            workers.push(service.register(host).await);
        }
        let mut sweeps = Vec::new();
        let mut jobs = BTreeMap::new();
        for stresses in [[1e6, 2e6, 3e6], [3e6, 4e6, 5e6]] {
            let id = service.submit(&definition("s", &stresses, &[1])).await;
            let points = service.app.points(id.parse().unwrap(), None, None, 100).await.unwrap();
            let own: Vec<JobId> = points.items.iter().map(|point| point.job).collect();
            jobs.extend(own.iter().map(|&job| (job, (Job::FRESH, Vec::new(), None))));
            sweeps.push((id.parse().unwrap(), own));
        }
        Self { service, workers, jobs, sweeps }
    }

    /// Applies a happening to the model; whether it was accepted.
    fn model(&mut self, job: JobId, happening: Happening) -> bool {
        let limits = self.service.app.limits();
        let entry = self.jobs.get_mut(&job).unwrap();
        match entry.0.after(happening, limits) {
            Ok(next) => {
                entry.0 = next;
                true
            }
            Err(_) => false,
        }
    }

    async fn step(&mut self, rng: &mut Pcg64Mcg) {
        let worker = self.workers[rng.random_range(0..self.workers.len())];
        let picked = rng.random_range(0..self.jobs.len());
        let job = *self.jobs.keys().nth(picked).unwrap();
        let grant = {
            let grants = &self.jobs[&job].1;
            if grants.is_empty() { None } else { Some(grants[rng.random_range(0..grants.len())].clone()) }
        };
        let now = self.service.app.now();
        let limits = self.service.app.limits();
        match (rng.random_range(0..12), grant) {
            (0..4, _) => {
                let holding: Vec<JobId> = self.jobs.keys().copied().collect();
                for grant in self.service.claim(worker, 1, &holding).await {
                    assert!(self.model(grant.job, Happening::Claim), "claimed what the model does not give");
                    let entry = self.jobs.get_mut(&grant.job).unwrap();
                    assert_eq!(grant.attempt, entry.0.attempt);
                    entry.1.push(grant.clone());
                    entry.2 = Some(worker);
                }
            }
            (4 | 5, Some(grant)) => {
                let holder = self.jobs[&job].2.unwrap();
                let accepted = self.model(job, Happening::Complete(grant.attempt));
                let before = self.jobs[&job].0.state == JobState::Done;
                let status = self.service.complete(holder, &grant, 0.9).await.status;
                if accepted {
                    assert_eq!(status, 200);
                } else {
                    assert!(status == 409 || (status == 200 && before), "{status}");
                }
            }
            (6, Some(grant)) => {
                let kind = if rng.random_bool(0.2) { FailureKind::Permanent } else { FailureKind::Retryable };
                let failure = Failure {
                    worker: self.jobs[&job].2.unwrap(),
                    attempt: grant.attempt,
                    kind,
                    class: "test".to_owned(),
                    message: String::new(),
                };
                let accepted = self.model(job, Happening::Fail(grant.attempt, kind));
                let store = self.service.app.store();
                let write = store.fail(job, &failure, limits, Duration::ZERO, now).await.unwrap();
                assert_eq!(matches!(write, LeaseWrite::Accepted(_)), accepted, "{write:?}");
            }
            (7, Some(grant)) => {
                let who = (self.jobs[&job].2.unwrap(), grant.attempt);
                let accepted = self.model(job, Happening::Release(grant.attempt));
                let write = self.service.app.store().release(job, who, "", limits, now).await.unwrap();
                assert_eq!(matches!(write, LeaseWrite::Accepted(_)), accepted, "{write:?}");
            }
            (8, _) => {
                self.service.pass(91.0);
                self.service.app.reap().await.unwrap();
                let leased: Vec<(JobId, u32)> = self
                    .jobs
                    .iter()
                    .filter(|(_, (job, _, _))| job.state == JobState::Leased)
                    .map(|(&id, (job, _, _))| (id, job.attempt))
                    .collect();
                for (id, attempt) in leased {
                    assert!(self.model(id, Happening::Expire(attempt)));
                }
            }
            (9.., _) => self.control(rng).await,
            _ => {}
        }
    }

    async fn control(&mut self, rng: &mut Pcg64Mcg) {
        let (sweep, own) = self.sweeps[rng.random_range(0..self.sweeps.len())].clone();
        let controls = [
            Control::Pause,
            Control::Resume,
            Control::Resume,
            Control::Cancel,
            Control::Retry,
            Control::Retry,
        ];
        let control = controls[rng.random_range(0..controls.len())];
        let controlled =
            self.service.app.store().control(sweep, control, self.service.app.now()).await.unwrap();
        let Controlled::Changed(_) = controlled else { return };
        match control {
            Control::Pause | Control::Resume => {}
            Control::Cancel => {
                for job in own {
                    let mut wanted = false;
                    for (other, theirs) in &self.sweeps {
                        let view = self.service.app.sweep(*other).await.unwrap();
                        wanted |= theirs.contains(&job) && view.state.name() != "cancelled";
                    }
                    if !wanted {
                        self.model(job, Happening::Abandon);
                    }
                }
            }
            Control::Retry => {
                for job in own {
                    self.model(job, Happening::Retry);
                }
            }
        }
    }

    async fn compare(&self, step: usize) {
        for (&id, (job, _, _)) in &self.jobs {
            let view = self.service.app.job(id).await.unwrap();
            let stored = (view.state, view.attempt, view.failures, view.losses);
            assert_eq!(stored, (job.state, job.attempt, job.failures, job.losses), "job {id}, step {step}");
        }
        self.service.audit().await;
    }
}

#[tokio::test]
async fn the_store_does_what_the_life_cycle_says() {
    for seed in 0..3 {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut pair = Pair::new().await;
        for step in 0..120 {
            pair.step(&mut rng).await;
            pair.compare(step).await;
        }
    }
}
