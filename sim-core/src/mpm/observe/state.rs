//! One recorded state of the loading path.

use std::collections::VecDeque;

use record::{NotFinite, Row};
use serde::{Deserialize, Serialize};

use super::curvature;
use super::network::{Contact, Coordination, Impulses, contacts, coordination};
use crate::mpm::contact::detect::Outline;
use crate::mpm::contact::{ContactKind, Partner};
use crate::mpm::setup::{BOTTOM, LEFT, TOP};
use crate::mpm::world::World;

/// Wall impulses at an instant, from which forces over a window follow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Time [d √(ρ/E)].
    pub time: f64,
    /// Impulse on each wall since the start.
    pub impulse: Vec<f64>,
}

/// Everything measured at one instant, in reduced units; stresses in E.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Steps done.
    pub step: u64,
    /// Time [d √(ρ/E)].
    pub time: f64,
    /// Nominal strain 1 − h/h_i.
    pub strain: f64,
    /// Solid fraction by Σ V_p.
    pub phi: f64,
    /// Solid fraction by the area of the outlines.
    pub phi_outline: f64,
    /// Solid fraction by undeformed areas.
    pub phi_undeformed: f64,
    /// Bottom wall stress F/L_x, over the window.
    pub sigma: f64,
    /// Top wall stress, over the window.
    pub sigma_top: f64,
    /// Mean side wall stress F/h, over the window.
    pub sigma_side: f64,
    /// Volume-average −σ_yy.
    pub sigma_volume: f64,
    /// Force over the width of the contact zone of the bottom wall.
    pub sigma_contact: f64,
    /// −σ_yy of the point nearest to the centre of the first body.
    pub sigma_centre: f64,
    /// Z without rattlers.
    pub z: f64,
    /// Z over all discs.
    pub z_all: f64,
    /// Z over discs with at least three contacts.
    pub z_three: f64,
    /// Share of rattlers.
    pub rattlers: f64,
    /// Mean over the discs of their largest curvature, times the mean diameter.
    pub kappa_d: f64,
    /// The same with a window twice as wide: the sensitivity to the resolution.
    pub kappa_d_wide: f64,
    /// Plastic volume fraction, ε_p > 10⁻⁶.
    pub f_p: f64,
    /// Plastic volume fraction, ε_p > 10⁻³.
    pub f_p_wide: f64,
    /// Volume fraction that is yielding: q within 10⁻⁶ of the yield stress.
    pub yielding: f64,
    /// Area over undeformed area.
    pub area_ratio: f64,
    /// Largest width over the largest diameter.
    pub width_ratio: f64,
    /// Work of the walls.
    pub work: f64,
    /// Elastic energy.
    pub elastic: f64,
    /// Plastic dissipation.
    pub plastic: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Work against friction.
    pub friction: f64,
    /// Loss as contacts close.
    pub contact: f64,
    /// What the integrator takes: backward Euler's own dissipation, or the damping of the explicit step.
    pub numerical: f64,
    /// Worst overlap of an outline with a wall, in cells.
    pub overlap: f64,
}

/// What a state is measured from.
pub struct View<'a> {
    /// The world.
    pub world: &'a World,
    /// Width of the box.
    pub width: f64,
    /// Height before compression.
    pub height: f64,
    /// Earlier marks, oldest first.
    pub marks: &'a VecDeque<Mark>,
    /// Window of the wall forces; 0: the last step.
    pub window: f64,
    /// Impulses between bodies since the last state.
    pub network: &'a Impulses,
    /// Length of that interval.
    pub interval: f64,
}

