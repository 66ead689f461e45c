//! Implicit step: Newton's method on the end-of-step velocities with the contact problem solved inside each iteration.
//!
//! R(v) = M (v − vⁿ) + Δt [θ f(uⁿ⁺¹) + (1 − θ) f(uⁿ) − M b] − Hᵀ p, uⁿ⁺¹ = uⁿ + Δt (θ v + (1 − θ) vⁿ). The matrix
//! A = M + θ² Δt² K couples no two bodies: each has its own factor, and contact sees it through the compliance of the
//! body's boundary.

mod accelerate;
mod commit;
mod errors;

use rayon::prelude::*;

use super::body::{Body, Points};
use super::contact::detect::{Outline, candidates};
use super::contact::gauss_seidel::{self, Tolerance};
use super::contact::nodes;
use super::contact::rows::Rows;
use super::contact::{Candidate, ContactKind, Key, Partner, Wall};
use super::element::{Law, add_ghost_force, force_of_state, internal_force, internal_force_and_tangent};
use super::failure::Failure;
use super::skyline::Skyline;
use super::template::OUT_OF_REACH;
use super::updated;
use super::world::World;
use accelerate::Accelerator;

/// Residual ratio of two iterations above which old factors are given up.
const SLOW: f64 = 0.5;

/// Mass factor of an unknown held at rest: its response is below round-off.
const RIGID: f64 = 1e30;

/// Scratch space of one body.
struct Work {
    velocity: Vec<f64>,
    free: Vec<f64>,
    /// What the last iteration changed of `velocity`.
    change: Vec<f64>,
    displacement: Vec<f64>,
    /// Internal force at the start of the step.
    start_force: Vec<f64>,
    force: Vec<f64>,
    residual: Vec<f64>,
    trial: Points,
    matrix: Skyline,
    scratch: Vec<f64>,
    /// Whether the next linearisation makes a new matrix.
    fresh: bool,
    /// Norm of the residual, contact included, in this iteration and the one before.
    left: [f64; 2],
}

/// Solver with its scratch space; holds nothing that a run depends on.
pub struct Implicit {
    work: Vec<Work>,
    outlines: Vec<Outline>,
    candidates: Vec<Vec<Candidate>>,
    rows: Rows,
    compliance: Vec<Vec<f64>>,
    contact_velocity: Vec<Vec<f64>>,
    contact_impulse: Vec<Vec<f64>>,
    sizes: Vec<usize>,
    accelerator: Accelerator,
}

impl Implicit {
    /// Scratch space for a world.
    #[must_use]
    pub fn new(world: &World) -> Self {
        let work = world.bodies.iter().map(|body| Work::new(body, &world.law)).collect();
        let sizes: Vec<usize> =
            world.bodies.iter().map(|body| body.template.profile.contact_size()).collect();
        let n = world.bodies.len();
        Self {
            work,
            outlines: vec![Outline::default(); n],
            candidates: vec![Vec::new(); n],
            rows: Rows::default(),
            compliance: vec![Vec::new(); n],
            contact_velocity: sizes.iter().map(|&size| vec![0.0; size]).collect(),
            contact_impulse: sizes.iter().map(|&size| vec![0.0; size]).collect(),
            sizes,
            accelerator: Accelerator::default(),
        }
    }

    /// One step of `dt`, in halves, quarters, … where it does not converge at once.
    ///
    /// # Errors
    /// The [`Failure`] of the shortest step tried; the world is then at the last converged time.
    pub fn step(&mut self, world: &mut World, dt: f64) -> Result<(), Failure> {
        // a binary clock of substeps: `level` is the present halving, `done` the share of the step that is behind
        let (mut level, mut done) = (start_level(world, dt), 0_u64);
        let whole = 1_u64 << world.numerics.halvings;
        while done < whole {
            match self.attempt(world, dt / (1_u64 << level) as f64) {
                Ok(()) => {
                    done += whole >> level;
                    if level > 0 && done.is_multiple_of(whole >> (level - 1)) {
                        level -= 1;
                    }
                }
                Err(failure) if level == world.numerics.halvings => return Err(failure),
                Err(_) => {
                    level += 1;
                    world.effort.halved += 1;
                }
            }
        }
        Ok(())
    }

