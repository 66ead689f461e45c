//! Factor, solve and inverse block, two rows by two columns at a time.
//!
//! Rows come in pairs (the two unknowns of a node) with the same first column, so four sums share their operands. Every
//! sum runs in four fixed chains: the same bits in every build and with any width of the machine.

use super::{NotPositive, Profile};
use crate::mpm::real::{Quad, Real};

/// Σ x_i y_i for both x and both y: (x₀y₀, x₀y₁, x₁y₀, x₁y₁).
#[inline(always)]
fn dots(x: [&[f64]; 2], y: [&[f64]; 2]) -> [f64; 4] {
    let zero = Quad::constant(0.0);
    let (mut s00, mut s01, mut s10, mut s11) = (zero, zero, zero, zero);
    let (x0, x0_rest) = x[0].as_chunks::<4>();
    let (x1, x1_rest) = x[1].as_chunks::<4>();
    let (y0, y0_rest) = y[0].as_chunks::<4>();
    let (y1, y1_rest) = y[1].as_chunks::<4>();
    for (((a, b), c), d) in x0.iter().zip(x1).zip(y0).zip(y1) {
        let (a, b, c, d) = (Quad(*a), Quad(*b), Quad(*c), Quad(*d));
        s00 = s00 + a * c;
        s01 = s01 + a * d;
        s10 = s10 + b * c;
        s11 = s11 + b * d;
    }
    let Quad(mut sums) = Quad::sums([s00, s01, s10, s11]);
    for (((a, b), c), d) in x0_rest.iter().zip(x1_rest).zip(y0_rest).zip(y1_rest) {
        sums[0] += a * c;
        sums[1] += a * d;
        sums[2] += b * c;
        sums[3] += b * d;
    }
    sums
}

/// The two lines of a pair of rows, the second with its entry below the diagonal of the first.
#[inline(always)]
fn pair<'a>(values: &'a [f64], profile: &Profile, row: usize) -> [&'a [f64]; 2] {
    let [start, middle, end] = [0, 1, 2].map(|k| profile.start[row + k] as usize);
    [&values[start..middle], &values[middle..end]]
}

#[inline(always)]
pub(super) fn factorise(values: &mut [f64], profile: &Profile) -> Result<(), NotPositive> {
    for row in (0..profile.size()).step_by(2) {
        let (done, rest) = values.split_at_mut(profile.start[row] as usize);
        let first = profile.first[row] as usize;
        let n = row - first;
        let (upper, lower) = rest.split_at_mut(n + 1);
        for column in (first..row).step_by(2) {
            let [left, right] = pair(done, profile, column);
            let other = profile.first[column] as usize;
            let from = first.max(other);
            let (here, there) = (from - first..column - first, from - other..column - other);
            let sums = dots([&upper[here.clone()], &lower[here]], [&left[there.clone()], &right[there]]);
            let (at, end) = (column - first, column - other);
            let (scale_left, corner, scale_right) = (left[end], right[end], right[end + 1]);
            for (line, [a, b]) in [(&mut *upper, [sums[0], sums[1]]), (&mut *lower, [sums[2], sums[3]])] {
                line[at] = (line[at] - a) * scale_left;
                line[at + 1] = (line[at + 1] - b - line[at] * corner) * scale_right;
            }
        }
        let sums = dots([&upper[..n], &lower[..n]], [&upper[..n], &lower[..n]]);
        upper[n] = inverse_root(upper[n] - sums[0])?;
        lower[n] = (lower[n] - sums[2]) * upper[n];
        lower[n + 1] = inverse_root(lower[n + 1] - sums[3] - lower[n] * lower[n])?;
    }
    Ok(())
}

#[inline(always)]
fn inverse_root(pivot: f64) -> Result<f64, NotPositive> {
    if pivot.is_nan() || pivot <= 0.0 { Err(NotPositive) } else { Ok(1.0 / pivot.sqrt()) }
}

#[inline(always)]
pub(super) fn solve(values: &[f64], profile: &Profile, b: &mut [f64]) {
    for row in (0..profile.size()).step_by(2) {
        let [upper, lower] = pair(values, profile, row);
        let first = profile.first[row] as usize;
        let n = row - first;
        let (known, rest) = b.split_at_mut(row);
        let known = &known[first..];
        let [s0, _, s1, _] = dots([&upper[..n], &lower[..n]], [known, known]);
        rest[0] = (rest[0] - s0) * upper[n];
        rest[1] = (rest[1] - s1 - lower[n] * rest[0]) * lower[n + 1];
    }
    for row in (0..profile.size()).step_by(2).rev() {
        let [upper, lower] = pair(values, profile, row);
        let first = profile.first[row] as usize;
        let n = row - first;
        let x1 = b[row + 1] * lower[n + 1];
        let x0 = (b[row] - lower[n] * x1) * upper[n];
        (b[row], b[row + 1]) = (x0, x1);
        for ((target, u), l) in b[first..row].iter_mut().zip(upper).zip(lower) {
            *target -= u * x0 + l * x1;
        }
    }
}

#[inline(always)]
pub(super) fn compliance(values: &[f64], profile: &Profile, out: &mut Vec<f64>) {
    let n = profile.contact;
    let offset = profile.size() - n;
    out.clear();
    out.resize(n * n, 0.0);
    // rows of the inverse of L_bb by forward substitution: inv[i][..] = (e_i − Σ_{k<i} L_ik inv[k][..]) / L_ii
    let mut inverse = vec![0.0; n * n];
    for i in 0..n {
        let line = profile.slice(values, offset + i);
        let first = profile.first[offset + i] as usize;
        let (done, rest) = inverse.split_at_mut(i * n);
        let current = &mut rest[..=i];
        current[i] = 1.0;
        for k in first.max(offset) - offset..i {
            let l = line[offset + k - first];
            for (target, value) in current[..=k].iter_mut().zip(&done[k * n..=k * n + k]) {
                *target -= l * value;
            }
        }
        let diagonal = line[offset + i - first];
        current.iter_mut().for_each(|value| *value *= diagonal);
    }
    // out = invᵀ inv, summed over rows in order
    for k in 0..n {
        let row = &inverse[k * n..=k * n + k];
        for (i, &a) in row.iter().enumerate() {
            for (target, &b) in out[i * n..=i * n + i].iter_mut().zip(row) {
                *target += a * b;
            }
        }
    }
    for i in 0..n {
        for j in i + 1..n {
            out[i * n + j] = out[j * n + i];
        }
    }
}
