//! No images: free space, or walls (which act as contacts).

use serde::{Deserialize, Serialize};

use super::Boundary;
use crate::lane::Lane;
use crate::space::Space;

/// The null boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Open;

impl<S: Space> Boundary<S> for Open {
    const DEFORMS: bool = false;

    #[inline(always)]
    fn nearest<L: Lane>(&self, separation: S::Vector<L>) -> S::Vector<L> {
        separation
    }
    #[inline(always)]
    fn carried<L: Lane>(&self, _: S::Vector<L>, velocity: S::Vector<L>) -> S::Vector<L> {
        velocity
    }
}
