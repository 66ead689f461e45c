//! Plastic discs: material point method with contact dynamics.
//!
//! Nezamabadi, Ghadiri, Delenne, Radjai (2021), Comput. Part. Mech. 9, 45–52 ("the paper"; its equation numbers are
//! kept). Plane strain; any consistent units (the engine runs with E = ρ = 1, the tests with µm, MPa, µs).

pub mod body;
pub mod constitutive;
pub mod contact;
pub mod element;
mod explain;
pub mod explicit;
pub mod failure;
pub mod implicit;
pub mod observe;
pub mod packing;
pub mod plane;
pub mod real;
pub mod setup;
pub mod simulation;
pub mod skyline;
pub mod spline;
pub mod template;
pub mod updated;
pub mod world;

pub use explain::explain;
