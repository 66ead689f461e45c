//! The contact network: which discs carry force, coordination numbers.

use std::collections::BTreeMap;

use crate::mpm::contact::Partner;

/// Normal impulses between discs and with walls, summed over an interval.
pub type Impulses = BTreeMap<(u32, Partner), f64>;

/// A contact that bears force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// First disc.
    pub disc: u32,
    /// Second disc (the higher number) or a wall.
    pub partner: Partner,
    /// Mean normal force over the interval.
    pub force: f64,
}

/// Coordination of a network.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordination {
    /// Z = (2 N_cc + N_cw)/N′ over discs with at least two force-bearing contacts, others removed until none is left.
    pub z: f64,
    /// The same over all discs.
    pub z_all: f64,
    /// The same over discs with at least three contacts.
    pub z_three: f64,
    /// Share of discs with fewer than two force-bearing contacts.
    pub rattlers: f64,
}

/// Contacts with more than 10⁻³ of the mean force, pairs merged, walls counted once per disc.
#[must_use]
pub fn contacts(impulses: &Impulses, interval: f64) -> Vec<Contact> {
    let mut merged: Impulses = BTreeMap::new();
    for (&(disc, partner), &impulse) in impulses {
        let key = match partner {
            Partner::Body(other) if other < disc => (other, Partner::Body(disc)),
            _ => (disc, partner),
        };
        *merged.entry(key).or_insert(0.0) += impulse;
    }
    merged.retain(|_, impulse| *impulse > 0.0);
    let mean = merged.values().sum::<f64>() / merged.len().max(1) as f64;
    let bearing = merged.into_iter().filter(|(_, impulse)| *impulse > 1e-3 * mean);
    bearing.map(|((disc, partner), impulse)| Contact { disc, partner, force: impulse / interval }).collect()
}

/// Coordination numbers of `discs` discs.
#[must_use]
pub fn coordination(contacts: &[Contact], discs: usize) -> Coordination {
    let (z, kept) = backbone(contacts, discs, 2);
    let (z_three, _) = backbone(contacts, discs, 3);
    let (z_all, _) = backbone(contacts, discs, 0);
    Coordination { z, z_all, z_three, rattlers: 1.0 - kept as f64 / discs as f64 }
}

/// Mean coordination of the discs left when those with fewer than `least` contacts are removed again and again.
fn backbone(contacts: &[Contact], discs: usize, least: u32) -> (f64, usize) {
    let mut alive = vec![true; discs];
    loop {
        let mut count = vec![0_u32; discs];
        for contact in contacts {
            match contact.partner {
                Partner::Body(other) if alive[contact.disc as usize] && alive[other as usize] => {
                    count[contact.disc as usize] += 1;
                    count[other as usize] += 1;
                }
                Partner::Wall(_) if alive[contact.disc as usize] => count[contact.disc as usize] += 1,
                _ => {}
            }
        }
        let loose: Vec<usize> = (0..discs).filter(|&disc| alive[disc] && count[disc] < least).collect();
        if loose.is_empty() {
            let kept = alive.iter().filter(|alive| **alive).count();
            let sum: u32 = count.iter().sum();
            return (if kept > 0 { f64::from(sum) / kept as f64 } else { 0.0 }, kept);
        }
        loose.into_iter().for_each(|disc| alive[disc] = false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_between_walls_with_a_dangling_disc() {
        let mut impulses = Impulses::new();
        impulses.insert((0, Partner::Wall(0)), 2.0);
        impulses.insert((0, Partner::Body(1)), 1.0);
        impulses.insert((1, Partner::Body(0)), 1.0);
        impulses.insert((1, Partner::Wall(1)), 2.0);
        impulses.insert((2, Partner::Body(1)), 1e-2);
        impulses.insert((3, Partner::Body(2)), 1e-9);
        let found = contacts(&impulses, 0.5);
        assert_eq!(found.len(), 4, "the last one is below a thousandth of the mean");
        assert_eq!(found.iter().map(|contact| contact.force).fold(0.0, f64::max), 4.0);
        let z = coordination(&found, 4);
        // discs 0 and 1: one mutual contact and a wall each; disc 2 dangles, disc 3 is free
        assert_eq!((z.z, z.rattlers), (2.0, 0.5));
        assert_eq!(z.z_all, 6.0 / 4.0);
        assert_eq!(z.z_three, 0.0);
    }
}