    fn attempt(&mut self, world: &mut World, dt: f64) -> Result<(), Failure> {
        let numerics = world.numerics;
        let advance = numerics.theta * dt;
        let walls: Vec<Wall> = world
            .walls
            .iter()
            .map(|wall| Wall { point: [0, 1].map(|i| wall.point[i] + dt * wall.velocity[i]), ..*wall })
            .collect();
        // impulses of the last step, scaled to this one, are the first guess
        let scale = if world.last_dt > 0.0 { dt / world.last_dt } else { 0.0 };
        let mut warm: Vec<(Key, [f64; 2])> =
            world.impulses.iter().map(|&(key, p)| (key, p.map(|one| one * scale))).collect();
        for (work, body) in self.work.iter_mut().zip(&world.bodies) {
            work.velocity.copy_from_slice(&body.velocity);
            work.fresh = true;
            work.left = [f64::INFINITY; 2];
        }
        self.accelerator.clear();
        let cell = world.bodies.iter().map(|body| body.template.cell * body.size).fold(f64::MAX, f64::min);
        let mut worst = (f64::INFINITY, f64::INFINITY);
        let mut accelerated = false;
        for iteration in 0..=numerics.iterations {
            self.linearise(world, dt, |_| true)?;
            self.detect(world, &walls, 0.3 * cell, advance)?;
            self.rows.build(&self.candidates, &world.bodies, &walls, &warm, world.contact);
            let (residual, gap) = self.errors(world, dt, cell);
            let slow = residual > SLOW * worst.0;
            worst = (residual, gap);
            if iteration > 0 && residual <= numerics.residual && gap <= numerics.gap {
                world.effort.newton += iteration as u64;
                self.commit(world, walls, dt);
                self.regrid(world);
                return Ok(());
            }
            if iteration == numerics.iterations {
                break;
            }
            // the factors of the second iterate serve the later ones while they do their work: what is left to find then
            // are contact normals
            if iteration >= 2 && slow {
                self.renew(0.1 * residual);
                self.linearise(world, dt, |work| work.fresh)?;
            }
            self.factorise(world)?;
            self.release(world);
            self.work.iter_mut().for_each(|work| work.fresh = iteration == 0);
            self.bound(world, advance);
            gauss_seidel::prepare(&mut self.rows, &self.compliance, &self.sizes, world.friction);
            for ((contact, work), body) in self.contact_velocity.iter_mut().zip(&self.work).zip(&world.bodies)
            {
                gather_contact(body, &work.free, contact);
            }
            // far from the solution the contact problem need not be solved further than the next iterate is wrong
            let impulse = (0.03 * residual).clamp(numerics.impulse, 1e-3);
            let tolerance = Tolerance { impulse, sweeps: numerics.sweeps };
            let solve = gauss_seidel::solve(
                &mut self.rows,
                &mut self.contact_velocity,
                &self.sizes,
                world.friction,
                tolerance,
            );
            world.effort.sweeps += solve.sweeps as u64;
            let limit = 0.5 * cell / dt;
            self.correct(world, limit);
            self.accelerator.remember(&self.work);
            accelerated = slow && iteration >= 2 && !accelerated && {
                self.accelerator.apply(&mut self.work, &world.bodies, limit)
            };
            warm = self.rows.rows.iter().map(|row| (row.key, row.impulse)).collect();
        }
        world.effort.newton += numerics.iterations as u64;
        Err(Failure::Residual { residual: worst.0, gap: worst.1 })
    }

    /// Forces of some bodies at the present velocities, and new matrices where these are due.
    fn linearise(
        &mut self,
        world: &World,
        dt: f64,
        of: impl Fn(&Work) -> bool + Sync,
    ) -> Result<(), Failure> {
        let (law, theta, gravity): (Law, _, _) = (world.law, world.numerics.theta, world.acceleration);
        let all = self.work.par_iter_mut().zip(&world.bodies).enumerate();
        collect(all.filter(|(_, (work, _))| of(work)).map(|(number, (work, body))| {
            let motion = work.velocity.iter().zip(&body.velocity).zip(&body.displacement);
            for (u, ((v, v0), u0)) in work.displacement.iter_mut().zip(motion) {
                *u = u0 + dt * (theta * v + (1.0 - theta) * v0);
            }
            let (trial, force) = (&mut work.trial, &mut work.force);
            let done = if work.fresh {
                work.matrix.clear();
                let factor = theta * theta * dt * dt;
                internal_force_and_tangent(
                    body,
                    &work.displacement,
                    &law,
                    trial,
                    force,
                    factor,
                    &mut work.matrix,
                )
            } else {
                internal_force(body, &work.displacement, &law, trial, force)
            };
            done.map_err(|_| Failure::Inverted { body: number })?;
            for (unknown, residual) in work.residual.iter_mut().enumerate() {
                let mass = body.mass[unknown / 2];
                let force = theta * work.force[unknown] + (1.0 - theta) * work.start_force[unknown];
                *residual = mass * (work.velocity[unknown] - body.velocity[unknown])
                    + dt * (force - mass * gravity[unknown % 2]);
            }
            body.fixed.iter().for_each(|&unknown| work.residual[unknown as usize] = 0.0);
            Ok(())
        }))
    }

