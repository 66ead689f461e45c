//! Eq. (9) and the paper's Table III.

use serde::{Deserialize, Serialize};

/// −ln[1 − exp(−(P*1/P*)^α)]/α: what (9) adds to the straight line (7), over λ.
pub(super) fn bend(p_star: f64, alpha: f64, p_star_1: f64) -> f64 {
    let x = (p_star_1 / p_star).powf(alpha);
    -(-(-x).exp_m1()).ln() / alpha
}

/// 1/Φ by (9).
#[must_use]
pub fn inverse_phi(p_star: f64, p_star_0: f64, phi_0: f64, lambda: f64, alpha: f64, p_star_1: f64) -> f64 {
    1.0 / phi_0 - lambda * (p_star / p_star_0).ln() + lambda * bend(p_star, alpha, p_star_1)
}

/// A row of the paper's Table III, with P*1 from its caption.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PaperFit {
    /// μ_R/a [1].
    pub mu_r: f64,
    /// P*0 [1].
    pub p_star_0: f64,
    /// Φ0 [1].
    pub phi_0: f64,
    /// λ and its uncertainty [1].
    pub lambda: [f64; 2],
    /// Φmax [1].
    pub phi_max: f64,
    /// α and its uncertainty [1].
    pub alpha: [f64; 2],
    /// P*1 and its uncertainty [1].
    pub p_star_1: [f64; 2],
}

/// Table III.
const TABLE_III: [PaperFit; 3] = [
    PaperFit {
        mu_r: 0.0,
        p_star_0: 0.0237,
        phi_0: 0.469,
        lambda: [0.349, 0.019],
        phi_max: 0.7808,
        alpha: [0.91, 0.10],
        p_star_1: [0.271, 0.033],
    },
    PaperFit {
        mu_r: 0.005,
        p_star_0: 0.0316,
        phi_0: 0.515,
        lambda: [0.194, 0.004],
        phi_max: 0.7745,
        alpha: [1.08, 0.16],
        p_star_1: [0.900, 0.064],
    },
    PaperFit {
        mu_r: 0.5,
        p_star_0: 0.0178,
        phi_0: 0.382,
        lambda: [0.25, 0.01],
        phi_max: 0.724,
        alpha: [0.86, 0.24],
        p_star_1: [2.6, 0.4],
    },
];

impl PaperFit {
    /// The row of Table III for this μ_R/a.
    #[must_use]
    pub fn of(mu_r: f64) -> Option<Self> {
        TABLE_III.into_iter().find(|row| (row.mu_r - mu_r).abs() < 1e-9)
    }

    /// 1/Φ of the paper's fit.
    #[must_use]
    pub fn inverse_phi(&self, p_star: f64) -> f64 {
        inverse_phi(p_star, self.p_star_0, self.phi_0, self.lambda[0], self.alpha[0], self.p_star_1[0])
    }
}
