//! Checkpoints: magic with version, digest, identity of the scene, then the state, bit for bit.

use scene::Reduced;
use serde::{Deserialize, Serialize};

use super::{Log, PlasticDiscs};
use crate::SimError;
use crate::mpm::contact::{Key, Wall};
use crate::mpm::explicit::Memory;
use crate::mpm::observe::network::Impulses;
use crate::mpm::plane::{Mat2, Stress};
use crate::mpm::updated::{self, Cloud};
use crate::mpm::world::{Effort, Energies, World};

const MAGIC: &[u8; 8] = b"TAMPMPM4";
const DIGEST: usize = 32;

#[derive(Serialize, Deserialize)]
struct BodyState {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    gradient: Vec<[f64; 4]>,
    stress: Vec<Stress>,
    plastic: Vec<f64>,
    cloud: Option<Cloud>,
}

#[derive(Serialize, Deserialize)]
struct Saved {
    key: String,
    bodies: Vec<BodyState>,
    walls: Vec<Wall>,
    impulses: Vec<(Key, [f64; 2])>,
    last_dt: f64,
    wall_impulse: Vec<f64>,
    energies: Energies,
    effort: Effort,
    time: f64,
    memory: Memory,
    network: Impulses,
    log: Log,
}

fn key(run: &PlasticDiscs) -> String {
    Reduced::PlasticDiscs(run.scene.clone()).key().as_str().to_owned()
}

pub(super) fn save(run: &PlasticDiscs) -> Vec<u8> {
    let world = &run.world;
    let saved = Saved {
        key: key(run),
        bodies: world
            .bodies
            .iter()
            .map(|body| BodyState {
                displacement: body.displacement.clone(),
                velocity: body.velocity.clone(),
                gradient: body.points.gradient.iter().map(|f| [f.xx, f.xy, f.yx, f.yy]).collect(),
                stress: body.points.stress.clone(),
                plastic: body.points.plastic.clone(),
                cloud: body.cloud.as_deref().cloned(),
            })
            .collect(),
        walls: world.walls.clone(),
        impulses: world.impulses.clone(),
        last_dt: world.last_dt,
        wall_impulse: world.wall_impulse.clone(),
        energies: world.energies,
        effort: world.effort,
        time: world.time,
        memory: world.memory.clone(),
        network: world.network.clone(),
        log: run.log.clone(),
    };
    let payload = postcard::to_stdvec(&saved).expect("plain numbers can be written");
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(blake3::hash(&payload).as_bytes());
    bytes.extend_from_slice(&payload);
    bytes
}

pub(super) fn load(run: &mut PlasticDiscs, bytes: &[u8]) -> Result<(), SimError> {
    let refuse = |what: &str| Err(SimError::Checkpoint(what.to_owned()));
    let Some(rest) = bytes.strip_prefix(MAGIC.as_slice()) else {
        return refuse("is not one of plastic discs of this version");
    };
    if rest.len() < DIGEST {
        return refuse("is cut short");
    }
    let (digest, payload) = rest.split_at(DIGEST);
    if blake3::hash(payload).as_bytes() != digest {
        return refuse("is damaged: its digest differs");
    }
    let Ok(saved) = postcard::from_bytes::<Saved>(payload) else {
        return refuse("cannot be read");
    };
    if saved.key != key(run) {
        return refuse("belongs to another scene or physics version");
    }
    let world: &mut World = &mut run.world;
    if saved.bodies.len() != world.bodies.len() || saved.walls.len() != world.walls.len() {
        return refuse("has other bodies than the scene");
    }
    for (body, state) in world.bodies.iter_mut().zip(saved.bodies) {
        let fits = match (&state.cloud, &body.cloud) {
            (None, None) => state.displacement.len() == body.displacement.len(),
            (Some(saved), Some(own)) => {
                saved.position.len() == own.position.len() && saved.markers.len() == own.markers.len()
            }
            _ => false,
        };
        if !fits || state.plastic.len() != body.points.plastic.len() {
            return refuse("has another mesh than the scene");
        }
        body.cloud = state.cloud.map(Box::new);
        body.displacement = state.displacement;
        body.velocity = state.velocity;
        body.points.gradient =
            state.gradient.into_iter().map(|[xx, xy, yx, yy]| Mat2 { xx, xy, yx, yy }).collect();
        body.points.stress = state.stress;
        body.points.plastic = state.plastic;
    }
    world.walls = saved.walls;
    // nodal values of bodies whose grid lasts for one step follow from their points
    updated::regrid(world);
    world.impulses = saved.impulses;
    world.last_dt = saved.last_dt;
    world.wall_impulse = saved.wall_impulse;
    world.energies = saved.energies;
    world.effort = saved.effort;
    world.time = saved.time;
    world.memory = saved.memory;
    world.network = saved.network;
    run.log = saved.log;
    Ok(())
}
