//! Why a step failed.

/// Why a step did not come to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A material point was crushed by the trial step.
    Inverted {
        /// Body of the point.
        body: usize,
    },
    /// The tangent of a body is not positive definite.
    Indefinite {
        /// The body.
        body: usize,
    },
    /// Contact met a part of the outline that was far from everything at the start of the step.
    OutOfReach {
        /// The body.
        body: usize,
    },
    /// Newton's iteration did not reach the tolerance.
    Residual {
        /// Force residual relative to the forces.
        residual: f64,
        /// Worst overlap, or gap under load, in cells.
        gap: f64,
    },
}

impl std::fmt::Display for Failure {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Inverted { body } => write!(out, "a material point of body {body} was crushed"),
            Self::Indefinite { body } => write!(out, "the tangent of body {body} is not positive definite"),
            Self::OutOfReach { body } => write!(out, "body {body} moved by more than a cell in one step"),
            Self::Residual { residual, gap } => {
                write!(out, "relative force residual {residual:.1e}, worst gap error {gap:.1e} cells")
            }
        }
    }
}
