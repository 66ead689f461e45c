//! Contact impulses on lumped masses: projected Gauss–Seidel over the rows near contact.

use super::slots::Slot;
use crate::mpm::body::Body;
use crate::mpm::contact::detect::Outline;
use crate::mpm::contact::rows::tangent;
use crate::mpm::contact::{Partner, Wall};
use crate::mpm::world::Numerics;

/// Share of an overlap that is taken back in one step.
const RECOVERY: f64 = 0.1;
/// Gap below which a row takes part, in cells of the marker's body; so does one that would close in the step.
const NEAR: f64 = 0.02;
/// Weights of a row: up to four nodes on either side.
const WEIGHTS: usize = 8;

/// One contact of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    /// Whether it takes part.
    active: bool,
    /// Unit normal from the partner to the marker's body.
    normal: [f64; 2],
    /// Least normal velocity.
    bound: f64,
    /// 1/(H M⁻¹ Hᵀ), normal and tangential.
    stiffness: [f64; 2],
    /// Contact nodes (numbered through all bodies) and signed weights.
    nodes: [u32; WEIGHTS],
    weights: [f64; WEIGHTS],
    count: usize,
    /// Velocity of the partner if it is a wall.
    pub(super) wall_velocity: [f64; 2],
    /// Normal and tangential impulse.
    pub(super) impulse: [f64; 2],
}

impl Row {
    /// The impulse as a vector on the marker's body.
    pub(super) fn force(&self) -> [f64; 2] {
        let t = tangent(self.normal);
        [0, 1].map(|axis| self.impulse[0] * self.normal[axis] + self.impulse[1] * t[axis])
    }
}

/// Velocities and inverse masses of all contact nodes.
pub(super) struct Sweep {
    /// First contact node of each body.
    first: Vec<u32>,
    velocity: Vec<[f64; 2]>,
    /// 1/m by component, 0 for what is held at rest.
    yielding: Vec<[f64; 2]>,
    /// Rows that take part.
    active: Vec<u32>,
}

impl Sweep {
    pub(super) fn new(bodies: &[Body]) -> Self {
        let (mut first, mut yielding) = (Vec::new(), Vec::new());
        for body in bodies {
            first.push(yielding.len() as u32);
            for &node in &body.template.contact_nodes {
                let of = |axis: u32| {
                    if body.fixed.contains(&(2 * node + axis)) { 0.0 } else { 1.0 / body.mass[node as usize] }
                };
                yielding.push([of(0), of(1)]);
            }
        }
        Self { first, velocity: vec![[0.0; 2]; yielding.len()], yielding, active: Vec::new() }
    }

    pub(super) fn gather(&mut self, bodies: &[Body]) {
        let mut target = self.velocity.iter_mut();
        for body in bodies {
            for (&node, v) in body.template.contact_nodes.iter().zip(&mut target) {
                *v = [body.velocity[2 * node as usize], body.velocity[2 * node as usize + 1]];
            }
        }
    }

    pub(super) fn scatter(&self, bodies: &mut [Body]) {
        let mut source = self.velocity.iter();
        for body in bodies {
            for (&node, v) in body.template.contact_nodes.iter().zip(&mut source) {
                body.velocity[2 * node as usize..2 * node as usize + 2].copy_from_slice(v);
            }
        }
    }

    /// The row of a pair at the present positions; `time` is the step and its ratio to the last one.
    pub(super) fn prepare(
        &self,
        slot: &mut Slot,
        row: &mut Row,
        outlines: &[Outline],
        bodies: &[Body],
        walls: &[Wall],
        [dt, scale]: [f64; 2],
    ) {
        let own = slot.key.body as usize;
        let x = outlines[own].points[slot.key.marker as usize];
        row.count = 0;
        row.wall_velocity = [0.0; 2];
        row.active = true;
        let mut segment = None;
        let gap = match slot.key.partner {
            Partner::Wall(number) => {
                let wall = &walls[number as usize];
                (row.normal, row.wall_velocity) = (wall.normal, wall.velocity);
                (x[0] - wall.point[0]) * wall.normal[0] + (x[1] - wall.point[1]) * wall.normal[1]
            }
            Partner::Body(number) => {
                let other = &outlines[number as usize];
                slot.vertex = other.descend(x, slot.vertex as usize) as u32;
                let (start, share, normal, gap) = other.around(x, slot.vertex as usize);
                let facing = outlines[own].normals[slot.key.marker as usize];
                row.active = facing[0] * normal[0] + facing[1] * normal[1] < 0.0;
                (row.normal, segment) = (normal, Some((number as usize, start, share)));
                gap
            }
        };
        row.bound = if gap > 0.0 { -gap / dt } else { -RECOVERY * gap / dt };
        let body = &bodies[own];
        let near = NEAR * body.template.cell * body.size;
        if !row.active || gap > 10.0 * near {
            (row.active, row.impulse) = (false, [0.0; 2]);
            return;
        }
        self.add(row, own, &body.template.markers[slot.key.marker as usize].weights, 1.0);
        if let Some((number, start, share)) = segment {
            let markers = &bodies[number].template.markers;
            self.add(row, number, &markers[start].weights, share - 1.0);
            self.add(row, number, &markers[(start + 1) % markers.len()].weights, -share);
        }
        let u = self.relative(row);
        let closing = u[0] * row.normal[0] + u[1] * row.normal[1] < row.bound;
        if gap > near && !closing && slot.impulse[0] == 0.0 {
            (row.active, row.impulse) = (false, [0.0; 2]);
            return;
        }
        let t = tangent(row.normal);
        let mut flexibility = [0.0; 2];
        for (&node, &weight) in row.nodes.iter().zip(&row.weights).take(row.count) {
            let yielding = self.yielding[node as usize];
            for axis in 0..2 {
                flexibility[0] += weight * weight * row.normal[axis] * row.normal[axis] * yielding[axis];
                flexibility[1] += weight * weight * t[axis] * t[axis] * yielding[axis];
            }
        }
        row.stiffness = flexibility.map(|w| if w > 0.0 { 1.0 / w } else { 0.0 });
        row.impulse = slot.impulse.map(|p| p * scale);
    }

