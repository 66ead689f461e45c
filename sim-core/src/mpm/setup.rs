//! From a reduced scene to bodies and walls, in units d = E = ρ = 1.

use std::sync::Arc;

use scene::plastic::{Contact, ReducedPlastic, Rotation, Setup, StartVelocity, Variant};

use super::body::Body;
use super::constitutive::{Hardening, Kinematics, Material};
use super::contact::{ContactKind, Wall};
use super::element::Law;
use super::packing::{diameters, pack};
use super::spline;
use super::template::{Template, cubic_disc, disc, symmetric_cubic_disc, symmetric_disc};
use super::updated;
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
    let shapes = Shapes::new(scene, &law);
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
            let places = packing.radii.iter().zip(&packing.centres);
            let mut bodies: Vec<Body> = places.map(|(&r, &centre)| shapes.body(r, centre)).collect();
            let (width, height) = (packing.width, packing.height);
            let speed = start_speed(scene);
            if scene.start_velocity == StartVelocity::Uniform {
                for (body, centre) in bodies.iter_mut().zip(&packing.centres) {
                    move_up(body, -speed * centre[1] / height);
                }
            }
            let walls = [level(0.0, 1.0, 0.0), level(height, -1.0, -speed)]
                .into_iter()
                .chain(sides(0.0, width))
                .collect();
            Ok(finished(World::new(bodies, walls, law), scene, width, height))
        }
        Setup::Diametrical => {
            let body = shapes.body(0.5, [0.0, 0.5]);
            let walls = vec![level(0.0, 1.0, 0.0), level(1.0, -1.0, -start_speed(scene))];
            Ok(finished(World::new(vec![body], walls, law), scene, 1.0, 1.0))
        }
        Setup::Cell => {
            // without friction nothing but the mesh would hold the spin of the disc
            let body = shapes.body(0.5, [0.0, 0.0]);
            let half = 0.5 * start_speed(scene);
            let walls = [level(-0.5, 1.0, half), level(0.5, -1.0, -half)]
                .into_iter()
                .chain(sides(-0.5, 0.5))
                .collect();
            Ok(finished(World::new(vec![body], walls, law), scene, 1.0, 1.0))
        }
    }
}

/// The bodies of a scene: one shape, or one grid for all.
struct Shapes {
    /// Shape of total Lagrangian bodies.
    template: Option<Arc<Template>>,
    /// Distance of nodes of the grids of updated Lagrangian bodies.
    spacing: f64,
    /// Material points across a cell of these grids.
    points: u32,
    symmetric: bool,
    law: Law,
}

impl Shapes {
    fn new(scene: &ReducedPlastic, law: &Law) -> Self {
        let across = usize::try_from(scene.cells).expect("at most 64");
        let points = u32::try_from(scene.points_across).expect("at most 4");
        let symmetric = scene.setup == Setup::Cell;
        let template = match (scene.variant, symmetric) {
            (Variant::TotalBilinear, false) => Some(disc(across)),
            (Variant::TotalBilinear, true) => Some(symmetric_disc(across)),
            (Variant::TotalCubic, false) => Some(cubic_disc(across, points)),
            (Variant::TotalCubic, true) => Some(symmetric_cubic_disc(across, points)),
            (Variant::UpdatedCubic, _) => None,
        };
        Self { template: template.map(Arc::new), spacing: 1.0 / across as f64, points, symmetric, law: *law }
    }

    fn body(&self, radius: f64, centre: [f64; 2]) -> Body {
        let material = &self.law.material;
        let Some(template) = &self.template else {
            let fill = spline::disc(centre, radius, self.spacing, self.points);
            let turn = if self.symmetric { 0.0 } else { 0.25 };
            let markers = spline::circle(centre, radius, self.spacing, turn);
            let mut body = updated::body(&fill, markers, self.spacing, radius, centre, material);
            if let Some(cloud) = &mut body.cloud {
                cloud.held = [self.symmetric; 2];
            }
            return body;
        };
        let mut body = Body::new(template.clone(), radius, centre, material);
        if self.symmetric {
            body.hold_symmetric();
        }
        body
    }
}

fn finished(mut world: World, scene: &ReducedPlastic, width: f64, height: f64) -> Scenery {
    world.friction = scene.mu;
    world.numerics.theta = scene.theta;
    world.contact = match scene.contact {
        Contact::Markers => ContactKind::Markers,
        Contact::CommonMesh => ContactKind::CommonMesh,
    };
    updated::regrid(&mut world);
    Scenery { world, width, height }
}

/// Speed at which the box begins to close.
fn start_speed(scene: &ReducedPlastic) -> f64 {
    scene.pace.map_or(scene.wall_speed, |pace| pace.speed)
}

/// The whole body at one vertical speed.
fn move_up(body: &mut Body, speed: f64) {
    body.velocity.iter_mut().skip(1).step_by(2).for_each(|v| *v = speed);
    if let Some(cloud) = &mut body.cloud {
        cloud.velocity.iter_mut().for_each(|v| v[1] = speed);
    }
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
