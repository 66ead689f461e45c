//! Looking at the state without changing it: the forces of this instant and the [`View`].

use super::engine::Dem;
use super::{Energies, PairContact, View, WallContact, WallView};
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, Response};
use crate::control::ServoWalls;
use crate::dem::kernel::{Evaluated, constants_of};
use crate::lane::{Number, WIDEST};
use crate::space::{Space, Vector};
use crate::state::{ContactList, Force, Grains, Kinematics};

/// Most memory slots a law may have.
pub(super) const MOST_SLOTS: usize = 8;

/// Forces at t_n, by slot.
pub(super) struct Probe {
    pub forces: Vec<Force<f64>>,
    pub wall_force: [f64; 6],
    pub pairs: Vec<PairContact>,
    pub walls: Vec<WallContact>,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Evaluates every listed contact once on a copy of its memory.
    pub(super) fn probe(&self) -> Probe {
        let mut probe = Probe {
            forces: vec![Force::default(); self.len()],
            wall_force: [0.0; 6],
            pairs: Vec::new(),
            walls: Vec::new(),
        };
        let pass = self.pass(std::ptr::null_mut());
        let mut memory = [S::Real::default(); MOST_SLOTS * WIDEST];
        assert!(C::SLOTS <= MOST_SLOTS, "a law remembers at most {MOST_SLOTS} numbers");
        let mut recall = |list: &ContactList<S::Real>, k: usize| {
            for slot in 0..C::SLOTS {
                memory[slot * <S::Real as Number>::GROUP] = list.slot(k, slot);
            }
            memory.as_mut_ptr()
        };
        for chunk in &self.chunks {
            for list in [&chunk.inner, &chunk.outer] {
                for k in 0..list.count {
                    let (a, b) = list.pair(k);
                    let constants = constants_of::<G, S::Real>(&self.grains, a, b);
                    // SAFETY: the list holds valid slots, the copy of the memory has room for one lane.
                    let contact =
                        unsafe { pass.one_pair(self.path, a, b, recall(list, k), constants.as_ptr()) };
                    let (force, torque_a) =
                        (record::<S>(&contact), doubles::<S>(S::spin_record(contact.torque_a)));
                    let torque_b = doubles::<S>(S::spin_record(contact.torque_b));
                    for axis in 0..3 {
                        *probe.forces[a as usize].force_mut(axis) += force[axis];
                        *probe.forces[b as usize].force_mut(axis) -= force[axis];
                        *probe.forces[a as usize].torque_mut(axis) += torque_a[axis];
                        *probe.forces[b as usize].torque_mut(axis) += torque_b[axis];
                    }
                    let attraction: f64 = contact.response.attraction.into();
                    let distant = self.law.range() > 0.0 && attraction > 0.0;
                    if contact.overlap.into() > 0.0 || distant {
                        probe.pairs.push(self.describe(a, b, &contact));
                    }
                }
            }
            let Some(walls) = &self.walls else { continue };
            for (wall, list) in chunk.walls.iter().enumerate() {
                for k in 0..list.count {
                    let (a, _) = list.pair(k);
                    // SAFETY: as above.
                    let contact = unsafe { pass.wall::<S::Real>(walls, wall, &raw const a, recall(list, k)) };
                    let (force, torque) =
                        (record::<S>(&contact), doubles::<S>(S::spin_record(contact.torque_a)));
                    for axis in 0..3 {
                        *probe.forces[a as usize].force_mut(axis) += force[axis];
                        *probe.forces[a as usize].torque_mut(axis) += torque[axis];
                    }
                    probe.wall_force[wall] += contact.response.normal.into();
                    if contact.overlap.into() > 0.0 {
                        let response = &contact.response;
                        let [elastic, attraction, viscous] = parts::<S>(response);
                        probe.walls.push(WallContact {
                            particle: self.original[a as usize] as usize,
                            wall,
                            overlap: contact.overlap.into(),
                            elastic,
                            normal_force: elastic - attraction,
                            viscous,
                            tangential: shear::<S>(&contact),
                            sliding: sliding::<S>(response, self.wall_law.bound(elastic)),
                        });
                    }
                }
            }
        }
        probe
    }

    /// One pair in original numbering, lower number first.
    fn describe(&self, a: u32, b: u32, contact: &Evaluated<S, S::Real>) -> PairContact {
        let (mut i, mut j) = (self.original[a as usize] as usize, self.original[b as usize] as usize);
        let mut normal = doubles::<S>(S::vector_record(contact.normal));
        let response = &contact.response;
        let [elastic, attraction, viscous] = parts::<S>(response);
        let mut tangential = shear::<S>(contact);
        if i > j {
            (i, j) = (j, i);
            normal = normal.map(|x| -x);
            tangential = tangential.map(|x| -x);
        }
        PairContact {
            i,
            j,
            normal,
            overlap: contact.overlap.into(),
            elastic,
            normal_force: elastic - attraction,
            viscous,
            tangential,
            sliding: sliding::<S>(response, self.law.bound(elastic)),
        }
    }

