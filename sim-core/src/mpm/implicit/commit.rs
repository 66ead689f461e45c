//! The end of a converged step: the state is taken over, impulses and energies are booked.
//!
//! With v̄ = θ vⁿ⁺¹ + (1 − θ) vⁿ = Δu/Δt the residual times v̄ Δt is the balance of energy, term by term: wall work and
//! gravity = change of kinetic energy + ½ (fⁿ + fⁿ⁺¹)·Δu + (θ − ½)(Δv·M Δv + Δf·Δu) + friction + contact loss.

use super::{Implicit, Work, gather_contact};
use crate::mpm::body::Body;
use crate::mpm::constitutive::Hardening;
use crate::mpm::contact::rows::tangent;
use crate::mpm::contact::{Partner, Wall};
use crate::mpm::element::{add_ghost_force, force_of_state};
use crate::mpm::world::{Energies, World};

impl Implicit {
    /// Takes over the converged state.
    pub(super) fn commit(&mut self, world: &mut World, walls: Vec<Wall>, dt: f64) {
        let World { law, acceleration, numerics, energies, bodies, .. } = world;
        let theta = numerics.theta;
        for ((work, body), contact) in self.work.iter_mut().zip(bodies).zip(&mut self.contact_velocity) {
            if let Some(hardening) = law.material.plasticity {
                energies.plastic += plastic_dissipation(work, body, hardening);
            }
            // the velocity that contact power is counted with
            for (mean, (new, old)) in work.free.iter_mut().zip(work.velocity.iter().zip(&body.velocity)) {
                *mean = theta * new + (1.0 - theta) * old;
            }
            gather_contact(body, &work.free, contact);
            std::mem::swap(&mut body.points, &mut work.trial);
            force_of_state(body, &mut work.force);
            add_ghost_force(body, &work.displacement, law, &mut work.force);
            work_of_the_step(work, body, *acceleration, theta, energies);
            std::mem::swap(&mut work.force, &mut work.start_force);
            body.displacement.copy_from_slice(&work.displacement);
            body.velocity.copy_from_slice(&work.velocity);
        }
        world.impulses.clear();
        world.normals.clear();
        for row in self.rows.rows.iter().filter(|row| row.impulse != [0.0; 2]) {
            let (n, t) = (row.normal, tangent(row.normal));
            let u = self.rows.relative(row, &self.contact_velocity);
            let u = [0, 1].map(|axis| u[axis] - row.wall_velocity[axis]);
            world.energies.contact -= row.impulse[0] * (u[0] * n[0] + u[1] * n[1]);
            world.energies.friction -= row.impulse[1] * (u[0] * t[0] + u[1] * t[1]);
            *world.network.entry((row.key.body, row.key.partner)).or_insert(0.0) += row.impulse[0];
            if let Partner::Wall(number) = row.key.partner {
                world.wall_impulse[number as usize] += row.impulse[0];
                let p = [0, 1].map(|i| row.impulse[0] * n[i] + row.impulse[1] * t[i]);
                world.energies.work += p[0] * row.wall_velocity[0] + p[1] * row.wall_velocity[1];
            }
            world.impulses.push((row.key, row.impulse));
            world.normals.push(row.normal);
        }
        world.walls = walls;
        world.last_dt = dt;
        world.time += dt;
        world.effort.substeps += 1;
    }
}

/// Σ V q Δε_p.
fn plastic_dissipation(work: &Work, body: &Body, hardening: Hardening) -> f64 {
    let area = body.size * body.size;
    let mut sum = 0.0;
    for (p, (new, old)) in work.trial.plastic.iter().zip(&body.points.plastic).enumerate() {
        let flow = new - old;
        if flow > 0.0 {
            let volume = work.trial.gradient[p].det() * body.template.volumes[p] * area;
            sum += volume * (hardening.yield_stress + hardening.modulus * new) * flow;
        }
    }
    sum
}

/// Work of gravity and of the stresses, and what the integrator takes.
fn work_of_the_step(work: &Work, body: &Body, gravity: [f64; 2], theta: f64, energies: &mut Energies) {
    let (mut weight, mut internal, mut numerical) = (0.0, 0.0, 0.0);
    for unknown in 0..work.displacement.len() {
        let mass = body.mass[unknown / 2];
        let moved = work.displacement[unknown] - body.displacement[unknown];
        let faster = work.velocity[unknown] - body.velocity[unknown];
        let (before, after) = (work.start_force[unknown], work.force[unknown]);
        weight += mass * gravity[unknown % 2] * moved;
        internal += 0.5 * (before + after) * moved;
        numerical += (theta - 0.5) * (mass * faster * faster + (after - before) * moved);
    }
    energies.work += weight;
    energies.internal += internal;
    energies.numerical += numerical;
}
