//! Internal forces with their symmetrised tangent.
//!
//! With δL = grad δu at the end of the step, δ(V σ_ij N_a,j) = V (δσ_ij + σ_ij tr δL − σ_il δL_jl) N_a,j, where the
//! stress sees δL̄ = δL + ½ (⟨tr δL⟩ − tr δL) I, ⟨·⟩ the volume mean of the cell. Stress and its derivative come from
//! one pass over dual numbers. The test gradient is barred as well, which changes nothing in the force (the pressure of
//! a cell is uniform) and makes the matrix symmetric.

use super::force::deform;
use super::{Inverted, Law, ghost};
use crate::mpm::body::{Body, Points};
use crate::mpm::constitutive::{advance, increment};
use crate::mpm::plane::{Mat2, Stress};
use crate::mpm::real::{Dual, Real};
use crate::mpm::skyline::Skyline;

/// As [`internal_force`](super::internal_force), and adds `factor` times the tangent to `matrix`.
///
/// # Errors
/// [`Inverted`] when a point is crushed; the outputs are then void.
pub fn internal_force_and_tangent(
    body: &Body,
    displacement: &[f64],
    law: &Law,
    trial: &mut Points,
    force: &mut [f64],
    factor: f64,
    matrix: &mut Skyline,
) -> Result<(), Inverted> {
    match body.template.nodes_per_cell {
        4 => by_cell::<4, 8>(body, displacement, law, trial, force, factor, matrix),
        16 => by_cell::<16, 32>(body, displacement, law, trial, force, factor, matrix),
        other => unreachable!("cells have 4 or 16 nodes, not {other}"),
    }?;
    ghost::add_force(body, displacement, law, force);
    ghost::add_tangent(body, law, factor, matrix);
    Ok(())
}

/// A fourth-order tensor of the plane, rows and columns (xx, xy, yx, yy).
type Four = [[f64; 4]; 4];

fn by_cell<const N: usize, const M: usize>(
    body: &Body,
    displacement: &[f64],
    law: &Law,
    trial: &mut Points,
    force: &mut [f64],
    factor: f64,
    matrix: &mut Skyline,
) -> Result<(), Inverted> {
    let template = &*body.template;
    let (unit, area) = (1.0 / body.size, body.size * body.size);
    force.fill(0.0);
    let cells = template.cells.as_chunks::<N>().0;
    let gradients = template.gradients.as_chunks::<N>().0;
    let mut local = [[0.0; M]; M];
    for (cell, nodes) in cells.iter().enumerate() {
        let points = template.first_point[cell] as usize..template.first_point[cell + 1] as usize;
        if points.is_empty() {
            continue;
        }
        let u = nodes.map(|node| [displacement[2 * node as usize], displacement[2 * node as usize + 1]]);
        let swelling = deform(body, points.clone(), &u, gradients, trial);
        let mut sum = [0.0; M];
        // ⟨tr δL⟩ = mean · δu, and the coupling vectors of the barred gradient
        let (mut mean, mut coupling, mut dilatation) = ([0.0; M], [0.0; M], 0.0);
        local.iter_mut().for_each(|row| row.fill(0.0));
        for p in points {
            let now = trial.gradient[p];
            let seen = swelling.seen(law, now.dot(body.points.gradient[p].inverse()), p)?;
            let strain = increment(variable(seen), law.kinematics);
            let update = advance(
                &law.material,
                body.points.stress[p].lift(),
                Dual::constant(body.points.plastic[p]),
                &strain,
            );
            let s = Stress {
                xx: update.stress.xx.re,
                yy: update.stress.yy.re,
                zz: update.stress.zz.re,
                xy: update.stress.xy.re,
            };
            trial.stress[p] = s;
            trial.plastic[p] = body.points.plastic[p] + update.plastic.re;
            let det = now.det();
            let volume = template.volumes[p] * area * det;
            let g = spatial(&gradients[p], now, unit / det);
            for (a, g) in g.iter().enumerate() {
                sum[2 * a] += volume * (s.xx * g[0] + s.xy * g[1]);
                sum[2 * a + 1] += volume * (s.xy * g[0] + s.yy * g[1]);
            }
            let material = symmetric(by_spatial_gradient(&update.stress, seen));
            let mut total = initial_stress(s);
            if law.mean_dilatation {
                let (projected, by_volume, both) = project(&material);
                add(&mut total, &projected);
                for (a, g) in g.iter().enumerate() {
                    for i in 0..2 {
                        mean[2 * a + i] += volume * g[i];
                        coupling[2 * a + i] +=
                            0.5 * volume * (by_volume[2 * i] * g[0] + by_volume[2 * i + 1] * g[1]);
                    }
                }
                dilatation += 0.25 * volume * both;
            } else {
                add(&mut total, &material);
            }
            accumulate(&mut local, &g, &total, volume);
        }
        if law.mean_dilatation {
            let volume = swelling.after * area;
            mean.iter_mut().for_each(|one| *one /= volume);
            for r in 0..M {
                for c in 0..=r {
                    local[r][c] +=
                        coupling[r] * mean[c] + mean[r] * coupling[c] + dilatation * mean[r] * mean[c];
                }
            }
        }
        let places = &template.entries[cell * M * (M + 1) / 2..(cell + 1) * M * (M + 1) / 2];
        let mut place = places.iter();
        for (r, row) in local.iter().enumerate() {
            for (value, &entry) in row[..=r].iter().zip(&mut place) {
                matrix.add(entry as usize, factor * value);
            }
        }
        for (a, node) in nodes.iter().enumerate() {
            force[2 * *node as usize] += sum[2 * a];
            force[2 * *node as usize + 1] += sum[2 * a + 1];
        }
    }
    Ok(())
}

