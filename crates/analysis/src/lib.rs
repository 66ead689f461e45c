//! Collapse, fits, resampling: tables in, curves with uncertainties out.
//!
//! | endpoint | function |
//! |---|---|
//! | `/sweeps/{id}/collapse` | [`collapse`] |
//! | `/sweeps/{id}/fit` | [`fit_master`] on a [`Collapse`] |

pub mod collapse;
pub mod cost;
mod error;
mod estimate;
pub mod fit;
mod joint;
pub mod levels;
pub mod master;
pub mod plateau;
mod point;
mod run;
#[cfg(test)]
mod synthetic;

pub use collapse::{Collapse, CollapseOptions, collapse};
pub use error::{Determined, FitError};
pub use estimate::Estimate;
pub use fit::Fit;
pub use master::{MasterFit, fit as fit_master};
pub use run::{NotARun, Run};
