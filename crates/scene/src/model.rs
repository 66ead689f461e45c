//! The engines a scene can name.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::description::Description;
use crate::discs::Discs;
use crate::plastic::Plastic;
use crate::spheres::Spheres;
use crate::table::{Key, object_schema};
use crate::{Quantity, QuantityInfo};

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

    /// The model of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }

    /// What the model describes, in one sentence.
    #[must_use]
    pub fn summary(self) -> &'static str {
        match self {
            Self::CohesiveSpheres => {
                "Cohesive elastic-frictional spheres in 3D, compacted dynamically from a dilute agitated state by six \
                 servo-controlled rigid walls."
            }
            Self::CohesiveDiscs => {
                "Cohesive elastic-frictional discs in a periodic cell, consolidated quasi-statically."
            }
            Self::PlasticDiscs => {
                "Elastic-plastic discs that deform until they fill the space, by implicit MPM with contact dynamics."
            }
        }
    }

    /// The version of the physics: part of every scene key, raised whenever results change.
    #[must_use]
    pub fn physics_version(self) -> u32 {
        match self {
            // 2, spheres: the time step follows the network alone, and may be larger than 0.1 τ.
            // 2, discs: tangential force in the plane as one number; exact sum of the stress.
            // 3, both: 1/d as d · (1/d²), slip and lever arms with fewer roundings; an even number of chunks.
            // 3, discs: cohesionless discs start as a gas at the first pressure.
            // 3, spheres: `evidence` asks for the motion that deforms the network and for the trend of Z±; what carries no
            // load is not settled.
            // 4, discs: pairs across a border of the cell add to forces after all others (differs by the order of sums).
            Self::CohesiveDiscs => 4,
            // 4: the balance of the walls is that of their momentum, not of samples of the force on them; how a contact turns
            // and slips in another order of operations (differs by rounding).
            // 5: particles along a Hilbert curve; springs remember their force, and grow and turn in fewer operations
            // (differs by the order of sums, by rounding, and in second order of the step).
            Self::CohesiveSpheres => 5,
            // 2: over-relaxed contact sweeps, a step begins with the last halving.
            // 3: iterates are accelerated, factors renewed by body; splines see their gradients in the mean over what a
            // point stands for.
            Self::PlasticDiscs => 3,
        }
    }

    /// The keys of its scenes.
    #[must_use]
    pub fn keys(self) -> &'static [Key] {
        match self {
            Self::CohesiveSpheres => Spheres::KEYS,
            Self::CohesiveDiscs => Discs::KEYS,
            Self::PlasticDiscs => Plastic::KEYS,
        }
    }

    /// The key of a name.
    #[must_use]
    pub fn key(self, name: &str) -> Option<&'static Key> {
        self.keys().iter().find(|key| key.name == name)
    }

    /// The derived quantities of its scenes.
    #[must_use]
    pub fn quantities(self) -> Vec<QuantityInfo> {
        match self {
            Self::CohesiveSpheres => Spheres::QUANTITIES.iter().map(Quantity::info).collect(),
            Self::CohesiveDiscs => Discs::QUANTITIES.iter().map(Quantity::info).collect(),
            Self::PlasticDiscs => Plastic::QUANTITIES.iter().map(Quantity::info).collect(),
        }
    }

    /// The JSON schema of its scenes (draft 2020-12).
    #[must_use]
    pub fn schema(self) -> Value {
        object_schema(&[("model", self.name())], self.keys())
    }
}
