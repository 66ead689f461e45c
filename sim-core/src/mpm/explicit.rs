//! Explicit step: symplectic Euler on lumped masses, contact impulses by the same Signorini and Coulomb laws as in the
//! implicit step, with the masses of the outline nodes in place of the tangent.
//!
//! vⁿ⁺¹ = vⁿ + Δt (b − f(σⁿ)/m) + Hᵀp/m, uⁿ⁺¹ = uⁿ + Δt vⁿ⁺¹, then the stresses at uⁿ⁺¹. Δt is bounded by
//! [`bound::time_step`]. What is not rigid motion of a body decays at [`DAMPING`] c_S/R: a disc struck by a wall rings
//! for ever otherwise, while backward Euler damps such waves by its own error.

pub mod bound;
mod slots;
mod sweep;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::body::Body;
use super::contact::detect::Outline;
use super::contact::{Partner, Wall};
use super::element::{advance_points, force_of_state};
use super::failure::Failure;
use super::world::World;
use bound::Bound;
pub use slots::{Slot, flush};
use sweep::{Row, Sweep};

/// Decay rate of the motion that is not rigid, in c_S/R of the body: a tenth of critical for the slowest mode of a free
/// disc. A disc that deforms at the speed v feels a stress of about 0.1 ρ c_S v: 0.3 % of the stress of the single disc
/// at a strain of 0.05 for a wall at 0.1 m/s.
pub const DAMPING: f64 = 0.4;

/// What the explicit step remembers of contacts from one step to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Pairs of marker and partner that may touch, sorted by key.
    pub slots: Vec<Slot>,
    /// How far a marker may still move towards its partner before pairs are looked for again [length].
    pub reach: f64,
}

/// Solver with its scratch space; holds nothing that a run depends on.
pub struct Explicit {
    forces: Vec<Vec<f64>>,
    outlines: Vec<Outline>,
    rows: Vec<Row>,
    sweep: Sweep,
    bound: Bound,
}

impl Explicit {
    /// Scratch space for a world, and the forces of its state.
    #[must_use]
    pub fn new(world: &World) -> Self {
        let forces = world.bodies.iter().map(|body| {
            let mut force = vec![0.0; body.displacement.len()];
            force_of_state(body, &mut force);
            force
        });
        Self {
            forces: forces.collect(),
            outlines: vec![Outline::default(); world.bodies.len()],
            rows: Vec::new(),
            sweep: Sweep::new(&world.bodies),
            bound: Bound::new(world),
        }
    }

    /// The largest stable step of the present state.
    #[must_use]
    pub fn time_step(&self, world: &World) -> f64 {
        self.bound.time_step(world)
    }

    /// One step.
    ///
    /// # Errors
    /// [`Failure::Inverted`] when a point was crushed; the world is then void.
    pub fn step(&mut self, world: &mut World, dt: f64) -> Result<(), Failure> {
        self.outline(world);
        if world.memory.reach <= 0.0 {
            slots::renew(world, &self.outlines);
        }
        self.accelerate(world, dt);
        self.touch(world, dt);
        self.advance(world, dt)
    }

    fn outline(&mut self, world: &World) {
        self.outlines.par_iter_mut().zip(&world.bodies).for_each(|(outline, body)| {
            body.outline_at(&body.displacement, &mut outline.points);
            outline.refresh();
        });
    }

    /// Velocities without contact.
    fn accelerate(&mut self, world: &mut World, dt: f64) {
        let gravity = world.acceleration;
        let material = &world.law.material;
        let shear_speed = (material.shear() / material.density).sqrt();
        let all = world.bodies.par_iter_mut().zip(&self.forces);
        let done: Vec<[f64; 3]> = all
            .map(|(body, force)| {
                let keep = 1.0 - (world.damping * dt * shear_speed / body.size).min(1.0);
                let lost = if keep < 1.0 { damp(body, keep) } else { 0.0 };
                let [work, internal] = half_power(body, force, gravity);
                let nodes = body.velocity.as_chunks_mut::<2>().0.iter_mut().zip(force.as_chunks::<2>().0);
                for ((v, f), mass) in nodes.zip(&body.mass) {
                    for axis in 0..2 {
                        v[axis] += dt * (gravity[axis] - f[axis] / mass);
                    }
                }
                body.fixed.iter().for_each(|&unknown| body.velocity[unknown as usize] = 0.0);
                [lost, dt * work, dt * internal]
            })
            .collect();
        for [lost, work, internal] in done {
            world.energies.damping += lost;
            world.energies.work += work;
            world.energies.internal += internal;
        }
    }

