//! A definition, point by point.

use serde_json::{Map, Value};

use super::{Axis, Block, Sweep};
use crate::{Problems, Scene};

/// A point of a sweep that runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Place in the sweep's order, from 0; left-out points count too.
    pub index: u64,
    /// The scene.
    pub scene: Scene,
    /// Why the scene is outside of what the model describes, if it is: it runs and is marked.
    pub out_of_model: Option<String>,
}

/// What became of a place in the sweep's order.
#[expect(clippy::large_enum_variant, reason = "nearly every candidate runs; one lives at a time")]
#[derive(Clone, Debug, PartialEq)]
pub enum Candidate {
    /// The point runs.
    Runs(Point),
    /// A filter leaves the point out.
    LeftOut {
        /// Place in the sweep's order.
        index: u64,
        /// Which of [`Sweep::filters`].
        filter: usize,
    },
    /// Keys that are right alone make no scene together.
    Broken {
        /// Place in the sweep's order.
        index: u64,
        /// Why.
        problems: Problems,
    },
}

/// The candidates of a sweep in order; see [`Sweep::candidates`].
#[derive(Clone, Debug)]
pub struct Points<'a> {
    sweep: &'a Sweep,
    next: u64,
    end: u64,
}

impl Sweep {
    /// Every place in the sweep's order, lazily.
    #[must_use]
    pub fn candidates(&self) -> Points<'_> {
        Points { sweep: self, next: 0, end: self.size() }
    }

    /// The points that run, in order, lazily. A definition with broken points is refused by [`Sweep::survey`].
    pub fn points(&self) -> impl Iterator<Item = Point> {
        self.candidates().filter_map(|candidate| match candidate {
            Candidate::Runs(point) => Some(point),
            Candidate::LeftOut { .. } | Candidate::Broken { .. } => None,
        })
    }

    /// What became of one place in the sweep's order.
    ///
    /// # Panics
    /// When `index` is not below [`Sweep::size`].
    #[must_use]
    pub fn candidate(&self, index: u64) -> Candidate {
        let settled = match Scene::without_conflict_check(self.model, &self.keys_at(index)) {
            Ok(scene) => scene,
            Err(problems) => return Candidate::Broken { index, problems },
        };
        if let Some(filter) = self.filters.iter().position(|filter| !filter.keeps(&settled)) {
            return Candidate::LeftOut { index, filter };
        }
        if let Err(problems) = Problems::none_or(settled.conflicts()) {
            return Candidate::Broken { index, problems };
        }
        let out_of_model = settled.out_of_model();
        Candidate::Runs(Point { index, scene: settled, out_of_model })
    }

    /// The keys of the point at `index`, defaults not filled in.
    fn keys_at(&self, index: u64) -> Map<String, Value> {
        let mut keys = self.base.clone();
        let mut rest = index;
        let block = self
            .blocks
            .iter()
            .find(|block| {
                let size = block.size() * self.replicates;
                let here = rest < size;
                if !here {
                    rest -= size;
                }
                here
            })
            .expect("the index is below the size of the sweep");
        let replicate = rest % self.replicates;
        block.put(rest / self.replicates, &mut keys);
        if replicate > 0 {
            let first = keys.get("seed").map_or_else(|| self.default_seed(), Clone::clone);
            let seed = first.as_u64().expect("seeds are settled whole numbers") + replicate;
            keys.insert("seed".to_owned(), Value::from(seed));
        }
        keys
    }

    fn default_seed(&self) -> Value {
        let key =
            self.model.key("seed").expect("replicates need a seed, checked when the definition was read");
        match key.absent {
            crate::table::Absent::Default(text) => serde_json::from_str(text).expect("a default is JSON"),
            _ => Value::from(0),
        }
    }
}

impl Block {
    /// Writes the keys of the block's point `index` over `keys`.
    fn put(&self, index: u64, keys: &mut Map<String, Value>) {
        let mut rest = index;
        if !self.list.is_empty() {
            let count = self.list.len() as u64;
            let entry = usize::try_from(rest % count).expect("a list fits in memory");
            keys.extend(self.list[entry].clone());
            rest /= count;
        }
        if let Some(count) = self.zip.first().map(Axis::len) {
            for axis in &self.zip {
                keys.insert(axis.key.clone(), axis.value(rest % count));
            }
            rest /= count;
        }
        for axis in self.grid.iter().rev() {
            keys.insert(axis.key.clone(), axis.value(rest % axis.len()));
            rest /= axis.len();
        }
    }
}

impl Iterator for Points<'_> {
    type Item = Candidate;

    fn next(&mut self) -> Option<Candidate> {
        let candidate = (self.next < self.end).then(|| self.sweep.candidate(self.next))?;
        self.next += 1;
        Some(candidate)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::try_from(self.end - self.next).unwrap_or(usize::MAX);
        (left, Some(left))
    }

    fn nth(&mut self, skipped: usize) -> Option<Candidate> {
        self.next = self.next.saturating_add(skipped as u64).min(self.end);
        self.next()
    }
}

impl ExactSizeIterator for Points<'_> {}
