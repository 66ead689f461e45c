//! Equilibration of a dense initial state as hard spheres, by Metropolis Monte Carlo at constant volume.

use super::cells::{Cells, distance_squared};
use super::{SMALLEST_GAP, reach};
use crate::random::Stream;

/// Blocks of sweeps; neighbour lists are rebuilt and the step length adapted between blocks.
const BLOCKS: u32 = 120;
/// Trial moves per sphere and block.
const SWEEPS_PER_BLOCK: u32 = 10;
/// Farthest a sphere may go from where its neighbour list was built [d]. Within a block this is a fixed bound, so
/// the moves stay symmetric and detailed balance holds.
const TETHER: f64 = 0.15;
/// Hard diameter [d].
const DIAMETER: f64 = 1.0 + SMALLEST_GAP;

/// Makes 1200 trial moves per sphere; the state stays free of overlap throughout.
pub(super) fn equilibrate(positions: &mut [[f64; 3]], lengths: [f64; 3], stream: Stream) {
    let reaches = lengths.map(reach);
    let mut step = 0.1;
    for block in 0..BLOCKS {
        let anchors = positions.to_vec();
        let neighbours = neighbours(positions, lengths);
        let mut accepted = 0_u64;
        for sweep in 0..SWEEPS_PER_BLOCK {
            let mut moves = stream.item(u64::from(block * SWEEPS_PER_BLOCK + sweep));
            for i in 0..positions.len() {
                let trial = positions[i].map(|x| x + step * (2.0 * moves.unit() - 1.0));
                if is_free(i, &trial, positions, &neighbours, reaches)
                    && distance_squared(&trial, &anchors[i]) <= TETHER * TETHER
                {
                    positions[i] = trial;
                    accepted += 1;
                }
            }
        }
        let trials = u64::from(SWEEPS_PER_BLOCK) * positions.len() as u64;
        step = if 5 * accepted < 2 * trials { step * 0.8 } else { (step * 1.25).min(TETHER) };
    }
}

fn is_free(
    i: usize,
    trial: &[f64; 3],
    positions: &[[f64; 3]],
    neighbours: &Neighbours,
    reaches: [(f64, f64); 3],
) -> bool {
    let inside = trial.iter().zip(reaches).all(|(x, (low, high))| (low..=high).contains(x));
    inside && neighbours.of(i).iter().all(|&j| distance_squared(trial, &positions[j]) >= DIAMETER * DIAMETER)
}

/// Full neighbour lists in one array.
struct Neighbours {
    starts: Vec<usize>,
    members: Vec<usize>,
}

impl Neighbours {
    fn of(&self, i: usize) -> &[usize] {
        &self.members[self.starts[i]..self.starts[i + 1]]
    }
}

/// Everything that can come within the hard diameter while both spheres stay on their tethers.
fn neighbours(positions: &[[f64; 3]], lengths: [f64; 3]) -> Neighbours {
    let range = DIAMETER + 2.0 * TETHER;
    let mut pairs = Vec::new();
    Cells::new(positions, lengths, range).pairs_within(positions, range, |i, j| {
        pairs.push((i, j));
        pairs.push((j, i));
    });
    pairs.sort_unstable();
    let mut starts = vec![0; positions.len() + 1];
    for &(i, _) in &pairs {
        starts[i + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    Neighbours { starts, members: pairs.into_iter().map(|(_, j)| j).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equilibration_dissolves_the_peak_at_the_smallest_gap() {
        // Push-apart leaves most close pairs at one gap; in the hard-sphere fluid the density of pair distances is
        // continuous at contact, so two neighbouring narrow bins hold equal numbers up to counting noise.
        let request = super::super::Request { n: 800, ei: 1.19, speed: 0.0, seed: 2 };
        let state = super::super::initial(&request).unwrap();
        let count_within = |range: f64| {
            let mut count = 0;
            Cells::new(&state.positions, state.lengths, range).pairs_within(
                &state.positions,
                range,
                |_, _| count += 1,
            );
            f64::from(count)
        };
        let (near, both) = (count_within(DIAMETER + 0.004), count_within(DIAMETER + 0.008));
        let noise = both.sqrt();
        assert!((2.0 * near - both).abs() < 4.0 * noise, "{near} of {both} pairs in the nearer bin");
    }
}
