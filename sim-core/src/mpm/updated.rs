//! Updated Lagrangian bodies: material points carry everything, the grid is new at every step.
//!
//! The grids of all bodies have the same spacing and the same node places, each body its own nodal values (one mesh per
//! particle). Within a step a body moves as any other does, from the configuration at its start; afterwards its points
//! take position, volume and velocity along and the grid is laid afresh under them.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::body::{Body, Points};
use super::constitutive::Material;
use super::contact::ContactKind;
use super::contact::detect::Outline;
use super::contact::nodes::shared_nodes;
use super::plane::Mat2;
use super::spline::{Fill, Spread};
use super::template::{Reach, Scatter, cell_order, nodes, spline};
use super::world::World;

/// Markers nearer to something than this take part in the contact of the next step [cells]: the 0.3 cells within which
/// rows are made, a segment, and half a cell that either side may move.
const NEAR: f64 = 1.75;

/// What an updated Lagrangian body carries from one grid to the next, in the order of its points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cloud {
    /// Distance of neighbouring nodes.
    pub spacing: f64,
    /// Whether nodes on the axis x = 0 of the body hold their x, and those on y = 0 their y: planes of symmetry.
    pub held: [bool; 2],
    /// Positions.
    pub position: Vec<[f64; 2]>,
    /// Velocities.
    pub velocity: Vec<[f64; 2]>,
    /// Velocity gradients C of the affine transfer: (xx, xy, yx, yy).
    pub affine: Vec<[f64; 4]>,
    /// Masses.
    pub mass: Vec<f64>,
    /// Present volumes.
    pub volume: Vec<f64>,
    /// Present second moments of what the points stand for.
    pub spread: Vec<Spread>,
    /// Outline markers.
    pub markers: Vec<[f64; 2]>,
}

/// A body at rest on the grid of the given spacing; [`regrid`] lays its first grid once the world is there.
#[must_use]
pub fn body(
    fill: &Fill,
    markers: Vec<[f64; 2]>,
    spacing: f64,
    size: f64,
    origin: [f64; 2],
    material: &Material,
) -> Body {
    let Fill { positions: position, volumes: volume, spreads: spread } =
        fill.permuted(&cell_order(&fill.positions, spacing));
    let scatter = Scatter {
        spacing,
        origin,
        size,
        points: &position,
        volumes: &volume,
        spreads: &spread,
        markers: &markers,
    };
    let mut body = Body::new(
        spline(&scatter, &Reach::Markers(&vec![false; markers.len()])).into(),
        size,
        origin,
        material,
    );
    let count = position.len();
    body.cloud = Some(Box::new(Cloud {
        spacing,
        held: [false; 2],
        velocity: vec![[0.0; 2]; count],
        affine: vec![[0.0; 4]; count],
        mass: volume.iter().map(|volume| volume * material.density).collect(),
        position,
        volume,
        spread,
        markers,
    }));
    body
}

/// Takes the points of a body along with the step that has just been made.
///
/// The affine transfer (Jiang et al. 2015; for cubic splines C = 3/h² Σ N v ⊗ (x_i − x_p)) keeps linear and angular
/// momentum and carries affine motion without loss.
pub(super) fn carry(body: &mut Body) {
    let Some(mut cloud) = body.cloud.take() else { return };
    let template = &*body.template;
    let inertia = 3.0 / (cloud.spacing * cloud.spacing);
    for (cell, corners) in template.cells.as_chunks::<16>().0.iter().enumerate() {
        for p in template.first_point[cell] as usize..template.first_point[cell + 1] as usize {
            let x = cloud.position[p];
            let (mut moved, mut velocity, mut c) = ([0.0; 2], [0.0; 2], [0.0; 4]);
            for (&node, n) in corners.iter().zip(&template.values[16 * p..16 * p + 16]) {
                let at = body.reference(node as usize);
                let (u, v) = (2 * node as usize, 2 * node as usize + 1);
                let v = [n * body.velocity[u], n * body.velocity[v]];
                let arm = [at[0] - x[0], at[1] - x[1]];
                for i in 0..2 {
                    moved[i] += n * body.displacement[u + i];
                    velocity[i] += v[i];
                    c[2 * i] += v[i] * arm[0];
                    c[2 * i + 1] += v[i] * arm[1];
                }
            }
            cloud.position[p] = [x[0] + moved[0], x[1] + moved[1]];
            cloud.velocity[p] = velocity;
            cloud.affine[p] = c.map(|one| one * inertia);
            cloud.volume[p] *= body.points.gradient[p].det();
            cloud.spread[p] = carried(cloud.spread[p], body.points.gradient[p]);
        }
    }
    body.outline_at(&body.displacement, &mut cloud.markers);
    body.cloud = Some(cloud);
}

/// The moments of a domain that moves with F: F M Fᵀ.
fn carried([xx, xy, yy]: Spread, f: Mat2) -> Spread {
    [
        f.xx * f.xx * xx + 2.0 * f.xx * f.xy * xy + f.xy * f.xy * yy,
        f.xx * f.yx * xx + (f.xx * f.yy + f.xy * f.yx) * xy + f.xy * f.yy * yy,
        f.yx * f.yx * xx + 2.0 * f.yx * f.yy * xy + f.yy * f.yy * yy,
    ]
}

/// Lays new grids under all updated Lagrangian bodies; the kinetic energy that the transfer loses is booked.
pub fn regrid(world: &mut World) {
    if world.bodies.iter().all(|body| body.cloud.is_none()) {
        return;
    }
    let before = world.kinetic_energy();
    let reach = reach_of(world);
    world.bodies.par_iter_mut().zip(&reach).for_each(|(body, reach)| match reach {
        Near::Markers(near) => lay(body, &Reach::Markers(near)),
        Near::Nodes(list) => lay(body, &Reach::Nodes(list)),
    });
    world.energies.numerical += before - world.kinetic_energy();
}

