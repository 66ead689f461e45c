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

/// Eigenvalues within this part of the largest diagonal element of zero count as zero: far above round-off, which an
/// elimination amplifies by the inverse of the softest stiffness, and below the softest mode of networks under load.
/// Loose networks at P = 0 may bend more softly still (K_R/K_N = 1e-4, chains of dozens of discs): such modes count as
/// free, and what they add to the compliance may be missed.
const ZERO: f64 = 1e-9;

/// Largest number of refinements of a solution: the error of a mode of stiffness λ shrinks to δ/(λ + δ) with each, δ the
/// shift.
const REFINEMENTS: usize = 30;

/// Refinement ends when a step is not smaller than this part of the one before.
const SHRINKS: f64 = 0.9;

/// Signs of the eigenvalues of a symmetric matrix, by Sylvester's law from the pivots of K ± δ: as many pivots of K − δ
/// are negative as there are eigenvalues below δ. Pivots of K itself say nothing about a mechanism, whose own is
/// round-off of either sign.
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
        if value > ZERO * scale {
            self.positive += 1;
        } else if value < -ZERO * scale {
            self.negative += 1;
        } else {
            self.zero += 1;
        }
    }
}

/// LDLᵀ of a sparse symmetric matrix shifted by δ, unknowns ordered by approximate minimum degree.
///
/// Without rolling resistance networks have mechanisms: K is singular, though loads that come from strains do no work
/// on its free modes. The shift makes the factorisation regular; refinement with K itself takes its effect away from
/// every mode that resists.
pub struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    upper: Vec<(usize, usize, f64)>,
    signature: Signature,
}

impl Factor {
    /// Factorises the matrix given by the entries (row, column, value) of its upper triangle; duplicates add up.
    ///
    /// # Errors
    /// [`ElasticError::Factorisation`] when a pivot vanishes exactly or memory runs out.
    pub fn new(count: usize, upper: &[(usize, usize, f64)]) -> Result<Self, ElasticError> {
        let fails = |what: String| ElasticError::Factorisation(what);
        let shift = ZERO * largest_diagonal(count, upper);
        let shifted = |by: f64| {
            let diagonal = (0..count).map(|row| Triplet::new(row, row, by));
            let entries = upper.iter().map(|&(row, column, value)| Triplet::new(row, column, value));
            let triplets: Vec<_> = entries.chain(diagonal).collect();
            SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &triplets)
                .map_err(|error| fails(format!("{error:?}")))
        };
        let (lower, raised) = (shifted(-shift)?, shifted(shift)?);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(raised.symbolic(), Side::Upper, SymmetricOrdering::Amd, parameters)
                .map_err(|error| fails(format!("{error:?}")))?;
        let factorise = |matrix: &SparseColMat<usize, f64>| {
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
            Ok::<Vec<f64>, ElasticError>(values)
        };
        let below = negative_pivots(&symbolic, &factorise(&lower)?);
        let values = factorise(&raised)?;
        let negative = negative_pivots(&symbolic, &values);
        let signature = Signature { positive: count - below, zero: below - negative, negative };
        Ok(Self { symbolic, values, upper: upper.to_vec(), signature })
    }

    /// Signs of the eigenvalues.
    #[must_use]
    pub fn signature(&self) -> Signature {
        self.signature
    }

    /// Replaces a right-hand side by the solution; along free modes, where there is none, by round-off.
    pub fn solve(&self, right_hand_side: &mut [f64]) {
        let mut solution = vec![0.0; right_hand_side.len()];
        let mut residual = right_hand_side.to_vec();
        let mut last = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            let mut step = residual.clone();
            self.solve_shifted(&mut step);
            let size = norm(&step);
            // Steps shrink until they are round-off, or what round-off does to free modes. A NaN ends it as well.
            let shrinks = size < SHRINKS * last;
            if !shrinks {
                break;
            }
            last = size;
            solution.iter_mut().zip(&step).for_each(|(sum, part)| *sum += part);
            residual.copy_from_slice(right_hand_side);
            self.subtract_product(&solution, &mut residual);
        }
        right_hand_side.copy_from_slice(&solution);
    }

    fn solve_shifted(&self, right_hand_side: &mut [f64]) {
        let count = right_hand_side.len();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right_hand_side, count, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// y − K x into y.
    fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        for &(row, column, value) in &self.upper {
            y[row] -= value * x[column];
            if row != column {
                y[column] -= value * x[row];
            }
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum::<f64>().sqrt()
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

fn negative_pivots(symbolic: &SymbolicCholesky<usize>, values: &[f64]) -> usize {
    let SymbolicCholeskyRaw::Simplicial(structure) = symbolic.raw() else {
        unreachable!("the simplicial factorisation was asked for");
    };
    let counts = |pivot: f64| pivot < 0.0 || pivot.is_nan();
    // The diagonal of the unit triangle holds the pivot.
    structure.col_ptr()[..structure.ncols()].iter().filter(|&&first| counts(values[first])).count()
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

    #[test]
    fn a_free_mode_does_not_disturb_the_others() {
        // Springs 1 and 1e-5 in a row, and a pair of unknowns that only resists being pulled apart. Loads do no work
        // on the free mode (1, 1) of the pair; the soft spring is 1e4 times as stiff as the shift.
        let soft = 1e-5;
        let upper = [
            (0, 0, 1.0 + soft),
            (0, 1, -soft),
            (1, 1, soft),
            (2, 2, 1.0 / 3.0),
            (2, 3, -1.0 / 3.0),
            (3, 3, 1.0 / 3.0),
        ];
        let factor = Factor::new(4, &upper).unwrap();
        assert_eq!(factor.signature(), Signature { positive: 3, zero: 1, negative: 0 });
        let mut solution = [0.0, 1.0, 1.0, -1.0];
        factor.solve(&mut solution);
        assert!((solution[0] - 1.0).abs() < 1e-10 && (solution[1] / (1.0 + 1.0 / soft) - 1.0).abs() < 1e-10);
        assert!((solution[2] - solution[3] - 3.0).abs() < 1e-12, "{solution:?}");
    }
}
