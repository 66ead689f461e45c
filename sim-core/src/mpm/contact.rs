//! Contact between outlines and with walls: detection of candidate rows, and the contact-dynamics solve.
//!
//! Each row is one marker against one segment of another outline, or against a wall. Its unknown is an impulse.

pub mod detect;
pub mod gauss_seidel;
pub mod nodes;
pub mod rows;

use serde::{Deserialize, Serialize};

/// Between what contact acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactKind {
    /// Markers on the true outlines against outlines and walls, by their gap.
    #[default]
    Markers,
    /// Nodes that two bodies share on a common mesh, by their velocities alone: the paper's multi-mesh contact, which
    /// acts at a distance of a few cells.
    CommonMesh,
}

/// A rigid plane of infinite mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// A point of the plane [length].
    pub point: [f64; 2],
    /// Unit normal, into the domain.
    pub normal: [f64; 2],
    /// Prescribed velocity [length/time].
    pub velocity: [f64; 2],
}

/// What a marker faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Partner {
    /// A wall, by its number.
    Wall(u32),
    /// Another body, by its number.
    Body(u32),
}

/// A marker of body `body` facing `partner`: the identity of a row from one step to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Key {
    /// Body of the marker.
    pub body: u32,
    /// What it faces.
    pub partner: Partner,
    /// The marker, or the shared node of a common mesh.
    pub marker: u32,
}

/// A candidate contact. On a common mesh the gap is the way the two sides part within the step, and the segment is the
/// partner's node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Identity.
    pub key: Key,
    /// Gap along the normal, negative when overlapping [length].
    pub gap: f64,
    /// Unit normal from the partner to the marker's body.
    pub normal: [f64; 2],
    /// First marker of the partner's segment (0 for a wall).
    pub segment: u32,
    /// Place on the segment, 0 … 1.
    pub share: f64,
}