/// What contact may act on in a body.
enum Near {
    Markers(Vec<bool>),
    Nodes(Vec<[i32; 2]>),
}

fn reach_of(world: &World) -> Vec<Near> {
    match world.contact {
        ContactKind::Markers => near_markers(world).into_iter().map(Near::Markers).collect(),
        ContactKind::CommonMesh => {
            let grids: Vec<_> = world.bodies.iter().map(grid_of).collect();
            let spacing =
                world.bodies.iter().find_map(|body| body.cloud.as_ref()).map_or(1.0, |cloud| cloud.spacing);
            shared_nodes(&grids, &world.walls, spacing).into_iter().map(Near::Nodes).collect()
        }
    }
}

fn scatter<'a>(body: &Body, cloud: &'a Cloud) -> Scatter<'a> {
    Scatter {
        spacing: cloud.spacing,
        origin: body.origin,
        size: body.size,
        points: &cloud.position,
        volumes: &cloud.volume,
        spreads: &cloud.spread,
        markers: &cloud.markers,
    }
}

fn grid_of(body: &Body) -> Vec<[i32; 2]> {
    body.cloud.as_ref().map_or_else(Vec::new, |cloud| nodes(&scatter(body, cloud)))
}

/// Which markers of each body are near another body or a wall.
fn near_markers(world: &World) -> Vec<Vec<bool>> {
    let outlines: Vec<Outline> = world
        .bodies
        .iter()
        .map(|body| {
            let mut outline = Outline::default();
            match &body.cloud {
                Some(cloud) => outline.points.clone_from(&cloud.markers),
                None => body.outline_at(&body.displacement, &mut outline.points),
            }
            outline.refresh();
            outline
        })
        .collect();
    let of = |(number, own): (usize, &Outline)| -> Vec<bool> {
        let range = world.bodies[number].cloud.as_ref().map_or(0.0, |cloud| NEAR * cloud.spacing);
        let by_wall = |x: &[f64; 2]| {
            world.walls.iter().any(|wall| {
                (x[0] - wall.point[0]) * wall.normal[0] + (x[1] - wall.point[1]) * wall.normal[1] < range
            })
        };
        let others: Vec<&Outline> = outlines
            .iter()
            .enumerate()
            .filter(|(other, outline)| *other != number && own.near(outline, range))
            .map(|(_, outline)| outline)
            .collect();
        let by_body = |x: &[f64; 2]| {
            others.iter().any(|other| {
                let square = |p: &[f64; 2]| (p[0] - x[0]) * (p[0] - x[0]) + (p[1] - x[1]) * (p[1] - x[1]);
                other.holds(*x, range) && other.points.iter().any(|p| square(p) < range * range)
            })
        };
        own.points.iter().map(|x| by_wall(x) || by_body(x)).collect()
    };
    outlines.par_iter().enumerate().map(of).collect()
}

/// A new grid for one body: points sorted by cell, mass and momentum on the nodes, the configuration of now as
/// reference.
fn lay(body: &mut Body, reach: &Reach) {
    let Some(mut cloud) = body.cloud.take() else { return };
    sort(&mut cloud, &mut body.points);
    let template = spline(&scatter(body, &cloud), reach);
    let count = template.nodes.len();
    body.mass = vec![0.0; count];
    body.displacement = vec![0.0; 2 * count];
    let mut momentum = vec![0.0; 2 * count];
    body.template = template.into();
    body.points.gradient.fill(Mat2::identity());
    let template = &*body.template;
    for (cell, corners) in template.cells.as_chunks::<16>().0.iter().enumerate() {
        for p in template.first_point[cell] as usize..template.first_point[cell + 1] as usize {
            let (x, v, c) = (cloud.position[p], cloud.velocity[p], cloud.affine[p]);
            for (&node, n) in corners.iter().zip(&template.values[16 * p..16 * p + 16]) {
                let at = body.reference(node as usize);
                let arm = [at[0] - x[0], at[1] - x[1]];
                let mass = n * cloud.mass[p];
                body.mass[node as usize] += mass;
                for i in 0..2 {
                    momentum[2 * node as usize + i] +=
                        mass * (v[i] + c[2 * i] * arm[0] + c[2 * i + 1] * arm[1]);
                }
            }
        }
    }
    // a node that no point reaches has no momentum either
    let velocity = |(unknown, momentum): (usize, &f64)| {
        let mass = body.mass[unknown / 2];
        if mass > 0.0 { momentum / mass } else { 0.0 }
    };
    body.velocity = momentum.iter().enumerate().map(velocity).collect();
    body.fixed.clear();
    for (node, at) in template.nodes.iter().enumerate() {
        for axis in 0..2 {
            if cloud.held[axis] && at[axis].abs() < 1e-9 {
                body.fixed.push((2 * node + axis) as u32);
                body.velocity[2 * node + axis] = 0.0;
            }
        }
    }
    body.cloud = Some(cloud);
}

/// Points in the order of their cells.
fn sort(cloud: &mut Cloud, points: &mut Points) {
    let order = cell_order(&cloud.position, cloud.spacing);
    if order.is_sorted() {
        return;
    }
    fn permuted<T: Copy>(list: &mut Vec<T>, order: &[usize]) {
        *list = order.iter().map(|&p| list[p]).collect();
    }
    permuted(&mut cloud.position, &order);
    permuted(&mut cloud.velocity, &order);
    permuted(&mut cloud.affine, &order);
    permuted(&mut cloud.mass, &order);
    permuted(&mut cloud.volume, &order);
    permuted(&mut cloud.spread, &order);
    permuted(&mut points.stress, &order);
    permuted(&mut points.plastic, &order);
}
