//! The constitutive update of a material point: kinematics, rotation, elastic predictor, radial return.

mod kinematics;
mod material;
mod von_mises;

pub use kinematics::{Increment, Kinematics, increment};
pub use material::{Hardening, Material};
pub use von_mises::{Update, advance};
