//! Contact on a common mesh: every node that two bodies share carries a contact of their nodal velocities.
//!
//! The paper's multi-mesh contact as far as its text goes: the normal follows from the gradients of the two masses, the
//! bodies must not approach each other at the node, no gap is looked at. Cubic splines reach two cells beyond the
//! outermost point, so that bodies push each other before they touch.

use std::cmp::Ordering;

use super::{Candidate, Key, Partner, Wall};
use crate::mpm::body::Body;
use crate::mpm::world::World;

/// Least mass of a node that takes part, over the mean nodal mass of its body.
const LEAST_MASS: f64 = 1e-6;

/// How far a wall may move in a step [cells]; nodes within are kept ready for contact.
const WALL_MOVE: f64 = 1.0;

/// A grid node as a number: the same for every body and every step.
fn number([i, j]: [i32; 2]) -> u32 {
    (((j + 0x8000) as u32) << 16) | ((i + 0x8000) as u32 & 0xffff)
}

fn index(number: u32) -> [i32; 2] {
    [(number & 0xffff) as i32 - 0x8000, (number >> 16) as i32 - 0x8000]
}

/// The body's node with a grid number.
#[must_use]
pub fn node_of(body: &Body, number: u32) -> u32 {
    let [i, j] = index(number);
    let found = body.template.grid.binary_search_by_key(&[j, i], |&[i, j]| [j, i]);
    found.expect("a shared node is a node of both") as u32
}

/// For each grid the nodes it shares with another or that a wall may come to; grids are sorted by (j, i).
#[must_use]
pub fn shared_nodes(grids: &[Vec<[i32; 2]>], walls: &[Wall], spacing: f64) -> Vec<Vec<[i32; 2]>> {
    let mut all: Vec<[i32; 2]> = grids.iter().flatten().copied().collect();
    all.sort_unstable_by_key(|&[i, j]| [j, i]);
    let twice: Vec<[i32; 2]> = all.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    let of = |grid: &Vec<[i32; 2]>| {
        let shared = |&[i, j]: &[i32; 2]| twice.binary_search_by_key(&[j, i], |&[i, j]| [j, i]).is_ok();
        let by_wall =
            |at: &[i32; 2]| walls.iter().any(|wall| height(*at, spacing, wall) < WALL_MOVE * spacing);
        grid.iter().filter(|at| shared(at) || by_wall(at)).copied().collect()
    };
    grids.iter().map(of).collect()
}

/// Height of a node above a wall.
fn height(at: [i32; 2], spacing: f64, wall: &Wall) -> f64 {
    let x = at.map(|one| spacing * f64::from(one));
    (x[0] - wall.point[0]) * wall.normal[0] + (x[1] - wall.point[1]) * wall.normal[1]
}

/// Outward direction of a body at a node, Σ_p m_p ∇N_i(x_p).
fn outward(body: &Body) -> Vec<[f64; 2]> {
    let template = &*body.template;
    let mut sum = vec![[0.0; 2]; template.nodes.len()];
    for (cell, corners) in template.cells.as_chunks::<16>().0.iter().enumerate() {
        for p in template.first_point[cell] as usize..template.first_point[cell + 1] as usize {
            // the density of all points is the same but for the volume change: volumes serve as masses
            for (&node, g) in corners.iter().zip(&template.gradients[16 * p..16 * p + 16]) {
                sum[node as usize][0] += template.volumes[p] * body.size * g[0];
                sum[node as usize][1] += template.volumes[p] * body.size * g[1];
            }
        }
    }
    sum
}

