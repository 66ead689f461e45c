//! Coordination and force statistics of a packing of discs.

use core::f64::consts::PI;

/// One interaction of a packing of discs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscContact {
    /// First disc, the lower index.
    pub i: u32,
    /// Second disc.
    pub j: u32,
    /// Gap h between the perimeters; negative in contact [a].
    pub gap: f64,
    /// Vector from the centre of `i` to the centre of `j` [a].
    pub branch: [f64; 2],
    /// Normal force F_N, elastic and attractive, compression positive [F0].
    pub normal: f64,
    /// Tangential force F_T [F0].
    pub tangential: f64,
    /// Rolling moment Γ [F0 a].
    pub rolling: f64,
}

/// Coordination numbers of a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordination {
    /// z = 2 N_c/N over all interactions, distant ones included.
    pub all: f64,
    /// z+: carrying compression.
    pub compressive: f64,
    /// z−: carrying tension.
    pub tensile: f64,
    /// z0: carrying no force within tolerance.
    pub unloaded: f64,
    /// Distant attractive bonds (0 < h < D0) per disc, twice their number over N.
    pub distant: f64,
    /// Share x0 of discs that carry no load.
    pub rattler_share: f64,
    /// z* = z/(1 − x0); counts the interactions between load-carrying discs only.
    pub backbone: f64,
    /// Share x22 of contacts that join discs with exactly two contacts.
    pub two_by_two: f64,
    /// ⟨F_N⟩ over all interactions [F0].
    pub mean_normal: f64,
}

/// Counts interactions. Forces below `zero_force` count as zero; a disc is a rattler when, again and again after
/// removing others, it has fewer than `needed` interactions (two without rolling resistance, else one) that carry
/// more than that, or, in cohesive packings (`cohesive`), fewer than `needed` of any force: a pair at its
/// equilibrium distance holds its discs.
#[must_use]
pub fn coordination(
    discs: usize,
    contacts: &[DiscContact],
    zero_force: f64,
    rules: LoadRules,
) -> Coordination {
    let count = discs as f64;
    let mut result = Coordination::default();
    for contact in contacts {
        let kind = if contact.normal > zero_force {
            &mut result.compressive
        } else if contact.normal < -zero_force {
            &mut result.tensile
        } else {
            &mut result.unloaded
        };
        *kind += 2.0 / count;
        if contact.gap > 0.0 {
            result.distant += 2.0 / count;
        }
        result.mean_normal += contact.normal;
    }
    result.all = 2.0 * contacts.len() as f64 / count;
    if !contacts.is_empty() {
        result.mean_normal /= contacts.len() as f64;
    }
    let holds = |contact: &DiscContact| rules.unloaded_contacts_hold || contact.normal.abs() > zero_force;
    let carries = load_carrying(discs, contacts, rules.needed, holds);
    let carrying = carries.iter().filter(|&&carried| carried).count() as f64;
    result.rattler_share = 1.0 - carrying / count;
    let between = contacts
        .iter()
        .filter(|contact| holds(contact) && carries[contact.i as usize] && carries[contact.j as usize])
        .count();
    result.backbone = if carrying > 0.0 { 2.0 * between as f64 / carrying } else { 0.0 };
    result.two_by_two = two_by_two(discs, contacts);
    result
}

/// What makes a disc part of the load-carrying structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadRules {
    /// Interactions a disc needs to stand still.
    pub needed: usize,
    /// Whether an interaction without force holds its discs, as an adhesive contact does.
    pub unloaded_contacts_hold: bool,
}

/// The discs left after removing, again and again, those with fewer than `needed` holding interactions.
#[must_use]
pub fn load_carrying(
    discs: usize,
    contacts: &[DiscContact],
    needed: usize,
    holds: impl Fn(&DiscContact) -> bool,
) -> Vec<bool> {
    let mut neighbours = vec![Vec::new(); discs];
    for contact in contacts.iter().filter(|contact| holds(contact)) {
        neighbours[contact.i as usize].push(contact.j as usize);
        neighbours[contact.j as usize].push(contact.i as usize);
    }
    let mut degree: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    let mut carries = vec![true; discs];
    let mut loose: Vec<usize> = (0..discs).filter(|&disc| degree[disc] < needed).collect();
    while let Some(disc) = loose.pop() {
        if !carries[disc] {
            continue;
        }
        carries[disc] = false;
        for &other in &neighbours[disc] {
            degree[other] -= 1;
            if carries[other] && degree[other] < needed {
                loose.push(other);
            }
        }
    }
    carries
}

fn two_by_two(discs: usize, contacts: &[DiscContact]) -> f64 {
    let mut degree = vec![0_u32; discs];
    for contact in contacts {
        degree[contact.i as usize] += 1;
        degree[contact.j as usize] += 1;
    }
    let joined = contacts
        .iter()
        .filter(|contact| degree[contact.i as usize] == 2 && degree[contact.j as usize] == 2)
        .count();
    if contacts.is_empty() { 0.0 } else { joined as f64 / contacts.len() as f64 }
}

/// Number of clusters of discs joined by interactions; a disc alone is a cluster.
#[must_use]
pub fn clusters(discs: usize, pairs: impl Iterator<Item = (u32, u32)>) -> usize {
    let mut parent: Vec<u32> = (0..discs as u32).collect();
    let mut count = discs;
    for (i, j) in pairs {
        let (first, second) = (root(&mut parent, i), root(&mut parent, j));
        if first != second {
            parent[first.max(second) as usize] = first.min(second);
            count -= 1;
        }
    }
    count
}

