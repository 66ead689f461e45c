//! A lab of one test: a folder, a coordinator, workers, and a client to look at them.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::Mutex;
use std::time::Duration;

use protocol::api::{JobView, Page, PointView, SweepView};
use protocol::client::{Client, ClientError, Patience};
use protocol::{JobId, SweepId};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use tempfile::TempDir;
use tokio::runtime::Runtime;

use crate::scenes;
use crate::wait::until;

/// The program under test.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_tamp-under-test");

/// A process that does not outlive its test.
pub struct Process {
    child: Child,
}

impl Process {
    /// Starts it.
    pub fn spawn(command: &mut Command) -> Self {
        Self { child: command.spawn().expect("the program starts") }
    }

    /// Sends a signal.
    pub fn signal(&self, signal: Signal) {
        let pid = Pid::from_raw(self.child.id().cast_signed()).expect("a process id");
        kill_process(pid, signal).expect("the process is there");
    }

    /// Ends it at once, as a power cut would.
    pub fn kill(mut self) {
        self.child.kill().expect("the process is there");
        self.child.wait().expect("the process can be waited for");
    }

    /// Waits for its end.
    pub fn end(mut self) -> ExitStatus {
        until("the end of a process", || match self.child.try_wait() {
            Ok(Some(status)) => Ok(status),
            other => Err(other),
        })
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // gone already in most tests
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A folder with a coordinator.
pub struct Lab {
    folder: TempDir,
    coordinator: Option<Process>,
    address: String,
    runtime: Runtime,
    client: Client,
}

impl Lab {
    /// A lab with a fresh coordinator whose leases hold 90 s: no job moves unless a test makes it.
    pub fn new() -> Self {
        Self::with(&[])
    }

    /// A lab whose coordinator gets more flags.
    pub fn with(flags: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (coordinator, address) = serve(folder.path(), "127.0.0.1:0", flags);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let patience = Patience::brief(Duration::from_secs(20));
        let client = Client::new(&address, None, patience).unwrap();
        Self { folder, coordinator: Some(coordinator), address, runtime, client }
    }

    /// Where the test keeps its files.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Address of the coordinator.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Ends the coordinator at once.
    pub fn kill_coordinator(&mut self) {
        self.coordinator.take().expect("it runs").kill();
    }

    /// Starts the coordinator again, on its database and its port.
    pub fn start_coordinator(&mut self, flags: &[&str]) {
        let bind = self.address.trim_start_matches("http://").to_owned();
        let (coordinator, address) = serve(self.folder.path(), &bind, flags);
        assert_eq!(address, self.address);
        self.coordinator = Some(coordinator);
    }

    /// A worker with one slot and a folder of its own, saving five times a second.
    pub fn worker(&self, name: &str) -> Process {
        let mut command = Command::new(PROGRAM);
        command
            .args(["work", "--slots", "1", "--checkpoint-seconds", "0.2", "--server", &self.address])
            .arg("--data-dir")
            .arg(self.path(name))
            .env("TAMP_LOG", "warn");
        Process::spawn(&mut command)
    }

    /// Runs the client to the end of a question.
    pub fn ask<T>(&self, question: impl AsyncFnOnce(&Client) -> Result<T, ClientError>) -> T {
        self.try_ask(question).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Runs the client to the end of a question that may be refused.
    pub fn try_ask<T>(
        &self,
        question: impl AsyncFnOnce(&Client) -> Result<T, ClientError>,
    ) -> Result<T, ClientError> {
        self.runtime.block_on(question(&self.client))
    }

    /// Submits a sweep.
    pub fn submit(&self, definition: &Value) -> SweepId {
        let sweep: SweepView = self.ask(async |client| client.post("/v1/sweeps", Some(definition)).await);
        sweep.id
    }

    /// A sweep as it is now.
    pub fn sweep(&self, id: SweepId) -> SweepView {
        self.ask(async |client| client.get(&format!("/v1/sweeps/{id}")).await)
    }

    /// Waits until every point of a sweep has its result.
    pub fn wait_until_done(&self, id: SweepId) -> SweepView {
        until("the end of a sweep", || {
            let sweep = self.sweep(id);
            assert_ne!(sweep.counts.failed, sweep.points.max(1), "every job failed: {sweep:?}");
            if sweep.state.name() == "done" { Ok(sweep) } else { Err(sweep) }
        })
    }

    /// The jobs of a sweep, in the order of its points.
    pub fn jobs(&self, id: SweepId) -> Vec<JobId> {
        let page: Page<PointView> =
            self.ask(async |client| client.get(&format!("/v1/sweeps/{id}/points")).await);
        page.items.iter().map(|point| point.job).collect()
    }

    /// A job as it is now.
    pub fn job(&self, id: JobId) -> JobView {
        self.ask(async |client| client.get(&format!("/v1/jobs/{id}")).await)
    }

    /// Waits until a job has a checkpoint at the coordinator while it runs.
    pub fn wait_for_checkpoint(&self, id: JobId) -> u64 {
        until("a checkpoint", || {
            let job = self.job(id);
            assert!(!job.state.is_terminal(), "over before it could be stopped: {job:?}");
            job.checkpoint.as_ref().map(|checkpoint| checkpoint.steps).ok_or(job)
        })
    }
}

fn serve(folder: &Path, bind: &str, flags: &[&str]) -> (Process, String) {
    let mut command = Command::new(PROGRAM);
    command
        .args(["serve", "--bind", bind, "--heartbeat-seconds", "0.2"])
        .args(flags)
        .arg("--data-dir")
        .arg(folder.join("coordinator"))
        .env("TAMP_LOG", "warn")
        .stdout(Stdio::piped());
    let mut process = Process::spawn(&mut command);
    let mut line = String::new();
    let output = process.child.stdout.take().expect("piped");
    BufReader::new(output).read_line(&mut line).expect("the coordinator tells its address");
    let address = line.trim().to_owned();
    assert!(address.starts_with("http://127.0.0.1:"), "{address:?}");
    (process, address)
}

/// Runs the program to its end.
pub fn tamp(arguments: &[&str], paths: &[&Path]) -> Output {
    Command::new(PROGRAM).args(arguments).args(paths).output().expect("the program starts")
}

/// The digest of the outcome that a run wrote into a snapshot folder, as the coordinator computes it.
pub fn digest_of(snapshot: &Path) -> String {
    let text = std::fs::read(snapshot.join("outcome.json")).unwrap();
    let outcome: record::Outcome = serde_json::from_slice(&text).unwrap();
    blake3::hash(&serde_json::to_vec(&outcome).unwrap()).to_hex().to_string()
}

/// The digest of the undisturbed run of a scene of `steps` steps, without any service; computed once per test process.
pub fn undisturbed(steps: u64) -> String {
    static KNOWN: Mutex<BTreeMap<u64, String>> = Mutex::new(BTreeMap::new());
    // the lock is held meanwhile: whoever asks for the same run waits for it instead of repeating it
    let mut known = KNOWN.lock().unwrap();
    known
        .entry(steps)
        .or_insert_with(|| {
            let folder = tempfile::tempdir().unwrap();
            let (file, snapshot) = (folder.path().join("scene.json"), folder.path().join("snapshot"));
            std::fs::write(&file, scenes::scene_of(steps).to_string()).unwrap();
            let output = tamp(&["run", "--quiet"], &[&file, Path::new("--snapshot"), &snapshot]);
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            digest_of(&snapshot)
        })
        .clone()
}
