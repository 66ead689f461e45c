//! The compaction model, eqs. (5)–(17), compression positive.

use serde::{Deserialize, Serialize};

use crate::FitError;

/// Material of the discs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Material {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Poisson's ratio ν [1].
    pub nu: f64,
    /// Yield stress σ_y [Pa].
    pub sigma_y: f64,
    /// Plastic modulus H [Pa]; absent for elastic discs.
    pub h: Option<f64>,
}

impl Material {
    /// Shear modulus G = E/2(1 + ν) [Pa].
    #[must_use]
    pub fn shear(&self) -> f64 {
        0.5 * self.young / (1.0 + self.nu)
    }

    /// Bulk modulus in 2D, K = λ + μ = E/2(1 + ν)(1 − 2ν) [Pa].
    #[must_use]
    pub fn bulk(&self) -> f64 {
        0.5 * self.young / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu))
    }

    /// The material of the plastic part: E_p = E H/(E + H), ν_p = ν. Its K_p is by analogy; the paper defines none.
    #[must_use]
    pub fn plastic(&self) -> Option<Self> {
        let h = self.h?;
        let young = if h > 0.0 { self.young * h / (self.young + h) } else { 0.0 };
        Some(Self { young, ..*self })
    }
}

/// Constants of the model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Constants {
    /// Exponent f_E of the effective Young's modulus (8), and f_Ep (15) [1].
    pub f_e: f64,
    /// Exponent f_G of the effective shear modulus (9), and f_Gp (16) [1].
    pub f_g: f64,
    /// Exponent f_Ep (15) [1].
    pub f_ep: f64,
    /// Exponent f_Gp (16) [1].
    pub f_gp: f64,
    /// Critical porosity p_c [1].
    pub p_c: f64,
    /// c1 and c1p [1].
    pub c1: f64,
    /// c2 and c2p, near −ln Φ_c [1].
    pub c2: f64,
    /// Slope α of the plastic share (11) [1].
    pub alpha: f64,
    /// Solid fraction at jamming Φ_c [1].
    pub phi_c: f64,
}

impl Constants {
    /// The paper's constants.
    pub const PAPER: Self = Self {
        f_e: 1.2,
        f_g: 0.2,
        f_ep: 1.2,
        f_gp: 0.2,
        p_c: 0.201,
        c1: 1.0,
        c2: 0.23,
        alpha: 2.5,
        phi_c: 0.8,
    };

    /// 1 − p/p_c with p = 1 − Φ, kept at 0 below the critical porosity, where (8) and (9) would be complex.
    #[must_use]
    pub fn distance(&self, phi: f64) -> f64 {
        (1.0 - (1.0 - phi) / self.p_c).max(0.0)
    }

    /// Effective P-wave modulus (7) from (8), (9) for a material with exponents (f_E, f_G) [Pa].
    #[must_use]
    pub fn p_wave(&self, material: &Material, phi: f64, exponents: [f64; 2]) -> f64 {
        let x = self.distance(phi);
        if material.young <= 0.0 || x <= 0.0 {
            // (14) is 0/0 for H = 0; its limit is 0
            return 0.0;
        }
        p_wave(material.young * x.powf(exponents[0]), material.shear() * x.powf(exponents[1]))
    }

    /// Effective elastic Young's modulus (8) [Pa].
    #[must_use]
    pub fn young(&self, material: &Material, phi: f64) -> f64 {
        material.young * self.distance(phi).powf(self.f_e)
    }

    /// Effective elastic shear modulus (9) [Pa].
    #[must_use]
    pub fn shear(&self, material: &Material, phi: f64) -> f64 {
        material.shear() * self.distance(phi).powf(self.f_g)
    }

    /// Stress over strain beyond jamming (5): σ − σ_c = M_eff (ε − ε_c) [Pa].
    #[must_use]
    pub fn excess_stress(&self, material: &Material, phi: f64, excess_strain: f64) -> f64 {
        self.p_wave(material, phi, [self.f_e, self.f_g]) * excess_strain
    }

    /// Plastic stress from the strain (12): σ_y + M_p (ε − ε_c) [Pa]; nothing for elastic discs.
    #[must_use]
    pub fn excess_stress_plastic(&self, material: &Material, phi: f64, excess_strain: f64) -> Option<f64> {
        let plastic = material.plastic()?;
        Some(material.sigma_y + self.p_wave(&plastic, phi, [self.f_ep, self.f_gp]) * excess_strain)
    }

    /// Elastic stress (6): M_eff/(1 + M_eff/(c1 K Z Φ)) (ln Φ + c2), 0 below jamming [Pa].
    #[must_use]
    pub fn sigma_elastic(&self, material: &Material, phi: f64, z: f64) -> f64 {
        let modulus = self.p_wave(material, phi, [self.f_e, self.f_g]);
        self.stress(modulus, material.bulk(), phi, z)
    }

    /// Plastic stress (13): σ_y + M_p/(1 + M_p/(c1p K_p Z Φ)) (ln Φ + c2p) [Pa]; nothing for elastic discs.
    #[must_use]
    pub fn sigma_plastic(&self, material: &Material, phi: f64, z: f64) -> Option<f64> {
        let plastic = material.plastic()?;
        let modulus = self.p_wave(&plastic, phi, [self.f_ep, self.f_gp]);
        Some(material.sigma_y + self.stress(modulus, plastic.bulk(), phi, z))
    }

