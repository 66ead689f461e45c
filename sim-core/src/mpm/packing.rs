//! Initial states of an assembly: random, free of overlaps, below jamming.
//!
//! Soft discs at random places of the box are relaxed by FIRE (Bitzek et al. 2006, 10.1103/PhysRevLett.97.170201) on
//! their overlaps until none is left: frictionless discs below jamming always find such a state.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Discs in a box [0, width] × [0, height].
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// Radii.
    pub radii: Vec<f64>,
    /// Centres.
    pub centres: Vec<[f64; 2]>,
    /// Width of the box.
    pub width: f64,
    /// Height of the box.
    pub height: f64,
}

/// The relaxation kept an overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlapping {
    /// Largest overlap over the mean radius.
    pub overlap: f64,
}

/// Diameters uniform by area between `least` and `most`: density ∝ 1/d², d = 1/(1/least − u (1/least − 1/most)) at the
/// stratified u = (k + ½)/n.
#[must_use]
pub fn diameters(n: usize, least: f64, most: f64) -> Vec<f64> {
    let (a, b) = (1.0 / least, 1.0 / most);
    (0..n).map(|k| 1.0 / (a - (k as f64 + 0.5) / n as f64 * (a - b))).collect()
}

/// Smallest gap left between surfaces, in mean radii: no contact before the wall moves.
const CLEARANCE: f64 = 2e-3;

/// Packs discs of the given radii at the solid fraction `phi` in a square box.
///
/// # Errors
/// [`Overlapping`] when the solid fraction is at or above jamming.
pub fn pack(mut radii: Vec<f64>, phi: f64, seed: u64) -> Result<Packing, Overlapping> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    for k in (1..radii.len()).rev() {
        radii.swap(k, random.random_range(0..=k));
    }
    let area: f64 = radii.iter().map(|r| std::f64::consts::PI * r * r).sum();
    let side = (area / phi).sqrt();
    let centres: Vec<[f64; 2]> =
        radii.iter().map(|r| [0, 1].map(|_: usize| r + (side - 2.0 * r) * random.random::<f64>())).collect();
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    let grown: Vec<f64> = radii.iter().map(|r| r + CLEARANCE * mean).collect();
    let mut packing = Packing { radii: grown, centres, width: side, height: side };
    let overlap = relax(&mut packing, 0.25 * CLEARANCE * mean) / mean;
    packing.radii = radii;
    if overlap > 0.25 * CLEARANCE { Err(Overlapping { overlap }) } else { Ok(packing) }
}

/// Moves centres until the largest overlap is below `accepted`; returns what is left.
fn relax(packing: &mut Packing, accepted: f64) -> f64 {
    const MOST_STEPS: usize = 20_000;
    let n = packing.centres.len();
    let mut velocity = vec![[0.0; 2]; n];
    let mut force = vec![[0.0; 2]; n];
    let (mut dt, mut mixing, mut downhill) = (0.1, 0.1, 0_u32);
    let mut order: Vec<usize> = (0..n).collect();
    let mut worst = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        worst = forces(packing, &mut order, &mut force);
        if worst <= accepted {
            break;
        }
        let product = |a: &[[f64; 2]], b: &[[f64; 2]]| -> f64 {
            a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
        };
        let power = product(&force, &velocity);
        if power > 0.0 {
            downhill += 1;
            let scale = (product(&velocity, &velocity) / product(&force, &force)).sqrt();
            for (v, f) in velocity.iter_mut().zip(&force) {
                *v = [0, 1].map(|axis| (1.0 - mixing) * v[axis] + mixing * scale * f[axis]);
            }
            if downhill > 5 {
                dt = f64::min(1.1 * dt, 0.4);
                mixing *= 0.99;
            }
        } else {
            (dt, mixing, downhill) = (0.5 * dt, 0.1, 0);
            velocity.fill([0.0; 2]);
        }
        for ((x, v), f) in packing.centres.iter_mut().zip(&mut velocity).zip(&force) {
            for axis in 0..2 {
                v[axis] += dt * f[axis];
                x[axis] += dt * v[axis];
            }
        }
    }
    worst
}

/// Unit springs on overlaps of discs with each other and the box; returns the largest overlap.
fn forces(packing: &Packing, order: &mut [usize], force: &mut [[f64; 2]]) -> f64 {
    let Packing { radii, centres, width, height } = packing;
    let low = |k: usize| centres[k][0] - radii[k];
    order.sort_by(|&a, &b| low(a).total_cmp(&low(b)).then(a.cmp(&b)));
    force.fill([0.0; 2]);
    let mut worst = 0.0_f64;
    for (k, (x, r)) in centres.iter().zip(radii).enumerate() {
        for (axis, extent) in [*width, *height].into_iter().enumerate() {
            for (overlap, sign) in [(r - x[axis], 1.0), (x[axis] + r - extent, -1.0)] {
                if overlap > 0.0 {
                    worst = worst.max(overlap);
                    force[k][axis] += sign * overlap;
                }
            }
        }
    }
    for (place, &a) in order.iter().enumerate() {
        let reach = centres[a][0] + radii[a];
        for &b in order[place + 1..].iter().take_while(|&&b| low(b) < reach) {
            let away = [centres[b][0] - centres[a][0], centres[b][1] - centres[a][1]];
            let distance = (away[0] * away[0] + away[1] * away[1]).sqrt().max(1e-9);
            let overlap = radii[a] + radii[b] - distance;
            if overlap > 0.0 {
                worst = worst.max(overlap);
                for axis in 0..2 {
                    let push = overlap * away[axis] / distance;
                    force[a][axis] -= push;
                    force[b][axis] += push;
                }
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_uniform_by_area() {
        let d = diameters(300, 2.0, 4.0);
        let mean = d.iter().sum::<f64>() / 300.0;
        let square = d.iter().map(|d| d * d).sum::<f64>() / 300.0;
        assert!((mean - 4.0 * 2.0_f64.ln()).abs() < 1e-5 && (square - 8.0).abs() < 1e-3);
        // equal areas in equal ranges of diameter
        let area =
            |low: f64, high: f64| d.iter().filter(|d| (low..high).contains(*d)).map(|d| d * d).sum::<f64>();
        assert!((area(2.0, 3.0) / area(3.0, 4.0) - 1.0).abs() < 0.02);
    }

    #[test]
    fn nothing_overlaps_and_seeds_differ() {
        let make =
            |seed| pack(diameters(100, 1.0, 2.0).iter().map(|d| d / 2.0).collect(), 0.75, seed).unwrap();
        let p = make(1);
        for a in 0..100 {
            for axis in 0..2 {
                let x = p.centres[a][axis];
                assert!(x > p.radii[a] && x + p.radii[a] < p.width);
            }
            for b in 0..a {
                let d = libm::hypot(p.centres[a][0] - p.centres[b][0], p.centres[a][1] - p.centres[b][1]);
                assert!(d > p.radii[a] + p.radii[b]);
            }
        }
        assert_eq!(p, make(1));
        assert_ne!(p.centres, make(2).centres);
    }

    #[test]
    fn a_solid_fraction_above_jamming_is_refused() {
        assert!(pack(vec![0.5; 60], 0.92, 1).is_err());
    }
}