    /// New grids for bodies whose grid lasts for one step.
    fn regrid(&mut self, world: &mut World) {
        if world.bodies.iter().all(|body| body.cloud.is_none()) {
            return;
        }
        world.bodies.par_iter_mut().for_each(updated::carry);
        updated::regrid(world);
        let law = &world.law;
        self.work
            .par_iter_mut()
            .zip(&world.bodies)
            .filter(|(_, body)| body.cloud.is_some())
            .for_each(|(work, body)| *work = Work::new(body, law));
        for (number, body) in world.bodies.iter().enumerate() {
            let size = body.template.profile.contact_size();
            self.sizes[number] = size;
            self.contact_velocity[number].resize(size, 0.0);
            self.contact_impulse[number].resize(size, 0.0);
        }
    }

    /// Candidate contacts at the present velocities.
    fn detect(&mut self, world: &World, walls: &[Wall], range: f64, advance: f64) -> Result<(), Failure> {
        if world.contact == ContactKind::CommonMesh {
            let velocities: Vec<&[f64]> = self.work.iter().map(|work| work.velocity.as_slice()).collect();
            let lists = self.candidates.par_iter_mut().enumerate();
            lists.for_each(|(body, list)| nodes::candidates(body, world, &velocities, advance, list));
            return Ok(());
        }
        let shapes = self.outlines.par_iter_mut().zip(&world.bodies).zip(&self.work);
        shapes.for_each(|((outline, body), work)| {
            body.outline_at(&work.displacement, &mut outline.points);
            outline.refresh();
        });
        let outlines = &self.outlines;
        self.candidates
            .par_iter_mut()
            .enumerate()
            .for_each(|(body, list)| candidates(body, outlines, walls, range, list));
        if world.bodies.iter().all(|body| body.cloud.is_none()) {
            return Ok(());
        }
        let beyond =
            self.candidates.iter().flatten().find_map(|candidate| beyond_reach(candidate, &world.bodies));
        beyond.map_or(Ok(()), |body| Err(Failure::OutOfReach { body }))
    }

    /// Factors and boundary compliances of the new matrices.
    fn factorise(&mut self, world: &World) -> Result<(), Failure> {
        let all = self.work.par_iter_mut().zip(&world.bodies).zip(&mut self.compliance).enumerate();
        collect(all.filter(|(_, ((work, _), _))| work.fresh).map(|(number, ((work, body), compliance))| {
            let profile = &body.template.profile;
            for (unknown, mass) in body.mass.iter().flat_map(|mass| [mass, mass]).enumerate() {
                work.matrix.add(profile.entry(unknown, unknown), *mass);
            }
            // a node that no point reaches has no mass of its own
            let least = 1e-6 * body.area * world.law.material.density;
            for &unknown in &body.fixed {
                let unknown = unknown as usize;
                work.matrix.add(profile.entry(unknown, unknown), RIGID * body.mass[unknown / 2].max(least));
            }
            work.matrix.factorise(profile).map_err(|_| Failure::Indefinite { body: number })?;
            work.matrix.contact_compliance(profile, compliance);
            Ok(())
        }))
    }

    /// The velocities without contact.
    fn release(&mut self, world: &World) {
        let all = self.work.par_iter_mut().zip(&world.bodies);
        all.for_each(|(work, body)| {
            let profile = &body.template.profile;
            work.free.copy_from_slice(&work.residual);
            work.matrix.solve(profile, &mut work.free, &mut work.scratch);
            for (free, v) in work.free.iter_mut().zip(&work.velocity) {
                *free = v - *free;
            }
        });
    }

