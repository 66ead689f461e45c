//! What to simulate.
//!
//! A scene is written in SI units ([`Scene`]), checked key by key so that every problem is reported at once with
//! its field path ([`Problems`]), and reduced to dimensionless groups ([`Reduced`]). The hash of the canonical
//! reduced scene and the physics version is the [`SceneKey`]: two scenes with equal keys are the same run.

mod key;
mod model;
mod problem;
mod reduced;
mod scene;
pub mod spheres;

pub use key::SceneKey;
pub use model::Model;
pub use problem::{Problem, Problems};
pub use reduced::Reduced;
pub use scene::Scene;
