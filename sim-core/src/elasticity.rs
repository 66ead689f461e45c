//! Elastic moduli of a frozen contact network: stiffness matrix, its stability, and estimates of the bulk modulus.
//!
//! Source: Gilabert, Roux and Castellanos, cohesive powders under isotropic loads (2008), sections II D 3 and VI.

mod bounds;
mod factor;
mod moduli;
mod network;
mod stiffness;

pub use bounds::{BoundInputs, reuss_bulk, voigt_bulk, voigt_shear, z2_ratio};
pub use factor::{Factor, Signature};
pub use moduli::{ElasticError, Moduli, moduli};
pub use network::{Bond, Network};
pub use stiffness::{DegreesOfFreedom, Stiffness};
