//! Lists of contacts with their memory, in groups.

use crate::lane::Number;

/// Pairs that may touch before the next refresh, sorted by (a, b), a < b.
///
/// A group is [`Number::GROUP`] pairs. Its indices are stored a a … b b …; its memory is `slots` rows of one number per
/// pair. The last group may be partly filled: `count` says how many pairs there are; the places of the others hold pairs of the
/// list as well.
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

    /// Gives every pair its constants.
    pub fn set_constants(&mut self, values: impl Fn(u32, u32) -> [f64; 3]) {
        self.constants.clear();
        self.constants.resize(self.indices.len() / (2 * Self::GROUP) * 3 * Self::GROUP, T::of(1.0));
        for k in 0..self.count {
            let (a, b) = self.pair(k);
            let base = k / Self::GROUP * 3 * Self::GROUP + k % Self::GROUP;
            for (row, value) in values(a, b).into_iter().enumerate() {
                self.constants[base + row * Self::GROUP] = T::of(value);
            }
        }
    }

    /// The pair at `k`.
    #[must_use]
    pub fn pair(&self, k: usize) -> (u32, u32) {
        let at = k / Self::GROUP * 2 * Self::GROUP + k % Self::GROUP;
        (self.indices[at], self.indices[at + Self::GROUP])
    }

    /// Whether a pair is in the list.
    #[must_use]
    pub fn contains(&self, pair: (u32, u32)) -> bool {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.pair(middle) < pair { low = middle + 1 } else { high = middle }
        }
        low < self.count && self.pair(low) == pair
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

    /// Appends a pair with vacant memory.
    pub fn push(&mut self, a: u32, b: u32, vacant: fn(usize) -> f64) {
        let (group, lane) = (self.count / Self::GROUP, self.count % Self::GROUP);
        let at = group * 2 * Self::GROUP;
        if lane == 0 {
            self.indices.resize(at + Self::GROUP, a);
            self.indices.resize(at + 2 * Self::GROUP, b);
            self.memory.resize(self.memory.len() + self.slots * Self::GROUP, T::default());
        }
        self.indices[at + lane] = a;
        self.indices[at + Self::GROUP + lane] = b;
        for slot in 0..self.slots {
            self.memory[(group * self.slots + slot) * Self::GROUP + lane] = T::of(vacant(slot));
        }
        self.count += 1;
    }

    /// Makes this the list of `pairs` (ascending), with the memory that `old` has of them, else vacant. `slots` is that of
    /// the list, known where this is compiled.
    #[inline(always)]
    pub fn renew(&mut self, pairs: &[(u32, u32)], old: &Self, slots: usize, vacant: fn(usize) -> f64) {
        assert_eq!((self.slots, old.slots), (slots, slots), "the slots of the lists of one law");
        let groups = pairs.len().div_ceil(Self::GROUP);
        self.count = pairs.len();
        self.constants.clear();
        self.indices.resize(groups * 2 * Self::GROUP, 0);
        self.memory.resize(groups * slots * Self::GROUP, T::default());
        let mut at = 0;
        for (group, indices) in self.indices.chunks_exact_mut(2 * Self::GROUP).enumerate() {
            let own = &pairs[group * Self::GROUP..];
            let memory = &mut self.memory[group * slots * Self::GROUP..][..slots * Self::GROUP];
            for lane in 0..Self::GROUP {
                // The last lanes of the last group repeat its first pair.
                let Some(&pair) = own.get(lane) else {
                    (indices[lane], indices[Self::GROUP + lane]) = own[0];
                    continue;
                };
                (indices[lane], indices[Self::GROUP + lane]) = pair;
                while at < old.count && old.pair(at) < pair {
                    at += 1;
                }
                if at < old.count && old.pair(at) == pair {
                    let from = &old.memory[at / Self::GROUP * slots * Self::GROUP..][..slots * Self::GROUP];
                    for slot in 0..slots {
                        memory[slot * Self::GROUP + lane] = from[slot * Self::GROUP + at % Self::GROUP];
                    }
                } else {
                    for slot in 0..slots {
                        memory[slot * Self::GROUP + lane] = T::of(vacant(slot));
                    }
                }
            }
        }
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
