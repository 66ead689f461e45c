//! What lies around the particles, as a pair of them sees it.

mod open;
mod periodic_cell;

pub use open::Open;
pub use periodic_cell::{CellControl, PeriodicCell};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::lane::Lane;
use crate::space::Space;

/// Turns the difference of two positions and velocities into that of the nearest images, and moves what surrounds
/// the particles. Everything but `nearest` does nothing in an open space.
pub trait Boundary<S: Space>:
    Clone + PartialEq + Send + Sync + Serialize + DeserializeOwned + 'static
{
    /// Whether space deforms: then the force pass sums the virial, positions follow the deformation and the
    /// velocities of bodies are those relative to it.
    const DEFORMS: bool;

    /// Nearest image: separation of b as seen from a.
    fn nearest<L: Lane>(&self, separation: S::Vector<L>) -> S::Vector<L>;

    /// Relative velocity of b as seen from a, with what the deformation adds at this separation.
    fn carried<L: Lane>(&self, separation: S::Vector<L>, velocity: S::Vector<L>) -> S::Vector<L>;

    /// Nearest image of a separation, for the neighbour lists [d].
    fn separation(&self, separation: [f64; 3]) -> [f64; 3] {
        separation
    }

    /// Whether the nearest image of b at this separation is not b itself [d]. Between two sorts of the particles this does not
    /// change as long as two bodies are near each other.
    fn crosses(&self, separation: [f64; 3]) -> bool {
        let _ = separation;
        false
    }

    /// The place inside that is the same as `position` [d].
    fn inside(&self, position: [f64; 3]) -> [f64; 3] {
        position
    }

    /// Calls `visit` with every further image of a place inside that lies less than `reach` outside [d].
    fn images(&self, position: [f64; 3], reach: f64, visit: &mut dyn FnMut([f64; 3])) {
        let _ = (position, reach, visit);
    }

    /// Remembers that the near pairs were found now.
    fn mark(&mut self) {}

    /// Where a point that follows the deformation is now that was at `position` at the mark [d].
    fn since_mark(&self, position: [f64; 3]) -> [f64; 3] {
        position
    }

    /// Largest relative displacement, by deformation alone, of two points `apart` since the mark [d].
    fn strain_since_mark(&self, apart: f64) -> f64 {
        let _ = apart;
        0.0
    }

    /// Largest strain rate [1/τ].
    fn fastest(&self) -> f64 {
        0.0
    }

    /// Strain rates e_α at t_n + dt/2 under the virial Σ F_α r_α of t_n [1/τ].
    fn next_rate(&self, virial: [f64; 3], dt: f64) -> [f64; 3] {
        let _ = (virial, dt);
        [0.0; 3]
    }

    /// Coefficient of the local damping of all motion [1].
    fn local_damping(&self) -> f64 {
        0.0
    }

    /// Takes strain rates and edges to the next step.
    fn advance(&mut self, virial: [f64; 3], dt: f64) {
        let _ = (virial, dt);
    }

    /// Why the state makes no sense, if so.
    fn fault(&self) -> Option<String> {
        None
    }
}
