//! Initial states of spheres: at random without overlap in a box, at rest relative to their agitation.
//!
//! Deterministic from the seed. Random points are pushed apart until the smallest gap is [`SMALLEST_GAP`]; a dense
//! request (e_i below [`EQUILIBRATE_BELOW`]) is then equilibrated as hard spheres, because push-apart leaves a dense
//! state full of pairs at exactly the smallest gap.

mod cells;
mod hard_spheres;
mod push_apart;

use std::f64::consts::PI;

use crate::SimError;
use crate::random::Stream;

/// Smallest gap between two spheres of an initial state [d].
pub(crate) const SMALLEST_GAP: f64 = 1.0e-3;
/// Initial void ratio below which the state is equilibrated as hard spheres [1].
pub(crate) const EQUILIBRATE_BELOW: f64 = 1.2;
/// Proportions of the box: 25 d × 25 d × 40 d holds the paper's 17 657 spheres.
const PROPORTIONS: [f64; 3] = [25.0, 25.0, 40.0];

/// Streams of the seed, one per purpose.
mod stream {
    pub(super) const POSITIONS: u64 = 1;
    pub(super) const VELOCITIES: u64 = 2;
    pub(super) const EQUILIBRATION: u64 = 3;
}

/// An initial state in units of d and τ: the box is [0, lengths], walls on its faces.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Packing {
    /// Edge lengths of the box [d].
    pub(crate) lengths: [f64; 3],
    /// Centres [d].
    pub(crate) positions: Vec<[f64; 3]>,
    /// Velocities [d/τ].
    pub(crate) velocities: Vec<[f64; 3]>,
}

/// What an initial state is made from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request {
    /// Number of spheres.
    pub(crate) n: usize,
    /// Void ratio V_box/V_solid − 1 [1].
    pub(crate) ei: f64,
    /// Speed of every sphere [d/τ].
    pub(crate) speed: f64,
    /// Seed of positions and velocities.
    pub(crate) seed: u64,
}

/// Edge lengths of the box that holds `n` spheres at void ratio `ei`, in the paper's proportions [d].
#[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
pub(crate) fn box_lengths(n: usize, ei: f64) -> [f64; 3] {
    let volume = (1.0 + ei) * n as f64 * PI / 6.0;
    let scale = libm::cbrt(volume / PROPORTIONS.iter().product::<f64>());
    PROPORTIONS.map(|edge| edge * scale)
}

/// Makes the initial state.
///
/// # Errors
/// [`SimError::Scene`] naming `ei` when the spheres do not fit, or no state was found.
pub(crate) fn initial(request: &Request) -> Result<Packing, SimError> {
    let lengths = box_lengths(request.n, request.ei);
    let too_dense = |problem: String| SimError::Scene {
        field: "ei".to_owned(),
        problem,
        remedy: "raise ei or n".to_owned(),
    };
    if lengths.iter().any(|&edge| edge < 1.0 + SMALLEST_GAP) {
        let shortest = lengths[0];
        return Err(too_dense(format!(
            "{} at n = {} gives a box {shortest:.3} d wide: no sphere fits",
            request.ei, request.n
        )));
    }
    let mut points = Stream::new(request.seed, stream::POSITIONS);
    let mut positions: Vec<[f64; 3]> =
        (0..request.n).map(|_| lengths.map(|edge| 0.5 + (edge - 1.0) * points.unit())).collect();
    push_apart::push_apart(&mut positions, lengths).map_err(|stuck| {
        too_dense(format!(
            "{} at n = {}: no state without overlap was found ({} pairs still closer than {} d after {} sweeps)",
            request.ei,
            request.n,
            stuck.close_pairs,
            1.0 + SMALLEST_GAP,
            stuck.sweeps
        ))
    })?;
    if request.ei < EQUILIBRATE_BELOW {
        hard_spheres::equilibrate(&mut positions, lengths, Stream::new(request.seed, stream::EQUILIBRATION));
    }
    let headings = Stream::new(request.seed, stream::VELOCITIES);
    let velocities = (0..request.n)
        .map(|particle| headings.item(particle as u64).direction().map(|u| request.speed * u))
        .collect();
    Ok(Packing { lengths, positions, velocities })
}

/// Range of the coordinate of a centre along an edge: half a gap further in than the wall's reach [d].
fn reach(edge: f64) -> (f64, f64) {
    (0.5 + 0.5 * SMALLEST_GAP, edge - 0.5 - 0.5 * SMALLEST_GAP)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn smallest_distance(positions: &[[f64; 3]]) -> f64 {
        let mut smallest = f64::INFINITY;
        for (i, a) in positions.iter().enumerate() {
            for b in &positions[i + 1..] {
                let square: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
                smallest = smallest.min(square.sqrt());
            }
        }
        smallest
    }

    fn check(request: Request) {
        let state = initial(&request).unwrap();
        let volume: f64 = state.lengths.iter().product();
        let e = volume / (request.n as f64 * PI / 6.0) - 1.0;
        assert!((e - request.ei).abs() < 1e-12);
        assert!(smallest_distance(&state.positions) >= 1.0 + SMALLEST_GAP);
        for x in &state.positions {
            for (coordinate, edge) in x.iter().zip(state.lengths) {
                assert!((0.5..=edge - 0.5).contains(coordinate));
            }
        }
        for v in &state.velocities {
            let speed = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            assert!((speed - request.speed).abs() <= 1e-14 * request.speed);
        }
        assert_eq!(initial(&request).unwrap(), state);
    }

    #[test]
    fn the_papers_box_holds_the_papers_number() {
        let lengths = box_lengths(17_657, 25_000.0 / (17_657.0 * PI / 6.0) - 1.0);
        for (edge, expected) in lengths.iter().zip(PROPORTIONS) {
            assert!((edge - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn loose_to_dense_states_have_no_overlap() {
        for ei in [0.9, 1.0, 1.19, 1.3, 1.704, 3.0, 10.0] {
            check(Request { n: 500, ei, speed: 1.58e-4, seed: 1 });
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn any_reasonable_request_is_met(n in 60_usize..300, ei in 1.25_f64..10.0, seed in any::<u64>()) {
            check(Request { n, ei, speed: 1e-3, seed });
        }
    }

    #[test]
    fn an_impossible_density_names_ei() {
        for (n, ei) in [(1, 1.704), (3, 1.704), (100, 0.8), (100, 0.0)] {
            let error = initial(&Request { n, ei, speed: 0.0, seed: 1 }).unwrap_err();
            assert!(matches!(error, SimError::Scene { ref field, .. } if field == "ei"), "{error}");
        }
    }

    #[test]
    fn one_sphere_in_a_roomy_box() {
        check(Request { n: 1, ei: 9.0, speed: 1e-3, seed: 5 });
    }
}
