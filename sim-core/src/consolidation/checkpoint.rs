//! The complete state of a run as bytes and back.

use record::Row;
use scene::discs::ReducedDiscs;
use serde::{Deserialize, Serialize};

use super::assemble::{initial_state, parameters};
use super::driver::{Consolidation, Course, State};
use crate::dem::restore_discs;
use crate::{Options, SimError};

/// Format of the checkpoint.
const VERSION: u32 = 1;

/// Row as JSON, scattering, forces.
type StoredState = (String, Vec<[f64; 2]>, Vec<[f64; 2]>);

#[derive(Serialize, Deserialize)]
struct Stored {
    version: u32,
    scene_key: String,
    course: Course,
    /// Rows as JSON (they are self-describing, postcard is not), scattering, forces.
    states: Vec<StoredState>,
    fallback: Vec<u8>,
    particles: Vec<u8>,
}

impl Consolidation {
    /// The run as bytes.
    pub(super) fn to_checkpoint(&self) -> Vec<u8> {
        let stored = Stored {
            version: VERSION,
            scene_key: self.key.clone(),
            course: self.course.clone(),
            states: self
                .states
                .iter()
                .map(|state| {
                    let row = serde_json::to_string(&state.row).expect("a row is plain JSON");
                    (row, state.scattering.clone(), state.histogram.clone())
                })
                .collect(),
            fallback: self.fallback.clone(),
            particles: self.dem.save(),
        };
        let body = postcard::to_allocvec(&stored).expect("a state of plain numbers always encodes");
        let mut bytes = blake3::hash(&body).as_bytes().to_vec();
        bytes.extend(body);
        bytes
    }

    /// Continues from bytes made for the same scene, to the same bits.
    ///
    /// # Errors
    /// [`SimError::Checkpoint`] when the bytes are damaged or belong to another scene.
    pub fn from_checkpoint(
        scene: &ReducedDiscs,
        key: String,
        options: &Options,
        bytes: &[u8],
    ) -> Result<Self, SimError> {
        let bad = |what: String| SimError::Checkpoint(format!("consolidation: {what}"));
        let (digest, body) = bytes
            .split_at_checked(blake3::OUT_LEN)
            .ok_or_else(|| bad("shorter than its digest".to_owned()))?;
        if blake3::hash(body).as_bytes() != digest {
            return Err(bad("the digest does not fit: the bytes are damaged".to_owned()));
        }
        let stored: Stored = postcard::from_bytes(body).map_err(|error| bad(error.to_string()))?;
        if stored.version != VERSION {
            return Err(bad(format!("version {}, this program reads {VERSION}", stored.version)));
        }
        if stored.scene_key != key {
            return Err(bad(format!("of scene {}, not {key}", stored.scene_key)));
        }
        // Radii follow from the seed.
        let radii = initial_state(scene)?.radii;
        let dem = restore_discs(&parameters(scene), &radii, &stored.particles, options)?;
        let states = stored
            .states
            .into_iter()
            .map(|(row, scattering, histogram)| {
                let row: Row = serde_json::from_str(&row).map_err(|error| bad(error.to_string()))?;
                Ok(State { row, scattering, histogram })
            })
            .collect::<Result<Vec<State>, SimError>>()?;
        let run =
            Self::assemble(scene, key, options, radii, dem, stored.course, states, Some(stored.fallback));
        if let super::driver::Phase::Path(index) = run.course.phase
            && index >= run.path.len()
        {
            return Err(bad("a state beyond the end of the path".to_owned()));
        }
        Ok(run)
    }
}
