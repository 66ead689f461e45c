//! The command line of Tamp: one file per command.
//!
//! A library behind a binary of three lines, so that the end-to-end tests start the very same program.

mod bench;
mod explain;
mod failure;
mod input;
mod output;
mod preset;
mod progress;
mod remote;
mod run;
mod serve;
mod snapshot;
mod study;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Parameter sweeps of granular compaction: physics, coordinator and workers in one program.
#[derive(Parser)]
#[command(name = "tamp", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a whole sweep on this machine and show its collapse and fit
    Study(study::Arguments),
    /// Run one scene on this machine, without a server
    Run(run::Arguments),
    /// Tell what a scene or a sweep would run; run nothing
    Explain(explain::Arguments),
    /// Measure the cost of a step
    Bench(bench::Arguments),
    /// Print a ready sweep
    Preset(preset::Arguments),
    /// Start a coordinator
    Serve(server::Args),
    /// Start a worker
    Work(worker::Flags),
    /// Submit a sweep to a coordinator
    Submit(remote::submit::Arguments),
    /// Show the sweeps of a coordinator
    Status(remote::status::Arguments),
    /// Print the results of a sweep
    Results(remote::results::Arguments),
}

/// Runs the command given on the command line.
#[must_use]
pub fn main() -> ExitCode {
    let ended = match Arguments::parse().command {
        Command::Study(arguments) => study::study(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Explain(arguments) => explain::explain(&arguments),
        Command::Bench(arguments) => bench::bench(&arguments),
        Command::Preset(arguments) => preset::preset(&arguments),
        Command::Serve(arguments) => serve::serve(&arguments),
        Command::Work(flags) => return worker::main(&flags),
        Command::Submit(arguments) => remote::submit::submit(&arguments),
        Command::Status(arguments) => remote::status::status(&arguments),
        Command::Results(arguments) => remote::results::results(&arguments),
    };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
