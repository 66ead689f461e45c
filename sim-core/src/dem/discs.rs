//! Cohesive discs in a periodic cell: the staircase from parameters to a compiled system.

use super::InitialState;
use super::cell::CellDynamics;
use super::engine::Dem;
use super::kernel::Path;
use super::persist::Persisted;
use crate::boundary::{CellControl, PeriodicCell};
use crate::contact::attraction::{Attraction, FiniteRange, NoAttraction};
use crate::contact::damping::{Damping, Lagged, NoDamping, damping_ratio};
use crate::contact::normal::Hooke;
use crate::contact::rolling::{NoRolling, Rolling, SpringSlider};
use crate::contact::tangential::{Frictionless, PlanarSpring, Tangential};
use crate::contact::{ContactLaw, Law};
use crate::lane::Real;
use crate::space::Planar;
use crate::state::Discs;
use crate::{Options, SimError};

/// Normal stiffness in reduced units.
const KN: f64 = 1.0;

/// Laws of cohesive discs in units a = m = K_N = 1. A coefficient of zero means that the law is not there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscParameters {
    /// Pull-off force F0 [K_N a].
    pub f0: f64,
    /// Range of the attraction D0 [a].
    pub d0: f64,
    /// Normal restitution without adhesion; 1: no dashpot.
    pub restitution: f64,
    /// K_T [K_N].
    pub kt: f64,
    /// μ [1].
    pub mu: f64,
    /// K_R [K_N a²].
    pub kr: f64,
    /// μ_R [a].
    pub mu_r: f64,
    /// Whether velocities, forces and contact memories are kept in single precision.
    pub mixed: bool,
}

/// Where a system of discs starts.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialDiscs {
    /// Centres [a].
    pub positions: Vec<[f64; 2]>,
    /// Radii [a].
    pub radii: Vec<f64>,
    /// Velocities [a/τ].
    pub velocities: Vec<[f64; 2]>,
    /// Spins [1/τ].
    pub spins: Vec<f64>,
    /// Edges of the cell [a].
    pub edges: [f64; 2],
    /// What moves the edges.
    pub control: CellControl,
}

enum Source<'a> {
    Initial { initial: &'a InitialDiscs, dt: f64 },
    Saved { saved: Box<Persisted>, radii: &'a [f64] },
}

/// Builds the system of discs from its initial state.
#[must_use]
pub fn discs(
    parameters: &DiscParameters,
    initial: &InitialDiscs,
    dt: f64,
    options: &Options,
) -> Box<dyn CellDynamics> {
    choose_precision(parameters, Source::Initial { initial, dt }, options)
        .expect("an initial state needs no decoding")
}

/// Continues a system of discs from what [`super::Dynamics::save`] wrote, to the same bits; `radii` in the original
/// numbering.
///
/// # Errors
/// [`SimError::Checkpoint`] when the bytes are not such a state or belong to other parameters.
pub fn restore_discs(
    parameters: &DiscParameters,
    radii: &[f64],
    bytes: &[u8],
    options: &Options,
) -> Result<Box<dyn CellDynamics>, SimError> {
    let saved = Persisted::decode(bytes)?;
    if saved.bodies.len() != radii.len() {
        return Err(SimError::Checkpoint("particle state: another number of discs".to_owned()));
    }
    let kernel = saved.kernel.clone();
    let dem = choose_precision(parameters, Source::Saved { saved: Box::new(saved), radii }, options)?;
    if dem.kernel().split(';').next() != Some(kernel.as_str()) {
        return Err(SimError::Checkpoint(format!(
            "state of kernel {kernel:?}, these parameters need {:?}",
            dem.kernel()
        )));
    }
    Ok(dem)
}

type Compiled = Result<Box<dyn CellDynamics>, SimError>;

fn choose_precision(parameters: &DiscParameters, source: Source<'_>, options: &Options) -> Compiled {
    if parameters.mixed {
        choose_damping::<f32>(parameters, source, options)
    } else {
        choose_damping::<f64>(parameters, source, options)
    }
}

fn choose_damping<P: Real>(parameters: &DiscParameters, source: Source<'_>, options: &Options) -> Compiled {
    if parameters.restitution == 1.0 {
        choose_attraction::<P, _>(parameters, source, options, NoDamping)
    } else {
        let dashpot = Lagged::new(damping_ratio(parameters.restitution), KN);
        choose_attraction::<P, _>(parameters, source, options, dashpot)
    }
}

fn choose_attraction<P: Real, D: Damping>(
    parameters: &DiscParameters,
    source: Source<'_>,
    options: &Options,
    damping: D,
) -> Compiled {
    if parameters.f0 != 0.0 {
        let attraction = FiniteRange { f0: parameters.f0, d0: parameters.d0 };
        choose_friction::<P, _, _>(parameters, source, options, damping, attraction)
    } else {
        choose_friction::<P, _, _>(parameters, source, options, damping, NoAttraction)
    }
}

fn choose_friction<P: Real, D: Damping, A: Attraction>(
    parameters: &DiscParameters,
    source: Source<'_>,
    options: &Options,
    damping: D,
    attraction: A,
) -> Compiled {
    let friction = PlanarSpring { kt: parameters.kt, mu: parameters.mu };
    if parameters.kt == 0.0 || parameters.mu == 0.0 {
        build::<P, _, _, _, _>(source, options, damping, attraction, Frictionless, NoRolling)
    } else if parameters.kr == 0.0 || parameters.mu_r == 0.0 {
        build::<P, _, _, _, _>(source, options, damping, attraction, friction, NoRolling)
    } else {
        let rolling = SpringSlider { kr: parameters.kr, mu_r: parameters.mu_r };
        build::<P, _, _, _, _>(source, options, damping, attraction, friction, rolling)
    }
}

fn build<P: Real, D: Damping, A: Attraction, T: Tangential<Planar<P>>, R: Rolling<Planar<P>>>(
    source: Source<'_>,
    options: &Options,
    damping: D,
    attraction: A,
    tangential: T,
    rolling: R,
) -> Compiled
where
    Law<Hooke, D, A, T, R>: ContactLaw<Planar<P>>,
{
    let law = Law { normal: Hooke { kn: KN }, damping, attraction, tangential, rolling };
    let path = Path::choose(options.kernel);
    let threads = options.threads.max(1);
    match source {
        Source::Initial { initial, dt } => {
            let flat = |v: &[f64; 2]| [v[0], v[1], 0.0];
            let state = InitialState {
                positions: initial.positions.iter().map(flat).collect(),
                velocities: initial.velocities.iter().map(flat).collect(),
                spins: initial.spins.iter().map(|&spin| [0.0, 0.0, spin]).collect(),
                walls: [0.0; 6],
                wall_velocities: [0.0; 6],
            };
            let cell = PeriodicCell::new(initial.edges, initial.control);
            let grains = Discs::new(initial.radii.clone());
            Ok(Box::new(Dem::<Planar<P>, _, _, _>::new(
                law, law, grains, cell, None, &state, dt, path, threads,
            )))
        }
        Source::Saved { saved, radii } => {
            let cell: PeriodicCell = postcard::from_bytes(&saved.boundary)
                .map_err(|error| SimError::Checkpoint(format!("periodic cell: {error}")))?;
            let by_slot = saved.original.iter().map(|&disc| radii[disc as usize]).collect();
            let grains = Discs::new(by_slot);
            Ok(Box::new(Dem::<Planar<P>, _, _, _>::from_persisted(
                law, law, grains, cell, *saved, path, threads,
            )))
        }
    }
}
