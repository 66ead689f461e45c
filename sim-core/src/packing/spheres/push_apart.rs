//! Random points to spheres without overlap: pairs that are too close move apart until none is left.

use super::cells::{Cells, distance_squared};
use super::{SMALLEST_GAP, reach};

/// Sweeps after which a state counts as not found. Some 30 are needed at e = 1.7, hundreds at 0.9 with 500
/// spheres (fewer with more: less of the box is lost to the walls).
const MOST_SWEEPS: u32 = 5000;
/// Pairs are moved to a gap a little above the smallest one, so that a finite number of sweeps gets there [d].
const TARGET_GAP: f64 = 1.05 * SMALLEST_GAP;
/// Share of the missing distance by which a pair is moved apart: over-relaxation [1]. It also decides how much of the
/// large-scale unevenness of random points survives, and with adhesion the final void ratio depends on that
/// (docs/accuracy.md); 1.4 agrees with the independent reference runs in e, e_core and Z± at both sizes.
const OVER_RELAXATION: f64 = 1.4;
/// Reach of the pair list beyond the target, for pairs that come close within one sweep [d].
const MARGIN: f64 = 0.1;

/// No state without overlap was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stuck {
    pub(super) sweeps: u32,
    pub(super) close_pairs: usize,
}

/// Moves centres apart, Gauss–Seidel over the close pairs, until every gap is at least [`SMALLEST_GAP`]; the
/// number of sweeps that took.
pub(super) fn push_apart(positions: &mut [[f64; 3]], lengths: [f64; 3]) -> Result<u32, Stuck> {
    let reaches = lengths.map(reach);
    for x in positions.iter_mut() {
        clamp(x, reaches);
    }
    let mut close = Vec::new();
    let mut close_pairs = 0;
    for sweep in 0..MOST_SWEEPS {
        close.clear();
        close_pairs = 0;
        let range = 1.0 + TARGET_GAP + MARGIN;
        let smallest = (1.0 + SMALLEST_GAP) * (1.0 + SMALLEST_GAP);
        Cells::new(positions, lengths, range).pairs_within(positions, range, |i, j| {
            close_pairs += usize::from(distance_squared(&positions[i], &positions[j]) < smallest);
            close.push((i, j));
        });
        if close_pairs == 0 {
            return Ok(sweep);
        }
        for &(i, j) in &close {
            separate(positions, i, j, reaches);
        }
    }
    Err(Stuck { sweeps: MOST_SWEEPS, close_pairs })
}

/// Moves a pair that is too close beyond the target gap, half the way each, kept off the walls.
fn separate(positions: &mut [[f64; 3]], i: usize, j: usize, reaches: [(f64, f64); 3]) {
    const TARGET: f64 = 1.0 + TARGET_GAP;
    let square = distance_squared(&positions[i], &positions[j]);
    if square >= TARGET * TARGET {
        return;
    }
    let distance = square.sqrt();
    let normal = if distance > 1.0e-9 {
        [0, 1, 2].map(|k| (positions[i][k] - positions[j][k]) / distance)
    } else {
        // coincident centres part along the long edge
        [0.0, 0.0, 1.0]
    };
    let half = 0.5 * OVER_RELAXATION * (TARGET - distance);
    for k in 0..3 {
        positions[i][k] += half * normal[k];
        positions[j][k] -= half * normal[k];
    }
    clamp(&mut positions[i], reaches);
    clamp(&mut positions[j], reaches);
}

fn clamp(x: &mut [f64; 3], reaches: [(f64, f64); 3]) {
    for (coordinate, (low, high)) in x.iter_mut().zip(reaches) {
        *coordinate = coordinate.clamp(low, high);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn the_papers_density_takes_tens_of_sweeps() {
        for seed in 0..3 {
            let lengths = super::super::box_lengths(500, 1.704);
            let mut points = Stream::new(seed, 1);
            let mut positions: Vec<[f64; 3]> =
                (0..500).map(|_| lengths.map(|edge| 0.5 + (edge - 1.0) * points.unit())).collect();
            let sweeps = push_apart(&mut positions, lengths).unwrap();
            assert!((10..100).contains(&sweeps), "{sweeps}");
        }
    }
}
