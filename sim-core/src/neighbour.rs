//! Who may touch whom.
//!
//! Three levels, none of which changes a bit of a trajectory (masked lanes add exact zeros, the order of sums is
//! fixed by particle order): *near* pairs (cell list, rebuilt when a particle moved its margin), *listed* pairs that
//! may touch before the next refresh (evaluated every step), and touching pairs.

#[cfg(test)]
mod all_pairs;
mod cell_list;
mod order;

#[cfg(test)]
pub use all_pairs::all_pairs;
pub use cell_list::{CellList, near_pairs};
pub use order::{hilbert_order, morton_order};
