//! Symmetric positive definite matrices stored by rows under a skyline, their Cholesky factor and solves.
//!
//! A body has a few hundred unknowns and a fixed sparsity, and contact needs the exact compliance of its boundary:
//! a skyline with the contact unknowns last gives it from the last block of the factor.

mod plain;
#[cfg(target_arch = "x86_64")]
mod wide;

/// Where the entries of the lower triangle lie. Both unknowns of a node have the same first column, an even one.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Row of each unknown (unknown 2a + i is component i of node a).
    row: Vec<u32>,
    /// First stored column of each row.
    first: Vec<u32>,
    /// Start of each row in the value array, and its end.
    start: Vec<u32>,
    /// Number of trailing unknowns that take part in contact.
    contact: usize,
}

/// The matrix, later its factor, on a [`Profile`].
#[derive(Clone, Debug)]
pub struct Skyline {
    values: Vec<f64>,
}

/// The matrix has a pivot that is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositive;

impl Profile {
    /// The profile of the cell graph for nodes eliminated in `order`, the last `contact` of which touch others.
    #[must_use]
    pub fn new(order: &[u32], cells: &[u32], nodes_per_cell: usize, contact: usize) -> Self {
        let mut place = vec![0_u32; order.len()];
        for (position, &node) in order.iter().enumerate() {
            place[node as usize] = position as u32;
        }
        let mut least: Vec<u32> = (0..order.len() as u32).collect();
        for corners in cells.chunks_exact(nodes_per_cell) {
            let lowest = corners.iter().map(|&node| place[node as usize]).min().unwrap_or(0);
            for &node in corners {
                let at = place[node as usize] as usize;
                least[at] = least[at].min(lowest);
            }
        }
        // the contact block is used as a dense one
        let dense = order.len() - contact;
        least[dense..].iter_mut().for_each(|first| *first = (*first).min(dense as u32));
        let first: Vec<u32> = (0..2 * order.len()).map(|row| 2 * least[row / 2]).collect();
        let mut start = vec![0_u32; first.len() + 1];
        for row in 0..first.len() {
            start[row + 1] = start[row] + row as u32 + 1 - first[row];
        }
        let row = (0..2 * order.len()).map(|unknown| 2 * place[unknown / 2] + (unknown % 2) as u32).collect();
        Self { row, first, start, contact: 2 * contact }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.first.len()
    }

    /// Number of unknowns that take part in contact.
    #[must_use]
    pub fn contact_size(&self) -> usize {
        self.contact
    }

    /// Stored entries.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.start[self.first.len()] as usize
    }

    /// Place of the entry of two unknowns.
    #[inline]
    #[must_use]
    pub fn entry(&self, a: usize, b: usize) -> usize {
        let (a, b) = (self.row[a], self.row[b]);
        let (row, column) = if a >= b { (a, b) } else { (b, a) };
        (self.start[row as usize] + column - self.first[row as usize]) as usize
    }

    /// Row of an unknown.
    #[inline]
    #[must_use]
    pub fn row_of(&self, unknown: usize) -> usize {
        self.row[unknown] as usize
    }

    #[inline]
    fn slice<'a>(&self, values: &'a [f64], row: usize) -> &'a [f64] {
        &values[self.start[row] as usize..self.start[row + 1] as usize]
    }
}

