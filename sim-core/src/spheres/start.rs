//! From a reduced scene to parameters, time step and initial state.

use scene::Precision;
use scene::spheres::{Approach, DampingMass, ReducedSpheres};

use super::system;
use crate::dem::{InitialState, SphereParameters, View, largest_step};
use crate::equilibrium::evidence::Driven;
use crate::packing::spheres::{self as packing, Request};
use crate::{Explanation, Options, Saving, SimError, Skip};

/// Largest automatic time step [τ]: about the safe share of the critical step of a jammed network; up to 0.18 τ no bias
/// of e, Z± or β± was found (docs/accuracy.md).
pub(crate) const LARGEST_DT: f64 = 0.13;
/// Largest share of the critical time step of the present network that is used.
const SAFETY: f64 = 0.7;
/// Contacts that a wall may gather unseen, between two samples.
const SUDDEN_CONTACTS: f64 = 16.0;
/// 2^(−1/8): how finely the time step is lowered [1].
const EIGHTH_OF_AN_OCTAVE: f64 = 0.917_004_043_204_671_2;
/// Farthest a particle may fly in one step at the start [d].
const FARTHEST_FLIGHT: f64 = 0.02;

/// Parameters of the laws.
pub(crate) fn parameters(scene: &ReducedSpheres) -> SphereParameters {
    SphereParameters {
        pressure: scene.pressure,
        adhesion: scene.adhesion,
        wall_adhesion: scene.adhesion * scene.wall_adhesion,
        alpha_n: scene.alpha_n,
        damping_uses_particle_mass: scene.damping_mass == DampingMass::Particle,
        clamp_viscous: scene.clamp_viscous,
        mu: scene.mu,
        mu_wall: scene.mu_wall,
        kt: scene.kt_over_kn,
        wall_mass: scene.wall_mass,
        moving: moving(scene),
        mixed: scene.precision == Precision::Mixed,
    }
}

/// Which walls move: all six, or only the three high ones.
pub(crate) fn moving(scene: &ReducedSpheres) -> [bool; 6] {
    let low = scene.moving_walls == 6;
    [low, true, low, true, low, true]
}

/// The driven walls, as the stop rule sees them.
pub(crate) fn driven(scene: &ReducedSpheres) -> Driven {
    Driven { moving: moving(scene), mass: scene.wall_mass }
}

/// The largest time step of a run and why [τ].
pub(crate) fn largest_dt(scene: &ReducedSpheres) -> (f64, String) {
    if let Some(dt) = scene.dt {
        return (dt, "given".to_owned());
    }
    let flight =
        if scene.agitation_speed > 0.0 { FARTHEST_FLIGHT / scene.agitation_speed } else { f64::INFINITY };
    // The contacts that a wall can gather between two samples: one per d² of a small wall.
    let lengths = packing::box_lengths(usize::try_from(scene.n).unwrap_or(usize::MAX), scene.ei.min(1.0));
    let first_contacts = (lengths[1] * lengths[2]).clamp(1.0, SUDDEN_CONTACTS);
    let wall = SAFETY * on_wall(scene, first_contacts);
    if flight < LARGEST_DT && flight <= wall {
        return (flight, "a particle flies at most 0.02 d per step at the start".to_owned());
    }
    if wall < LARGEST_DT {
        return (wall, "stiffest mode of a wall on its first contacts".to_owned());
    }
    (LARGEST_DT, format!("{LARGEST_DT} τ, below the stiffest mode"))
}

/// Critical time step of the moving walls on the contacts they have now, bounded as for the network [τ]: every contact
/// has a spring and a dashpot 2 α_n √(k_n m). Cheap, so it is asked for at every sample: light walls are stiffer than
/// any particle, and they gather contacts after Z has stopped to grow.
#[expect(clippy::cast_precision_loss, reason = "a number of contacts")]
pub(crate) fn walls_limit(scene: &ReducedSpheres, view: &View) -> f64 {
    let mut contacts = [0_usize; 6];
    for contact in &view.wall_contacts {
        contacts[contact.wall] += 1;
    }
    let most =
        contacts.into_iter().zip(moving(scene)).filter_map(|(count, moves)| moves.then_some(count)).max();
    on_wall(scene, most.unwrap_or(0) as f64)
}

/// Critical time step of a wall on a number of contacts [τ].
fn on_wall(scene: &ReducedSpheres, contacts: f64) -> f64 {
    let over_mass = contacts / scene.wall_mass;
    largest_step(2.0 * over_mass, 4.0 * scene.alpha_n * over_mass)
}

