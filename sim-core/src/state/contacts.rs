//! Lists of contacts with their memory, in groups of four.

use crate::lane::GROUP;

/// Pairs that may touch before the next refresh, sorted by (a, b), a < b.
///
/// Indices of a group are stored a a a a b b b b; its memory is `slots` rows of four. The last group may be partly
/// filled: `count` says how many pairs there are.
#[derive(Clone, Debug, Default)]
pub struct ContactList {
    /// Pairs in the list.
    pub count: usize,
    /// Indices of the groups.
    pub indices: Vec<[u32; 2 * GROUP]>,
    /// Memory of the groups, `slots · GROUP` numbers each.
    pub memory: Vec<f64>,
    /// Memory slots per contact.
    pub slots: usize,
    /// Constants of the groups, three rows of four each; empty when the particles need none.
    pub constants: Vec<f64>,
}

impl ContactList {
    /// An empty list.
    #[must_use]
    pub fn new(slots: usize) -> Self {
        Self { slots, ..Self::default() }
    }

    /// Forgets all pairs, keeps the storage.
    pub fn clear(&mut self) {
        self.count = 0;
        self.indices.clear();
        self.memory.clear();
        self.constants.clear();
    }

    /// Gives the newest pair its constants.
    #[inline]
    pub fn set_constants(&mut self, values: [f64; 3]) {
        let (group, lane) = ((self.count - 1) / GROUP, (self.count - 1) % GROUP);
        let base = group * 3 * GROUP;
        if self.constants.len() <= base {
            self.constants.resize(base + 3 * GROUP, 1.0);
        }
        for (row, value) in values.into_iter().enumerate() {
            self.constants[base + row * GROUP + lane] = value;
        }
    }

    /// The pair at `k`.
    #[must_use]
    pub fn pair(&self, k: usize) -> (u32, u32) {
        let group = &self.indices[k / GROUP];
        (group[k % GROUP], group[GROUP + k % GROUP])
    }

    /// One number of the memory of pair `k`.
    #[must_use]
    pub fn slot(&self, k: usize, slot: usize) -> f64 {
        self.memory[(k / GROUP * self.slots + slot) * GROUP + k % GROUP]
    }

    /// One number of the memory of pair `k`, to write.
    pub fn slot_mut(&mut self, k: usize, slot: usize) -> &mut f64 {
        &mut self.memory[(k / GROUP * self.slots + slot) * GROUP + k % GROUP]
    }

    /// Appends a pair; its memory is that of `from` in another list, or vacant.
    #[inline]
    pub fn push(&mut self, a: u32, b: u32, from: Option<(&Self, usize)>, vacant: fn(usize) -> f64) {
        let lane = self.count % GROUP;
        if lane == 0 {
            self.indices.push([a, a, a, a, b, b, b, b]);
            self.memory.resize(self.memory.len() + self.slots * GROUP, 0.0);
        }
        let group = self.count / GROUP;
        let indices = &mut self.indices[group];
        indices[lane] = a;
        indices[GROUP + lane] = b;
        let base = group * self.slots * GROUP + lane;
        match from {
            Some((list, k)) => {
                let source = k / GROUP * self.slots * GROUP + k % GROUP;
                for slot in 0..self.slots {
                    self.memory[base + slot * GROUP] = list.memory[source + slot * GROUP];
                }
            }
            None => {
                for slot in 0..self.slots {
                    self.memory[base + slot * GROUP] = vacant(slot);
                }
            }
        }
        self.count += 1;
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.indices.capacity() * size_of::<[u32; 2 * GROUP]>() + self.memory.capacity() * size_of::<f64>()
    }
}

/// Particles that may touch one wall before the next refresh, in ascending order, with their memory.
pub type WallList = ContactList;
