//! Order in memory, and what it takes along: the first of three levels of neighbours (then near pairs, listed pairs).

use super::engine::Dem;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::lane::Number;
use crate::neighbour::{hilbert_order, morton_order};
use crate::space::Space;
use crate::state::{ContactList, Grains, Kinematics};

/// Steps between two sorts of the particles along the space-filling curve. The order decides the order of sums, so
/// this number is part of the definition of the result.
pub(super) const SORT_EVERY: u64 = 8192;

/// Margin of a particle in the near list [d]: pairs with a gap below twice this are near.
pub(super) const NEAR_MARGIN: f64 = 0.12;

/// A touching contact on its way from one list to another.
#[derive(Clone, Debug)]
pub(super) struct Carried {
    pub a: u32,
    /// The other particle, or the wall.
    pub b: u32,
    pub memory: Vec<f64>,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Contacts with something to remember: pairs and wall contacts, by slot.
    pub(super) fn carried(&self) -> (Vec<Carried>, Vec<Carried>) {
        let collect = |list: &ContactList<S::Real>, wall: Option<u32>, into: &mut Vec<Carried>| {
            for k in 0..list.count {
                let memory: Vec<f64> = (0..C::SLOTS).map(|slot| list.slot(k, slot).into()).collect();
                if memory
                    .iter()
                    .enumerate()
                    .any(|(slot, &value)| S::Real::of(value) != S::Real::of(C::vacant(slot)))
                {
                    let (a, b) = list.pair(k);
                    into.push(Carried { a, b: wall.unwrap_or(b), memory });
                }
            }
        };
        let (mut pairs, mut walls) = (Vec::new(), Vec::new());
        for chunk in &self.chunks {
            collect(&chunk.inner, None, &mut pairs);
            collect(&chunk.outer, None, &mut pairs);
            for (wall, list) in (0_u32..).zip(&chunk.walls) {
                collect(list, Some(wall), &mut walls);
            }
        }
        (pairs, walls)
    }

    /// Fills the lists with exactly the given contacts; a refresh must follow.
    pub(super) fn place(&mut self, mut pairs: Vec<Carried>, mut walls: Vec<Carried>) {
        pairs.sort_unstable_by_key(|contact| (contact.a, contact.b));
        walls.sort_unstable_by_key(|contact| (contact.b, contact.a));
        let write = |list: &mut ContactList<S::Real>, a: u32, b: u32, memory: &[f64]| {
            list.push(a, b, C::vacant);
            for (slot, &value) in memory.iter().enumerate() {
                *list.slot_mut(list.count - 1, slot) = S::Real::of(value);
            }
        };
        for chunk in &mut self.chunks {
            chunk.inner.clear();
            chunk.outer.clear();
            chunk.ghosts.targets.clear();
            chunk.ghosts.changed = true;
            chunk.walls.iter_mut().for_each(ContactList::clear);
            for contact in &pairs {
                if (chunk.start..chunk.end).contains(&(contact.a as usize)) {
                    let [x, y] = [contact.a, contact.b].map(|slot| self.bodies[slot as usize].position());
                    let apart = std::array::from_fn(|k| y[k] - x[k]);
                    let inside = (contact.b as usize) < chunk.end && !self.boundary.crosses(apart);
                    let list = if inside { &mut chunk.inner } else { &mut chunk.outer };
                    write(list, contact.a, contact.b, &contact.memory);
                }
            }
            for contact in &walls {
                if (chunk.start..chunk.end).contains(&(contact.a as usize)) {
                    write(&mut chunk.walls[contact.b as usize], contact.a, contact.a, &contact.memory);
                }
            }
        }
    }

    /// Sorts the particles along the space-filling curve and rebuilds all lists.
    pub(super) fn sort(&mut self) {
        let (mut pairs, mut walls) = self.carried();
        if B::DEFORMS {
            for body in &mut self.bodies {
                let inside = self.boundary.inside(body.position());
                body.move_to(inside);
            }
        }
        let at = |slot: usize| self.bodies[slot].position();
        let order =
            if S::DIMENSION == 3 { hilbert_order(self.len(), at) } else { morton_order(self.len(), at) };
        let mut slot_of = vec![0_u32; self.len()];
        for (slot, &old) in (0_u32..).zip(&order) {
            slot_of[old as usize] = slot;
        }
        self.bodies = order.iter().map(|&old| self.bodies[old as usize]).collect();
        self.original = order.iter().map(|&old| self.original[old as usize]).collect();
        self.grains.permute(&order);
        self.order_drag();
        for contact in &mut pairs {
            (contact.a, contact.b) = (slot_of[contact.a as usize], slot_of[contact.b as usize]);
            if contact.a > contact.b {
                // Springs hold displacements of b against a: they change sign with the roles.
                (contact.a, contact.b) = (contact.b, contact.a);
                for (slot, value) in contact.memory.iter_mut().enumerate() {
                    if C::reverses(slot) {
                        *value = -*value;
                    }
                }
            }
        }
        for contact in &mut walls {
            contact.a = slot_of[contact.a as usize];
        }
        self.place(pairs, walls);
        self.rebuild();
        self.refresh();
    }
}

/// Speed of a body [d/τ].
pub(super) fn speed<S: Space>(body: &S::Body) -> f64 {
    let (v, _) = body.motion();
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
