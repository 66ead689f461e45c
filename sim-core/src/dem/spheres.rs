//! Cohesive spheres between servo walls: the staircase from parameters to a compiled system. A law that a scene does
//! not need is replaced by its null type, which stores and computes nothing.

use super::engine::Dem;
use super::kernel::Path;
use super::persist::Persisted;
use super::{Dynamics, InitialState, SphereParameters};
use crate::boundary::Open;
use crate::contact::attraction::{Attraction, Constant, NoAttraction};
use crate::contact::damping::{Damping, NoDamping, Viscous};
use crate::contact::normal::Hooke;
use crate::contact::rolling::NoRolling;
use crate::contact::tangential::{CoulombSpring, Frictionless, Tangential};
use crate::contact::{ContactLaw, Law};
use crate::control::ServoWalls;
use crate::lane::Real;
use crate::space::Spatial;
use crate::state::Equal;
use crate::{Options, SimError};

/// Normal stiffness in reduced units.
const KN: f64 = 1.0;

/// Where the state comes from.
enum Source<'a> {
    Initial { initial: &'a InitialState, dt: f64 },
    Saved(Box<Persisted>),
}

/// Which laws are compiled in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Laws {
    /// Null types for everything the parameters do not need.
    Needed,
    /// All laws, with zero coefficients where the parameters say so (to check the null types against).
    All,
}

/// Builds the system of spheres from its initial state.
#[must_use]
pub fn spheres(
    parameters: &SphereParameters,
    initial: &InitialState,
    dt: f64,
    laws: Laws,
    options: &Options,
) -> Box<dyn Dynamics> {
    choose_precision(parameters, Source::Initial { initial, dt }, laws, options)
}

/// Continues a system of spheres from what [`Dynamics::save`] wrote, to the same bits.
///
/// # Errors
/// [`SimError::Checkpoint`] when the bytes are not such a state or belong to other parameters.
pub fn restore_spheres(
    parameters: &SphereParameters,
    bytes: &[u8],
    options: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    let saved = Persisted::decode(bytes)?;
    let dem = choose_precision(parameters, Source::Saved(Box::new(saved.clone())), Laws::Needed, options);
    if dem.kernel().split(';').next() != Some(saved.kernel.as_str()) {
        return Err(SimError::Checkpoint(format!(
            "state of kernel {:?}, these parameters need {:?}",
            saved.kernel,
            dem.kernel()
        )));
    }
    Ok(dem)
}

fn choose_precision(
    parameters: &SphereParameters,
    source: Source<'_>,
    laws: Laws,
    options: &Options,
) -> Box<dyn Dynamics> {
    if parameters.mixed {
        choose_damping::<f32>(parameters, source, laws, options)
    } else {
        choose_damping::<f64>(parameters, source, laws, options)
    }
}

fn choose_damping<P: Real>(
    parameters: &SphereParameters,
    source: Source<'_>,
    laws: Laws,
    options: &Options,
) -> Box<dyn Dynamics> {
    if parameters.alpha_n == 0.0 && laws == Laws::Needed {
        choose_attraction::<P, _>(parameters, source, laws, options, NoDamping)
    } else if parameters.clamp_viscous {
        choose_attraction::<P, _>(
            parameters,
            source,
            laws,
            options,
            Viscous::<true>::new(parameters.alpha_n, KN),
        )
    } else {
        choose_attraction::<P, _>(
            parameters,
            source,
            laws,
            options,
            Viscous::<false>::new(parameters.alpha_n, KN),
        )
    }
}

fn choose_attraction<P: Real, D: Damping>(
    parameters: &SphereParameters,
    source: Source<'_>,
    laws: Laws,
    options: &Options,
    damping: D,
) -> Box<dyn Dynamics> {
    let adhesive = parameters.adhesion != 0.0 || parameters.wall_adhesion != 0.0;
    if adhesive || laws == Laws::All {
        let attractions = [Constant { fc: parameters.adhesion }, Constant { fc: parameters.wall_adhesion }];
        choose_friction::<P, _, _>(parameters, source, laws, options, damping, attractions)
    } else {
        choose_friction::<P, _, _>(parameters, source, laws, options, damping, [NoAttraction; 2])
    }
}

fn choose_friction<P: Real, D: Damping, A: Attraction>(
    parameters: &SphereParameters,
    source: Source<'_>,
    laws: Laws,
    options: &Options,
    damping: D,
    attractions: [A; 2],
) -> Box<dyn Dynamics> {
    let frictional = parameters.kt != 0.0 && (parameters.mu != 0.0 || parameters.mu_wall != 0.0);
    if frictional || laws == Laws::All {
        let friction = [
            CoulombSpring { kt: parameters.kt, mu: parameters.mu },
            CoulombSpring { kt: parameters.kt, mu: parameters.mu_wall },
        ];
        build::<P, _, _, _>(parameters, source, options, damping, attractions, friction)
    } else {
        build::<P, _, _, _>(parameters, source, options, damping, attractions, [Frictionless; 2])
    }
}

fn build<P: Real, D: Damping, A: Attraction, T: Tangential<Spatial<P>>>(
    parameters: &SphereParameters,
    source: Source<'_>,
    options: &Options,
    damping: D,
    [attraction, wall_attraction]: [A; 2],
    [tangential, wall_tangential]: [T; 2],
) -> Box<dyn Dynamics>
where
    Law<Hooke, D, A, T, NoRolling>: ContactLaw<Spatial<P>>,
{
    let normal = Hooke { kn: KN };
    let law = Law { normal, damping, attraction, tangential, rolling: NoRolling };
    let wall_law =
        Law { normal, damping, attraction: wall_attraction, tangential: wall_tangential, rolling: NoRolling };
    // m_eff = m/2 for a pair, m for a wall; or the particle mass for both.
    let pair_mass: f64 = if parameters.damping_uses_particle_mass { 1.0 } else { 0.5 };
    let grains = Equal { root_pair_mass: pair_mass.sqrt() };
    let path = Path::choose(options.kernel);
    let threads = options.threads.max(1);
    match source {
        Source::Initial { initial, dt } => {
            let walls = ServoWalls {
                position: initial.walls,
                velocity: initial.wall_velocities,
                mass: parameters.wall_mass,
                pressure: parameters.pressure,
                moving: parameters.moving,
            };
            Box::new(Dem::<Spatial<P>, _, _, _>::new(
                law,
                wall_law,
                grains,
                Open,
                Some(walls),
                initial,
                dt,
                path,
                threads,
            ))
        }
        Source::Saved(saved) => Box::new(Dem::<Spatial<P>, _, _, _>::from_persisted(
            law, wall_law, grains, Open, *saved, path, threads,
        )),
    }
}