impl Skyline {
    /// A zero matrix.
    #[must_use]
    pub fn zero(profile: &Profile) -> Self {
        Self { values: vec![0.0; profile.entries()] }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds to an entry found by [`Profile::entry`].
    #[inline]
    pub fn add(&mut self, entry: usize, value: f64) {
        self.values[entry] += value;
    }

    /// Replaces the matrix by its lower Cholesky factor, with the inverse of the diagonal in its place.
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not positive; the content is then void.
    pub fn factorise(&mut self, profile: &Profile) -> Result<(), NotPositive> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the feature was detected.
            return unsafe { wide::factorise(&mut self.values, profile) };
        }
        plain::factorise(&mut self.values, profile)
    }

    /// Solves L Lᵀ x = b in place; `b` in the order of the rows.
    pub fn solve_rows(&self, profile: &Profile, b: &mut [f64]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the feature was detected.
            return unsafe { wide::solve(&self.values, profile, b) };
        }
        plain::solve(&self.values, profile, b);
    }

    /// Solves for a vector in the order of the unknowns, with `scratch` of the same length.
    pub fn solve(&self, profile: &Profile, b: &mut [f64], scratch: &mut Vec<f64>) {
        scratch.clear();
        scratch.resize(b.len(), 0.0);
        for (unknown, &value) in b.iter().enumerate() {
            scratch[profile.row_of(unknown)] = value;
        }
        self.solve_rows(profile, scratch);
        for (unknown, value) in b.iter_mut().enumerate() {
            *value = scratch[profile.row_of(unknown)];
        }
    }

    /// The contact block of the inverse, (L_bb L_bbᵀ)⁻¹, dense and row by row in the order of the contact rows.
    pub fn contact_compliance(&self, profile: &Profile, out: &mut Vec<f64>) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the feature was detected.
            return unsafe { wide::compliance(&self.values, profile, out) };
        }
        plain::compliance(&self.values, profile, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of cells with two extra contact nodes at the end.
    fn example() -> (Profile, Skyline, Vec<Vec<f64>>) {
        let cells: Vec<u32> = (0..5).flat_map(|k| [2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]).collect();
        let order: Vec<u32> = vec![4, 5, 2, 3, 6, 7, 8, 9, 10, 0, 1, 11];
        let profile = Profile::new(&order, &cells, 4, 3);
        let mut matrix = Skyline::zero(&profile);
        let n = profile.size();
        let mut full = vec![vec![0.0; n]; n];
        for corners in cells.chunks_exact(4) {
            for a in 0..8 {
                for b in 0..=a {
                    let (i, j) = (2 * corners[a / 2] as usize + a % 2, 2 * corners[b / 2] as usize + b % 2);
                    let value = if a == b { 9.0 + a as f64 } else { libm::sin((3 * a + 7 * b) as f64) };
                    matrix.add(profile.entry(i, j), value);
                    full[i][j] += value;
                    if i != j {
                        full[j][i] += value;
                    }
                }
            }
        }
        (profile, matrix, full)
    }

    #[test]
    fn solves_and_inverts() {
        let (profile, mut matrix, full) = example();
        matrix.factorise(&profile).unwrap();
        let n = profile.size();
        let mut scratch = Vec::new();
        let exact: Vec<f64> = (0..n).map(|i| libm::cos(i as f64)).collect();
        let mut b: Vec<f64> =
            full.iter().map(|row| row.iter().zip(&exact).map(|(a, b)| a * b).sum()).collect();
        matrix.solve(&profile, &mut b, &mut scratch);
        assert!(b.iter().zip(&exact).all(|(x, y)| (x - y).abs() < 1e-12));
        let mut compliance = Vec::new();
        matrix.contact_compliance(&profile, &mut compliance);
        let m = profile.contact_size();
        for j in 0..m {
            let mut column = vec![0.0; n];
            column[n - m + j] = 1.0;
            matrix.solve_rows(&profile, &mut column);
            for i in 0..m {
                assert!((compliance[i * m + j] - column[n - m + i]).abs() < 1e-13);
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn wide_lanes_have_the_bits_of_plain_ones() {
        if !std::arch::is_x86_feature_detected!("avx2") {
            return;
        }
        let (profile, matrix, _) = example();
        let (mut a, mut b) = (matrix.values.clone(), matrix.values);
        plain::factorise(&mut a, &profile).unwrap();
        // SAFETY: the feature was detected.
        unsafe { wide::factorise(&mut b, &profile).unwrap() };
        assert_eq!(a, b);
        let mut x: [Vec<f64>; 2] =
            std::array::from_fn(|_| (0..profile.size()).map(|i| libm::sin(i as f64)).collect());
        let mut inverse = [Vec::new(), Vec::new()];
        plain::solve(&a, &profile, &mut x[0]);
        plain::compliance(&a, &profile, &mut inverse[0]);
        // SAFETY: the feature was detected.
        unsafe {
            wide::solve(&a, &profile, &mut x[1]);
            wide::compliance(&a, &profile, &mut inverse[1]);
        }
        assert!(x[0] == x[1] && inverse[0] == inverse[1]);
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let (profile, mut matrix, _) = example();
        matrix.add(profile.entry(4, 4), -40.0);
        assert_eq!(matrix.factorise(&profile), Err(NotPositive));
    }
}
