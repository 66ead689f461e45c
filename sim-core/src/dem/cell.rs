//! Discs in a periodic cell as their driver sees them.

use super::Dynamics;
use super::engine::Dem;
use super::probe::MOST_SLOTS;
use crate::boundary::{CellControl, PeriodicCell};
use crate::contact::ContactLaw;
use crate::lane::{Real, WIDEST};
use crate::observables::disc_contacts::DiscContact;
use crate::space::{Planar, Space};
use crate::state::{Force, Grains, Kinematics};

/// A particle system in a periodic cell.
pub trait CellDynamics: Dynamics {
    /// Edges, strain rates and control of this instant.
    fn cell(&self) -> &PeriodicCell;

    /// Changes what moves the edges; a fixed cell loses its strain rates.
    fn set_control(&mut self, control: CellControl);

    /// Changes the local damping of discs and cell [1].
    fn set_local_damping(&mut self, coefficient: f64);

    /// Forces that do not balance and motion that has not died down, on undamped forces.
    fn residuals(&self) -> CellResiduals;

    /// The consistent picture of this instant.
    fn picture(&self) -> CellPicture;
}

/// What is left of motion and imbalance, in units of k_n, d, m.
#[derive(Clone, Debug, PartialEq)]
pub struct CellResiduals {
    /// Net force on every disc, original numbering [k_n d].
    pub forces: Vec<f64>,
    /// Net moment on every disc [k_n d²].
    pub moments: Vec<f64>,
    /// Kinetic energy of every disc, velocities relative to the cell [k_n d²].
    pub kinetic: Vec<f64>,
    /// Stresses σ_1, σ_2, compression positive [k_n/d].
    pub stress: [f64; 2],
    /// Contacts at their Coulomb bound.
    pub sliding: usize,
    /// Interacting pairs (i, j, F_N without its viscous part), i < j, unsorted.
    pub pairs: Vec<(u32, u32, f64)>,
}

/// Discs and contacts at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct CellPicture {
    /// Edges [d].
    pub edges: [f64; 2],
    /// Centres inside the cell [d].
    pub positions: Vec<[f64; 2]>,
    /// Radii [d].
    pub radii: Vec<f64>,
    /// Velocities relative to the cell at t_n − dt/2 [d/τ].
    pub velocities: Vec<[f64; 2]>,
    /// Spins at t_n − dt/2 [1/τ].
    pub spins: Vec<f64>,
    /// Interactions, sorted by (i, j).
    pub contacts: Vec<DiscContact>,
    /// Stresses from static forces (without dashpots), compression positive [k_n/d].
    pub stress: [f64; 2],
    /// Elastic energy of normal, tangential springs and rolling springs, and potential of the attraction [k_n d²].
    pub potential: [f64; 4],
}

impl<R: Real, G: Grains, C: ContactLaw<Planar<R>>> CellDynamics for Dem<Planar<R>, G, PeriodicCell, C> {
    fn cell(&self) -> &PeriodicCell {
        &self.boundary
    }

    fn set_control(&mut self, control: CellControl) {
        if control == CellControl::Fixed {
            self.boundary.rate = [0.0; 2];
        }
        self.boundary.control = control;
    }

    fn set_local_damping(&mut self, coefficient: f64) {
        self.boundary.local_damping = coefficient;
    }

    fn residuals(&self) -> CellResiduals {
        let mut forces = vec![Force::<f64>::default(); self.len()];
        let mut virial = [0.0; 2];
        let mut sliding = 0;
        let mut pairs = Vec::new();
        self.each_contact(|a, b, contact| {
            let force: [f64; 3] = Planar::<R>::vector_record(contact.force).map(R::into);
            let separation = Planar::<R>::vector_record(contact.separation);
            let torques: [f64; 2] = [contact.torque_a, contact.torque_b].map(|torque| torque.0[0].into());
            for axis in 0..2 {
                *forces[a as usize].force_mut(axis) += force[axis];
                *forces[b as usize].force_mut(axis) -= force[axis];
                virial[axis] -= force[axis] * separation[axis];
            }
            *forces[a as usize].torque_mut(2) += torques[0];
            *forces[b as usize].torque_mut(2) += torques[1];
            let response = &contact.response;
            let [overlap, elastic, attraction]: [f64; 3] =
                [contact.overlap, response.elastic, response.attraction].map(R::into);
            if overlap > 0.0 || attraction > 0.0 {
                let (i, j) = (self.original[a as usize], self.original[b as usize]);
                pairs.push((i.min(j), i.max(j), elastic - attraction));
                let bound = self.law.bound(elastic);
                let shear = response.tangential.0[0].into().abs();
                sliding += usize::from(shear > 0.0 && shear >= bound * (1.0 - R::AT_BOUND.max(1e-9)));
            }
        });
        let count = self.len();
        let mut residuals = CellResiduals {
            forces: vec![0.0; count],
            moments: vec![0.0; count],
            kinetic: vec![0.0; count],
            stress: self.boundary.stress(virial),
            sliding,
            pairs,
        };
        for (slot, (body, force)) in self.bodies.iter().zip(&forces).enumerate() {
            let disc = self.original[slot] as usize;
            let ([u, v, _], [_, _, w]) = body.motion();
            residuals.forces[disc] = libm::hypot(force.force()[0], force.force()[1]);
            residuals.moments[disc] = force.torque()[2].abs();
            residuals.kinetic[disc] =
                0.5 * (self.grains.mass(slot) * (u * u + v * v) + self.grains.inertia(slot) * w * w);
        }
        residuals
    }

