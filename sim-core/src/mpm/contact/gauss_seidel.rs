//! Non-linear Gauss–Seidel over contacts: Signorini's condition with Coulomb friction (contact dynamics).
//!
//! Per row: 0 ≤ p_n ⊥ u_n − bound ≥ 0 and |p_t| ≤ μ p_n with p_t opposite to sliding; velocities are u = u_free + W p
//! with the Delassus operator W = H A⁻¹ Hᵀ of the implicit system, through the compliance of each body's boundary.

use rayon::prelude::*;

use super::rows::{Row, Rows, tangent};

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Sum of impulse changes of a sweep over the sum of impulses.
    pub impulse: f64,
    /// Most sweeps.
    pub sweeps: usize,
}

/// What a solve took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solve {
    /// Sweeps done.
    pub sweeps: usize,
    /// Relative change of the impulses in the last sweep.
    pub change: f64,
}

/// Fills responses and local Delassus matrices from the boundary compliance of each body.
pub fn prepare(rows: &mut Rows, compliance: &[Vec<f64>], sizes: &[usize], friction: f64) {
    let directions = if friction > 0.0 { 2 } else { 1 };
    let mut total = 0_u32;
    for row in &mut rows.rows {
        for side in &mut row.sides[..row.side_count] {
            side.response = total;
            total += (directions * sizes[side.body as usize]) as u32;
        }
    }
    rows.responses.clear();
    rows.responses.resize(total as usize, 0.0);
    // one chunk of rows per task: disjoint parts of the response array
    let mut parts: Vec<(&Row, &mut [f64])> = Vec::with_capacity(rows.rows.len());
    let mut rest = rows.responses.as_mut_slice();
    for row in &rows.rows {
        let length: usize =
            row.sides[..row.side_count].iter().map(|side| directions * sizes[side.body as usize]).sum();
        let (head, tail) = rest.split_at_mut(length);
        parts.push((row, head));
        rest = tail;
    }
    let entries = &rows.entries;
    let local: Vec<[f64; 3]> = parts
        .into_par_iter()
        .with_min_len(64)
        .map(|(row, out)| {
            let (n, t) = (row.normal, tangent(row.normal));
            let mut w = [0.0; 3];
            let mut at = 0;
            for side in &row.sides[..row.side_count] {
                let size = sizes[side.body as usize];
                let matrix = &compliance[side.body as usize];
                let weights = &entries[side.entries.0 as usize..side.entries.1 as usize];
                for (direction, d) in [n, t].iter().take(directions).enumerate() {
                    let response = &mut out[at + direction * size..at + (direction + 1) * size];
                    for &(place, weight) in weights {
                        let place = place as usize;
                        let (x, y) = (weight * d[0], weight * d[1]);
                        let row_x = &matrix[place * size..(place + 1) * size];
                        let row_y = &matrix[(place + 1) * size..(place + 2) * size];
                        for ((r, a), b) in response.iter_mut().zip(row_x).zip(row_y) {
                            *r += x * a + y * b;
                        }
                    }
                }
                let along = |response: &[f64], d: [f64; 2]| {
                    let sum = |&(place, weight): &(u32, f64)| {
                        weight * (d[0] * response[place as usize] + d[1] * response[place as usize + 1])
                    };
                    weights.iter().map(sum).sum::<f64>()
                };
                w[0] += along(&out[at..at + size], n);
                if directions == 2 {
                    w[1] += along(&out[at..at + size], t);
                    w[2] += along(&out[at + size..at + 2 * size], t);
                }
                at += directions * size;
            }
            w
        })
        .collect();
    for (row, w) in rows.rows.iter_mut().zip(local) {
        row.delassus = w;
    }
}

/// Over-relaxation of contacts without friction: markers of one contact zone stand in for each other, which plain sweeps
/// sort out slowly: half the sweeps of the factor 1 (30 discs, 12 cells: 425 for 880 a step). Any factor between 0 and 2
/// converges, the problem being a convex quadratic one with bounds.
const RELAXATION: f64 = 1.7;
/// Tolerance below which sweeps are plain: which of two redundant markers bears what then settles in one way, and
/// Newton's iteration does not go round in circles at its last digits.
const STRICT: f64 = 1e-6;

