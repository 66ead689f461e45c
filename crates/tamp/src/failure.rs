//! How a command fails: lines on stderr, exit status 2 for bad input and 1 for everything else.

use std::path::Path;
use std::process::ExitCode;

use protocol::client::{BuildError, ClientError};
use scene::{Problem, Problems};
use sim_core::SimError;
use worker::WorkerError;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The input is wrong: every problem, each with what to do.
    #[error("{0}")]
    Input(Problems),
    /// The input is right; the work failed.
    #[error("{0}")]
    Work(String),
    /// Whoever reads the output is gone.
    #[error("the output is closed")]
    OutputClosed,
}

impl Failure {
    /// One problem of the input.
    pub fn input(
        field: impl Into<String>,
        value: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Input(
            Problem {
                field: field.into(),
                value: value.into(),
                problem: problem.into(),
                remedy: remedy.into(),
            }
            .into(),
        )
    }

    /// A file that cannot be written or read.
    pub fn file(path: &Path, error: &std::io::Error) -> Self {
        Self::Work(format!("{}: {error}", path.display()))
    }

    /// Tells it on stderr, and with which status to end.
    pub fn tell(&self) -> ExitCode {
        match self {
            Self::Input(problems) => {
                for one in &problems.0 {
                    eprintln!("error: {} = {}: {}", one.field, one.value, one.problem);
                    eprintln!("  remedy: {}", one.remedy);
                }
                ExitCode::from(2)
            }
            Self::Work(what) => {
                eprintln!("error: {what}");
                ExitCode::FAILURE
            }
            // `tamp … | head` is no failure
            Self::OutputClosed => ExitCode::SUCCESS,
        }
    }
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        Self::Input(problems)
    }
}

impl From<SimError> for Failure {
    fn from(error: SimError) -> Self {
        match error {
            SimError::Scene { field, problem, remedy } => Self::input(field, "given", problem, remedy),
            other => Self::Work(other.to_string()),
        }
    }
}

impl From<BuildError> for Failure {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Address(server) => Self::input(
                "server",
                server,
                "is not the address of a coordinator",
                "write http://HOST:PORT or https://HOST",
            ),
            BuildError::Token => {
                Self::input("token", "(hidden)", "cannot be sent in a header", "use printable ASCII")
            }
            BuildError::Http(error) => Self::Work(error.to_string()),
        }
    }
}

impl From<ClientError> for Failure {
    fn from(error: ClientError) -> Self {
        match error {
            ClientError::FixInput(problem) if !problem.errors.is_empty() => {
                let problems = problem.errors.iter().map(|one| Problem {
                    field: one.field.clone(),
                    value: one.value.clone(),
                    problem: one.problem.clone(),
                    remedy: one.remedy.clone(),
                });
                Self::Input(Problems(problems.collect()))
            }
            other => Self::Work(other.to_string()),
        }
    }
}

impl From<WorkerError> for Failure {
    fn from(error: WorkerError) -> Self {
        match error {
            WorkerError::Config { field, value, problem, remedy } => {
                Self::input(field, value, problem, remedy)
            }
            other => Self::Work(other.to_string()),
        }
    }
}
