//! The complete state as bytes and back. What is stored is the state alone; lists are made anew, which changes no bit
//! of what follows.

use serde::{Deserialize, Serialize};

use super::engine::Dem;
use super::kernel::Path;
use super::lists::Carried;
use super::{Drag, lists};
use crate::SimError;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::lane::Number;
use crate::space::Space;
use crate::state::{Grains, Kinematics};

/// The stored state, particles in slot order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Persisted {
    /// Name of the compiled laws, without the path.
    pub kernel: String,
    pub step: u64,
    pub dt: f64,
    pub time: f64,
    pub walls: Option<ServoWalls>,
    /// The boundary, encoded.
    pub boundary: Vec<u8>,
    /// x, v, ω of every slot.
    pub bodies: Vec<[[f64; 3]; 3]>,
    pub original: Vec<u32>,
    pub drag: Drag,
    /// Slots and memory of pair contacts, then (slot, wall) and memory of wall contacts.
    pub pairs: Vec<(u32, u32, Vec<f64>)>,
    pub wall_contacts: Vec<(u32, u32, Vec<f64>)>,
}

impl Persisted {
    /// Reads a state and checks that its parts fit together.
    pub fn decode(bytes: &[u8]) -> Result<Self, SimError> {
        let bad = |what: &str| SimError::Checkpoint(format!("particle state: {what}"));
        let state: Self = postcard::from_bytes(bytes).map_err(|error| bad(&error.to_string()))?;
        let count = state.bodies.len();
        let mut seen = vec![false; count];
        for &particle in &state.original {
            let place = seen.get_mut(particle as usize).ok_or_else(|| bad("particle number out of range"))?;
            if std::mem::replace(place, true) {
                return Err(bad("a particle number occurs twice"));
            }
        }
        if state.original.len() != count {
            return Err(bad("numbers and bodies differ in length"));
        }
        if let Drag::Each(rates) = &state.drag
            && rates.len() != count
        {
            return Err(bad("drag and bodies differ in length"));
        }
        let valid_pair = |(a, b, _): &(u32, u32, Vec<f64>)| a < b && (*b as usize) < count;
        if !state.pairs.iter().all(valid_pair) {
            return Err(bad("contact of particles that do not exist"));
        }
        let valid_wall = |(a, wall, _): &(u32, u32, Vec<f64>)| (*a as usize) < count && *wall < 6;
        if !state.wall_contacts.iter().all(valid_wall) {
            return Err(bad("wall contact of a particle or wall that does not exist"));
        }
        Ok(state)
    }
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// The state as bytes.
    pub(super) fn persist(&self) -> Vec<u8> {
        let pack = |contacts: Vec<Carried>| -> Vec<(u32, u32, Vec<f64>)> {
            let mut packed: Vec<_> =
                contacts.into_iter().map(|contact| (contact.a, contact.b, contact.memory)).collect();
            packed.sort_unstable_by_key(|&(a, b, _)| (a, b));
            packed
        };
        let (pairs, wall_contacts) = self.carried();
        let state = Persisted {
            kernel: Self::law_name(),
            step: self.step,
            dt: self.dt,
            time: self.time,
            walls: self.walls.clone(),
            boundary: postcard::to_allocvec(&self.boundary)
                .expect("a boundary of plain numbers always encodes"),
            bodies: self
                .bodies
                .iter()
                .map(|body| {
                    let (velocity, spin) = body.motion();
                    [body.position(), velocity, spin]
                })
                .collect(),
            original: self.original.clone(),
            drag: self.drag.clone(),
            pairs: pack(pairs),
            wall_contacts: pack(wall_contacts),
        };
        postcard::to_allocvec(&state).expect("a state of plain numbers always encodes")
    }

    /// Continues from a stored state that [`Persisted::decode`] has checked.
    pub(super) fn from_persisted(
        law: C,
        wall_law: C,
        grains: G,
        boundary: B,
        state: Persisted,
        path: Path,
        threads: usize,
    ) -> Self {
        let bodies = state.bodies.iter().map(|&[x, v, w]| S::Body::new(x, v, w)).collect();
        let mut dem = Self::assemble(
            law,
            wall_law,
            grains,
            boundary,
            state.walls,
            bodies,
            state.original,
            state.dt,
            path,
            threads,
        );
        (dem.step, dem.time, dem.drag) = (state.step, state.time, state.drag);
        dem.order_drag();
        let unpack = |contacts: Vec<(u32, u32, Vec<f64>)>| {
            contacts
                .into_iter()
                .filter(|(_, _, memory)| memory.len() == C::SLOTS)
                .map(|(a, b, memory)| lists::Carried { a, b, memory })
                .collect()
        };
        dem.place(unpack(state.pairs), unpack(state.wall_contacts));
        dem.rebuild();
        dem.refresh();
        dem
    }

    /// Name of the compiled laws.
    pub(super) fn law_name() -> String {
        format!("dem{}d+{}{}", S::DIMENSION, <S::Real as Number>::NAME, C::name())
    }
}
