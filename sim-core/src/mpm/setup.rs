//! From a reduced scene to bodies and walls, in units d = E = ρ = 1.

use std::sync::Arc;

use scene::plastic::{ReducedPlastic, Rotation, Setup};

use super::body::Body;
use super::constitutive::{Hardening, Kinematics, Material};
use super::contact::Wall;
use super::element::Law;
use super::packing::{diameters, pack};
use super::template::{disc, symmetric_disc};
use super::world::World;
use crate::SimError;

/// Walls of every setup, in this order; the side walls are absent in diametrical compression.
pub const BOTTOM: usize = 0;
/// The wall that comes down.
pub const TOP: usize = 1;
/// First side wall.
pub const LEFT: usize = 2;

/// A world with the extent of its box.
pub struct Scenery {
    /// Bodies and walls.
    pub world: World,
    /// Width the wall stresses refer to.
    pub width: f64,
    /// Height before compression.
    pub height: f64,
}

/// Builds the initial state of a scene.
///
/// # Errors
/// [`SimError::Scene`] when an assembly cannot be packed as loosely as asked.
pub fn build(scene: &ReducedPlastic) -> Result<Scenery, SimError> {
    let law = law(scene);
    let across = usize::try_from(scene.cells).expect("at most 64");
    match scene.setup {
        Setup::Assembly => {
            let n = usize::try_from(scene.n).expect("at most 10000");
            let radii = diameters(n, scene.size_ratio, 1.0).into_iter().map(|d| 0.5 * d).collect();
            let packing = pack(radii, scene.phi_i, scene.seed).map_err(|left| SimError::Scene {
                field: "phi_i".to_owned(),
                problem: format!(
                    "{} cannot be packed, an overlap of {:.1e} radii is left",
                    scene.phi_i, left.overlap
                ),
                remedy: "lower phi_i".to_owned(),
            })?;
            let template = Arc::new(disc(across));
            let places = packing.radii.iter().zip(&packing.centres);
            let bodies =
                places.map(|(&r, &centre)| Body::new(template.clone(), r, centre, &law.material)).collect();
            let (width, height) = (packing.width, packing.height);
            let walls = [level(0.0, 1.0, 0.0), level(height, -1.0, -scene.wall_speed)]
                .into_iter()
                .chain(sides(0.0, width))
                .collect();
            Ok(finished(World::new(bodies, walls, law), scene, width, height))
        }
        Setup::Diametrical => {
            let body = Body::new(Arc::new(disc(across)), 0.5, [0.0, 0.5], &law.material);
            let walls = vec![level(0.0, 1.0, 0.0), level(1.0, -1.0, -scene.wall_speed)];
            Ok(finished(World::new(vec![body], walls, law), scene, 1.0, 1.0))
        }
        Setup::Cell => {
            // without friction nothing but the mesh would hold the spin of the disc
            let mut body = Body::new(Arc::new(symmetric_disc(across)), 0.5, [0.0, 0.0], &law.material);
            body.hold_symmetric();
            let half = 0.5 * scene.wall_speed;
            let walls = [level(-0.5, 1.0, half), level(0.5, -1.0, -half)]
                .into_iter()
                .chain(sides(-0.5, 0.5))
                .collect();
            Ok(finished(World::new(vec![body], walls, law), scene, 1.0, 1.0))
        }
    }
}

fn finished(mut world: World, scene: &ReducedPlastic, width: f64, height: f64) -> Scenery {
    world.friction = scene.mu;
    world.numerics.theta = scene.theta;
    Scenery { world, width, height }
}

fn law(scene: &ReducedPlastic) -> Law {
    let plasticity = scene.sigma_y.map(|yield_stress| Hardening { yield_stress, modulus: scene.h });
    Law {
        material: Material { young: 1.0, poisson: scene.nu, density: 1.0, plasticity },
        kinematics: match scene.rotation {
            Rotation::Jaumann => Kinematics::Jaumann,
            Rotation::Infinitesimal => Kinematics::Infinitesimal,
        },
        mean_dilatation: scene.f_bar,
    }
}

fn level(y: f64, side: f64, speed: f64) -> Wall {
    Wall { point: [0.0, y], normal: [0.0, side], velocity: [0.0, speed] }
}

fn sides(left: f64, right: f64) -> [Wall; 2] {
    [(left, 1.0), (right, -1.0)].map(|(x, side)| Wall {
        point: [x, 0.0],
        normal: [side, 0.0],
        velocity: [0.0; 2],
    })
}
