//! Internal forces alone.

use std::ops::Range;

use super::ghost::add_force;
use super::{Inverted, LEAST_STEP_JACOBIAN, Law};
use crate::mpm::body::{Body, Points};
use crate::mpm::constitutive::{advance, increment};
use crate::mpm::plane::{Mat2, Stress};
use crate::mpm::real::Real;

/// The internal force on every node for a displacement, and the state it leads to, from the state of `body`.
///
/// # Errors
/// [`Inverted`] when a point is crushed; `trial` and `force` are then void.
pub fn internal_force(
    body: &Body,
    displacement: &[f64],
    law: &Law,
    trial: &mut Points,
    force: &mut [f64],
) -> Result<(), Inverted> {
    match body.template.nodes_per_cell {
        4 => by_cell::<4>(body, displacement, law, trial, force),
        16 => by_cell::<16>(body, displacement, law, trial, force),
        other => unreachable!("cells have 4 or 16 nodes, not {other}"),
    }?;
    add_force(body, displacement, law, force);
    Ok(())
}

fn by_cell<const N: usize>(
    body: &Body,
    displacement: &[f64],
    law: &Law,
    trial: &mut Points,
    force: &mut [f64],
) -> Result<(), Inverted> {
    let template = &*body.template;
    let (unit, area) = (1.0 / body.size, body.size * body.size);
    force.fill(0.0);
    let cells = template.cells.as_chunks::<N>().0;
    let gradients = template.gradients.as_chunks::<N>().0;
    for (cell, nodes) in cells.iter().enumerate() {
        let points = template.first_point[cell] as usize..template.first_point[cell + 1] as usize;
        if points.is_empty() {
            continue;
        }
        let u = nodes.map(|node| [displacement[2 * node as usize], displacement[2 * node as usize + 1]]);
        let swelling = deform(body, points.clone(), &u, gradients, trial);
        let mut sum = [[0.0; 2]; N];
        for p in points {
            let now = trial.gradient[p];
            let seen = swelling.seen(law, now.dot(body.points.gradient[p].inverse()), p)?;
            let strain = increment(seen, law.kinematics);
            let update = advance(&law.material, body.points.stress[p], body.points.plastic[p], &strain);
            trial.stress[p] = update.stress;
            trial.plastic[p] = body.points.plastic[p] + update.plastic;
            let weight = template.volumes[p] * area * unit;
            let [xx, xy, yx, yy] = cofactor_stress(weight, update.stress, now);
            for (target, g) in sum.iter_mut().zip(&gradients[p]) {
                target[0] += xx * g[0] + xy * g[1];
                target[1] += yx * g[0] + yy * g[1];
            }
        }
        for (node, sum) in nodes.iter().zip(&sum) {
            force[2 * *node as usize] += sum[0];
            force[2 * *node as usize + 1] += sum[1];
        }
    }
    Ok(())
}

/// Volumes of the points of a cell before and after a step, in units of the body's size.
pub(super) struct Swelling {
    before: f64,
    pub(super) after: f64,
}

/// Moves the points of a cell with its nodes.
#[inline(always)]
pub(super) fn deform<const N: usize>(
    body: &Body,
    points: Range<usize>,
    u: &[[f64; 2]; N],
    gradients: &[[[f64; 2]; N]],
    trial: &mut Points,
) -> Swelling {
    let (template, unit) = (&*body.template, 1.0 / body.size);
    let mut swelling = Swelling { before: 0.0, after: 0.0 };
    for p in points {
        let f = gradient(u, &gradients[p], unit);
        trial.gradient[p] = f;
        swelling.before += template.volumes[p] * body.points.gradient[p].det();
        swelling.after += template.volumes[p] * f.det();
    }
    swelling
}

impl Swelling {
    /// What the stress of a point sees of the gradient of a step: with F-bar the volume change is that of the cell.
    #[inline(always)]
    pub(super) fn seen(&self, law: &Law, step: Mat2, point: usize) -> Result<Mat2, Inverted> {
        let jacobian = step.det();
        if jacobian.is_nan() || jacobian <= LEAST_STEP_JACOBIAN {
            return Err(Inverted { point });
        }
        let mean = || step.scaled((self.after / self.before / jacobian).sqrt());
        Ok(if law.mean_dilatation { mean() } else { step })
    }
}

/// The internal force of the stresses of `body`, no point moved and without the ghost penalty: for four-node cells with the bits that
/// [`advance_points`](super::advance_points) left behind.
pub fn force_of_state(body: &Body, force: &mut [f64]) {
    match body.template.nodes_per_cell {
        4 => of_state::<4>(body, force),
        16 => of_state::<16>(body, force),
        other => unreachable!("cells have 4 or 16 nodes, not {other}"),
    }
}

fn of_state<const N: usize>(body: &Body, force: &mut [f64]) {
    let template = &*body.template;
    let (unit, area) = (1.0 / body.size, body.size * body.size);
    force.fill(0.0);
    let gradients = template.gradients.as_chunks::<N>().0;
    for (cell, nodes) in template.cells.as_chunks::<N>().0.iter().enumerate() {
        let first = template.first_point[cell] as usize;
        let mut sum = [[0.0; 2]; N];
        for p in first..template.first_point[cell + 1] as usize {
            let weight = template.volumes[p] * area * unit;
            let [xx, xy, yx, yy] = cofactor_stress(weight, body.points.stress[p], body.points.gradient[p]);
            for (target, g) in sum.iter_mut().zip(&gradients[p]) {
                // the first term is not added to a zero: −0 would become +0
                let (x, y) = (xx * g[0] + xy * g[1], yx * g[0] + yy * g[1]);
                *target = if p == first { [x, y] } else { [target[0] + x, target[1] + y] };
            }
        }
        for (node, sum) in nodes.iter().zip(&sum) {
            force[2 * *node as usize] += sum[0];
            force[2 * *node as usize + 1] += sum[1];
        }
    }
}

/// V σ F⁻ᵀ by the adjugate, V0 σ cof(F): components xx, xy, yx, yy.
#[inline(always)]
pub(super) fn cofactor_stress<T: Real>(weight: T, s: Stress<T>, f: Mat2<T>) -> [T; 4] {
    [
        weight * (s.xx * f.yy - s.xy * f.xy),
        weight * (s.xy * f.xx - s.xx * f.yx),
        weight * (s.xy * f.yy - s.yy * f.xy),
        weight * (s.yy * f.xx - s.xy * f.yx),
    ]
}

/// F = I + Σ_a u_a ⊗ ∇N_a.
#[inline]
fn gradient<const N: usize>(u: &[[f64; 2]; N], g: &[[f64; 2]; N], unit: f64) -> Mat2 {
    let mut sum = [0.0; 4];
    for (u, g) in u.iter().zip(g) {
        sum[0] += u[0] * g[0];
        sum[1] += u[0] * g[1];
        sum[2] += u[1] * g[0];
        sum[3] += u[1] * g[1];
    }
    Mat2 { xx: 1.0 + unit * sum[0], xy: unit * sum[1], yx: unit * sum[2], yy: 1.0 + unit * sum[3] }
}
