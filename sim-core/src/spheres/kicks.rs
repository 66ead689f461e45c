//! Rolling kicks: pure rolling velocities for the particles that carry the slow process.
//!
//! Long after e has settled, particles with two contacts still roll over their neighbours until they find a third.
//! A kick sets them rolling at half the escape speed f_c/√(k_n m): too slow to open a contact, and with the spin
//! that makes the contact points stand still it does no work on the neighbours. Particles that touch a wall are left
//! alone. Off by default; what it did is in the record (docs/accuracy.md).

use crate::dem::{Motion, View};
use crate::equilibrium::sample::HELD_CONTACTS;
use crate::random::Stream;

/// Steps between kicks.
pub(crate) const EVERY: u64 = 300;
/// Rate of the drag on held particles while kicks go on, and on all particles afterwards [1/τ].
pub(crate) const DRAG: f64 = 0.01;
/// Speed of a kicked particle in units of f_c/√(k_n m).
const AMPLITUDE: f64 = 0.5;
/// Stream of the seed.
const STREAM: u64 = 4;

/// The touching neighbours of particles that have at most two of them.
#[derive(Clone, Copy, Debug)]
struct Touching {
    count: u32,
    on_wall: bool,
    /// Unit vectors to the neighbours and distances from the centre to the contact points [d].
    normals: [[f64; 3]; 2],
    levers: [f64; 2],
}

/// The kicks of a state: one motion per particle that is kicked; the total number of contacts of each particle.
pub(crate) fn kicks(view: &View, adhesion: f64, seed: u64, kick: u64) -> (Vec<Motion>, Vec<u32>) {
    let none = Touching { count: 0, on_wall: false, normals: [[0.0; 3]; 2], levers: [0.5; 2] };
    let mut touching = vec![none; view.positions.len()];
    for contact in &view.contacts {
        let lever = 0.5 * (1.0 - contact.overlap);
        for (particle, sign) in [(contact.i, 1.0), (contact.j, -1.0)] {
            let own = &mut touching[particle];
            if own.count < 2 {
                own.normals[own.count as usize] = contact.normal.map(|c| sign * c);
                own.levers[own.count as usize] = lever;
            }
            own.count += 1;
        }
    }
    for contact in &view.wall_contacts {
        touching[contact.particle].on_wall = true;
        touching[contact.particle].count += 1;
    }
    let speed = AMPLITUDE * adhesion;
    let draws = Stream::new(seed, STREAM).item(kick);
    let motions = touching
        .iter()
        .enumerate()
        .filter(|(particle, own)| {
            let v = view.velocities[*particle];
            own.count <= 2 && !own.on_wall && dot(v, v) < speed * speed
        })
        .filter_map(|(particle, own)| motion(particle, own, speed, draws.item(particle as u64)))
        .collect();
    (motions, touching.iter().map(|own| own.count).collect())
}

/// Drag rates while kicks go on: on held particles only [1/τ].
pub(crate) fn drag_rates(contacts: &[u32]) -> Vec<f64> {
    contacts.iter().map(|&count| if count >= HELD_CONTACTS { DRAG } else { 0.0 }).collect()
}

/// Kinetic energy the motions add to a state [k_n d²].
pub(crate) fn added_energy(view: &View, motions: &[Motion]) -> f64 {
    let energy = |v: [f64; 3], w: [f64; 3]| 0.5 * dot(v, v) + 0.05 * dot(w, w);
    motions
        .iter()
        .map(|to| {
            energy(to.velocity, to.spin) - energy(view.velocities[to.particle], view.spins[to.particle])
        })
        .sum()
}

/// Pure rolling: v + ω × (lever n) = 0 at every contact point.
fn motion(particle: usize, own: &Touching, speed: f64, mut draw: Stream) -> Option<Motion> {
    let heading = draw.direction();
    let [first, second] = own.normals;
    let (velocity, spin) = match own.count {
        0 => (heading.map(|c| speed * c), [0.0; 3]),
        1 => {
            let along = dot(heading, first);
            let tangent = unit([0, 1, 2].map(|k| heading[k] - along * first[k]))?;
            let velocity = tangent.map(|c| speed * c);
            (velocity, cross(velocity, first).map(|c| c / own.levers[0]))
        }
        _ => {
            // along n1 × n2; ω ∥ n1 − n2 then stills both contact points when the levers are equal
            let across = cross(first, second);
            let length = dot(across, across).sqrt();
            if length < 0.1 {
                return None;
            }
            let sign = if heading[0] < 0.0 { -1.0 } else { 1.0 };
            let velocity = across.map(|c| sign * speed * c / length);
            let lever = 0.5 * (own.levers[0] + own.levers[1]);
            (velocity, [0, 1, 2].map(|k| -sign * speed / (lever * length) * (first[k] - second[k])))
        }
    };
    Some(Motion { particle, velocity, spin })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 0.1).then(|| a.map(|c| c / length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::{PairContact, WallContact};

    fn contact(i: usize, j: usize, normal: [f64; 3]) -> PairContact {
        PairContact {
            i,
            j,
            normal,
            overlap: 0.002,
            elastic: 0.002,
            normal_force: 0.0,
            viscous: 0.0,
            tangential: [0.0; 3],
            sliding: false,
        }
    }

    /// Particle 0 touches 1 and 2; 3 is free; 4 touches 1 and a wall.
    fn state() -> View {
        let tilted = unit([0.6, 0.7, -0.2]).unwrap();
        View {
            positions: vec![[0.0; 3]; 5],
            velocities: vec![[0.0; 3]; 5],
            spins: vec![[0.0; 3]; 5],
            contacts: vec![
                contact(0, 1, [1.0, 0.0, 0.0]),
                contact(0, 2, tilted),
                contact(1, 4, [0.0, 0.0, 1.0]),
            ],
            wall_contacts: vec![WallContact {
                particle: 4,
                wall: 5,
                overlap: 0.1,
                elastic: 0.1,
                normal_force: 0.1,
                viscous: 0.0,
                tangential: [0.0; 3],
                sliding: false,
            }],
            ..View::default()
        }
    }

    #[test]
    fn contact_points_of_kicked_particles_stand_still() {
        let view = state();
        let (motions, contacts) = kicks(&view, 1e-3, 1, 0);
        assert_eq!(contacts, [2, 2, 1, 0, 2]);
        let kicked: Vec<usize> = motions.iter().map(|to| to.particle).collect();
        assert_eq!(kicked, [0, 1, 2, 3], "the particle on the wall is left alone");
        for to in &motions {
            assert!((dot(to.velocity, to.velocity).sqrt() - 0.5e-3).abs() < 1e-15);
            for contact in &view.contacts {
                let arm = if contact.i == to.particle {
                    contact.normal.map(|c| 0.499 * c)
                } else if contact.j == to.particle {
                    contact.normal.map(|c| -0.499 * c)
                } else {
                    continue;
                };
                let turn = cross(to.spin, arm);
                for (v, w) in to.velocity.iter().zip(turn) {
                    assert!((v + w).abs() < 1e-15, "{to:?}");
                }
            }
        }
    }

    #[test]
    fn fast_particles_are_left_alone_and_energy_is_accounted() {
        let mut view = state();
        view.velocities[3] = [1e-3, 0.0, 0.0];
        let (motions, _) = kicks(&view, 1e-3, 1, 0);
        assert!(motions.iter().all(|to| to.particle != 3));
        let energy = added_energy(&view, &motions);
        assert!(energy > 0.0 && energy < 3.0 * 0.5 * 0.25e-6 * 2.0);
    }
}
