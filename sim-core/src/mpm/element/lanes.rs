//! Stress update and internal forces of bilinear cells, the four points of a cell at once: the explicit kernel.
//!
//! The same laws in the same order as [`internal_force`](super::internal_force), which is the oracle: the bits agree.

use super::force::cofactor_stress;
use super::{Inverted, LEAST_STEP_JACOBIAN, Law};
use crate::mpm::body::Body;
use crate::mpm::constitutive::{advance, increment};
use crate::mpm::plane::{Mat2, Stress};
use crate::mpm::real::{Quad, Real};
use crate::mpm::template::Lanes;

/// Moves the points of `body` to its present displacement and fills `force`; returns the plastic dissipation
/// Σ V q Δε_p of the step.
///
/// # Errors
/// [`Inverted`] when a point is crushed; the points are then void.
pub fn advance_points(body: &mut Body, law: &Law, force: &mut [f64]) -> Result<f64, Inverted> {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the feature was detected.
        return unsafe { with_avx2(body, law, force) };
    }
    all(body, law, force)
}

/// The same on any machine.
///
/// # Errors
/// As [`advance_points`].
pub fn advance_points_plain(body: &mut Body, law: &Law, force: &mut [f64]) -> Result<f64, Inverted> {
    all(body, law, force)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(body: &mut Body, law: &Law, force: &mut [f64]) -> Result<f64, Inverted> {
    all(body, law, force)
}

#[inline(always)]
fn all(body: &mut Body, law: &Law, force: &mut [f64]) -> Result<f64, Inverted> {
    let template = body.template.clone();
    let (unit, area) = (1.0 / body.size, body.size * body.size);
    let (displacement, _) = body.displacement.as_chunks::<2>();
    let (force, _) = force.as_chunks_mut::<2>();
    force.fill([0.0; 2]);
    let gradients = body.points.gradient.as_chunks_mut::<4>().0;
    let stresses = body.points.stress.as_chunks_mut::<4>().0;
    let plastics = body.points.plastic.as_chunks_mut::<4>().0;
    let cells = template.cells.as_chunks::<4>().0;
    let mut dissipated = 0.0;
    for (cell, nodes) in cells.iter().enumerate() {
        let Lanes { gradients: g, volumes } = &template.lanes[cell];
        let (old_f, old_stress, old_plastic) =
            (&mut gradients[cell], &mut stresses[cell], &mut plastics[cell]);
        let now = gradient(&nodes.map(|node| displacement[node as usize]), g, unit);
        let old = gather(old_f);
        let det = now.det();
        let before = (*volumes * old.det()).sum();
        let after = (*volumes * det).sum();
        let step = now.dot(old.inverse());
        let jacobian = step.det();
        if !jacobian.0.iter().all(|j| *j > LEAST_STEP_JACOBIAN) {
            let point = jacobian.0.iter().position(|j| j.is_nan() || *j <= LEAST_STEP_JACOBIAN).unwrap_or(0);
            return Err(Inverted { point: 4 * cell + point });
        }
        let seen = if law.mean_dilatation {
            step.scaled((Quad::constant(after / before) / jacobian).sqrt())
        } else {
            step
        };
        let strain = increment(seen, law.kinematics);
        let plastic = Quad(*old_plastic);
        let update = advance(&law.material, gather_stress(old_stress), plastic, &strain);
        let s = update.stress;
        scatter(old_f, &now);
        scatter_stress(old_stress, &s);
        if let Some(hardening) = law.material.plasticity {
            let flowed = plastic + update.plastic;
            *old_plastic = flowed.0;
            let q = flowed * hardening.modulus + hardening.yield_stress;
            dissipated += (*volumes * det * q * update.plastic).sum();
        }
        let [xx, xy, yx, yy] = cofactor_stress(*volumes * area * unit, s, now);
        let along = |a: usize| xx * g[a][0] + xy * g[a][1];
        let up = |a: usize| yx * g[a][0] + yy * g[a][1];
        let x = Quad::sums([along(0), along(1), along(2), along(3)]);
        let y = Quad::sums([up(0), up(1), up(2), up(3)]);
        for (a, &node) in nodes.iter().enumerate() {
            let target = &mut force[node as usize];
            target[0] += x.0[a];
            target[1] += y.0[a];
        }
    }
    Ok(area * dissipated)
}

/// F = I + Σ_a u_a ⊗ ∇N_a.
#[inline(always)]
fn gradient(u: &[[f64; 2]; 4], g: &[[Quad; 2]; 4], unit: f64) -> Mat2<Quad> {
    let zero = Quad::constant(0.0);
    let mut sum = [zero; 4];
    for (u, g) in u.iter().zip(g) {
        sum[0] = sum[0] + g[0] * u[0];
        sum[1] = sum[1] + g[1] * u[0];
        sum[2] = sum[2] + g[0] * u[1];
        sum[3] = sum[3] + g[1] * u[1];
    }
    Mat2 { xx: sum[0] * unit + 1.0, xy: sum[1] * unit, yx: sum[2] * unit, yy: sum[3] * unit + 1.0 }
}

#[inline(always)]
fn gather(of: &[Mat2; 4]) -> Mat2<Quad> {
    let [xx, xy, yx, yy] = Quad::transposed(of.map(|f| Quad([f.xx, f.xy, f.yx, f.yy])));
    Mat2 { xx, xy, yx, yy }
}

#[inline(always)]
fn scatter(to: &mut [Mat2; 4], f: &Mat2<Quad>) {
    let rows = Quad::transposed([f.xx, f.xy, f.yx, f.yy]);
    *to = rows.map(|Quad([xx, xy, yx, yy])| Mat2 { xx, xy, yx, yy });
}

#[inline(always)]
fn gather_stress(of: &[Stress; 4]) -> Stress<Quad> {
    let [xx, yy, zz, xy] = Quad::transposed(of.map(|s| Quad([s.xx, s.yy, s.zz, s.xy])));
    Stress { xx, yy, zz, xy }
}

#[inline(always)]
fn scatter_stress(to: &mut [Stress; 4], s: &Stress<Quad>) {
    let rows = Quad::transposed([s.xx, s.yy, s.zz, s.xy]);
    *to = rows.map(|Quad([xx, yy, zz, xy])| Stress { xx, yy, zz, xy });
}