/// Sweeps until the impulses stand still; `velocities` holds the contact velocities without any impulse of `rows` and
/// is updated to the velocities with them.
pub fn solve(
    rows: &mut Rows,
    velocities: &mut [Vec<f64>],
    sizes: &[usize],
    friction: f64,
    tolerance: Tolerance,
) -> Solve {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the feature was detected.
        return unsafe { wide(rows, velocities, sizes, friction, tolerance) };
    }
    sweeps(rows, velocities, sizes, friction, tolerance)
}

/// The same operations with wider lanes: the same bits.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn wide(
    rows: &mut Rows,
    velocities: &mut [Vec<f64>],
    sizes: &[usize],
    friction: f64,
    tolerance: Tolerance,
) -> Solve {
    sweeps(rows, velocities, sizes, friction, tolerance)
}

#[inline(always)]
fn sweeps(
    rows: &mut Rows,
    velocities: &mut [Vec<f64>],
    sizes: &[usize],
    friction: f64,
    tolerance: Tolerance,
) -> Solve {
    let relaxation = if tolerance.impulse < STRICT { 1.0 } else { RELAXATION };
    let mut list = std::mem::take(&mut rows.rows);
    for row in &list {
        push(rows, row, row.impulse, velocities, sizes);
    }
    let mut done = Solve::default();
    while done.sweeps < tolerance.sweeps {
        let (mut change, mut sum) = (0.0, 0.0);
        for row in &mut list {
            let u = rows.relative(row, velocities);
            let next = if friction > 0.0 { coulomb(row, u, friction) } else { signorini(row, u, relaxation) };
            let delta = [next[0] - row.impulse[0], next[1] - row.impulse[1]];
            if delta != [0.0; 2] {
                push(rows, row, delta, velocities, sizes);
                row.impulse = next;
            }
            change += delta[0].abs() + delta[1].abs();
            sum += next[0];
        }
        done.sweeps += 1;
        done.change = if sum > 0.0 { change / sum } else { 0.0 };
        if change <= tolerance.impulse * sum {
            break;
        }
    }
    rows.rows = list;
    done
}

/// Adds the effect of an impulse to the contact velocities.
#[inline(always)]
fn push(rows: &Rows, row: &Row, impulse: [f64; 2], velocities: &mut [Vec<f64>], sizes: &[usize]) {
    for side in &row.sides[..row.side_count] {
        let size = sizes[side.body as usize];
        let start = side.response as usize;
        let target = &mut velocities[side.body as usize];
        for (direction, &p) in impulse.iter().enumerate() {
            if p != 0.0 {
                let response = &rows.responses[start + direction * size..start + (direction + 1) * size];
                for (v, r) in target.iter_mut().zip(response) {
                    *v += p * r;
                }
            }
        }
    }
}

#[inline]
fn signorini(row: &Row, u: [f64; 2], relaxation: f64) -> [f64; 2] {
    let normal = u[0] * row.normal[0] + u[1] * row.normal[1];
    [(row.impulse[0] - relaxation * (normal - row.bound) / row.delassus[0]).max(0.0), 0.0]
}

/// Exact solution of one contact with friction by enumeration: open, stick, slide either way.
#[inline]
fn coulomb(row: &Row, u: [f64; 2], friction: f64) -> [f64; 2] {
    let (n, t) = (row.normal, tangent(row.normal));
    let [nn, nt, tt] = row.delassus;
    let moving = [u[0] - row.wall_velocity[0], u[1] - row.wall_velocity[1]];
    // velocities without this row's own impulse
    let free_n = u[0] * n[0] + u[1] * n[1] - row.bound - nn * row.impulse[0] - nt * row.impulse[1];
    let free_t = moving[0] * t[0] + moving[1] * t[1] - nt * row.impulse[0] - tt * row.impulse[1];
    if free_n >= 0.0 {
        return [0.0; 2];
    }
    let det = nn * tt - nt * nt;
    let stick = [(nt * free_t - tt * free_n) / det, (nt * free_n - nn * free_t) / det];
    if stick[0] >= 0.0 && stick[1].abs() <= friction * stick[0] {
        return stick;
    }
    // slide: p_t = ∓μ p_n for u_t of sign ±
    for sign in [1.0, -1.0] {
        let p_n = -free_n / (nn - sign * friction * nt);
        let u_t = free_t + (nt - sign * friction * tt) * p_n;
        if p_n >= 0.0 && u_t * sign >= 0.0 {
            return [p_n, -sign * friction * p_n];
        }
    }
    [(-free_n / nn).max(0.0), 0.0]
}