    fn stress(&self, modulus: f64, bulk: f64, phi: f64, z: f64) -> f64 {
        if modulus <= 0.0 || z <= 0.0 {
            return 0.0;
        }
        modulus / (1.0 + modulus / (self.c1 * bulk * z * phi)) * (phi.ln() + self.c2).max(0.0)
    }

    /// Plastic share f_p = α ln(Φ/Φ_c) (11), within [0, 1].
    #[must_use]
    pub fn plastic_share(&self, phi: f64) -> f64 {
        (self.alpha * (phi / self.phi_c).ln()).clamp(0.0, 1.0)
    }

    /// Stress (10): (1 − f_p) σ_e + f_p σ_p; σ_e for elastic discs [Pa].
    #[must_use]
    pub fn sigma(&self, material: &Material, phi: f64, z: f64) -> f64 {
        let elastic = self.sigma_elastic(material, phi, z);
        let share = self.plastic_share(phi);
        self.sigma_plastic(material, phi, z)
            .map_or(elastic, |plastic| (1.0 - share) * elastic + share * plastic)
    }
}

/// M = G (4G − E)/(3G − E) (7) [Pa].
fn p_wave(young: f64, shear: f64) -> f64 {
    shear * (4.0 * shear - young) / (3.0 * shear - young)
}

/// Z by (17): Z_c + (Z_1 − Z_c) √((Φ − Φ_c)/(Φ_1 − Φ_c)) [1].
///
/// # Errors
/// [`FitError::OutOfRange`] below Φ_c.
pub fn coordination(phi: f64, jamming: [f64; 2], later: [f64; 2]) -> Result<f64, FitError> {
    let ([phi_c, z_c], [phi_1, z_1]) = (jamming, later);
    if phi < phi_c {
        return Err(FitError::out_of_range(
            "coordination (17)",
            format!("Φ = {phi} lies below Φ_c = {phi_c}"),
        ));
    }
    Ok(z_c + (z_1 - z_c) * ((phi - phi_c) / (phi_1 - phi_c)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(h: Option<f64>) -> Material {
        Material { young: 10.0, nu: 0.45, sigma_y: 0.4, h }
    }

    /// Independent values (six digits) of all the formulas, with Z = 4 + 5.1 √(Φ − 0.8), stresses in MPa.
    #[test]
    fn agrees_with_independent_values_of_the_formulas() {
        let rows = include_str!("model_eqs.csv");
        let constants = Constants::PAPER;
        let mut checked = 0;
        for row in rows.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let h = if cells[0] == "el" { None } else { Some(cells[0].parse::<f64>().unwrap()) };
            let (phi, expected): (f64, f64) = (cells[2].parse().unwrap(), cells[3].parse().unwrap());
            let material = material(h);
            let z = coordination(phi, [0.8, 4.0], [0.81, 4.51]).unwrap();
            let found = match cells[1] {
                "E_eff_MPa" => constants.young(&material, phi),
                "G_eff_MPa" => constants.shear(&material, phi),
                "M_eff_MPa" => constants.p_wave(&material, phi, [constants.f_e, constants.f_g]),
                "sigma_MPa" => constants.sigma(&material, phi, z),
                "sigma_p_MPa" => constants.sigma_plastic(&material, phi, z).unwrap(),
                "f_p" => constants.plastic_share(phi),
                other => panic!("unknown quantity {other}"),
            };
            assert!((found / expected - 1.0).abs() < 5e-6, "{row}: {found}");
            checked += 1;
        }
        assert!(checked >= 40, "{checked}");
    }

    #[test]
    fn elastic_constants_of_the_paper() {
        let elastic = material(None);
        assert!((elastic.shear() - 3.448_28).abs() < 1e-5);
        assert!((elastic.bulk() - 34.4828).abs() < 1e-4);
        // Φ = 1: M = λ + 2μ
        assert!((Constants::PAPER.p_wave(&elastic, 1.0, [1.2, 0.2]) - 37.931).abs() < 1e-3);
        // uniaxial tangents
        assert!((material(Some(1.0)).plastic().unwrap().young - 0.9091).abs() < 1e-4);
        assert!((material(Some(3.0)).plastic().unwrap().young - 2.3077).abs() < 1e-4);
        assert!((Constants::PAPER.excess_stress(&elastic, 1.0, 0.01) - 0.379_31).abs() < 1e-5);
        // (12) at Φ = 1: E_p/E of the elastic modulus, above σ_y; only σ_y for H = 0
        let hard = Constants::PAPER.excess_stress_plastic(&material(Some(1.0)), 1.0, 0.01).unwrap();
        assert!((hard - 0.4 - 0.379_31 / 11.0).abs() < 1e-5);
        assert_eq!(Constants::PAPER.excess_stress_plastic(&material(Some(0.0)), 0.9, 0.01), Some(0.4));
        assert_eq!(Constants::PAPER.excess_stress_plastic(&elastic, 0.9, 0.01), None);
    }

    #[test]
    fn below_jamming_nothing_is_carried() {
        let constants = Constants::PAPER;
        assert_eq!(constants.sigma(&material(Some(1.0)), 0.79, 4.0), 0.0);
        assert_eq!((constants.plastic_share(0.7), constants.distance(0.5)), (0.0, 0.0));
        assert!(coordination(0.79, [0.8, 4.0], [0.95, 6.0]).is_err());
        assert_eq!(coordination(0.8, [0.8, 4.0], [0.95, 6.0]).unwrap(), 4.0);
        assert_eq!(coordination(0.95, [0.8, 4.0], [0.95, 6.0]).unwrap(), 6.0);
    }
}