    /// Adds a marker's weights; nodes that are there already are not repeated.
    fn add(&self, row: &mut Row, body: usize, weights: &[(u32, f64)], share: f64) {
        for &(place, weight) in weights {
            let node = self.first[body] + place;
            let known = row.nodes[..row.count].iter().position(|&other| other == node);
            let at = known.unwrap_or(row.count);
            if known.is_none() {
                (row.nodes[at], row.weights[at]) = (node, 0.0);
                row.count += 1;
            }
            row.weights[at] += share * weight;
        }
    }

    /// Work of the impulses on the bodies, Σ m (v − v*)·½ (v₀ + v): v* is the velocity without contact, which the
    /// bodies still have, v₀ = v* − Δt (b − f/m) the one before the step.
    pub(super) fn work_on_bodies(
        &self,
        bodies: &[Body],
        forces: &[Vec<f64>],
        gravity: [f64; 2],
        dt: f64,
    ) -> f64 {
        let mut nodes = self.velocity.iter().zip(&self.yielding);
        let mut sum = 0.0;
        for (body, force) in bodies.iter().zip(forces) {
            for (&node, (new, yielding)) in body.template.contact_nodes.iter().zip(&mut nodes) {
                let mass = body.mass[node as usize];
                for axis in 0..2 {
                    let unknown = 2 * node as usize + axis;
                    let free = body.velocity[unknown];
                    if yielding[axis] > 0.0 && new[axis] != free {
                        let start = free - dt * (gravity[axis] - force[unknown] / mass);
                        sum += mass * (new[axis] - free) * 0.5 * (start + new[axis]);
                    }
                }
            }
        }
        sum
    }

    #[inline]
    fn relative(&self, row: &Row) -> [f64; 2] {
        let mut u = row.wall_velocity.map(|v| -v);
        for (&node, &weight) in row.nodes.iter().zip(&row.weights).take(row.count) {
            let v = self.velocity[node as usize];
            u[0] += weight * v[0];
            u[1] += weight * v[1];
        }
        u
    }

    /// Tangential velocity of a row.
    pub(super) fn tangential(&self, row: &Row) -> f64 {
        let (u, t) = (self.relative(row), tangent(row.normal));
        u[0] * t[0] + u[1] * t[1]
    }

    #[inline]
    fn push(&mut self, row: &Row, p: [f64; 2]) {
        for (&node, &weight) in row.nodes.iter().zip(&row.weights).take(row.count) {
            let yielding = self.yielding[node as usize];
            let v = &mut self.velocity[node as usize];
            v[0] += weight * yielding[0] * p[0];
            v[1] += weight * yielding[1] * p[1];
        }
    }

    /// Sweeps until the impulses stand still; returns the number of sweeps.
    pub(super) fn solve(&mut self, rows: &mut [Row], friction: f64, numerics: &Numerics) -> usize {
        let mut active = std::mem::take(&mut self.active);
        active.clear();
        active.extend((0..rows.len() as u32).filter(|&row| rows[row as usize].active));
        for &row in &active {
            let row = &rows[row as usize];
            self.push(row, row.force());
        }
        let mut sweeps = 0;
        while sweeps < numerics.explicit_sweeps {
            let (mut change, mut sum) = (0.0, 0.0);
            for &row in &active {
                let row = &mut rows[row as usize];
                let u = self.relative(row);
                let (n, t) = (row.normal, tangent(row.normal));
                let normal = u[0] * n[0] + u[1] * n[1];
                let p = (row.impulse[0] - (normal - row.bound) * row.stiffness[0]).max(0.0);
                let mut delta = [p - row.impulse[0], 0.0];
                if friction > 0.0 {
                    let along = u[0] * t[0] + u[1] * t[1];
                    let most = friction * p;
                    let q = (row.impulse[1] - along * row.stiffness[1]).clamp(-most, most);
                    delta[1] = q - row.impulse[1];
                    row.impulse[1] = q;
                }
                row.impulse[0] = p;
                if delta != [0.0; 2] {
                    self.push(row, [delta[0] * n[0] + delta[1] * t[0], delta[0] * n[1] + delta[1] * t[1]]);
                }
                change += delta[0].abs() + delta[1].abs();
                sum += p;
            }
            sweeps += 1;
            if change <= numerics.explicit_impulse * sum {
                break;
            }
        }
        self.active = active;
        sweeps
    }
}
