//! Estimates of the moduli from averages over the network.
//!
//! Gilabert, Roux and Castellanos (2008), eqs. (12) to (14), with the measured moments of the diameters in place of
//! those of the infinite sample.

use core::f64::consts::PI;

/// Averages that enter the estimates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundInputs {
    /// Coordination number z [1].
    pub coordination: f64,
    /// Solid fraction Φ [1].
    pub solid_fraction: f64,
    /// ⟨d⟩ [a].
    pub mean_diameter: f64,
    /// ⟨d²⟩ [a²].
    pub mean_square_diameter: f64,
    /// K_N [F0/a].
    pub normal_stiffness: f64,
    /// K_T [F0/a].
    pub tangential_stiffness: f64,
}

/// Voigt bound of the bulk modulus, B_V = z Φ (⟨d²⟩ + ⟨d⟩²) K_N/(4π ⟨d²⟩), eq. (12) [F0/a].
#[must_use]
pub fn voigt_bulk(inputs: &BoundInputs) -> f64 {
    let (second, first) = (inputs.mean_square_diameter, inputs.mean_diameter);
    inputs.coordination * inputs.solid_fraction * (second + first * first) * inputs.normal_stiffness
        / (4.0 * PI * second)
}

/// Voigt bound of the shear modulus, G_V = B_V (K_N + K_T)/(2 K_N), eq. (12) [F0/a].
#[must_use]
pub fn voigt_shear(inputs: &BoundInputs) -> f64 {
    let ratio = (inputs.normal_stiffness + inputs.tangential_stiffness) / (2.0 * inputs.normal_stiffness);
    ratio * voigt_bulk(inputs)
}

/// Reuss bound of the bulk modulus, B_R = z Φ ⟨d⟩² K_N/(2π ⟨d²⟩ Z̃_2), eq. (14) [F0/a].
#[must_use]
pub fn reuss_bulk(inputs: &BoundInputs, z2: f64) -> f64 {
    let first = inputs.mean_diameter;
    inputs.coordination * inputs.solid_fraction * first * first * inputs.normal_stiffness
        / (2.0 * PI * inputs.mean_square_diameter * z2)
}

/// Z̃_2 = ⟨F_N² + (K_N/K_T) F_T² + (K_N/K_R) Γ²⟩/⟨F_N⟩², eq. (13) [1]; `forces` holds (F_N, F_T, Γ) of every
/// contact. Absent springs (stiffness zero) carry nothing and drop out. `None` when the mean force vanishes.
#[must_use]
pub fn z2_ratio(forces: &[(f64, f64, f64)], normal: f64, tangential: f64, rolling: f64) -> Option<f64> {
    let weight = |stiffness: f64| if stiffness > 0.0 { normal / stiffness } else { 0.0 };
    let (by_tangential, by_rolling) = (weight(tangential), weight(rolling));
    let mut mean = 0.0;
    let mut energy = 0.0;
    for &(pressing, shearing, moment) in forces {
        mean += pressing;
        energy += pressing * pressing + by_tangential * shearing * shearing + by_rolling * moment * moment;
    }
    let count = forces.len() as f64;
    (mean != 0.0).then(|| energy * count / (mean * mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_coefficients_for_uniform_diameters() {
        // d uniform in [1/2, 1]: ⟨d⟩ = 3/4, ⟨d²⟩ = 7/12; B_V = 55 z Φ K_N/(112 π), B_R = 27 z Φ K_N/(56 π Z̃_2).
        let inputs = BoundInputs {
            coordination: 3.0,
            solid_fraction: 0.5,
            mean_diameter: 0.75,
            mean_square_diameter: 7.0 / 12.0,
            normal_stiffness: 1e5,
            tangential_stiffness: 1e5,
        };
        let voigt = 55.0 * 3.0 * 0.5 * 1e5 / (112.0 * PI);
        assert!((voigt_bulk(&inputs) / voigt - 1.0).abs() < 1e-14);
        assert!((voigt_shear(&inputs) / voigt - 1.0).abs() < 1e-14);
        let reuss = 27.0 * 3.0 * 0.5 * 1e5 / (56.0 * PI * 1.4);
        assert!((reuss_bulk(&inputs, 1.4) / reuss - 1.0).abs() < 1e-14);
    }

    #[test]
    fn monodisperse_triangular_lattice_meets_its_voigt_bound() {
        let inputs = BoundInputs {
            coordination: 6.0,
            solid_fraction: PI / (2.0 * 3.0_f64.sqrt()),
            mean_diameter: 1.0,
            mean_square_diameter: 1.0,
            normal_stiffness: 1.0,
            tangential_stiffness: 0.5,
        };
        assert!((voigt_bulk(&inputs) - 3.0_f64.sqrt() / 2.0).abs() < 1e-14);
        assert!((voigt_shear(&inputs) - 3.0_f64.sqrt() / 4.0 * 1.5).abs() < 1e-14);
    }

    #[test]
    fn equal_forces_have_unit_ratio() {
        assert_eq!(z2_ratio(&[(2.0, 0.0, 0.0); 5], 1.0, 1.0, 0.0), Some(1.0));
        let mixed = z2_ratio(&[(1.0, 1.0, 0.5), (3.0, 0.0, 0.0)], 2.0, 1.0, 0.5).unwrap();
        assert!((mixed - (1.0 + 2.0 + 1.0 + 9.0) / 2.0 / 4.0).abs() < 1e-15);
        assert_eq!(z2_ratio(&[(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)], 1.0, 1.0, 1.0), None);
    }
}
