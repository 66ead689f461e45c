//! The lists of a chunk: which near pairs and which particles beside a wall may touch while the displacement budgets last. They
//! are made every few steps, so they cost as much as a part of the forces: no branches that cannot be predicted, one look
//! at every particle for all walls.

use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::lane::Number;
use crate::space::Space;
use crate::state::{Chunk, Grains, Kinematics};

/// Lists the pairs of a chunk that may touch, keeping the memory of those that were listed.
pub(super) fn list_pairs<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>>(
    chunk: &mut Chunk<S::Real, S::Force>,
    bodies: &[S::Body],
    budget: &[f64],
    grains: &G,
    boundary: &B,
    slack: f64,
    law: &C,
) {
    select::<S, G, B>(chunk, bodies, budget, grains, boundary, slack + law.range());
    let [inner, outer] = &mut chunk.spare;
    for (list, old, pairs) in
        [(&mut *inner, &chunk.inner, &chunk.selected[0]), (&mut *outer, &chunk.outer, &chunk.selected[1])]
    {
        list.renew(pairs, old, C::SLOTS, C::vacant);
        if G::CONSTANTS > 0 {
            list.set_constants(|a, b| grains.constants(a as usize, b as usize));
        }
    }
    let other_ghosts = outer.count != chunk.outer.count
        || outer.indices != chunk.outer.indices
        || chunk.ghosts.targets.len() < outer.count;
    std::mem::swap(&mut chunk.inner, inner);
    std::mem::swap(&mut chunk.outer, outer);
    if other_ghosts {
        list_ghosts(chunk);
    }
}

/// Chooses the near pairs of a chunk whose gap may close while the budgets last, in order: those inside the chunk, and those to
/// later chunks or across a border of the space.
fn select<S: Space, G: Grains, B: Boundary<S>>(
    chunk: &mut Chunk<S::Real, S::Force>,
    bodies: &[S::Body],
    budget: &[f64],
    grains: &G,
    boundary: &B,
    slack: f64,
) {
    let Chunk { selected: [inner, outer], near, end, .. } = chunk;
    let end = *end as u32;
    // One place more than there are pairs: each is written, then kept or overwritten by the next.
    inner.resize(near.len() + 1, (0, 0));
    outer.resize(near.len() + 1, (0, 0));
    let (mut inside, mut across) = (0, 0);
    for &(a, b) in near.iter() {
        let (i, j) = (a as usize, b as usize);
        let (x, y) = (bodies[i].position(), bodies[j].position());
        let apart = [y[0] - x[0], y[1] - x[1], y[2] - x[2]];
        let [dx, dy, dz] = boundary.separation(apart);
        let cutoff = (grains.radius(i) + budget[i]) + (grains.radius(j) + budget[j]) + slack;
        let may_touch = usize::from(dx * dx + dy * dy + dz * dz < cutoff * cutoff);
        let own = usize::from((b < end) & !boundary.crosses(apart));
        inner[inside] = (a, b);
        outer[across] = (a, b);
        inside += may_touch & own;
        across += may_touch & (own ^ 1);
    }
    inner.truncate(inside);
    outer.truncate(across);
}

/// Lists the ghosts of a chunk: the particles b of its outer contacts.
fn list_ghosts<T: Number, F: Clone + Default>(chunk: &mut Chunk<T, F>) {
    let ghosts = &mut chunk.ghosts;
    ghosts.changed = true;
    ghosts.particles.clear();
    ghosts.particles.extend((0..chunk.outer.count).map(|k| chunk.outer.pair(k).1));
    ghosts.particles.sort_unstable();
    ghosts.particles.dedup();
    ghosts.forces.clear();
    ghosts.forces.resize(ghosts.particles.len(), F::default());
    ghosts.targets.clear();
    for k in 0..chunk.outer.count {
        let (_, b) = chunk.outer.pair(k);
        let place = ghosts.particles.binary_search(&b).expect("every b of an outer contact is a ghost");
        ghosts.targets.push(place as u32);
    }
    // Whole groups, as the list has.
    ghosts.targets.resize(chunk.outer.count.next_multiple_of(T::GROUP), 0);
}

/// Lists the particles of a chunk that may touch a wall, keeping the memory of those that were listed.
pub(super) fn list_walls<S: Space, G: Grains, C: ContactLaw<S>>(
    chunk: &mut Chunk<S::Real, S::Force>,
    bodies: &[S::Body],
    budget: &[f64],
    grains: &G,
    walls: &ServoWalls,
    wall_budget: &[f64; 6],
) {
    let gap = |i: usize, wall: usize| {
        let axis = ServoWalls::axis(wall);
        (walls.position[wall] - bodies[i].position()[axis]) * ServoWalls::outward(wall) - wall_budget[wall]
    };
    let Chunk { start, end, outermost, selected: [beside, _], spare: [list, _], walls: listed, .. } = chunk;
    outermost.clear();
    outermost.extend(
        (*start..*end)
            .filter(|&i| {
                let nearest = (0..6).map(|wall| gap(i, wall)).fold(f64::INFINITY, f64::min);
                nearest < grains.radius(i) + budget[i]
            })
            .map(|i| i as u32),
    );
    for (wall, listed) in listed.iter_mut().enumerate() {
        beside.clear();
        beside.extend(outermost.iter().filter_map(|&particle| {
            let i = particle as usize;
            (gap(i, wall) < grains.radius(i) + budget[i]).then_some((particle, particle))
        }));
        list.renew(beside, listed, C::SLOTS, C::vacant);
        std::mem::swap(listed, list);
    }
}
