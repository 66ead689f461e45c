//! What lies around the particles, as a pair of them sees it.

use crate::lane::Lane;
use crate::space::Space;

/// Turns the difference of two positions and velocities into that of the nearest images.
pub trait Boundary<S: Space>: Clone + Send + Sync + 'static {
    /// Nearest image: separation and relative velocity of b as seen from a.
    fn nearest<L: Lane>(
        &self,
        separation: S::Vector<L>,
        velocity: S::Vector<L>,
    ) -> (S::Vector<L>, S::Vector<L>);
}

/// No images: free space, or walls (which act as contacts).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Open;

impl<S: Space> Boundary<S> for Open {
    #[inline(always)]
    fn nearest<L: Lane>(
        &self,
        separation: S::Vector<L>,
        velocity: S::Vector<L>,
    ) -> (S::Vector<L>, S::Vector<L>) {
        (separation, velocity)
    }
}