impl View<'_> {
    /// Height of the box now.
    #[must_use]
    pub fn present_height(&self) -> f64 {
        let walls = &self.world.walls;
        walls[TOP].point[1] - walls[BOTTOM].point[1]
    }

    /// Present outlines.
    #[must_use]
    pub fn outlines(&self) -> Vec<Outline> {
        let of = |body: &crate::mpm::body::Body| {
            let mut outline = Outline::default();
            body.outline_at(&body.displacement, &mut outline.points);
            outline.refresh();
            outline
        };
        self.world.bodies.iter().map(of).collect()
    }

    /// Force-bearing contacts over the interval.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        contacts(self.network, self.interval)
    }

    /// Mean force on a wall over the window.
    fn wall_force(&self, wall: usize) -> f64 {
        let (now, time) = (self.world.wall_impulse[wall], self.world.time);
        if self.window <= 0.0 {
            return self.world.wall_force(wall);
        }
        let start = (time - self.window).max(0.0);
        let after = self.marks.iter().position(|mark| mark.time > start).unwrap_or(self.marks.len());
        let end = Mark { time, impulse: self.world.wall_impulse.clone() };
        let late = self.marks.get(after).unwrap_or(&end);
        let begun = match after.checked_sub(1).map(|before| &self.marks[before]) {
            Some(early) => {
                let share = (start - early.time) / (late.time - early.time);
                early.impulse[wall] + share * (late.impulse[wall] - early.impulse[wall])
            }
            None => late.impulse[wall],
        };
        if time > start { (now - begun) / (time - start) } else { 0.0 }
    }

    /// Everything.
    #[must_use]
    pub fn state(&self, step: u64) -> State {
        let world = self.world;
        let height = self.present_height();
        let outlines = self.outlines();
        let box_area = self.width * height;
        let (mut area, mut undeformed, mut outlined) = (0.0, 0.0, 0.0);
        let (mut flowed, mut flowed_wide, mut yielding, mut mean_stress) = (0.0, 0.0, 0.0, 0.0);
        let hardening = world.law.material.plasticity;
        for (body, outline) in world.bodies.iter().zip(&outlines) {
            undeformed += body.area;
            outlined += outline.area();
            for (p, volume) in body.volumes().enumerate() {
                let (plastic, stress) = (body.points.plastic[p], body.points.stress[p]);
                area += volume;
                mean_stress -= volume * stress.yy;
                flowed += if plastic > 1e-6 { volume } else { 0.0 };
                flowed_wide += if plastic > 1e-3 { volume } else { 0.0 };
                if let Some(hardening) = hardening {
                    let limit = hardening.yield_stress + hardening.modulus * plastic;
                    yielding += if stress.von_mises() > (1.0 - 1e-6) * limit { volume } else { 0.0 };
                }
            }
        }
        let count = world.bodies.len() as f64;
        let mean_diameter = world.bodies.iter().map(|body| 2.0 * body.size).sum::<f64>() / count;
        let kappa = |factor: f64| {
            let of = |(body, outline): (&crate::mpm::body::Body, &Outline)| {
                let window = factor * f64::max(1.5 * body.template.cell * body.size, 0.1 * body.size);
                curvature::largest(&outline.points, window)
            };
            world.bodies.iter().zip(&outlines).map(of).sum::<f64>() / count * mean_diameter
        };
        let Coordination { z, z_all, z_three, rattlers } = coordination(&self.contacts(), world.bodies.len());
        let bottom = self.wall_force(BOTTOM);
        let sides = world.walls.len() > LEFT;
        let width = outlines.iter().map(|outline| outline.high[0] - outline.low[0]).fold(0.0, f64::max);
        let widest = world.bodies.iter().map(|body| 2.0 * body.size).fold(0.0, f64::max);
        let zone = self.contact_width(&outlines);
        State {
            step,
            time: world.time,
            strain: 1.0 - height / self.height,
            phi: area / box_area,
            phi_outline: outlined / box_area,
            phi_undeformed: undeformed / box_area,
            sigma: bottom / self.width,
            sigma_top: self.wall_force(TOP) / self.width,
            sigma_side: if sides {
                0.5 * (self.wall_force(LEFT) + self.wall_force(LEFT + 1)) / height
            } else {
                0.0
            },
            sigma_volume: mean_stress / area,
            sigma_contact: if zone > 0.0 { bottom / zone } else { 0.0 },
            sigma_centre: self.centre_stress(),
            z,
            z_all,
            z_three,
            rattlers,
            kappa_d: kappa(1.0),
            kappa_d_wide: kappa(2.0),
            f_p: flowed / area,
            f_p_wide: flowed_wide / area,
            yielding: yielding / area,
            area_ratio: area / undeformed,
            width_ratio: width / widest,
            work: world.energies.work,
            elastic: world.elastic_energy(),
            plastic: world.energies.plastic,
            kinetic: world.kinetic_energy(),
            friction: world.energies.friction,
            contact: world.energies.contact,
            numerical: world.energies.numerical + world.energies.damping,
            overlap: self.overlap(&outlines),
        }
    }

    /// Width of the contact zones on the bottom wall: for each body from its first to its last marker that bears
    /// impulse, half a spacing more on either side. (Markers in between may be relieved by their neighbours.)
    fn contact_width(&self, outlines: &[Outline]) -> f64 {
        if self.world.contact == ContactKind::CommonMesh {
            // impulses act on nodes, not on markers: there is no zone of the outline to measure
            return 0.0;
        }
        let on = Partner::Wall(BOTTOM as u32);
        let mut zones: Vec<(u32, [f64; 2])> = Vec::new();
        for (key, _) in self.world.impulses.iter().filter(|(key, _)| key.partner == on) {
            let points = &outlines[key.body as usize].points;
            let (n, k) = (points.len(), key.marker as usize);
            let x = points[k][0];
            let half = 0.25 * (points[(k + 1) % n][0] - points[(k + n - 1) % n][0]).abs();
            match zones.last_mut().filter(|(body, _)| *body == key.body) {
                Some((_, zone)) => *zone = [zone[0].min(x - half), zone[1].max(x + half)],
                None => zones.push((key.body, [x - half, x + half])),
            }
        }
        zones.iter().map(|(_, zone)| zone[1] - zone[0]).sum()
    }

    fn centre_stress(&self) -> f64 {
        let body = &self.world.bodies[0];
        let template = &body.template;
        let n = template.nodes_per_cell;
        // the four points that began nearest to the centre of the first body, or are nearest to its centre of mass
        let centre = body.cloud.as_ref().map_or([0.0; 2], |cloud| {
            let mass: f64 = cloud.mass.iter().sum();
            let along = |axis: usize| -> f64 {
                cloud.position.iter().zip(&cloud.mass).map(|(x, m)| m * x[axis]).sum::<f64>() / mass
            };
            [0, 1].map(|axis| (along(axis) - body.origin[axis]) / body.size)
        });
        let mut nearest: Vec<(f64, usize)> = Vec::with_capacity(template.point_count());
        for (cell, nodes) in template.cells.chunks_exact(n).enumerate() {
            for p in template.first_point[cell] as usize..template.first_point[cell + 1] as usize {
                let mut x = [0.0; 2];
                for (a, &node) in nodes.iter().enumerate() {
                    let at = template.nodes[node as usize];
                    x[0] += template.values[n * p + a] * at[0];
                    x[1] += template.values[n * p + a] * at[1];
                }
                let (dx, dy) = (x[0] - centre[0], x[1] - centre[1]);
                nearest.push((dx * dx + dy * dy, p));
            }
        }
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        -nearest[..4].iter().map(|&(_, p)| body.points.stress[p].yy).sum::<f64>() / 4.0
    }

    fn overlap(&self, outlines: &[Outline]) -> f64 {
        let mut worst = 0.0_f64;
        for (body, outline) in self.world.bodies.iter().zip(outlines) {
            let cell = body.template.cell * body.size;
            for wall in &self.world.walls {
                for x in &outline.points {
                    let gap =
                        (x[0] - wall.point[0]) * wall.normal[0] + (x[1] - wall.point[1]) * wall.normal[1];
                    worst = worst.max(-gap / cell);
                }
            }
        }
        worst
    }
}

