//! The worker: claims jobs, runs the simulation, checkpoints and reports.
//!
//! A worker keeps nothing that cannot be lost: every state it saved and every result it finished lies on its disk
//! until the coordinator has it, and every message carries the attempt it belongs to, so that a worker that was
//! away too long is refused instead of believed. Simulations run on threads of their own; heartbeats never wait
//! for them.

pub mod checkpoint;
mod claim;
mod clock;
mod config;
mod control;
mod deliver;
mod engine;
mod error;
mod execution;
mod failure;
#[cfg(test)]
mod fake;
mod files;
mod gate;
pub mod host;
mod job;
mod load;
mod outbox;
mod process;
mod runner;
mod seal;
mod session;
mod signal;
mod slice;

use std::sync::Arc;
use std::time::{Duration, Instant};

use protocol::client::{Client, Patience};
use tokio::sync::watch;
use tokio_util::sync::CancellationToken;
use uuid::Uuid;

pub use claim::Ended;
pub use clock::{Clock, SystemClock};
pub use config::{Config, Flags};
pub use control::{Command, Control, Report};
pub use engine::{Engine, SimCore};
pub use error::WorkerError;
pub use execution::{CODE_VERSION, Execution};
pub use failure::Failed;
pub use files::write_durably;
pub use load::{LoadMeter, ProcStat};
pub use process::main;
pub use runner::{End, Task, run as run_task};
pub use signal::stop_on_signals;

use checkpoint::Shelf;
use claim::Desk;
use deliver::Courier;
use gate::{Gate, Leave};
use job::Context;
use outbox::Outbox;

/// A state nobody came back for is removed after this long.
const KEEP_CHECKPOINTS: Duration = Duration::from_secs(30 * 24 * 3600);
/// Time between two looks at the load and the clock.
const GATE_INTERVAL: Duration = Duration::from_secs(5);

/// What a worker is made of, besides its settings.
pub struct Parts {
    /// The physics.
    pub engine: Arc<dyn Engine>,
    /// The wall clock.
    pub clock: Arc<dyn Clock>,
    /// The load of others.
    pub load: Box<dyn LoadMeter>,
}

impl Default for Parts {
    fn default() -> Self {
        Self { engine: Arc::new(SimCore), clock: Arc::new(SystemClock), load: Box::new(ProcStat::default()) }
    }
}

/// Works until `stop`, the end of the machine's time, or too long without work. Jobs in hand are then saved,
/// uploaded and given back; what cannot be delivered waits on disk for the next start.
///
/// # Errors
/// [`WorkerError`] when the worker cannot start, or the coordinator refuses it for good.
pub async fn run(config: Config, parts: Parts, stop: CancellationToken) -> Result<Ended, WorkerError> {
    config.check()?;
    let client = Client::new(&config.server, config.token.clone(), Patience::none())?;
    let shelf = directory(&config, "worker-checkpoints", Shelf::open)?;
    let outbox = directory(&config, "worker-outbox", Outbox::open)?;
    shelf.tidy(KEEP_CHECKPOINTS);
    let registration = session::introduction(&config, parts.engine.as_ref(), Uuid::new_v4());
    tracing::info!(server = config.server, slots = config.slots, "starting");
    let session = tokio::select! {
        () = stop.cancelled() => return Ok(Ended::Stopped),
        session = session::register(&client, &registration) => session?,
    };
    tracing::info!(worker = %session.worker, "registered");

    let courier = Arc::new(Courier::new(outbox, shelf.clone()));
    let grace = Duration::from_secs_f64(config.drain_seconds);
    let (gate_sender, gate) = watch::channel(first_leave(&config));
    let rules = config.rules()?;
    let context = Arc::new(Context {
        client: client.clone(),
        engine: parts.engine,
        shelf,
        courier: Arc::clone(&courier),
        config,
    });

    let jobs_are_over = CancellationToken::new();
    let delivering = courier.run(&client, &jobs_are_over, grace);
    let watching = watch_gate(Gate::new(rules), parts.clock, parts.load, gate_sender);
    let working = async {
        let ended = Desk::new(context, registration, session).work(gate, &stop).await;
        jobs_are_over.cancel();
        ended
    };
    let (ended, ()) = tokio::select! {
        both = async { tokio::join!(working, delivering) } => both,
        never = watching => match never {},
    };
    tracing::info!(?ended, "ended");
    ended
}

fn directory<T>(
    config: &Config,
    name: &str,
    open: fn(&std::path::Path) -> std::io::Result<T>,
) -> Result<T, WorkerError> {
    let path = config.data_dir.join(name);
    open(&path).map_err(|error| WorkerError::DataDir { path, error })
}

/// Before the first look at the machine: unknown is not idle.
fn first_leave(config: &Config) -> Leave {
    if config.idle_only { Leave::Pause } else { Leave::Work }
}

async fn watch_gate(
    mut gate: Gate,
    clock: Arc<dyn Clock>,
    mut load: Box<dyn LoadMeter>,
    told: watch::Sender<Leave>,
) -> std::convert::Infallible {
    let begun = Instant::now();
    let mut ticks = tokio::time::interval(GATE_INTERVAL);
    loop {
        ticks.tick().await;
        let leave = gate.observe(begun.elapsed(), clock.now(), load.foreign_cores());
        told.send_if_modified(|present| {
            let moved = *present != leave;
            if moved {
                tracing::info!(?leave, "the machine's availability changed");
            }
            *present = leave;
            moved
        });
    }
}
