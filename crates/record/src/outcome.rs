//! Everything a finished run hands over.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{Row, Table};

/// The result of one run, as made by the physics; the runner adds wall time, host and attempt to `record`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// The flat record: `status`, `e`, `z`, … with their standard errors (`e_se`, …).
    pub record: Row,
    /// One row per equilibrium state of a loading path; empty for engines with a single final state.
    #[serde(default)]
    pub states: Vec<Row>,
    /// The time series.
    #[serde(default)]
    pub series: Table,
    /// The final packing.
    #[serde(default)]
    pub packing: Packing,
}

/// A packing as named tables: `particles`, `contacts`, `walls`, … .
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Packing(pub BTreeMap<String, Table>);
