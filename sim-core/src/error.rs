//! Errors of a simulation, typed by what the caller can do.

/// Why a simulation cannot go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimError {
    /// The scene asks for something the engine cannot do: fix the input.
    #[error("{field}: {problem} ({remedy})")]
    Scene {
        /// Field of the scene.
        field: String,
        /// What is wrong.
        problem: String,
        /// What the user can do.
        remedy: String,
    },
    /// The state blew up (NaN, energy growth, particle outside) even with a smaller time step: give up.
    #[error("unstable at step {step}: {what}; a retry with dt = {retried_dt} failed as well")]
    Unstable {
        /// Step at which it was caught.
        step: u64,
        /// Evidence.
        what: String,
        /// Time step of the retry [τ].
        retried_dt: f64,
    },
    /// An iteration did not converge: give up, or ask for other numerics.
    #[error("no convergence at step {step}: {what}")]
    NotConverged {
        /// Step.
        step: u64,
        /// Evidence.
        what: String,
    },
    /// The checkpoint does not belong to this scene, kernel or version, or is damaged: start from the beginning.
    #[error("checkpoint: {0}")]
    Checkpoint(String),
    /// A defect of the program.
    #[error("internal: {0}")]
    Internal(String),
}
