//! A validated scene of any model, in SI units.

use serde::{Deserialize, Serialize};

use crate::spheres::Spheres;
use crate::{Model, Reduced};

/// A validated scene in SI units. `Deserialize` alone does not validate: use `Scene::from_json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Scene {
    /// Cohesive spheres in 3D under servo walls.
    CohesiveSpheres(Spheres),
}

impl Scene {
    /// The engine of this scene.
    #[must_use]
    pub fn model(&self) -> Model {
        match self {
            Self::CohesiveSpheres(_) => Model::CohesiveSpheres,
        }
    }

    /// The dimensionless groups.
    #[must_use]
    pub fn reduce(&self) -> Reduced {
        match self {
            Self::CohesiveSpheres(spheres) => Reduced::CohesiveSpheres(spheres.reduce()),
        }
    }
}