    fn picture(&self) -> CellPicture {
        let count = self.len();
        let mut picture = CellPicture {
            edges: self.boundary.edges,
            positions: vec![[0.0; 2]; count],
            radii: vec![0.0; count],
            velocities: vec![[0.0; 2]; count],
            spins: vec![0.0; count],
            contacts: Vec::new(),
            stress: [0.0; 2],
            potential: [0.0; 4],
        };
        for (slot, body) in self.bodies.iter().enumerate() {
            let disc = self.original[slot] as usize;
            let inside = crate::boundary::Boundary::<Planar<R>>::inside(&self.boundary, body.position());
            picture.positions[disc] = [inside[0], inside[1]];
            picture.radii[disc] = self.grains.radius(slot);
            let ([u, v, _], [_, _, spin]) = body.motion();
            picture.velocities[disc] = [u, v];
            picture.spins[disc] = spin;
        }
        self.each_contact(|a, b, contact| {
            let response = &contact.response;
            let [overlap, elastic, attraction]: [f64; 3] =
                [contact.overlap, response.elastic, response.attraction].map(R::into);
            if overlap <= 0.0 && attraction <= 0.0 {
                return;
            }
            let (i, j) = (self.original[a as usize], self.original[b as usize]);
            let separation = Planar::<R>::vector_record(contact.separation);
            let sign = if i < j { 1.0 } else { -1.0 };
            picture.contacts.push(DiscContact {
                i: i.min(j),
                j: i.max(j),
                gap: -overlap,
                branch: [sign * separation[0], sign * separation[1]],
                normal: elastic - attraction,
                // Along t = (−n_y, n_x): reversing n and the force leaves it as it is.
                tangential: response.tangential.0[0].into(),
                rolling: sign * response.rolling.0[0].into(),
            });
        });
        picture.contacts.sort_unstable_by_key(|contact| (contact.i, contact.j));
        let stiffness = self.law.stiffness();
        let spring =
            |force: f64, stiffness: f64| if stiffness > 0.0 { 0.5 * force * force / stiffness } else { 0.0 };
        for contact in &picture.contacts {
            let length = libm::hypot(contact.branch[0], contact.branch[1]);
            let n = [contact.branch[0] / length, contact.branch[1] / length];
            // Force on j is F_N n − F_T t, where F_T t acts on i.
            let on_j = [
                contact.normal * n[0] + contact.tangential * n[1],
                contact.normal * n[1] - contact.tangential * n[0],
            ];
            for axis in 0..2 {
                picture.stress[axis] += on_j[axis] * contact.branch[axis];
            }
            let (elastic, attraction) = self.law.potential(-contact.gap);
            picture.potential[0] += elastic;
            picture.potential[1] += spring(contact.tangential, stiffness.tangential);
            picture.potential[2] += spring(contact.rolling, stiffness.rolling);
            picture.potential[3] += attraction;
        }
        picture.stress = self.boundary.stress(picture.stress);
        picture
    }
}

impl<R: Real, G: Grains, C: ContactLaw<Planar<R>>> Dem<Planar<R>, G, PeriodicCell, C> {
    /// Evaluates every listed contact once on a copy of its memory.
    fn each_contact(&self, mut visit: impl FnMut(u32, u32, &super::kernel::Evaluated<Planar<R>, R>)) {
        let pass = self.pass(std::ptr::null_mut());
        let mut memory = [R::default(); MOST_SLOTS * WIDEST];
        assert!(C::SLOTS <= MOST_SLOTS, "a law remembers at most {MOST_SLOTS} numbers");
        for chunk in &self.chunks {
            for list in [&chunk.inner, &chunk.outer] {
                for k in 0..list.count {
                    let (a, b) = list.pair(k);
                    for slot in 0..C::SLOTS {
                        memory[slot * R::GROUP] = list.slot(k, slot);
                    }
                    let constants = super::kernel::constants_of::<G, R>(&self.grains, a, b);
                    // SAFETY: the list holds valid slots, the copy of the memory has room for one lane.
                    let contact =
                        unsafe { pass.one_pair(self.path, a, b, memory.as_mut_ptr(), constants.as_ptr()) };
                    visit(a, b, &contact);
                }
            }
        }
    }
}
