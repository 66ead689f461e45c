//! Elastic predictor and radial return of J2 plasticity with linear isotropic hardening.

use super::{Increment, Material};
use crate::mpm::plane::Stress;
use crate::mpm::real::Real;

/// Result of an update.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update<T = f64> {
    /// Stress at the end of the step.
    pub stress: Stress<T>,
    /// Increment of the equivalent plastic strain Δγ ≥ 0 [1].
    pub plastic: T,
}

/// σ_tr = RσRᵀ + λ tr(Δε) I + 2G Δε; when q > σ_y + H ε_p, s is scaled back by 1 − 3GΔγ/q with
/// Δγ = (q − σ_y − H ε_p)/(3G + H), exact for linear hardening (Simo & Hughes, box 3.1). The deviator is the
/// three-dimensional one, σ_zz included.
#[inline(always)]
#[must_use]
pub fn advance<T: Real>(
    material: &Material,
    stress: Stress<T>,
    plastic_strain: T,
    step: &Increment<T>,
) -> Update<T> {
    let shear = material.shear();
    let pressure = (step.xx + step.yy) * material.lame();
    let rotated = stress.rotated(step.cos, step.sin);
    let trial = Stress {
        xx: rotated.xx + pressure + step.xx * (2.0 * shear),
        yy: rotated.yy + pressure + step.yy * (2.0 * shear),
        zz: rotated.zz + pressure,
        xy: rotated.xy + step.xy * (2.0 * shear),
    };
    let zero = T::constant(0.0);
    let Some(hardening) = material.plasticity else {
        return Update { stress: trial, plastic: zero };
    };
    let limit = plastic_strain * hardening.modulus + hardening.yield_stress;
    let q = trial.von_mises();
    let yields = q.above(limit);
    if !T::any(yields) {
        return Update { stress: trial, plastic: zero };
    }
    let plastic = (q - limit) * (1.0 / (3.0 * shear + hardening.modulus));
    let keep = T::constant(1.0) - plastic / q * (3.0 * shear);
    let mean = trial.mean();
    let returned = |component: T| (component - mean) * keep + mean;
    let stress = Stress {
        xx: T::choose(yields, returned(trial.xx), trial.xx),
        yy: T::choose(yields, returned(trial.yy), trial.yy),
        zz: T::choose(yields, returned(trial.zz), trial.zz),
        xy: T::choose(yields, trial.xy * keep, trial.xy),
    };
    Update { stress, plastic: T::choose(yields, plastic, zero) }
}
