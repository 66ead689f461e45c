//! Upkeep of the three levels of neighbours: order in memory, near pairs, listed pairs.

use super::engine::Dem;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::neighbour::{near_pairs, spatial_order};
use crate::space::Space;
use crate::state::{Body, Chunk, ContactList, Grains};

/// Steps between two sorts of the particles along the space-filling curve. The order decides the order of sums, so
/// this number is part of the definition of the result.
pub(super) const SORT_EVERY: u64 = 8192;

/// Margin of a particle in the near list [d]: pairs with a gap below twice this are near.
pub(super) const NEAR_MARGIN: f64 = 0.12;

/// Smallest and largest displacement budget of a particle between two refreshes [d].
const LEAST_BUDGET: f64 = 4e-4;
const MOST_BUDGET: f64 = 0.5 * NEAR_MARGIN;

/// Bounds of the number of steps a refresh is meant to last.
const STEPS_PER_REFRESH: (f64, f64) = (6.0, 120.0);

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
        let collect = |list: &ContactList, wall: Option<u32>, into: &mut Vec<Carried>| {
            for k in 0..list.count {
                let memory: Vec<f64> = (0..C::SLOTS).map(|slot| list.slot(k, slot)).collect();
                if memory.iter().enumerate().any(|(slot, &value)| value != C::vacant(slot)) {
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
        let write = |list: &mut ContactList, a: u32, b: u32, memory: &[f64]| {
            list.push(a, b, None, C::vacant);
            for (slot, &value) in memory.iter().enumerate() {
                *list.slot_mut(list.count - 1, slot) = value;
            }
        };
        for chunk in &mut self.chunks {
            chunk.inner.clear();
            chunk.outer.clear();
            chunk.walls.iter_mut().for_each(ContactList::clear);
            for contact in &pairs {
                if (chunk.start..chunk.end).contains(&(contact.a as usize)) {
                    let list =
                        if (contact.b as usize) < chunk.end { &mut chunk.inner } else { &mut chunk.outer };
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
                let inside = self.boundary.inside(point(body));
                body.position[..3].copy_from_slice(&inside);
            }
        }
        let order = spatial_order(self.len(), |slot| point(&self.bodies[slot]));
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
                for value in &mut contact.memory[C::TANGENTIAL_SLOT..] {
                    *value = -*value;
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

    /// Finds the near pairs anew.
    pub(super) fn rebuild(&mut self) {
        self.lists.rebuilds += 1;
        let bodies = &self.bodies;
        self.lists.near_at = bodies.iter().map(point).collect();
        let reach = 2.0 * NEAR_MARGIN + self.law.range();
        let size = 2.0 * self.grains.largest_radius() + reach;
        self.boundary.mark();
        let boundary = &self.boundary;
        let mut places: Vec<[f64; 3]> = bodies.iter().map(|body| boundary.inside(point(body))).collect();
        // Images near the borders of a periodic space join the search; `real` tells whose they are.
        let mut real: Vec<u32> = (0..bodies.len() as u32).collect();
        for slot in 0..bodies.len() {
            boundary.images(places[slot], size, &mut |image| {
                places.push(image);
                real.push(slot as u32);
            });
        }
        self.lists.cells.build(places.len(), size, |place| places[place]);
        let (cells, grains) = (&self.lists.cells, &self.grains);
        for chunk in &mut self.chunks {
            near_pairs(
                cells,
                chunk.start..chunk.end,
                |place| places[place],
                |place| real[place as usize],
                |i, j| grains.radius(i) + grains.radius(j) + reach,
                &mut chunk.near_start,
                &mut chunk.near,
            );
        }
    }

    /// Gives every particle and wall a displacement budget for the coming steps and lists the pairs that may touch
    /// within it. Rebuilds the near pairs first when a particle could leave its margin.
    pub(super) fn refresh(&mut self) {
        self.lists.refreshes += 1;
        let mean_speed = self.bodies.iter().map(speed).sum::<f64>() / (self.len().max(1) as f64);
        // A refresh costs some ten listed pairs per particle; a listed pair is paid every step, and their number
        // grows with the budget. The best interval is near this one (and no result depends on it).
        let steps = (0.09 / (mean_speed * self.dt + 1e-300)).sqrt();
        let steps = steps.clamp(STEPS_PER_REFRESH.0, STEPS_PER_REFRESH.1);
        let budget_of = |speed: f64| (1.5 * steps * self.dt * speed).clamp(LEAST_BUDGET, MOST_BUDGET);
        self.lists.budget.clear();
        self.lists.budget.extend(self.bodies.iter().map(|body| budget_of(speed(body))));
        if let Some(walls) = &self.walls {
            self.lists.wall_budget = walls.velocity.map(|velocity| budget_of(velocity.abs()));
        }
        self.lists.strain_budget = if B::DEFORMS {
            let strain = steps * self.dt * self.boundary.fastest();
            (1.5 * strain * self.pair_reach()).clamp(1e-9, LEAST_BUDGET)
        } else {
            0.0
        };
        let boundary = &self.boundary;
        let margin =
            NEAR_MARGIN - 0.5 * (boundary.strain_since_mark(self.pair_reach()) + self.lists.strain_budget);
        let strayed = self.lists.near_at.len() != self.len()
            || self.bodies.iter().zip(&self.lists.near_at).zip(&self.lists.budget).any(
                |((body, from), budget)| {
                    let from = boundary.since_mark(*from);
                    let moved: f64 = (0..3).map(|k| (body.position[k] - from[k]).powi(2)).sum();
                    // Written so that a NaN strays.
                    let stays = moved.sqrt() + budget < margin;
                    !stays
                },
            );
        if strayed {
            self.rebuild();
        }
        for (body, budget) in self.bodies.iter_mut().zip(&self.lists.budget) {
            body.position[3] = 1.0 / budget;
        }
        self.lists.used = 0.0;

        let (bodies, budget, law) = (&self.bodies, &self.lists.budget, &self.law);
        let slack = self.lists.strain_budget;
        for chunk in &mut self.chunks {
            list_pairs::<S, G, B, C>(chunk, bodies, budget, &self.grains, &self.boundary, slack, law);
            if let Some(walls) = &self.walls {
                list_walls::<S, G, C>(chunk, bodies, budget, &self.grains, walls, &self.lists.wall_budget);
            }
        }
        self.link_ghosts();
    }

    /// Tells every chunk which ghosts of earlier chunks lie in it.
    fn link_ghosts(&mut self) {
        for chunk in &mut self.chunks {
            chunk.incoming.clear();
        }
        for c in 0..self.chunks.len() {
            let (earlier, later) = self.chunks.split_at_mut(c + 1);
            let mut target = 0;
            for (place, &particle) in (0_u32..).zip(&earlier[c].ghosts.particles) {
                while later[target].end <= particle as usize {
                    target += 1;
                }
                later[target].incoming.push((c as u32, place, particle));
            }
        }
    }
}

/// Lists the pairs of a chunk that may touch, keeping the memory of those that were listed.
fn list_pairs<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>>(
    chunk: &mut Chunk,
    bodies: &[Body],
    budget: &[f64],
    grains: &G,
    boundary: &B,
    slack: f64,
    law: &C,
) {
    let [inner, outer] = &mut chunk.spare;
    inner.clear();
    outer.clear();
    let (mut inner_at, mut outer_at) = (0, 0);
    for i in chunk.start..chunk.end {
        let k = i - chunk.start;
        let near = &chunk.near[chunk.near_start[k] as usize..chunk.near_start[k + 1] as usize];
        let x = &bodies[i].position;
        let reach = grains.radius(i) + budget[i] + law.range() + slack;
        for &j in near {
            let y = &bodies[j as usize].position;
            let [dx, dy, dz] = boundary.separation([y[0] - x[0], y[1] - x[1], y[2] - x[2]]);
            let cutoff = reach + grains.radius(j as usize) + budget[j as usize];
            if dx * dx + dy * dy + dz * dz < cutoff * cutoff {
                let pair = (i as u32, j);
                let (list, old, at) = if (j as usize) < chunk.end {
                    (&mut *inner, &chunk.inner, &mut inner_at)
                } else {
                    (&mut *outer, &chunk.outer, &mut outer_at)
                };
                while *at < old.count && old.pair(*at) < pair {
                    *at += 1;
                }
                let known = *at < old.count && old.pair(*at) == pair;
                list.push(pair.0, pair.1, known.then_some((old, *at)), C::vacant);
                if G::CONSTANTS > 0 {
                    list.set_constants(grains.constants(i, j as usize));
                }
            }
        }
    }
    std::mem::swap(&mut chunk.inner, inner);
    std::mem::swap(&mut chunk.outer, outer);

    let ghosts = &mut chunk.ghosts;
    ghosts.particles.clear();
    ghosts.particles.extend((0..chunk.outer.count).map(|k| chunk.outer.pair(k).1));
    ghosts.particles.sort_unstable();
    ghosts.particles.dedup();
    ghosts.forces.clear();
    ghosts.forces.resize(ghosts.particles.len(), crate::state::Force::default());
    ghosts.targets.clear();
    for k in 0..chunk.outer.count {
        if k % 4 == 0 {
            ghosts.targets.push([0; 4]);
        }
        let (_, b) = chunk.outer.pair(k);
        let place = ghosts.particles.binary_search(&b).expect("every b of an outer contact is a ghost");
        ghosts.targets[k / 4][k % 4] = place as u32;
    }
}

/// Lists the particles of a chunk that may touch a wall, keeping the memory of those that were listed.
fn list_walls<S: Space, G: Grains, C: ContactLaw<S>>(
    chunk: &mut Chunk,
    bodies: &[Body],
    budget: &[f64],
    grains: &G,
    walls: &ServoWalls,
    wall_budget: &[f64; 6],
) {
    for wall in 0..6 {
        let (axis, outward) = (ServoWalls::axis(wall), ServoWalls::outward(wall));
        let list = &mut chunk.spare[0];
        list.clear();
        let old = &chunk.walls[wall];
        let mut at = 0;
        for i in chunk.start..chunk.end {
            let distance = (walls.position[wall] - bodies[i].position[axis]) * outward;
            if distance < grains.radius(i) + budget[i] + wall_budget[wall] {
                let particle = i as u32;
                while at < old.count && old.pair(at).0 < particle {
                    at += 1;
                }
                let known = at < old.count && old.pair(at).0 == particle;
                list.push(particle, particle, known.then_some((old, at)), C::vacant);
            }
        }
        std::mem::swap(&mut chunk.walls[wall], &mut chunk.spare[0]);
    }
}

/// Centre of a body [d].
pub(super) fn point(body: &Body) -> [f64; 3] {
    [body.position[0], body.position[1], body.position[2]]
}

/// Speed of a body [d/τ].
pub(super) fn speed(body: &Body) -> f64 {
    let v = &body.velocity;
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
