//! What is kept of a state while the run goes on.

use serde::{Deserialize, Serialize};

use super::deformation::deforming_energy;
use crate::dem::View;
use crate::observables::coordination::{Coordination, coordination};
use crate::observables::void_ratio::void_ratio;

/// Contacts from which on a particle counts as held in the kinetic energies of the evidence and for the drag of rolling kicks; with three or fewer it can
/// vibrate or roll freely.
pub(crate) const HELD_CONTACTS: u32 = 4;

/// One row of the time series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sample {
    /// Step.
    pub(crate) step: u64,
    /// Time [τ].
    pub(crate) time: f64,
    /// Time step [τ].
    pub(crate) dt: f64,
    /// Void ratio [1].
    pub(crate) e: f64,
    /// 2 N_pp/N [1].
    pub(crate) z: f64,
    /// Compressive share of it [1].
    pub(crate) z_plus: f64,
    /// Tensile share of it [1].
    pub(crate) z_minus: f64,
    /// Particles with exactly two contacts, walls counted.
    pub(crate) with_two: u64,
    /// Kinetic energy of all particles [k_n d²].
    pub(crate) kinetic: f64,
    /// Kinetic energy of particles with at least four contacts [k_n d²].
    pub(crate) kinetic_held: f64,
    /// Kinetic energy of the motion along the normals between held particles [k_n d²].
    pub(crate) deforming: f64,
    /// Elastic energy [k_n d²].
    pub(crate) elastic: f64,
    /// Mean unbalanced force on backbone particles over the mean contact force [1]; 0 without contacts.
    pub(crate) unbalanced: f64,
    /// Normal forces on the walls [k_n d].
    pub(crate) wall_forces: [f64; 6],
    /// Loads p S on the walls [k_n d].
    pub(crate) wall_loads: [f64; 6],
    /// Velocities of the walls along their axes [d/τ].
    pub(crate) wall_velocities: [f64; 6],
}

impl Sample {
    /// Samples a state.
    pub(crate) fn of(view: &View, dt: f64) -> Self {
        let counted = coordination(view);
        Self {
            step: view.step,
            time: view.time,
            dt,
            e: void_ratio(&walls_of(view), view.positions.len()),
            z: counted.z,
            z_plus: counted.z_plus,
            z_minus: counted.z_minus,
            with_two: counted.with_two,
            kinetic: view.energies.kinetic(),
            kinetic_held: kinetic_held(view, &counted),
            deforming: deforming_energy(view, &counted.contacts),
            elastic: view.energies.elastic(),
            unbalanced: unbalanced(view, &counted),
            wall_forces: [0, 1, 2, 3, 4, 5].map(|wall| view.walls[wall].force),
            wall_loads: [0, 1, 2, 3, 4, 5].map(|wall| view.walls[wall].load),
            wall_velocities: [0, 1, 2, 3, 4, 5].map(|wall| view.walls[wall].velocity),
        }
    }
}

/// Positions of the six walls.
pub(crate) fn walls_of(view: &View) -> [f64; 6] {
    [0, 1, 2, 3, 4, 5].map(|wall| view.walls[wall].position)
}

/// Σ m v²/2 + I ω²/2 over particles with at least four contacts, I = m d²/10.
fn kinetic_held(view: &View, counted: &Coordination) -> f64 {
    let square = |v: &[f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    counted
        .contacts
        .iter()
        .zip(view.velocities.iter().zip(&view.spins))
        .filter(|&(&contacts, _)| contacts >= HELD_CONTACTS)
        .map(|(_, (velocity, spin))| 0.5 * square(velocity) + 0.05 * square(spin))
        .sum()
}

/// Mean |Σ f| over the backbone divided by the mean magnitude of the contact forces on pairs and walls.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
fn unbalanced(view: &View, counted: &Coordination) -> f64 {
    let length = |v: &[f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let magnitude = |normal: f64, tangential: &[f64; 3]| {
        let t = length(tangential);
        (normal * normal + t * t).sqrt()
    };
    let held = counted.backbone.iter().filter(|&&kept| kept).count();
    let contacts = view.contacts.len() + view.wall_contacts.len();
    if held == 0 || contacts == 0 {
        return 0.0;
    }
    let on_pairs: f64 = view.contacts.iter().map(|c| magnitude(c.normal_force, &c.tangential)).sum();
    let on_walls: f64 = view.wall_contacts.iter().map(|c| magnitude(c.normal_force, &c.tangential)).sum();
    let mean_contact = (on_pairs + on_walls) / contacts as f64;
    if mean_contact <= 0.0 {
        return 0.0;
    }
    let left_over: f64 = counted
        .backbone
        .iter()
        .zip(&view.forces)
        .filter(|&(&kept, _)| kept)
        .map(|(_, force)| length(force))
        .sum();
    left_over / held as f64 / mean_contact
}
