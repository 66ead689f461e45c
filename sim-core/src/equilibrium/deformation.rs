//! Kinetic energy of the motion that deforms the network: the only one that its dashpots can dissipate.
//!
//! Long after e has settled, nearly all kinetic energy sits in motion without any deformation: particles with few contacts
//! roll over their neighbours, clusters of well-held particles roll along with them, rattlers fly, spin and bounce. Next to
//! none of it is damped, and none of it says how far the forces are from balance (docs/accuracy.md, "Stop rule").

use super::sample::HELD_CONTACTS;
use crate::dem::View;

/// Mass of a pair in relative motion along its normal [m].
const REDUCED_MASS: f64 = 0.5;

/// Σ m_eff u_n²/2 over the contacts between particles with at least four contacts each, u_n the relative velocity along
/// the normal [k_n d²]; `contacts` counts those of every particle, walls included.
pub(crate) fn deforming_energy(view: &View, contacts: &[u32]) -> f64 {
    let held = |particle: usize| contacts[particle] >= HELD_CONTACTS;
    view.contacts
        .iter()
        .filter(|contact| held(contact.i) && held(contact.j))
        .map(|contact| {
            let (vi, vj) = (view.velocities[contact.i], view.velocities[contact.j]);
            let rate: f64 = (0..3).map(|k| (vj[k] - vi[k]) * contact.normal[k]).sum();
            0.5 * REDUCED_MASS * rate * rate
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::PairContact;

    /// Two touching spheres along x with these velocities.
    fn state(velocities: [[f64; 3]; 2]) -> View {
        View {
            positions: vec![[0.0; 3], [0.99, 0.0, 0.0]],
            velocities: velocities.to_vec(),
            spins: vec![[0.0; 3]; 2],
            contacts: vec![PairContact {
                i: 0,
                j: 1,
                normal: [1.0, 0.0, 0.0],
                overlap: 0.01,
                ..PairContact::default()
            }],
            ..View::default()
        }
    }

    #[test]
    fn a_head_on_approach_counts_in_full_and_turning_together_not_at_all() {
        let approach = state([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]]);
        assert!((deforming_energy(&approach, &[4, 5]) - 0.01).abs() < 1e-16, "all of 2 m v²/2");
        // rigid rotation about z through the first centre, and flight as one: v = v0 + ω × x
        let together = state([[0.3, 0.2, 0.0], [0.3, 0.2 + 0.7 * 0.99, 0.0]]);
        assert!(deforming_energy(&together, &[4, 4]) < 1e-30);
    }

    #[test]
    fn loose_particles_do_not_count() {
        let approach = state([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]]);
        assert!(deforming_energy(&approach, &[3, 9]).abs() < 1e-30);
    }
}
