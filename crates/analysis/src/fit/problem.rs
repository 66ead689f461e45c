//! The least-squares problem as the iteration wants it.

use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};

use super::{Datum, step};

/// Weighted residuals (model − y)/σ with a central-difference Jacobian.
pub(super) struct Problem<'a, M> {
    pub data: &'a [Datum],
    pub theta: DVector<f64>,
    pub model: &'a M,
}

impl<M: Fn(f64, &[f64]) -> f64> Problem<'_, M> {
    fn weighted_residuals(&self, theta: &[f64]) -> DVector<f64> {
        DVector::from_iterator(
            self.data.len(),
            self.data.iter().map(|d| ((self.model)(d.x, theta) - d.y) / d.sigma),
        )
    }

    /// ∂(residual)/∂θ, one row per datum.
    pub fn weighted_jacobian(&self) -> DMatrix<f64> {
        let theta = self.theta.as_slice();
        let mut jacobian = DMatrix::zeros(self.data.len(), theta.len());
        let mut work = theta.to_vec();
        for j in 0..theta.len() {
            let h = step(theta[j]);
            work[j] = theta[j] + h;
            let above = self.weighted_residuals(&work);
            work[j] = theta[j] - h;
            let below = self.weighted_residuals(&work);
            work[j] = theta[j];
            jacobian.set_column(j, &((above - below) / (2.0 * h)));
        }
        jacobian
    }
}

impl<M: Fn(f64, &[f64]) -> f64> LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, M> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, theta: &DVector<f64>) {
        self.theta.copy_from(theta);
    }

    fn params(&self) -> DVector<f64> {
        self.theta.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let residuals = self.weighted_residuals(self.theta.as_slice());
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let jacobian = self.weighted_jacobian();
        jacobian.iter().all(|r| r.is_finite()).then_some(jacobian)
    }
}
