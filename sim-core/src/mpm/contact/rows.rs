//! Contact rows with their Delassus data: what one unit of impulse does to the contact nodes of the two bodies.

use super::nodes::node_of;
use super::{Candidate, ContactKind, Key, Partner, Wall};
use crate::mpm::body::Body;

/// Most unknowns a row side can touch is 2 × 16 weights; kept as ranges into shared arrays.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// The body.
    pub body: u32,
    /// Range of `entries`.
    pub entries: (u32, u32),
    /// Start of the response of the contact unknowns to a unit normal impulse; tangential follows.
    pub response: u32,
}

/// One unilateral contact.
#[derive(Clone, Debug)]
pub struct Row {
    /// Identity.
    pub key: Key,
    /// Unit normal from the partner to the marker's body.
    pub normal: [f64; 2],
    /// Least normal velocity that keeps the gap open at the end of the step.
    pub bound: f64,
    /// Velocity of the partner if it is a wall.
    pub wall_velocity: [f64; 2],
    /// Marker side and, unless the partner is a wall, the segment side.
    pub sides: [Side; 2],
    /// Number of sides that are bodies.
    pub side_count: usize,
    /// Local Delassus matrix (nn, nt, tt).
    pub delassus: [f64; 3],
    /// Normal and tangential impulse.
    pub impulse: [f64; 2],
}

/// All rows of a solve.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// The rows in the order of their keys.
    pub rows: Vec<Row>,
    /// (place in the contact block of component x, signed weight) of all sides.
    pub entries: Vec<(u32, f64)>,
    /// Responses of all sides.
    pub responses: Vec<f64>,
}

/// The tangent that goes with a normal: a quarter turn counter-clockwise.
#[inline]
#[must_use]
pub fn tangent(normal: [f64; 2]) -> [f64; 2] {
    [-normal[1], normal[0]]
}

impl Rows {
    /// Rows for candidates; impulses are taken over from `warm` (sorted by key) where the identity is known.
    pub fn build(
        &mut self,
        candidates: &[Vec<Candidate>],
        bodies: &[Body],
        walls: &[Wall],
        warm: &[(Key, [f64; 2])],
        kind: ContactKind,
    ) {
        self.rows.clear();
        self.entries.clear();
        let mut known = warm.iter().peekable();
        for candidate in candidates.iter().flatten() {
            let key = candidate.key;
            while known.next_if(|(other, _)| *other < key).is_some() {}
            let impulse = known.next_if(|(other, _)| *other == key).map_or([0.0; 2], |(_, impulse)| *impulse);
            let own = &bodies[key.body as usize];
            let first = match kind {
                ContactKind::Markers => self.side(own, key.body, &[(key.marker, 1.0)]),
                ContactKind::CommonMesh => self.node(own, key.body, node_of(own, key.marker), 1.0),
            };
            let (second, side_count, wall_velocity) = match key.partner {
                Partner::Wall(number) => (Side::default(), 1, walls[number as usize].velocity),
                Partner::Body(number) if kind == ContactKind::CommonMesh => {
                    (self.node(&bodies[number as usize], number, candidate.segment, -1.0), 2, [0.0; 2])
                }
                Partner::Body(number) => {
                    let body = &bodies[number as usize];
                    let next = (candidate.segment + 1) % body.template.markers.len() as u32;
                    let ends = [(candidate.segment, candidate.share - 1.0), (next, -candidate.share)];
                    (self.side(body, number, &ends), 2, [0.0; 2])
                }
            };
            self.rows.push(Row {
                key,
                normal: candidate.normal,
                bound: 0.0,
                wall_velocity,
                sides: [first, second],
                side_count,
                delassus: [0.0; 3],
                impulse,
            });
        }
    }

    fn side(&mut self, body: &Body, number: u32, markers: &[(u32, f64)]) -> Side {
        let start = self.entries.len() as u32;
        for &(marker, share) in markers {
            for &(place, weight) in &body.template.markers[marker as usize].weights {
                self.entries.push((body.template.contact_rows[place as usize], share * weight));
            }
        }
        Side { body: number, entries: (start, self.entries.len() as u32), response: 0 }
    }

    /// A side that is a single node.
    fn node(&mut self, body: &Body, number: u32, node: u32, share: f64) -> Side {
        let start = self.entries.len() as u32;
        let template = &body.template;
        let place = template.contact_nodes.binary_search(&node).expect("a shared node takes part in contact");
        self.entries.push((template.contact_rows[place], share));
        Side { body: number, entries: (start, start + 1), response: 0 }
    }

    /// Signed weights of a side.
    #[inline(always)]
    #[must_use]
    pub fn weights(&self, side: &Side) -> &[(u32, f64)] {
        &self.entries[side.entries.0 as usize..side.entries.1 as usize]
    }

    /// Relative velocity of a row from the contact velocities of the bodies, wall velocity not subtracted.
    #[inline(always)]
    #[must_use]
    pub fn relative(&self, row: &Row, velocities: &[Vec<f64>]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for side in &row.sides[..row.side_count] {
            let v = &velocities[side.body as usize];
            for &(at, weight) in self.weights(side) {
                sum[0] += weight * v[at as usize];
                sum[1] += weight * v[at as usize + 1];
            }
        }
        sum
    }

    /// Adds the impulses of all rows to vectors over the contact unknowns of each body.
    pub fn scatter(&self, impulses: &mut [Vec<f64>]) {
        for row in &self.rows {
            if row.impulse == [0.0; 2] {
                continue;
            }
            let t = tangent(row.normal);
            let p = [0, 1].map(|axis| row.impulse[0] * row.normal[axis] + row.impulse[1] * t[axis]);
            for side in &row.sides[..row.side_count] {
                let target = &mut impulses[side.body as usize];
                for &(at, weight) in self.weights(side) {
                    target[at as usize] += weight * p[0];
                    target[at as usize + 1] += weight * p[1];
                }
            }
        }
    }
}
