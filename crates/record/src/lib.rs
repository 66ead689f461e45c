//! What a run yields.
//!
//! An [`Outcome`] is the one type that travels from the physics through worker, coordinator and store to the
//! analysis: a flat [`Row`] of finite numbers and words, the rows of a curve (`states`, for engines whose result
//! is a loading path), a time [`Table`] and the final packing as named tables. A NaN or an infinity cannot be put
//! into any of them: [`Finite`] refuses it at construction and at deserialisation.

mod cell;
mod csv;
mod finite;
mod outcome;
mod row;
mod table;
mod vtk;

pub use cell::Cell;
pub use csv::csv;
pub use finite::{Finite, NotFinite};
pub use outcome::{Outcome, Packing};
pub use row::Row;
pub use table::{Column, Table, TableError};
pub use vtk::{NoPicture, vtk};