/// The automatic time step for a network with critical time step `critical`: the largest cap/2^(k/8) below the
/// safe share of it [τ].
pub(crate) fn safe_dt(cap: f64, critical: f64) -> f64 {
    let mut dt = cap;
    while dt > SAFETY * critical && dt > 1.0e-6 {
        dt *= EIGHTH_OF_AN_OCTAVE;
    }
    dt
}

/// The initial state.
///
/// # Errors
/// [`SimError::Scene`] naming `ei` when the spheres do not fit.
pub(crate) fn initial_state(scene: &ReducedSpheres) -> Result<InitialState, SimError> {
    let n = usize::try_from(scene.n).map_err(|_| SimError::Scene {
        field: "n".to_owned(),
        problem: format!("{} spheres do not fit into memory", scene.n),
        remedy: "lower n".to_owned(),
    })?;
    let request = Request { n, ei: scene.ei, speed: scene.agitation_speed, seed: scene.seed };
    let packed = packing::initial(&request)?;
    let [x, y, z] = packed.lengths;
    Ok(InitialState {
        spins: vec![[0.0; 3]; n],
        positions: packed.positions,
        velocities: packed.velocities,
        walls: [0.0, x, 0.0, y, 0.0, z],
        wall_velocities: [0.0; 6],
    })
}

/// What a scene would run. A small system of the same laws is built to name the kernel and to measure the memory.
///
/// # Errors
/// [`SimError::Scene`] when the scene has no initial state.
pub(crate) fn explain(scene: &ReducedSpheres) -> Result<Explanation, SimError> {
    /// Cost of one step on one core of a current machine [s per particle].
    const SECONDS_PER_PARTICLE_STEP: f64 = 30.0e-9;
    /// Size of the small system.
    const TRIAL: u64 = 1000;
    let (dt, dt_reason) = largest_dt(scene);
    let (expected_steps, _) = scene.steps(dt);
    let trial = ReducedSpheres { n: scene.n.min(TRIAL), ..scene.clone() };
    let system = system::new(&parameters(&trial), &initial_state(&trial)?, dt, &Options::default());
    let bytes = system.counters().bytes;
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let expected_seconds = expected_steps as f64 * scene.n as f64 * SECONDS_PER_PARTICLE_STEP;
    Ok(Explanation {
        kernel: system.kernel(),
        skips: skips(scene),
        dt,
        dt_reason,
        memory_bytes: bytes.saturating_mul(scene.n.div_ceil(trial.n)),
        expected_steps,
        expected_seconds,
    })
}

/// What the scene does not need. Savings are those of docs/performance.md, rounded down to what repeats agree on.
fn skips(scene: &ReducedSpheres) -> Vec<Skip> {
    let skip = |absent: &str, skipped: &str, saved: Option<(f64, f64)>| Skip {
        absent: absent.to_owned(),
        skipped: skipped.to_owned(),
        saves: saved.map(|(bytes_per_particle, ns_per_particle_step)| Saving {
            bytes_per_particle,
            ns_per_particle_step,
        }),
    };
    let mut found = Vec::new();
    if scene.mu == 0.0 && scene.mu_wall == 0.0 {
        found.push(skip(
            "friction (mu = 0, mu_wall = 0)",
            "spins, torques, tangential history and its force",
            Some((637.0, 10.0)),
        ));
    }
    if scene.adhesion == 0.0 {
        found.push(skip(
            "adhesion (sigma_c = 0)",
            "the attraction, statistics of fn/fc and the exponents β±",
            Some((0.0, 0.0)),
        ));
    }
    if scene.alpha_n == 0.0 {
        found.push(skip(
            "damping (alpha_n = 0)",
            "the viscous force and the rate each contact remembers",
            Some((212.0, 0.0)),
        ));
    }
    if scene.approach == Approach::Natural {
        found.push(skip("rolling kicks", "drag and kicks", Some((8.0, 3.0))));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ladder_goes_down_only_as_far_as_needed() {
        assert_eq!(safe_dt(0.1, f64::INFINITY), 0.1);
        assert_eq!(safe_dt(0.1, 0.15), 0.1);
        // four eighths of an octave down, four roundings
        assert!((safe_dt(0.1, 0.11) / (0.1 * std::f64::consts::FRAC_1_SQRT_2) - 1.0).abs() < 1e-15);
    }
}
