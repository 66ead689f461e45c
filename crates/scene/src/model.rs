//! The engines a scene can name.

use serde::{Deserialize, Serialize};

/// The engine that runs a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// Cohesive spheres in 3D under servo walls.
    CohesiveSpheres,
    /// Cohesive discs in a periodic cell, quasi-static.
    CohesiveDiscs,
    /// Plastic discs by implicit MPM with contact dynamics.
    PlasticDiscs,
}

impl Model {
    /// Every model, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::CohesiveSpheres, Self::CohesiveDiscs, Self::PlasticDiscs];

    /// The name used in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::CohesiveSpheres => "cohesive_spheres",
            Self::CohesiveDiscs => "cohesive_discs",
            Self::PlasticDiscs => "plastic_discs",
        }
    }

    /// The version of the physics: part of every scene key, raised whenever results change.
    #[must_use]
    pub fn physics_version(self) -> u32 {
        match self {
            Self::CohesiveSpheres | Self::CohesiveDiscs | Self::PlasticDiscs => 1,
        }
    }
}
