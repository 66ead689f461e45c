//! What a model has to provide so that scenes, sweeps, documentation and results know it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::table::{Key, check_object};
use crate::{Model, Problem, Problems, Quantity};

/// A scene of one model in SI units, all defaults filled in. The checklist for a new model is in CONTRIBUTING.md.
pub trait Description: Clone + PartialEq + Serialize + DeserializeOwned + 'static {
    /// The dimensionless groups: what the engine runs.
    type Reduced: Clone + PartialEq + Serialize + DeserializeOwned;

    /// The engine that runs it.
    const MODEL: Model;

    /// Every key; one per field of the struct, in the order of the documentation.
    const KEYS: &'static [Key];

    /// Derived quantities, for `where` in sweeps, results and analysis.
    const QUANTITIES: &'static [Quantity<Self>];

    /// What is wrong with the combination of keys, each of which is right alone.
    fn conflicts(&self) -> Vec<Problem>;

    /// The dimensionless groups, rounded to 12 significant digits ([`crate::round12`]).
    fn reduce(&self) -> Self::Reduced;

    /// Why the scene is outside of what the model describes, if it is: it runs and is marked.
    fn out_of_model(&self) -> Option<String> {
        None
    }
}

/// Reads a scene of a known model, key by key; `model` and conflicts between keys are left to the caller.
///
/// # Errors
/// [`Problems`]: every one of them.
pub(crate) fn read<D: Description>(object: &Map<String, Value>) -> Result<D, Problems> {
    let mut problems = Vec::new();
    let settled = check_object("", D::KEYS, &["model"], object, &mut problems);
    Problems::none_or(problems)?;
    Ok(serde_json::from_value(Value::Object(settled))
        .expect("the key table and the struct have the same fields and types"))
}

/// Writes a scene as [`read`] takes it: absent values as `"auto"`.
pub(crate) fn write<D: Description>(scene: &D) -> Value {
    let mut value = serde_json::to_value(scene).expect("a scene is plain JSON");
    let object = value.as_object_mut().expect("a scene is an object");
    for entry in object.values_mut().filter(|entry| entry.is_null()) {
        *entry = Value::from("auto");
    }
    object.insert("model".to_owned(), Value::from(D::MODEL.name()));
    value
}
