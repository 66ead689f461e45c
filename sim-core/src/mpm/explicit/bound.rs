//! The stable time step: Δt ≤ 2/ω of the fastest mode of any body.
//!
//! The fastest mode of the undeformed mesh follows by power iteration once per shape; it scales with the inverse size.
//! A deformed cell is stiffer along its short side: its stiffness grows by at most σ_max/σ_min, the ratio of the
//! singular values of F (its volume by σ_max σ_min, the square of its gradients by 1/σ_min²), masses stay.

use std::sync::Arc;

use crate::mpm::body::{Body, Points};
use crate::mpm::constitutive::Material;
use crate::mpm::element::{Law, internal_force};
use crate::mpm::plane::Mat2;
use crate::mpm::template::Template;
use crate::mpm::world::World;

/// Share of the bound that is used: stresses add to the stiffness what the bound does not see, up to 10 % at 0.4 E.
const SAFETY: f64 = 0.9;

/// Fastest modes of the shapes of a world.
pub struct Bound {
    /// 2/ω of each body, undeformed.
    undeformed: Vec<f64>,
}

impl Bound {
    /// Finds the fastest mode of every shape.
    #[must_use]
    pub fn new(world: &World) -> Self {
        let mut known: Vec<(Arc<Template>, f64)> = Vec::new();
        let mut undeformed = Vec::with_capacity(world.bodies.len());
        for body in &world.bodies {
            let found = known.iter().find(|(shape, _)| Arc::ptr_eq(shape, &body.template)).map(|one| one.1);
            let omega = found.unwrap_or_else(|| {
                let omega = fastest_mode(&body.template, &world.law);
                known.push((body.template.clone(), omega));
                omega
            });
            undeformed.push(2.0 * body.size / omega);
        }
        Self { undeformed }
    }

    /// The largest stable step of the present state.
    #[must_use]
    pub fn time_step(&self, world: &World) -> f64 {
        let of = |(body, step): (&Body, &f64)| {
            let worst = body.points.gradient.iter().map(distortion).fold(1.0, f64::max);
            step / worst.sqrt()
        };
        SAFETY * world.bodies.iter().zip(&self.undeformed).map(of).fold(f64::MAX, f64::min)
    }
}

/// σ_max/σ_min of F: (s + √(s² − 4J²))/(2J) with s = F:F.
fn distortion(f: &Mat2) -> f64 {
    let s = f.xx * f.xx + f.xy * f.xy + f.yx * f.yx + f.yy * f.yy;
    let j = f.det();
    (s + (s * s - 4.0 * j * j).max(0.0).sqrt()) / (2.0 * j)
}

/// Largest angular frequency of a free elastic body of unit size on lumped masses.
#[must_use]
pub fn fastest_mode(template: &Arc<Template>, law: &Law) -> f64 {
    const ITERATIONS: usize = 300;
    /// Small enough for the forces to be linear to eight digits.
    const PROBE: f64 = 1e-8;
    let elastic = Law { material: Material { plasticity: None, ..law.material }, ..*law };
    let body = Body::new(template.clone(), 1.0, [0.0; 2], &elastic.material);
    let n = body.displacement.len();
    let mut mode: Vec<f64> = (0..n).map(|k| libm::sin(1.0 + 7.3 * k as f64 * k as f64)).collect();
    let (mut trial, mut force) = (Points::virgin(template.point_count()), vec![0.0; n]);
    let mut square = 0.0;
    for _ in 0..ITERATIONS {
        let norm = mode.iter().map(|x| x * x).sum::<f64>().sqrt();
        mode.iter_mut().for_each(|x| *x *= PROBE / norm);
        internal_force(&body, &mode, &elastic, &mut trial, &mut force).expect("the probe moves nothing far");
        let of_mass: f64 = mode.iter().enumerate().map(|(k, x)| body.mass[k / 2] * x * x).sum();
        // Rayleigh's quotient of K M⁻¹ K against K tends to ω² from below, faster than that of K against M
        let work: f64 = mode.iter().zip(&force).map(|(x, f)| x * f).sum();
        let next: f64 = force.iter().enumerate().map(|(k, f)| f * f / body.mass[k / 2]).sum();
        square = f64::max(work / of_mass, if work > 0.0 { next / work } else { 0.0 });
        for (k, (x, f)) in mode.iter_mut().zip(&force).enumerate() {
            *x = f / body.mass[k / 2];
        }
    }
    square.sqrt()
}
