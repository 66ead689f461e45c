//! Lists of contacts with their memory, in groups.

use crate::lane::Number;

/// Pairs that may touch before the next refresh, sorted by (a, b), a < b.
///
/// A group is [`Number::GROUP`] pairs. Its indices are stored a a … b b …; its memory is `slots` rows of one number per
/// pair. The last group may be partly filled: `count` says how many pairs there are.
#[derive(Clone, Debug, Default)]
pub struct ContactList<T> {
    /// Pairs in the list.
    pub count: usize,
    /// Indices of the groups, `2 · GROUP` each.
    pub indices: Vec<u32>,
    /// Memory of the groups, `slots · GROUP` numbers each.
    pub memory: Vec<T>,
    /// Memory slots per contact.
    pub slots: usize,
    /// Constants of the groups, three rows each; empty when the particles need none.
    pub constants: Vec<T>,
}

impl<T: Number> ContactList<T> {
    const GROUP: usize = T::GROUP;

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
        let (group, lane) = ((self.count - 1) / Self::GROUP, (self.count - 1) % Self::GROUP);
        let base = group * 3 * Self::GROUP;
        if self.constants.len() <= base {
            self.constants.resize(base + 3 * Self::GROUP, T::of(1.0));
        }
        for (row, value) in values.into_iter().enumerate() {
            self.constants[base + row * Self::GROUP + lane] = T::of(value);
        }
    }

    /// The pair at `k`.
    #[must_use]
    pub fn pair(&self, k: usize) -> (u32, u32) {
        let at = k / Self::GROUP * 2 * Self::GROUP + k % Self::GROUP;
        (self.indices[at], self.indices[at + Self::GROUP])
    }

    /// One number of the memory of pair `k`.
    #[must_use]
    pub fn slot(&self, k: usize, slot: usize) -> T {
        self.memory[(k / Self::GROUP * self.slots + slot) * Self::GROUP + k % Self::GROUP]
    }

    /// One number of the memory of pair `k`, to write.
    pub fn slot_mut(&mut self, k: usize, slot: usize) -> &mut T {
        &mut self.memory[(k / Self::GROUP * self.slots + slot) * Self::GROUP + k % Self::GROUP]
    }

    /// Appends a pair; its memory is that of `from` in another list, or vacant.
    #[inline]
    pub fn push(&mut self, a: u32, b: u32, from: Option<(&Self, usize)>, vacant: fn(usize) -> f64) {
        let (group, lane) = (self.count / Self::GROUP, self.count % Self::GROUP);
        let at = group * 2 * Self::GROUP;
        if lane == 0 {
            self.indices.resize(at + Self::GROUP, a);
            self.indices.resize(at + 2 * Self::GROUP, b);
            self.memory.resize(self.memory.len() + self.slots * Self::GROUP, T::default());
        }
        self.indices[at + lane] = a;
        self.indices[at + Self::GROUP + lane] = b;
        let base = group * self.slots * Self::GROUP + lane;
        match from {
            Some((list, k)) => {
                let source = k / Self::GROUP * self.slots * Self::GROUP + k % Self::GROUP;
                for slot in 0..self.slots {
                    self.memory[base + slot * Self::GROUP] = list.memory[source + slot * Self::GROUP];
                }
            }
            None => {
                for slot in 0..self.slots {
                    self.memory[base + slot * Self::GROUP] = T::of(vacant(slot));
                }
            }
        }
        self.count += 1;
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.indices.capacity() * size_of::<u32>()
            + (self.memory.capacity() + self.constants.capacity()) * size_of::<T>()
    }
}

/// Particles that may touch one wall before the next refresh, in ascending order, with their memory.
pub type WallList<T> = ContactList<T>;