/// Contacts of the nodes of one body with walls and with bodies of higher number, in the order of their keys. Walls are
/// where they were at the start of the step, as the grids are.
pub fn candidates(body: usize, world: &World, velocities: &[&[f64]], advance: f64, out: &mut Vec<Candidate>) {
    out.clear();
    let own = &world.bodies[body];
    let Some(cloud) = &own.cloud else { return };
    let least = |body: &Body| LEAST_MASS * body.mass.iter().sum::<f64>() / body.mass.len() as f64;
    let own_least = least(own);
    let velocity = |body: usize, node: usize| [velocities[body][2 * node], velocities[body][2 * node + 1]];
    for (wall_number, wall) in world.walls.iter().enumerate() {
        for (node, &at) in own.template.grid.iter().enumerate() {
            if height(at, cloud.spacing, wall) > 0.0 || own.mass[node] <= own_least {
                continue;
            }
            let v = velocity(body, node);
            let parting =
                (v[0] - wall.velocity[0]) * wall.normal[0] + (v[1] - wall.velocity[1]) * wall.normal[1];
            let key =
                Key { body: body as u32, partner: Partner::Wall(wall_number as u32), marker: number(at) };
            out.push(Candidate { key, gap: advance * parting, normal: wall.normal, segment: 0, share: 0.0 });
        }
    }
    let mut own_outward = Vec::new();
    for (other_number, other) in world.bodies.iter().enumerate().skip(body + 1) {
        let shared = common(&own.template.grid, &other.template.grid);
        if shared.is_empty() {
            continue;
        }
        if own_outward.is_empty() {
            own_outward = outward(own);
        }
        let (other_outward, other_least) = (outward(other), least(other));
        for (a, b) in shared {
            if own.mass[a] <= own_least || other.mass[b] <= other_least {
                continue;
            }
            let difference = [0, 1].map(|axis| other_outward[b][axis] - own_outward[a][axis]);
            let length = libm::hypot(difference[0], difference[1]);
            if length == 0.0 {
                continue;
            }
            let normal = difference.map(|one| one / length);
            let (va, vb) = (velocity(body, a), velocity(other_number, b));
            let parting = (va[0] - vb[0]) * normal[0] + (va[1] - vb[1]) * normal[1];
            let key = Key {
                body: body as u32,
                partner: Partner::Body(other_number as u32),
                marker: number(own.template.grid[a]),
            };
            out.push(Candidate { key, gap: advance * parting, normal, segment: b as u32, share: 0.0 });
        }
    }
}

/// Places of the nodes that two sorted grids have in common.
fn common(a: &[[i32; 2]], b: &[[i32; 2]]) -> Vec<(usize, usize)> {
    let (mut i, mut j) = (0, 0);
    let mut out = Vec::new();
    while i < a.len() && j < b.len() {
        match [a[i][1], a[i][0]].cmp(&[b[j][1], b[j][0]]) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => {
                out.push((i, j));
                i += 1;
                j += 1;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::constitutive::{Kinematics, Material};
    use crate::mpm::contact::ContactKind;
    use crate::mpm::element::Law;
    use crate::mpm::spline::{block, rim};
    use crate::mpm::updated;

    #[test]
    fn two_boxes_see_each_other_along_the_line_between_them() {
        let material = Material { young: 1.0, poisson: 0.3, density: 1.0, plasticity: None };
        let law = Law { material, kinematics: Kinematics::Jaumann, mean_dilatation: true };
        let at = |low: [i32; 2]| {
            let (fill, markers) = (block(low, [4, 4], 1.0), rim(low, [4, 4], 1.0));
            let corner = low.map(f64::from);
            updated::body(&fill, markers, 1.0, 1.0, corner, &material)
        };
        let mut world = World::new(vec![at([0, 0]), at([5, 0]), at([20, 0])], Vec::new(), law);
        world.contact = ContactKind::CommonMesh;
        world.bodies[0].cloud.as_mut().unwrap().velocity.fill([0.5, 0.0]);
        updated::regrid(&mut world);
        let velocities: Vec<&[f64]> = world.bodies.iter().map(|body| body.velocity.as_slice()).collect();
        let mut found = Vec::new();
        candidates(0, &world, &velocities, 0.1, &mut found);
        // nodes 3 to 5 hold mass of both: the first box reaches to x = 5.75, the second down to 3.25
        assert!(!found.is_empty() && found.is_sorted_by_key(|one| one.key));
        for one in &found {
            let [i, j] = index(one.key.marker);
            assert_eq!(one.key.partner, Partner::Body(1));
            assert!((4..=5).contains(&i), "{i}");
            // in the middle of the faces straight along x, from the partner to this body; approaching: a negative way
            if (1..=3).contains(&j) {
                assert!(one.normal[0] < -0.99, "{:?} at {i}, {j}", one.normal);
                assert!((one.gap / (0.1 * 0.5) - one.normal[0]).abs() < 1e-12);
            }
        }
        candidates(1, &world, &velocities, 0.1, &mut found);
        assert!(found.is_empty(), "pairs are listed once");
    }
}
