//! Sweeps: a definition that expands, lazily and in a fixed order, to scenes.
//!
//! # Order of the points
//! Blocks come in the order they are written. Inside a block the points are the product of its parts: `grid` axes in
//! the order of their **names** (JSON objects have no order), the last name varying fastest; then `zip`; then `list`;
//! then replicates. Replicate r of a point with seed s has seed s + r. A definition without `blocks` is one point:
//! its `base`.
//!
//! # Size
//! The number of points is computed from the counts before anything is expanded; more than [`Sweep::MAX_POINTS`] are
//! refused.

mod axis;
mod expand;
mod filter;
mod read;
mod survey;
mod write;

pub use axis::Axis;
pub use expand::{Candidate, Point, Points};
pub use filter::Filter;
pub use survey::{LeftOut, Survey};

use serde_json::{Map, Value};

use crate::Model;

/// A checked sweep definition: a source of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Name for people.
    pub name: String,
    /// The engine.
    pub model: Model,
    /// Keys that hold for every point unless a block says otherwise.
    pub base: Map<String, Value>,
    /// The sweep is their union, in this order.
    pub blocks: Vec<Block>,
    /// Runs per point, with seeds s, s + 1, … .
    pub replicates: u64,
    /// Points outside of any of these intervals are left out.
    pub filters: Vec<Filter>,
    /// Larger runs first.
    pub priority: i64,
}

/// A set of points: the product of its parts. A part that is not used has no axis or entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Axes whose product is taken, in the order of their names.
    pub grid: Vec<Axis>,
    /// Axes of equal length that are walked together.
    pub zip: Vec<Axis>,
    /// Explicit points.
    pub list: Vec<Map<String, Value>>,
}

impl Sweep {
    /// Largest number of points of a sweep, before `where` leaves some out.
    pub const MAX_POINTS: u64 = 1_000_000;

    /// Largest number of replicates.
    pub const MAX_REPLICATES: u64 = 10_000;

    /// Number of points before `where` leaves some out.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.blocks.iter().map(|block| block.size() * self.replicates).sum()
    }
}

impl Block {
    /// Number of points of the block, without replicates.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.checked_size().expect("the size was checked when the definition was read")
    }

    fn checked_size(&self) -> Option<u64> {
        let zipped = self.zip.first().map_or(1, Axis::len);
        let listed = if self.list.is_empty() { 1 } else { self.list.len() as u64 };
        self.grid
            .iter()
            .map(Axis::len)
            .chain([zipped, listed])
            .try_fold(1_u64, |product, count| product.checked_mul(count))
    }
}