    /// Contact impulses.
    fn touch(&mut self, world: &mut World, dt: f64) {
        let World { bodies, walls, memory, friction, numerics, last_dt, .. } = world;
        if memory.slots.is_empty() {
            return;
        }
        let scale = if *last_dt > 0.0 { dt / *last_dt } else { 0.0 };
        self.sweep.gather(bodies);
        self.rows.resize_with(memory.slots.len(), Row::default);
        let (outlines, sweep, friction) = (&self.outlines, &self.sweep, *friction);
        let pairs = memory.slots.par_iter_mut().zip(&mut self.rows).with_min_len(256);
        pairs.for_each(|(slot, row)| sweep.prepare(slot, row, outlines, bodies, walls, [dt, scale]));
        let sweeps = self.sweep.solve(&mut self.rows, friction, numerics);
        let gained = self.sweep.work_on_bodies(bodies, &self.forces, world.acceleration, dt);
        world.effort.sweeps += sweeps as u64;
        self.sweep.scatter(&mut world.bodies);
        let (mut by_walls, mut rubbed) = (0.0, 0.0);
        for (slot, row) in world.memory.slots.iter_mut().zip(&self.rows) {
            slot.impulse = row.impulse;
            if row.impulse == [0.0; 2] {
                continue;
            }
            slot.total += row.impulse[0];
            if friction > 0.0 {
                rubbed -= row.impulse[1] * self.sweep.tangential(row);
            }
            if let Partner::Wall(number) = slot.key.partner {
                world.wall_impulse[number as usize] += row.impulse[0];
                let p = row.force();
                by_walls += p[0] * row.wall_velocity[0] + p[1] * row.wall_velocity[1];
            }
        }
        world.energies.work += by_walls;
        world.energies.friction += rubbed;
        world.energies.contact += by_walls - rubbed - gained;
    }

    /// Displacements, walls and stresses.
    fn advance(&mut self, world: &mut World, dt: f64) -> Result<(), Failure> {
        let (law, gravity) = (world.law, world.acceleration);
        let all = world.bodies.par_iter_mut().zip(&mut self.forces).enumerate();
        let done: Vec<Result<[f64; 4], Failure>> = all
            .map(|(number, (body, force))| {
                let [work, internal] = half_power(body, force, gravity);
                let mut fastest = 0.0_f64;
                let nodes = body.displacement.as_chunks_mut::<2>().0.iter_mut();
                for (u, v) in nodes.zip(body.velocity.as_chunks::<2>().0) {
                    fastest = fastest.max(v[0] * v[0] + v[1] * v[1]);
                    for axis in 0..2 {
                        u[axis] += dt * v[axis];
                    }
                }
                let dissipated =
                    advance_points(body, &law, force).map_err(|_| Failure::Inverted { body: number })?;
                Ok([fastest, dt * work, dt * internal, dissipated])
            })
            .collect();
        let mut fastest = 0.0_f64;
        for one in done {
            let [speed, work, internal, dissipated] = one?;
            fastest = fastest.max(speed);
            world.energies.work += work;
            world.energies.internal += internal;
            world.energies.plastic += dissipated;
        }
        let of_wall = |wall: &Wall| wall.velocity[0].abs() + wall.velocity[1].abs();
        let wall = world.walls.iter().map(of_wall).fold(0.0, f64::max);
        let fastest = fastest.sqrt();
        world.memory.reach -= dt * (fastest + fastest.max(wall));
        for wall in &mut world.walls {
            wall.point = [0, 1].map(|axis| wall.point[axis] + dt * wall.velocity[axis]);
        }
        world.last_dt = dt;
        world.time += dt;
        world.effort.substeps += 1;
        Ok(())
    }
}

/// Half the power of gravity and of the stresses at the present velocity: with the velocities before and after a step
/// both halves make the power at its middle, and the balance of kinetic energy closes to round-off.
fn half_power(body: &Body, force: &[f64], gravity: [f64; 2]) -> [f64; 2] {
    let (mut weight, mut internal) = (0.0, 0.0);
    let nodes = body.velocity.as_chunks::<2>().0.iter().zip(force.as_chunks::<2>().0);
    for ((v, f), mass) in nodes.zip(&body.mass) {
        for axis in 0..2 {
            weight += 0.5 * mass * gravity[axis] * v[axis];
            internal += 0.5 * f[axis] * v[axis];
        }
    }
    [weight, internal]
}

/// Scales what is not rigid motion of the body by `keep`; returns the kinetic energy this takes. Momentum and angular
/// momentum stay.
fn damp(body: &mut Body, keep: f64) -> f64 {
    let (mut mass, mut centre, mut momentum) = (0.0, [0.0; 2], [0.0; 2]);
    let at = |body: &Body, node: usize| {
        let reference = body.reference(node);
        [0, 1].map(|axis| reference[axis] + body.displacement[2 * node + axis])
    };
    for (node, m) in body.mass.iter().enumerate() {
        let x = at(body, node);
        mass += m;
        for axis in 0..2 {
            centre[axis] += m * x[axis];
            momentum[axis] += m * body.velocity[2 * node + axis];
        }
    }
    let (centre, drift) = (centre.map(|c| c / mass), momentum.map(|p| p / mass));
    let (mut inertia, mut spin) = (0.0, 0.0);
    for (node, m) in body.mass.iter().enumerate() {
        let x = at(body, node);
        let r = [x[0] - centre[0], x[1] - centre[1]];
        inertia += m * (r[0] * r[0] + r[1] * r[1]);
        spin += m * (r[0] * body.velocity[2 * node + 1] - r[1] * body.velocity[2 * node]);
    }
    let spin = if body.fixed.is_empty() { spin / inertia } else { 0.0 };
    let mut lost = 0.0;
    for node in 0..body.mass.len() {
        let x = at(body, node);
        let rigid = [drift[0] - spin * (x[1] - centre[1]), drift[1] + spin * (x[0] - centre[0])];
        for axis in 0..2 {
            let v = body.velocity[2 * node + axis];
            let new = rigid[axis] + keep * (v - rigid[axis]);
            lost += 0.5 * body.mass[node] * (v * v - new * new);
            body.velocity[2 * node + axis] = new;
        }
    }
    lost
}
