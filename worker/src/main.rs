//! `tamp-worker`: a worker process. The same as `tamp work`.

use std::process::ExitCode;

use clap::Parser;

/// Claims jobs of a Tamp coordinator, runs them, checkpoints and reports.
#[derive(Parser)]
#[command(name = "tamp-worker", version)]
struct Arguments {
    #[command(flatten)]
    flags: worker::Flags,
}

fn main() -> ExitCode {
    worker::main(&Arguments::parse().flags)
}
