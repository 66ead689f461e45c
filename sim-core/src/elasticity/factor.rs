//! Sparse LDLᵀ factorisation with the signs of its pivots.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::moduli::ElasticError;

/// Pivots below this part of the largest diagonal element count as zero: far above round-off (1e-16 times the
/// number of unknowns), far below the softest bending mode of the loosest network (about 1e-6).
const ZERO_PIVOT: f64 = 1e-11;

/// Signs of the eigenvalues of a symmetric matrix; by Sylvester's law those of its pivots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Signature {
    /// Number of positive eigenvalues.
    pub positive: usize,
    /// Number of eigenvalues that vanish within round-off.
    pub zero: usize,
    /// Number of negative eigenvalues.
    pub negative: usize,
}

impl Signature {
    /// Sign of the smallest eigenvalue: 1 for a positive definite matrix, 0 for a mechanism, −1 for an instability.
    #[must_use]
    pub fn smallest(self) -> i8 {
        match self {
            Self { negative: 0, zero: 0, .. } => 1,
            Self { negative: 0, .. } => 0,
            _ => -1,
        }
    }

    /// Counts one more eigenvalue.
    pub fn count(&mut self, value: f64, scale: f64) {
        if value > ZERO_PIVOT * scale {
            self.positive += 1;
        } else if value < -ZERO_PIVOT * scale {
            self.negative += 1;
        } else {
            self.zero += 1;
        }
    }
}

/// LDLᵀ of a sparse symmetric matrix, unknowns ordered by approximate minimum degree.
pub struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    signature: Signature,
}

impl Factor {
    /// Factorises the matrix given by the entries (row, column, value) of its upper triangle; duplicates add up.
    ///
    /// # Errors
    /// [`ElasticError::Factorisation`] when a pivot vanishes exactly or memory runs out.
    pub fn new(count: usize, upper: &[(usize, usize, f64)]) -> Result<Self, ElasticError> {
        let fails = |what: String| ElasticError::Factorisation(what);
        let triplets: Vec<_> =
            upper.iter().map(|&(row, column, value)| Triplet::new(row, column, value)).collect();
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &triplets)
            .map_err(|error| fails(format!("{error:?}")))?;
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(matrix.symbolic(), Side::Upper, SymmetricOrdering::Amd, parameters)
                .map_err(|error| fails(format!("{error:?}")))?;
        let mut values = vec![0.0; symbolic.len_val()];
        let mut memory =
            MemBuffer::new(symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Spec::default()));
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                matrix.as_ref(),
                Side::Upper,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(|error| fails(format!("{error:?}")))?;
        let scale = largest_diagonal(count, upper);
        let signature = signature(&symbolic, &values, scale);
        Ok(Self { symbolic, values, signature })
    }

    /// Signs of the eigenvalues.
    #[must_use]
    pub fn signature(&self) -> Signature {
        self.signature
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&self, right_hand_side: &mut [f64]) {
        let count = right_hand_side.len();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right_hand_side, count, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }
}

fn largest_diagonal(count: usize, upper: &[(usize, usize, f64)]) -> f64 {
    let mut diagonal = vec![0.0; count];
    for &(row, column, value) in upper {
        if row == column {
            diagonal[row] += value;
        }
    }
    diagonal.iter().fold(0.0, |largest: f64, value: &f64| largest.max(value.abs()))
}

fn signature(symbolic: &SymbolicCholesky<usize>, values: &[f64], scale: f64) -> Signature {
    let SymbolicCholeskyRaw::Simplicial(structure) = symbolic.raw() else {
        unreachable!("the simplicial factorisation was asked for");
    };
    let mut signature = Signature::default();
    for &first in &structure.col_ptr()[..structure.ncols()] {
        // The diagonal of the unit triangle holds the pivot.
        signature.count(values[first], scale);
    }
    signature
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_counts_signs() {
        // Eigenvalues of [[2, -1, 0], [-1, 2, -1], [0, -1, -3]]: two positive, one negative.
        let upper = [(0, 0, 2.0), (0, 1, -1.0), (1, 1, 2.0), (1, 2, -1.0), (2, 2, -1.0), (2, 2, -2.0)];
        let factor = Factor::new(3, &upper).unwrap();
        assert_eq!(factor.signature(), Signature { positive: 2, zero: 0, negative: 1 });
        assert_eq!(factor.signature().smallest(), -1);
        let mut solution = [3.0, -2.0, -2.0];
        factor.solve(&mut solution);
        let residual = [
            2.0 * solution[0] - solution[1] - 3.0,
            -solution[0] + 2.0 * solution[1] - solution[2] + 2.0,
            -solution[1] - 3.0 * solution[2] + 2.0,
        ];
        assert!(residual.iter().all(|value| value.abs() < 1e-14), "{residual:?}");
    }

    #[test]
    fn a_mechanism_has_a_zero() {
        let factor = Factor::new(2, &[(0, 0, 1.0), (0, 1, -1.0), (1, 1, 1.0 + 1e-15)]).unwrap();
        assert_eq!(factor.signature().smallest(), 0);
    }
}