    /// Bounds of the normal velocities: the gap at the end of the step stays open.
    fn bound(&mut self, world: &World, advance: f64) {
        for ((contact, work), body) in self.contact_velocity.iter_mut().zip(&self.work).zip(&world.bodies) {
            gather_contact(body, &work.velocity, contact);
        }
        let mut rows = std::mem::take(&mut self.rows.rows);
        for (row, candidate) in rows.iter_mut().zip(self.candidates.iter().flatten()) {
            let u = self.rows.relative(row, &self.contact_velocity);
            row.bound = u[0] * row.normal[0] + u[1] * row.normal[1] - candidate.gap / advance;
        }
        self.rows.rows = rows;
    }

    /// New velocities from the impulses, no node moving by more than half a cell relative to the last iterate.
    fn correct(&mut self, world: &World, limit: f64) {
        self.contact_impulse.iter_mut().for_each(|vector| vector.fill(0.0));
        self.rows.scatter(&mut self.contact_impulse);
        let all = self.work.par_iter_mut().zip(&world.bodies).zip(&self.contact_impulse);
        let most: Vec<f64> = all
            .map(|((work, body), impulse)| {
                let profile = &body.template.profile;
                let inner = profile.size() - profile.contact_size();
                work.scratch.clear();
                work.scratch.resize(profile.size(), 0.0);
                work.scratch[inner..].copy_from_slice(impulse);
                work.matrix.solve_rows(profile, &mut work.scratch);
                let mut most = 0.0_f64;
                for (unknown, free) in work.free.iter_mut().enumerate() {
                    *free += work.scratch[profile.row_of(unknown)];
                    most = most.max((*free - work.velocity[unknown]).abs());
                }
                most
            })
            .collect();
        let share = (limit / most.into_iter().fold(limit, f64::max)).min(1.0);
        for work in &mut self.work {
            for ((v, new), change) in work.velocity.iter_mut().zip(&work.free).zip(&mut work.change) {
                *change = share * (new - *v);
                *v += *change;
            }
        }
    }
}

impl Work {
    fn new(body: &Body, law: &Law) -> Self {
        let n = body.displacement.len();
        let zero = || vec![0.0; n];
        let mut start_force = zero();
        force_of_state(body, &mut start_force);
        add_ghost_force(body, &body.displacement, law, &mut start_force);
        Self {
            velocity: zero(),
            free: zero(),
            change: zero(),
            displacement: zero(),
            start_force,
            force: zero(),
            residual: zero(),
            trial: body.points.clone(),
            matrix: Skyline::zero(&body.template.profile),
            scratch: zero(),
            fresh: true,
            left: [f64::INFINITY; 2],
        }
    }
}

/// The body, if any, that a candidate would act on where its factor has no contact rows.
fn beyond_reach(candidate: &Candidate, bodies: &[Body]) -> Option<usize> {
    let own = candidate.key.body as usize;
    if !bodies[own].template.reaches(candidate.key.marker) {
        return Some(own);
    }
    let Partner::Body(other) = candidate.key.partner else { return None };
    let template = &bodies[other as usize].template;
    let next = (candidate.segment + 1) % template.markers.len() as u32;
    let both = template.reaches(candidate.segment) && template.reaches(next);
    (!both).then_some(other as usize)
}

/// Halvings a step may begin with.
const FIRST_HALVINGS: u32 = 2;

/// Halving that a step begins with: one less than the last step ended with. Where contacts form and break, the whole
/// step would fail again and again. Few at the most: after a much shorter step (the caller's, not a halved one) the
/// shortest substeps are the hardest, inertia being all there is in their residual.
fn start_level(world: &World, dt: f64) -> u32 {
    let mut level = 0;
    while level < FIRST_HALVINGS.min(world.numerics.halvings)
        && world.last_dt > 0.0
        && world.last_dt < 0.3 * dt / f64::from(1_u32 << level)
    {
        level += 1;
    }
    level
}

/// The values of the contact unknowns in the order of their rows.
fn gather_contact(body: &Body, values: &[f64], out: &mut [f64]) {
    let rows = body.template.contact_nodes.iter().zip(&body.template.contact_rows);
    for (&node, &row) in rows.filter(|(_, row)| **row != OUT_OF_REACH) {
        out[row as usize] = values[2 * node as usize];
        out[row as usize + 1] = values[2 * node as usize + 1];
    }
}

/// The first failure in the order of the bodies, whichever thread met it first.
fn collect(results: impl ParallelIterator<Item = Result<(), Failure>>) -> Result<(), Failure> {
    results.collect::<Vec<_>>().into_iter().collect()
}