fn root(parent: &mut [u32], mut disc: u32) -> u32 {
    while parent[disc as usize] != disc {
        let above = parent[parent[disc as usize] as usize];
        parent[disc as usize] = above;
        disc = above;
    }
    disc
}

/// Mean normal force expected from pressure, ⟨F_N⟩ = π ⟨d²⟩ P/(z Φ ⟨d⟩), eq. (11) of the 2008 paper [F0].
#[must_use]
pub fn expected_mean_normal(pressure: f64, coordination: f64, solid_fraction: f64, diameters: &[f64]) -> f64 {
    let count = diameters.len() as f64;
    let first = diameters.iter().sum::<f64>() / count;
    let second = diameters.iter().map(|d| d * d).sum::<f64>() / count;
    PI * second * pressure / (coordination * solid_fraction * first)
}

/// Probability density of the normal forces in equal bins.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceHistogram {
    /// Middle of every bin [units of the forces].
    pub centres: Vec<f64>,
    /// Density P(F_N); integrates to the share of the forces inside the range.
    pub densities: Vec<f64>,
}

/// Histogram of `forces` with `bins` bins from `lowest` to `highest`.
#[must_use]
pub fn force_histogram(
    forces: impl Iterator<Item = f64>,
    lowest: f64,
    highest: f64,
    bins: usize,
) -> ForceHistogram {
    let width = (highest - lowest) / bins as f64;
    let mut counts = vec![0_usize; bins];
    let mut total = 0_usize;
    for force in forces {
        total += 1;
        let bin = libm::floor((force - lowest) / width);
        if bin >= 0.0 && bin < bins as f64 {
            counts[bin as usize] += 1;
        }
    }
    let norm = if total == 0 { 0.0 } else { 1.0 / (total as f64 * width) };
    ForceHistogram {
        centres: (0..bins).map(|bin| lowest + (bin as f64 + 0.5) * width).collect(),
        densities: counts.iter().map(|&count| count as f64 * norm).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(i: u32, j: u32, normal: f64) -> DiscContact {
        let gap = if normal == -0.5 { 5e-4 } else { -1e-5 };
        DiscContact { i, j, gap, branch: [1.0, 0.0], normal, tangential: 0.0, rolling: 0.0 }
    }

    #[test]
    fn counts_by_sign() {
        // A ring of four with a tail 3-4-5 and a free disc 6; one distant bond.
        let contacts = [
            contact(0, 1, 1.0),
            contact(0, 3, -0.2),
            contact(1, 2, 0.0),
            contact(2, 3, 2.0),
            contact(3, 4, -0.5),
            contact(4, 5, 0.0),
        ];
        let rules = LoadRules { needed: 2, unloaded_contacts_hold: true };
        let found = coordination(7, &contacts, 1e-4, rules);
        assert!((found.all - 12.0 / 7.0).abs() < 1e-15);
        assert!((found.compressive - 4.0 / 7.0).abs() < 1e-15);
        assert!((found.tensile - 4.0 / 7.0).abs() < 1e-15);
        assert!((found.unloaded - 4.0 / 7.0).abs() < 1e-15);
        assert!((found.distant - 2.0 / 7.0).abs() < 1e-15);
        assert!((found.rattler_share - 3.0 / 7.0).abs() < 1e-15);
        assert!((found.backbone - 2.0).abs() < 1e-15);
        // Discs with two contacts: 0, 1, 2, 4; joined: 0-1 and 1-2.
        assert!((found.two_by_two - 2.0 / 6.0).abs() < 1e-15);
        assert!((found.mean_normal - 2.3 / 6.0).abs() < 1e-15);
        let strict = LoadRules { needed: 2, unloaded_contacts_hold: false };
        assert!((coordination(7, &contacts, 1e-4, strict).rattler_share - 1.0).abs() < 1e-15);
    }

    #[test]
    fn clusters_are_counted() {
        assert_eq!(clusters(5, [(0, 1), (3, 4), (1, 0)].into_iter()), 3);
        assert_eq!(clusters(5, [(0, 1), (3, 4), (1, 2), (2, 3)].into_iter()), 1);
    }

    #[test]
    fn density_integrates_to_the_share_inside() {
        let histogram = force_histogram([-0.5, 0.1, 0.2, 3.0].into_iter(), -1.0, 1.0, 8);
        let integral: f64 = histogram.densities.iter().map(|density| density * 0.25).sum();
        assert!((integral - 0.75).abs() < 1e-15);
        assert!((histogram.densities[2] - 1.0).abs() < 1e-15);
    }

    #[test]
    fn mean_force_of_uniform_diameters() {
        // 7π a P/(9 z Φ) for d uniform in [a/2, a].
        let diameters: Vec<f64> =
            (0..100_001).map(|index| 0.5 + 0.5 * f64::from(index) / 100_000.0).collect();
        let found = expected_mean_normal(0.01, 3.0, 0.5, &diameters);
        assert!((found / (7.0 * PI * 0.01 / (9.0 * 1.5)) - 1.0).abs() < 1e-5);
    }
}
