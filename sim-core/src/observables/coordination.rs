//! Coordination numbers and rattlers.

use crate::dem::View;

/// Contacts per particle, and what follows from them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coordination {
    /// Contacts of each particle, walls included.
    pub(crate) contacts: Vec<u32>,
    /// Particles left after those with fewer than two contacts were removed again and again.
    pub(crate) backbone: Vec<bool>,
    /// Z = 2 N_pp/N.
    pub(crate) z: f64,
    /// Z+: contacts with k_n ov − f_c ≥ 0.
    pub(crate) z_plus: f64,
    /// Z−: contacts with k_n ov − f_c < 0.
    pub(crate) z_minus: f64,
    /// Z with walls: (2 N_pp + N_pw)/N.
    pub(crate) z_wall: f64,
    /// Z without rattlers, walls counted: contacts among the backbone over its particles; 0 without a backbone.
    pub(crate) z_backbone: f64,
    /// Share of particles that are not in the backbone.
    pub(crate) rattler_share: f64,
    /// Particles with exactly two contacts.
    pub(crate) with_two: u64,
}

/// Counts the contacts of a state.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub(crate) fn coordination(view: &View) -> Coordination {
    let n = view.positions.len();
    let mut contacts = vec![0_u32; n];
    let mut tensile = 0_u64;
    for contact in &view.contacts {
        contacts[contact.i] += 1;
        contacts[contact.j] += 1;
        tensile += u64::from(contact.normal_force < 0.0);
    }
    for contact in &view.wall_contacts {
        contacts[contact.particle] += 1;
    }
    let pairs: Vec<(usize, usize)> = view.contacts.iter().map(|contact| (contact.i, contact.j)).collect();
    let backbone = backbone(contacts.clone(), &pairs);
    let inner = pairs.iter().filter(|&&(i, j)| backbone[i] && backbone[j]).count();
    let at_walls = view.wall_contacts.iter().filter(|contact| backbone[contact.particle]).count();
    let held = backbone.iter().filter(|&&kept| kept).count();
    let count = n as f64;
    let z = 2.0 * pairs.len() as f64 / count;
    let z_minus = 2.0 * tensile as f64 / count;
    Coordination {
        with_two: contacts.iter().filter(|&&found| found == 2).count() as u64,
        z,
        z_minus,
        z_plus: 2.0 * (pairs.len() as u64 - tensile) as f64 / count,
        z_wall: (2 * pairs.len() + view.wall_contacts.len()) as f64 / count,
        z_backbone: if held == 0 { 0.0 } else { (2 * inner + at_walls) as f64 / held as f64 },
        rattler_share: (n - held) as f64 / count,
        contacts,
        backbone,
    }
}

/// Removes particles with fewer than two contacts until none is left; the result does not depend on the order.
fn backbone(mut contacts: Vec<u32>, pairs: &[(usize, usize)]) -> Vec<bool> {
    let mut starts = vec![0_usize; contacts.len() + 1];
    for &(i, j) in pairs {
        starts[i + 1] += 1;
        starts[j + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut partners = vec![0_usize; 2 * pairs.len()];
    for &(i, j) in pairs {
        for (a, b) in [(i, j), (j, i)] {
            partners[next[a]] = b;
            next[a] += 1;
        }
    }
    let mut kept = vec![true; contacts.len()];
    let mut loose: Vec<usize> = (0..contacts.len()).filter(|&i| contacts[i] < 2).collect();
    while let Some(i) = loose.pop() {
        if !kept[i] {
            continue;
        }
        kept[i] = false;
        for &j in &partners[starts[i]..starts[i + 1]] {
            if kept[j] {
                contacts[j] -= 1;
                if contacts[j] < 2 {
                    loose.push(j);
                }
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::{PairContact, WallContact};

    fn pair(i: usize, j: usize, normal_force: f64) -> PairContact {
        PairContact {
            i,
            j,
            normal: [1.0, 0.0, 0.0],
            overlap: 0.01,
            elastic: 0.01,
            normal_force,
            ..PairContact::default()
        }
    }

    fn on_wall(particle: usize) -> WallContact {
        WallContact {
            particle,
            wall: 0,
            overlap: 0.01,
            elastic: 0.01,
            normal_force: 0.01,
            viscous: 0.0,
            tangential: [0.0; 3],
            sliding: false,
        }
    }

    /// A triangle with a chain of two hanging from it, and a free particle.
    fn triangle_and_chain() -> View {
        View {
            positions: vec![[0.0; 3]; 6],
            contacts: vec![
                pair(0, 1, 0.1),
                pair(0, 2, -0.1),
                pair(1, 2, 0.1),
                pair(2, 3, -0.2),
                pair(3, 4, 0.0),
            ],
            ..View::default()
        }
    }

    #[test]
    fn chains_fall_off_one_by_one() {
        let found = coordination(&triangle_and_chain());
        assert_eq!(found.backbone, [true, true, true, false, false, false]);
        assert_eq!(found.contacts, [2, 2, 3, 2, 1, 0]);
        assert!((found.z - 10.0 / 6.0).abs() < 1e-15);
        assert!((found.z_plus - 1.0).abs() < 1e-15);
        assert!((found.z_plus + found.z_minus - found.z).abs() < 1e-15);
        assert!((found.z_backbone - 2.0).abs() < 1e-15);
        assert!((found.rattler_share - 0.5).abs() < 1e-15);
        assert_eq!(found.with_two, 3);
    }

    #[test]
    fn a_wall_holds_the_end_of_a_chain() {
        let mut view = triangle_and_chain();
        view.wall_contacts.push(on_wall(4));
        let found = coordination(&view);
        assert_eq!(found.backbone, [true, true, true, true, true, false]);
        assert!((found.z_wall - 11.0 / 6.0).abs() < 1e-15);
        assert!((found.z_backbone - 11.0 / 5.0).abs() < 1e-15);
    }

    #[test]
    fn nothing_touches() {
        let found = coordination(&View { positions: vec![[0.0; 3]; 3], ..View::default() });
        assert_eq!((found.z, found.z_backbone, found.rattler_share), (0.0, 0.0, 1.0));
    }
}
