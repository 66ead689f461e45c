//! The dimensionless groups of a scene: what the simulation runs.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::discs::ReducedDiscs;
use crate::plastic::ReducedPlastic;
use crate::spheres::ReducedSpheres;
use crate::{Model, Problem, Problems, SceneKey};

/// A reduced scene. Its numbers are rounded to 12 significant digits, so that equal groups written in different
/// units are equal bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Reduced {
    /// Cohesive spheres in units d = m = k_n = 1.
    CohesiveSpheres(ReducedSpheres),
    /// Cohesive discs in units a = m = K_N = 1.
    CohesiveDiscs(ReducedDiscs),
    /// Plastic discs in units d = E = ρ = 1.
    PlasticDiscs(ReducedPlastic),
}

impl Reduced {
    /// The engine of this scene.
    #[must_use]
    pub fn model(&self) -> Model {
        match self {
            Self::CohesiveSpheres(_) => Model::CohesiveSpheres,
            Self::CohesiveDiscs(_) => Model::CohesiveDiscs,
            Self::PlasticDiscs(_) => Model::PlasticDiscs,
        }
    }

    /// Reads a reduced scene, as written by [`Reduced::to_json`]. It comes from a coordinator that has validated the
    /// scene behind it; who runs it compares [`Reduced::key`] with the key that came along.
    ///
    /// # Errors
    /// [`Problems`] when a field is missing, unknown or of another type.
    pub fn from_json(value: &Value) -> Result<Self, Problems> {
        serde_json::from_value(value.clone()).map_err(|error| {
            Problem::new(
                "reduced",
                value,
                format!("is not a reduced scene of this version: {error}"),
                "use the same version for coordinator and worker",
            )
            .into()
        })
    }

    /// The reduced scene as JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        serde_json::to_value(self).expect("a reduced scene is plain JSON")
    }

    /// The identity of the run: hash of the canonical form (RFC 8785) with the physics version.
    #[must_use]
    pub fn key(&self) -> SceneKey {
        let identity = serde_json::json!({
            "physics_version": self.model().physics_version(),
            "scene": self,
        });
        let canonical = serde_json_canonicalizer::to_vec(&identity)
            .expect("finite numbers and text have a canonical form");
        SceneKey::of(&canonical)
    }
}
