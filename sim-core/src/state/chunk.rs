//! Fixed chunks of particles: the unit of work of a thread, and what makes any number of threads give the same bits.
//!
//! A chunk owns a range of particles and the contacts whose lower index lies in it. Contacts inside the range are
//! summed in list order. Contacts to a later chunk, or across a border of the space, add to *ghost* forces of this chunk, which the
//! other chunk adds to its own in the order of chunks. The chunks depend on the number of particles alone, so sums do not depend on
//! who computes them.

use super::{ContactList, WallList};
use crate::lane::Number;

/// Particles per chunk aimed at. Part of the definition of the result (order of sums): changing it changes bits.
const CHUNK: usize = 2300;

/// First particle of every chunk, and the end: one chunk, or an even number of them, so that two threads have as much to
/// do each.
#[must_use]
pub fn chunk_bounds(particles: usize) -> Vec<usize> {
    let chunks = if particles < 2 * CHUNK { 1 } else { 2 * ((particles + CHUNK) / (2 * CHUNK)) };
    (0..=chunks).map(|c| particles * c / chunks).collect()
}

/// Forces a chunk exerts on particles of later chunks, and on its own across a border of the space.
#[derive(Clone, Debug, Default)]
pub struct Ghosts<F> {
    /// The particles, ascending.
    pub particles: Vec<u32>,
    /// What they feel from this chunk.
    pub forces: Vec<F>,
    /// Place in `particles` of b of every outer contact.
    pub targets: Vec<u32>,
    /// Whether they changed since the other chunks were told.
    pub changed: bool,
}

/// One chunk: its particles are `start..end`; forces are records `F`.
#[derive(Clone, Debug, Default)]
pub struct Chunk<T: Number, F> {
    /// First particle.
    pub start: usize,
    /// One past the last particle.
    pub end: usize,
    /// Contacts with both particles in the chunk and no border of the space between them.
    pub inner: ContactList<T>,
    /// Contacts with b in a later chunk or across a border of the space.
    pub outer: ContactList<T>,
    /// Ghosts of the outer contacts.
    pub ghosts: Ghosts<F>,
    /// Ghosts of earlier chunks, or its own, that lie in this one: chunk, places among its ghosts.
    pub incoming: Vec<(usize, std::ops::Range<usize>)>,
    /// Contacts with each wall.
    pub walls: [WallList<T>; 6],
    /// Σ F_α r_α of the contacts its particles own, where space deforms [k_n d].
    pub virial: [f64; 3],
    /// Force of the particles of this chunk on each wall, positive outwards [k_n d].
    pub wall_force: [f64; 6],
    /// Near pairs (a, b) with a in the chunk and a < b, ascending.
    pub near: Vec<(u32, u32)>,
    /// Largest |v component| / displacement budget in the last step [1/τ].
    pub rush: f64,
    /// Whether a particle could leave the margin of its near pairs.
    pub strayed: bool,
    /// Scratch: the near pairs that may touch, inside the chunk and to later ones.
    pub selected: [Vec<(u32, u32)>; 2],
    /// Scratch: particles that have used up much of their budget.
    pub spenders: Vec<u32>,
    /// Scratch: particles that may touch a wall.
    pub outermost: Vec<u32>,
    /// Storage for the next lists, swapped at a refresh.
    pub spare: [ContactList<T>; 2],
}

impl<T: Number, F: Default> Chunk<T, F> {
    /// An empty chunk of particles `start..end` with contact memories of `slots`.
    #[must_use]
    pub fn new(start: usize, end: usize, slots: usize) -> Self {
        Self {
            start,
            end,
            inner: ContactList::new(slots),
            outer: ContactList::new(slots),
            walls: std::array::from_fn(|_| WallList::new(slots)),
            spare: std::array::from_fn(|_| ContactList::new(slots)),
            ..Self::default()
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.inner.bytes()
            + self.outer.bytes()
            + self.spare.iter().map(ContactList::bytes).sum::<usize>()
            + self.walls.iter().map(ContactList::bytes).sum::<usize>()
            + self.near.capacity() * size_of::<(u32, u32)>()
            + self.selected.iter().map(Vec::capacity).sum::<usize>() * size_of::<(u32, u32)>()
            + (self.outermost.capacity() + self.spenders.capacity()) * size_of::<u32>()
            + self.ghosts.forces.capacity() * size_of::<F>()
            + (self.ghosts.particles.capacity() + self.ghosts.targets.capacity()) * size_of::<u32>()
    }
}