impl State {
    /// Names, units and values of all columns.
    #[must_use]
    pub fn columns(&self) -> Vec<(&'static str, &'static str, f64)> {
        vec![
            ("time", "d sqrt(rho/E)", self.time),
            ("strain", "1", self.strain),
            ("strain_log", "1", libm::log1p(-self.strain)),
            ("phi", "1", self.phi),
            ("phi_outline", "1", self.phi_outline),
            ("phi_undeformed", "1", self.phi_undeformed),
            ("sigma", "E", self.sigma),
            ("sigma_top", "E", self.sigma_top),
            ("sigma_side", "E", self.sigma_side),
            ("sigma_volume", "E", self.sigma_volume),
            ("sigma_contact", "E", self.sigma_contact),
            ("sigma_centre", "E", self.sigma_centre),
            ("z", "1", self.z),
            ("z_all", "1", self.z_all),
            ("z_three", "1", self.z_three),
            ("rattler_share", "1", self.rattlers),
            ("kappa_d", "1", self.kappa_d),
            ("kappa_d_wide", "1", self.kappa_d_wide),
            ("f_p", "1", self.f_p),
            ("f_p_1e-3", "1", self.f_p_wide),
            ("yielding", "1", self.yielding),
            ("area_ratio", "1", self.area_ratio),
            ("width_ratio", "1", self.width_ratio),
            ("work", "E d^2", self.work),
            ("elastic_energy", "E d^2", self.elastic),
            ("plastic_dissipation", "E d^2", self.plastic),
            ("kinetic_energy", "E d^2", self.kinetic),
            ("friction_dissipation", "E d^2", self.friction),
            ("contact_loss", "E d^2", self.contact),
            ("numerical_loss", "E d^2", self.numerical),
            ("overlap", "cell", self.overlap),
        ]
    }

    /// The state as a row.
    ///
    /// # Errors
    /// [`NotFinite`] when something was not a number.
    pub fn row(&self) -> Result<Row, NotFinite> {
        let mut row = Row::new();
        row.put("steps", i64::try_from(self.step).unwrap_or(i64::MAX));
        for (name, _, value) in self.columns() {
            row.number(name, value)?;
        }
        Ok(row)
    }
}
