//! Plastic discs against closed forms and the independent reference of `reference.csv` (case, H, quantity, x, y).
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod assembly;
mod bodies;
mod closed_form;
mod explicit;
mod material_point;
mod reference;
mod scenes;
mod single_disc;
mod square_cell;
mod tolerance;
mod updated;