    /// Velocity and spin at t_n, from those at t_n − dt/2 and the forces of t_n.
    fn synchronous(&self, slot: usize, body: &S::Body, force: &Force<f64>) -> ([f64; 3], [f64; 3]) {
        let half = 0.5 * self.dt;
        let keep = 1.0 / (1.0 + half * self.drag_rates().of(slot));
        let (per_mass, per_inertia) =
            (half * self.grains.inverse_mass(slot), half * self.grains.inverse_inertia(slot));
        let (velocity, spin) = body.motion();
        (
            std::array::from_fn(|k| keep * (velocity[k] + per_mass * force.force()[k])),
            std::array::from_fn(|k| keep * (spin[k] + per_inertia * force.torque()[k])),
        )
    }

    /// The picture of this instant.
    pub(super) fn picture(&self) -> View {
        let Probe { forces, wall_force, mut pairs, walls: mut wall_contacts } = self.probe();
        pairs.sort_unstable_by_key(|contact| (contact.i, contact.j));
        wall_contacts.sort_unstable_by_key(|contact| (contact.particle, contact.wall));
        let count = self.len();
        let mut view = View {
            step: self.step,
            time: self.time,
            radii: vec![0.0; count],
            positions: vec![[0.0; 3]; count],
            velocities: vec![[0.0; 3]; count],
            spins: vec![[0.0; 3]; count],
            forces: vec![[0.0; 3]; count],
            torques: vec![[0.0; 3]; count],
            contacts: pairs,
            wall_contacts,
            walls: Vec::new(),
            energies: Energies::default(),
        };
        let mut slot_of = vec![0_usize; count];
        for (slot, body) in self.bodies.iter().enumerate() {
            let particle = self.original[slot] as usize;
            slot_of[particle] = slot;
            let (velocity, spin) = self.synchronous(slot, body, &forces[slot]);
            view.radii[particle] = self.grains.radius(slot);
            view.positions[particle] = body.position();
            view.velocities[particle] = velocity;
            view.spins[particle] = spin;
            view.forces[particle] = std::array::from_fn(|k| forces[slot].force()[k]);
            view.torques[particle] = std::array::from_fn(|k| forces[slot].torque()[k]);
        }
        // Sums in original numbering: the same number whatever the order in memory.
        let energies = &mut view.energies;
        let square = |v: &[f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        for particle in 0..count {
            energies.translation +=
                0.5 * self.grains.mass(slot_of[particle]) * square(&view.velocities[particle]);
            energies.rotation += 0.5 * self.grains.inertia(slot_of[particle]) * square(&view.spins[particle]);
        }
        let tangential = |force: &[f64; 3], kt: f64| if kt > 0.0 { 0.5 * square(force) / kt } else { 0.0 };
        for contact in &view.contacts {
            let (elastic, attraction) = self.law.potential(contact.overlap);
            energies.elastic_normal += elastic;
            energies.adhesion += attraction;
            energies.elastic_tangential += tangential(&contact.tangential, self.law.stiffness().tangential);
        }
        for contact in &view.wall_contacts {
            let (elastic, attraction) = self.wall_law.potential(contact.overlap);
            energies.elastic_normal += elastic;
            energies.adhesion += attraction;
            energies.elastic_tangential +=
                tangential(&contact.tangential, self.wall_law.stiffness().tangential);
        }
        if let Some(walls) = &self.walls {
            for wall in 0..6 {
                let velocity =
                    walls.velocity[wall] + 0.5 * self.dt * walls.acceleration(wall, wall_force[wall]);
                if walls.moving[wall] {
                    energies.walls += 0.5 * walls.mass * velocity * velocity;
                }
                view.walls.push(WallView {
                    axis: ServoWalls::axis(wall),
                    position: walls.position[wall],
                    velocity,
                    force: wall_force[wall],
                    load: walls.load(wall),
                    moving: walls.moving[wall],
                });
            }
            energies.load = walls.pressure * walls.volume();
        }
        view
    }
}

/// Force on a as three components.
fn record<S: Space>(contact: &Evaluated<S, S::Real>) -> [f64; 3] {
    doubles::<S>(S::vector_record(contact.force))
}

/// Tangential force on a as three components.
fn shear<S: Space>(contact: &Evaluated<S, S::Real>) -> [f64; 3] {
    doubles::<S>(S::vector_record(S::shear_vector(contact.normal, contact.response.tangential)))
}

/// Elastic repulsion, attraction, viscous force.
fn parts<S: Space>(response: &Response<S, S::Real>) -> [f64; 3] {
    doubles::<S>([response.elastic, response.attraction, response.viscous])
}

fn doubles<S: Space>(record: [S::Real; 3]) -> [f64; 3] {
    record.map(Into::into)
}

/// Whether the tangential force is at its bound (to round-off).
fn sliding<S: Space>(response: &Response<S, S::Real>, bound: f64) -> bool {
    let square: f64 = response.tangential.dot(response.tangential).into();
    square > 0.0 && square.sqrt() >= bound * (1.0 - S::Real::AT_BOUND)
}
