//! Collapse, fits, resampling: tables in, curves with uncertainties out.
//!
//! | endpoint | function |
//! |---|---|
//! | `/sweeps/{id}/collapse` | [`collapse`] |
//! | `/sweeps/{id}/fit` | [`fit_master`] on a [`Collapse`] |
//! | `/sweeps/{id}/exponents` | [`exponents`] on a [`Collapse`] |
//! | `/sweeps/{id}/bonds` | [`bonds`] |
//! | `/sweeps/{id}/forces` | [`forces`]; one packing: [`forces::distribution`](forces::distribution()) |
//! | packing of one job | [`profile::from_table`] |
//! | `/sweeps/{id}/consolidation` | [`discs::consolidation`](discs::consolidation()) |
//! | `/sweeps/{id}/moduli` | [`discs::moduli`](discs::moduli()) |
//! | `/sweeps/{id}/structure` | [`discs::structure`](discs::structure()); averaged I(k): [`discs::structure::fit_intensity`] |
//! | `/sweeps/{id}/compaction` | [`plastic::compaction`](plastic::compaction()) |
//! | `/sweeps/{id}/coordination` | [`plastic::coordination`](plastic::coordination()) |
//! | α_n, m_w, e_i | [`variation`](variation()) |
//!
//! Pictures of all of them: [`plot`].
//!
//! Runs of spheres come from records by [`Run::from_rows`], states of discs by [`discs::DiscState::from_run`] and
//! [`plastic::PlasticCurve::from_run`]. Every answer is plain data for JSON; a part that the data do not
//! determine is a [`Determined::Undetermined`] with its reason while the rest stands.

pub mod bonds;
pub mod collapse;
pub mod compare;
pub mod cost;
pub mod discs;
mod error;
mod estimate;
pub mod exponents;
pub mod fit;
pub mod forces;
mod joint;
pub mod levels;
pub mod master;
pub mod plastic;
pub mod plateau;
pub mod plot;
mod point;
pub mod profile;
mod resample;
mod run;
#[cfg(test)]
mod synthetic;
pub mod variation;

pub use bonds::{Bonds, bonds};
pub use collapse::{Collapse, CollapseOptions, collapse};
pub use error::{Determined, FitError};
pub use estimate::Estimate;
pub use exponents::{ExponentOptions, Exponents, exponents};
pub use fit::Fit;
pub use forces::{Forces, forces};
pub use master::{MasterFit, fit as fit_master};
pub use run::{NotARun, Run};
pub use variation::{Variation, variation};
