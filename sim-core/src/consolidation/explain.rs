//! What a scene of cohesive discs would run.

use scene::discs::{Assembly, ReducedDiscs};

use super::assemble::parameters;
use crate::boundary::CellControl;
use crate::dem::{InitialDiscs, discs};
use crate::{Explanation, Options, SimError, Skip};

/// Bytes of one disc with its lists: records, contacts, neighbours.
const BYTES_PER_DISC: u64 = 1500;

/// Explains a reduced scene.
///
/// # Errors
/// None at present: every reduced scene compiles.
pub(crate) fn explain(scene: &ReducedDiscs) -> Result<Explanation, SimError> {
    // The kernel of two discs is that of all.
    let pair = InitialDiscs {
        positions: vec![[1.0, 1.0], [3.0, 3.0]],
        radii: vec![0.5; 2],
        velocities: vec![[0.0; 2]; 2],
        spins: vec![0.0; 2],
        edges: [8.0; 2],
        control: CellControl::Fixed,
    };
    let kernel = discs(&parameters(scene), &pair, scene.dt, &Options::default()).kernel();
    let mut skips = Vec::new();
    let mut skip = |absent: &str, skipped: &str| {
        skips.push(Skip { absent: absent.to_owned(), skipped: skipped.to_owned(), saves: None });
    };
    if scene.f0 == 0.0 {
        skip("attraction", "its force, and the search for pairs at a distance");
    }
    if scene.kt == 0.0 || scene.mu == 0.0 {
        skip("friction", "tangential memory, spins and torques");
    }
    if scene.kr == 0.0 || scene.mu_r == 0.0 {
        skip("rolling resistance", "rolling memory and moments");
    }
    if scene.en == 1.0 {
        skip("damping", "the normal dashpot and its memory");
    }
    if scene.assembly != Assembly::Type2 {
        skip("aggregation", "agitation and the stage in a fixed cell");
    }
    let cost = scene::cost(&scene::Reduced::CohesiveDiscs(scene.clone()));
    Ok(Explanation {
        kernel,
        skips,
        dt: scene.dt,
        dt_reason:
            "given in √(m/K_N), 0.1 unless the scene says otherwise; larger steps than 0.14 are refused \
                    because they fail silently"
                .to_owned(),
        memory_bytes: scene.n * BYTES_PER_DISC,
        expected_steps: cost.steps,
        expected_seconds: cost.seconds,
    })
}
