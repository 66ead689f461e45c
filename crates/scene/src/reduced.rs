//! The dimensionless groups of a scene: what the simulation runs.

use serde::{Deserialize, Serialize};

use crate::spheres::ReducedSpheres;
use crate::{Model, SceneKey};

/// A reduced scene. Its numbers are rounded to 12 significant digits, so that equal groups written in different
/// units are equal bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Reduced {
    /// Cohesive spheres in units d = m = k_n = 1.
    CohesiveSpheres(ReducedSpheres),
}

impl Reduced {
    /// The engine of this scene.
    #[must_use]
    pub fn model(&self) -> Model {
        match self {
            Self::CohesiveSpheres(_) => Model::CohesiveSpheres,
        }
    }

    /// The identity of the run: hash of the canonical form (RFC 8785) with the physics version.
    #[must_use]
    pub fn key(&self) -> SceneKey {
        let identity = serde_json::json!({
            "physics_version": self.model().physics_version(),
            "scene": self,
        });
        let canonical = serde_json_canonicalizer::to_vec(&identity).expect("a reduced scene is plain JSON");
        SceneKey::of(&canonical)
    }
}