fn variable(f: Mat2) -> Mat2<Dual> {
    Mat2 {
        xx: Dual::variable(f.xx, 0),
        xy: Dual::variable(f.xy, 1),
        yx: Dual::variable(f.yx, 2),
        yy: Dual::variable(f.yy, 3),
    }
}

/// Spatial gradients F⁻ᵀ ∇_X N; `scale` holds 1/det F and the unit of length.
#[inline]
fn spatial<const N: usize>(reference: &[[f64; 2]; N], f: Mat2, scale: f64) -> [[f64; 2]; N] {
    reference.map(|g| [scale * (f.yy * g[0] - f.yx * g[1]), scale * (f.xx * g[1] - f.xy * g[0])])
}

/// ∂σ_ij/∂L_kl = Σ_n ∂σ_ij/∂f_kn f_ln.
#[inline]
fn by_spatial_gradient(stress: &Stress<Dual>, f: Mat2) -> Four {
    let row = |d: [f64; 4]| {
        [
            d[0] * f.xx + d[1] * f.xy,
            d[0] * f.yx + d[1] * f.yy,
            d[2] * f.xx + d[3] * f.xy,
            d[2] * f.yx + d[3] * f.yy,
        ]
    };
    let shear = row(stress.xy.d);
    [row(stress.xx.d), shear, shear, row(stress.yy.d)]
}

/// ½(σ_ij δ_kl + δ_ij σ_kl) − ½(σ_il δ_jk + σ_kj δ_li).
#[inline]
fn initial_stress(s: Stress) -> Four {
    let sigma = [[s.xx, s.xy], [s.xy, s.yy]];
    let delta = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
    let mut out = [[0.0; 4]; 4];
    for (ij, row) in out.iter_mut().enumerate() {
        let (i, j) = (ij / 2, ij % 2);
        for (kl, value) in row.iter_mut().enumerate() {
            let (k, l) = (kl / 2, kl % 2);
            *value = 0.5
                * (sigma[i][j] * delta(k, l) + delta(i, j) * sigma[k][l]
                    - sigma[i][l] * delta(j, k)
                    - sigma[k][j] * delta(l, i));
        }
    }
    out
}

#[inline]
fn symmetric(a: Four) -> Four {
    let mut out = a;
    for i in 0..4 {
        for j in 0..4 {
            out[i][j] = 0.5 * (a[i][j] + a[j][i]);
        }
    }
    out
}

#[inline]
fn add(a: &mut Four, b: &Four) {
    for i in 0..4 {
        for j in 0..4 {
            a[i][j] += b[i][j];
        }
    }
}

/// P D P, P D 1 and 1ᵀ D 1 with P = I − ½ 1 1ᵀ, 1 = (1, 0, 0, 1).
#[inline]
fn project(d: &Four) -> (Four, [f64; 4], f64) {
    let by_volume = d.map(|row| row[0] + row[3]);
    let both = by_volume[0] + by_volume[3];
    let unit = [1.0, 0.0, 0.0, 1.0];
    let mut projected = *d;
    for i in 0..4 {
        for j in 0..4 {
            projected[i][j] +=
                0.25 * both * unit[i] * unit[j] - 0.5 * (unit[i] * by_volume[j] + by_volume[i] * unit[j]);
        }
    }
    let mut deviator = by_volume;
    deviator[0] -= 0.5 * both;
    deviator[3] -= 0.5 * both;
    (projected, deviator, both)
}

/// local += volume · Bᵀ D B, lower triangle (whole 2 × 2 blocks on the diagonal).
#[inline]
fn accumulate<const N: usize, const M: usize>(
    local: &mut [[f64; M]; M],
    g: &[[f64; 2]; N],
    d: &Four,
    volume: f64,
) {
    for b in 0..N {
        // T_(ij)k = Σ_l D_(ij)(kl) g_l
        let mut t = [[0.0; 2]; 4];
        for (t, row) in t.iter_mut().zip(d) {
            t[0] = volume * (row[0] * g[b][0] + row[1] * g[b][1]);
            t[1] = volume * (row[2] * g[b][0] + row[3] * g[b][1]);
        }
        for a in b..N {
            for i in 0..2 {
                for k in 0..2 {
                    local[2 * a + i][2 * b + k] += g[a][0] * t[2 * i][k] + g[a][1] * t[2 * i + 1][k];
                }
            }
        }
    }
}
