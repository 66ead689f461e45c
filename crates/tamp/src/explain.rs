//! `tamp explain`: what would run, and why; runs nothing.

use protocol::client::{Client, Patience};
use scene::{Scene, Sweep};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::input::{self, Definition};
use crate::{output, remote};

/// Arguments of `tamp explain`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Scene or sweep as JSON; - reads it from standard input
    file: String,
    /// Keys to replace in the scene, or in the base of the sweep
    #[arg(value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Ask this coordinator what it knows already
    #[arg(long, value_name = "URL")]
    server: Option<String>,
    /// Token of the coordinator
    #[arg(long, env = "TAMP_TOKEN", hide_env_values = true)]
    token: Option<String>,
}

/// Explains a scene or a sweep, as JSON.
pub fn explain(arguments: &Arguments) -> Result<(), Failure> {
    match input::definition(&arguments.file, &arguments.overrides)? {
        Definition::Scene(scene) => explain_scene(arguments, &scene),
        Definition::Sweep(sweep) => explain_sweep(arguments, &sweep),
    }
}

fn explain_scene(arguments: &Arguments, scene: &Scene) -> Result<(), Failure> {
    let reduced = scene.reduce();
    let explanation = sim_core::explain(&reduced)?;
    let mut told = to_value(&explanation)?;
    let derived: serde_json::Map<String, Value> =
        scene.derived().into_iter().map(|(name, value)| (name.to_owned(), Value::from(value))).collect();
    let cost = scene::cost(&reduced);
    if let Value::Object(fields) = &mut told {
        fields.insert("scene_key".to_owned(), Value::from(scene.key().as_str()));
        fields.insert("physics_version".to_owned(), Value::from(scene.model().physics_version()));
        fields.insert("scene".to_owned(), scene.to_json());
        fields.insert("reduced".to_owned(), reduced.to_json());
        fields.insert("derived".to_owned(), Value::Object(derived));
        let estimate =
            json!({ "steps": cost.steps, "particle_steps": cost.particle_steps, "seconds": cost.seconds });
        fields.insert("cost".to_owned(), estimate);
        if let Some(why) = scene.out_of_model() {
            fields.insert("out_of_model".to_owned(), Value::from(why));
        }
    }
    if let Some(server) = &arguments.server {
        let path = format!("/v1/points/{}/explain", scene.key());
        told["known"] = ask(server, arguments.token.clone(), async |client| client.get(&path).await)?;
    }
    output::json(&told)
}

fn explain_sweep(arguments: &Arguments, sweep: &Sweep) -> Result<(), Failure> {
    let mut told = to_value(&sweep.survey()?)?;
    if let Some(point) = sweep.points().next() {
        told["first_point"] = to_value(&sim_core::explain(&point.scene.reduce())?)?;
    }
    if let Some(server) = &arguments.server {
        let definition = sweep.to_json();
        told["known"] = ask(server, arguments.token.clone(), async |client| {
            client.post("/v1/sweeps?dry_run=true", Some(&definition)).await
        })?;
    }
    output::json(&told)
}

fn ask(
    server: &str,
    token: Option<String>,
    question: impl AsyncFnOnce(Client) -> Result<Value, protocol::client::ClientError>,
) -> Result<Value, Failure> {
    let client = Client::new(server, token, Patience::brief(std::time::Duration::from_secs(10)))?;
    remote::block_on(async { Ok(question(client).await?) })
}

fn to_value<T: serde::Serialize>(value: &T) -> Result<Value, Failure> {
    serde_json::to_value(value).map_err(|error| Failure::Work(format!("cannot be written as JSON: {error}")))
}
