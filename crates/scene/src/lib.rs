//! What to simulate.
//!
//! A scene is written in SI units ([`Scene`]), checked key by key so that every problem is reported at once with
//! its field path ([`Problems`]), and reduced to dimensionless groups ([`Reduced`]). The hash of the canonical
//! reduced scene and the physics version is the [`SceneKey`]: two scenes with equal keys are the same run. A
//! [`Sweep`] is a source of scenes.

mod cost;
mod description;
pub mod discs;
mod key;
mod model;
mod number;
mod parse;
pub mod plastic;
mod precision;
mod preset;
mod problem;
mod quantity;
mod reduced;
mod scene;
pub mod spheres;
pub mod sweep;
pub mod table;

pub use cost::{Cost, cost};
pub use description::Description;
pub use key::SceneKey;
pub use model::Model;
pub use number::round12;
pub use parse::parse_json;
pub use precision::Precision;
pub use preset::{PRESETS, Preset, preset};
pub use problem::{Problem, Problems};
pub use quantity::{Quantity, QuantityInfo};
pub use reduced::Reduced;
pub use scene::Scene;
pub use sweep::Sweep;
