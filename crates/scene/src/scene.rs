//! A validated scene of any model, in SI units.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::description::{Description, read, write};
use crate::discs::Discs;
use crate::plastic::Plastic;
use crate::problem::Problem;
use crate::spheres::Spheres;
use crate::table::unknown_name;
use crate::{Model, Problems, Reduced, SceneKey, parse_json};

/// A validated scene in SI units. `Deserialize` alone does not validate: use [`Scene::from_json`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Scene {
    /// Cohesive spheres in 3D under servo walls.
    CohesiveSpheres(Spheres),
    /// Cohesive discs in a periodic cell, quasi-static.
    CohesiveDiscs(Discs),
    /// Elastic-plastic discs that fill the space.
    PlasticDiscs(Plastic),
}

/// Runs an expression on the description inside a scene, whichever model it is.
macro_rules! on_description {
    ($scene:expr, $inner:ident => $body:expr) => {
        match $scene {
            Scene::CohesiveSpheres($inner) => $body,
            Scene::CohesiveDiscs($inner) => $body,
            Scene::PlasticDiscs($inner) => $body,
        }
    };
}

impl Scene {
    /// Reads and checks a scene: `{"model": …, key: value, …}`.
    ///
    /// # Errors
    /// [`Problems`]: every one of them, each with field path, value and remedy.
    pub fn from_json(value: &Value) -> Result<Self, Problems> {
        let Value::Object(object) = value else {
            let remedy = "give an object: {\"model\": \"cohesive_spheres\", …}";
            return Err(Problem::new("", value, "a scene is an object", remedy).into());
        };
        let scene = Self::without_conflict_check(read_model(object.get("model"))?, object)?;
        Problems::none_or(scene.conflicts())?;
        Ok(scene)
    }

    /// Reads a scene whose keys are right one by one; [`Scene::conflicts`] is still to be asked.
    pub(crate) fn without_conflict_check(
        model: Model,
        object: &Map<String, Value>,
    ) -> Result<Self, Problems> {
        match model {
            Model::CohesiveSpheres => read(object).map(Self::CohesiveSpheres),
            Model::CohesiveDiscs => read(object).map(Self::CohesiveDiscs),
            Model::PlasticDiscs => read(object).map(Self::PlasticDiscs),
        }
    }

    /// What is wrong with the combination of keys, each of which is right alone.
    pub(crate) fn conflicts(&self) -> Vec<Problem> {
        on_description!(self, inner => inner.conflicts())
    }

    /// Reads and checks a scene from JSON text; names that occur twice and numbers beyond the range of doubles are
    /// problems too.
    ///
    /// # Errors
    /// [`Problems`]: every one of them.
    pub fn from_text(text: &str) -> Result<Self, Problems> {
        Self::from_json(&parse_json(text.as_bytes())?)
    }

    /// The scene as [`Scene::from_json`] takes it, every default written out.
    #[must_use]
    pub fn to_json(&self) -> Value {
        on_description!(self, inner => write(inner))
    }

    /// The engine of this scene.
    #[must_use]
    pub fn model(&self) -> Model {
        match self {
            Self::CohesiveSpheres(_) => Model::CohesiveSpheres,
            Self::CohesiveDiscs(_) => Model::CohesiveDiscs,
            Self::PlasticDiscs(_) => Model::PlasticDiscs,
        }
    }

    /// The dimensionless groups.
    #[must_use]
    pub fn reduce(&self) -> Reduced {
        match self {
            Self::CohesiveSpheres(spheres) => Reduced::CohesiveSpheres(spheres.reduce()),
            Self::CohesiveDiscs(discs) => Reduced::CohesiveDiscs(discs.reduce()),
            Self::PlasticDiscs(discs) => Reduced::PlasticDiscs(discs.reduce()),
        }
    }

    /// The identity of the run: see [`Reduced::key`].
    #[must_use]
    pub fn key(&self) -> SceneKey {
        self.reduce().key()
    }

    /// A numeric key or a derived quantity; `None` when the name is unknown or the value is `"auto"`.
    #[must_use]
    pub fn quantity(&self, name: &str) -> Option<f64> {
        on_description!(self, inner => quantity(inner, name))
    }

    /// Every derived quantity with its value.
    #[must_use]
    pub fn derived(&self) -> Vec<(&'static str, f64)> {
        on_description!(self, inner => derived(inner))
    }

    /// Why the scene is outside of what the model describes, if it is: it runs and is marked.
    #[must_use]
    pub fn out_of_model(&self) -> Option<String> {
        on_description!(self, inner => inner.out_of_model())
    }
}

/// The model that a scene or a sweep names.
pub(crate) fn read_model(value: Option<&Value>) -> Result<Model, Problems> {
    let names: Vec<&str> = Model::ALL.iter().map(|model| model.name()).collect();
    let Some(value) = value else {
        return Err(Problem {
            field: "model".to_owned(),
            value: "absent".to_owned(),
            problem: "is required".to_owned(),
            remedy: format!("give one of {}", names.join(", ")),
        }
        .into());
    };
    let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    Model::named(&name).ok_or_else(|| unknown_name("model".to_owned(), value, "model", &name, &names).into())
}

fn quantity<D: Description>(scene: &D, name: &str) -> Option<f64> {
    if let Some(found) = D::QUANTITIES.iter().find(|quantity| quantity.name == name) {
        return Some((found.of)(scene));
    }
    if !D::KEYS.iter().any(|key| key.name == name && key.domain.is_numeric()) {
        return None;
    }
    serde_json::to_value(scene).expect("a scene is plain JSON").get(name)?.as_f64()
}

fn derived<D: Description>(scene: &D) -> Vec<(&'static str, f64)> {
    D::QUANTITIES.iter().map(|quantity| (quantity.name, (quantity.of)(scene))).collect()
}
