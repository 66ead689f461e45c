//! Why a run failed, typed by whether another try may help.

use protocol::FailureKind;
use sim_core::SimError;

/// A failed run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failed {
    /// Whether another try may help.
    pub kind: FailureKind,
    /// Stable class.
    pub class: &'static str,
    /// Evidence for a person.
    pub message: String,
}

impl Failed {
    /// Another try may help.
    #[must_use]
    pub fn retryable(class: &'static str, message: String) -> Self {
        Self { kind: FailureKind::Retryable, class, message }
    }

    /// The payload of a panic.
    #[must_use]
    pub fn panic(payload: &(dyn std::any::Any + Send)) -> Self {
        let message = payload
            .downcast_ref::<&str>()
            .map(|text| (*text).to_owned())
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "a panic without a message".to_owned());
        Self::retryable("panic", message)
    }
}

impl From<SimError> for Failed {
    fn from(error: SimError) -> Self {
        // the scene decides: it would fail the same way everywhere
        let (kind, class) = match &error {
            SimError::Scene { .. } => (FailureKind::Permanent, "scene"),
            SimError::Unstable { .. } => (FailureKind::Permanent, "unstable"),
            SimError::NotConverged { .. } => (FailureKind::Permanent, "not_converged"),
            SimError::Checkpoint(_) => (FailureKind::Retryable, "checkpoint"),
            SimError::Internal(_) => (FailureKind::Retryable, "internal"),
        };
        Self { kind, class, message: error.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_scene_causes_is_permanent_and_what_the_machine_causes_is_not() {
        let unstable = SimError::Unstable { step: 9, what: "NaN".to_owned(), retried_dt: 0.01 };
        assert_eq!(Failed::from(unstable).kind, FailureKind::Permanent);
        assert_eq!(Failed::from(SimError::Checkpoint("torn".to_owned())).kind, FailureKind::Retryable);
        let caught = std::panic::catch_unwind(|| panic!("index {}", 3)).unwrap_err();
        let failed = Failed::panic(caught.as_ref());
        assert_eq!((failed.kind, failed.message.as_str()), (FailureKind::Retryable, "index 3"));
    }
}
