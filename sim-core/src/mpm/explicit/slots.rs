//! Pairs of marker and partner that are followed from step to step.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::mpm::contact::detect::{Outline, candidates};
use crate::mpm::contact::{Key, Partner};
use crate::mpm::observe::network::Impulses;
use crate::mpm::world::World;

/// Distance at which pairs are taken up, in the smallest cell.
const RANGE: f64 = 0.8;
/// Part of it that is left when they are looked for again.
const LEFT: f64 = 0.1;

/// A marker and what it may touch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Slot {
    /// Identity.
    pub key: Key,
    /// Vertex of the partner's outline near the marker (0 for a wall).
    pub vertex: u32,
    /// Normal and tangential impulse of the last step.
    pub impulse: [f64; 2],
    /// Normal impulse since the last time it was added to the network.
    pub total: f64,
}

/// Looks for pairs again; known ones keep their impulses.
pub(super) fn renew(world: &mut World, outlines: &[Outline]) {
    flush(&mut world.memory.slots, &mut world.network);
    let cell = world.bodies.iter().map(|body| body.template.cell * body.size).fold(f64::MAX, f64::min);
    let walls = &world.walls;
    let found: Vec<Vec<Slot>> = (0..world.bodies.len())
        .into_par_iter()
        .map(|body| {
            let mut list = Vec::new();
            candidates(body, outlines, walls, RANGE * cell, &mut list);
            let slot = |one: crate::mpm::contact::Candidate| Slot {
                key: one.key,
                vertex: one.segment,
                impulse: [0.0; 2],
                total: 0.0,
            };
            list.into_iter().map(slot).collect()
        })
        .collect();
    let mut known = std::mem::take(&mut world.memory.slots).into_iter().peekable();
    for mut slot in found.into_iter().flatten() {
        while known.next_if(|old| old.key < slot.key).is_some() {}
        if let Some(old) = known.next_if(|old| old.key == slot.key) {
            slot.impulse = old.impulse;
        }
        world.memory.slots.push(slot);
    }
    world.memory.reach = (RANGE - LEFT) * cell;
}

/// Adds what the pairs have borne since the last time to the network.
pub fn flush(slots: &mut [Slot], network: &mut Impulses) {
    let mut pair: Option<((u32, Partner), f64)> = None;
    for slot in slots.iter_mut().filter(|slot| slot.total > 0.0) {
        let key = (slot.key.body, slot.key.partner);
        match &mut pair {
            Some((of, sum)) if *of == key => *sum += slot.total,
            _ => {
                if let Some((of, sum)) = pair.replace((key, slot.total)) {
                    *network.entry(of).or_insert(0.0) += sum;
                }
            }
        }
        slot.total = 0.0;
    }
    if let Some((of, sum)) = pair {
        *network.entry(of).or_insert(0.0) += sum;
    }
}
