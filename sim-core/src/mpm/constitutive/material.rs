//! Material constants.

use serde::{Deserialize, Serialize};

/// Linear isotropic hardening; its absence is `None` in [`Material`], which removes yield altogether.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hardening {
    /// First yield stress σ_y [stress].
    pub yield_stress: f64,
    /// Plastic modulus H = dσ_y/dε_p [stress].
    pub modulus: f64,
}

impl Hardening {
    /// From the slope of the uniaxial stress–strain line past yield, E_t: H = E E_t/(E − E_t).
    #[must_use]
    pub fn from_tangent(yield_stress: f64, young: f64, tangent: f64) -> Self {
        Self { yield_stress, modulus: young * tangent / (young - tangent) }
    }
}

/// Isotropic linear elasticity (hypoelastic: constant moduli on the Cauchy stress) with optional J2 plasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus E [stress].
    pub young: f64,
    /// Poisson's ratio ν [1].
    pub poisson: f64,
    /// Density ρ [mass / area · thickness].
    pub density: f64,
    /// Yield; `None` is a purely elastic material.
    pub plasticity: Option<Hardening>,
}

impl Material {
    /// Shear modulus G = E/(2(1 + ν)).
    #[must_use]
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Lamé's λ = E ν/((1 + ν)(1 − 2ν)).
    #[must_use]
    pub fn lame(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// P-wave modulus M = λ + 2G.
    #[must_use]
    pub fn p_wave(&self) -> f64 {
        self.lame() + 2.0 * self.shear()
    }

    /// P-wave speed c_P = √(M/ρ).
    #[must_use]
    pub fn p_wave_speed(&self) -> f64 {
        (self.p_wave() / self.density).sqrt()
    }
}
