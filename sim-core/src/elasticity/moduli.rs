//! Elastic moduli of a network under diagonal strains.

use super::factor::{Factor, Signature};
use super::network::Network;
use super::stiffness::{DegreesOfFreedom, Stiffness};

/// Why there are no moduli.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ElasticError {
    /// No disc carries load.
    #[error("the network carries no load")]
    NoNetwork,
    /// The factorisation broke down.
    #[error("factorisation of the stiffness matrix: {0}")]
    Factorisation(String),
}

/// Moduli of a statistically isotropic network and its stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moduli {
    /// C_11 and C_22, measured separately [F0/a].
    pub c11: [f64; 2],
    /// C_12 = C_21 [F0/a].
    pub c12: f64,
    /// Signs of the eigenvalues of the (3N + 2)-dimensional matrix without the free translations.
    pub signature: Signature,
}

impl Moduli {
    /// Bulk modulus B = (C11 + C12)/2, C11 averaged over both directions [F0/a].
    #[must_use]
    pub fn bulk(&self) -> f64 {
        0.5 * (0.5 * (self.c11[0] + self.c11[1]) + self.c12)
    }

    /// Shear modulus G = (C11 − C12)/2 [F0/a].
    #[must_use]
    pub fn shear(&self) -> f64 {
        0.5 * (0.5 * (self.c11[0] + self.c11[1]) - self.c12)
    }
}

/// Elastic response to diagonal strains, every disc in equilibrium: C = (K_εε − K_εu K⁻¹ K_uε)/A.
///
/// This is the solution of K·U = F for unit stress increments (eq. 6) with the displacements eliminated first, so
/// that the two full rows of the strains never enter the factorisation. Displacements are those of the frozen
/// network: no sliding, no change of geometry, no prestress terms.
///
/// # Errors
/// [`ElasticError`] when nothing carries load or the factorisation breaks down.
pub fn moduli(network: &Network) -> Result<Moduli, ElasticError> {
    let carries = network.load_carrying();
    if !carries.iter().any(|&carried| carried) {
        return Err(ElasticError::NoNetwork);
    }
    let rotations = network.bonds.iter().any(|bond| bond.tangential != 0.0 || bond.rolling != 0.0);
    let unknowns = DegreesOfFreedom::of_periodic(&carries, rotations);
    let stiffness = Stiffness::assemble(network, &carries, &unknowns);
    let factor = Factor::new(stiffness.count, &stiffness.upper)?;
    let responses = stiffness.strain_coupling.clone().map(|mut column| {
        factor.solve(&mut column);
        column
    });
    let condensed = |first: usize, second: usize| {
        let coupling = &stiffness.strain_coupling[first];
        let relaxed: f64 =
            coupling.iter().zip(&responses[second]).map(|(force, response)| force * response).sum();
        stiffness.strain[first][second] - relaxed
    };
    let (c11, c22) = (condensed(0, 0), condensed(1, 1));
    let c12 = 0.5 * (condensed(0, 1) + condensed(1, 0));
    let mut signature = factor.signature();
    let scale = stiffness.strain[0][0].max(stiffness.strain[1][1]);
    // Pivots of the condensed 2 × 2 matrix: inertia is additive (Haynsworth).
    signature.count(c11, scale);
    signature.count(c22 - if c11 == 0.0 { 0.0 } else { c12 * c12 / c11 }, scale);
    let area = network.area;
    Ok(Moduli { c11: [c11 / area, c22 / area], c12: c12 / area, signature })
}

#[cfg(test)]
mod tests {
    use super::super::network::Bond;
    use super::*;

    /// Triangular lattice of unit discs, `columns` × 2 `pairs` of rows, bonds of stiffness (normal, tangential).
    fn triangular(columns: usize, pairs: usize, normal: f64, tangential: f64, rolling: f64) -> Network {
        let height = 3.0_f64.sqrt();
        let id = |column: usize, row: usize| (row % (2 * pairs)) * columns + column % columns;
        let mut bonds = Vec::new();
        let mut link = |i: usize, j: usize, branch: [f64; 2]| {
            bonds.push(Bond { i, j, branch, arm_i: 0.5, arm_j: 0.5, normal, tangential, rolling });
        };
        for row in 0..2 * pairs {
            for column in 0..columns {
                let here = id(column, row);
                let right_above = column + row % 2;
                link(here, id(column + 1, row), [1.0, 0.0]);
                link(here, id(right_above, row + 1), [0.5, 0.5 * height]);
                link(here, id(right_above + columns - 1, row + 1), [-0.5, 0.5 * height]);
            }
        }
        let area = columns as f64 * pairs as f64 * height;
        Network { discs: 2 * pairs * columns, area, bonds }
    }

    #[test]
    fn frictionless_triangular_lattice() {
        let found = moduli(&triangular(6, 3, 2.0, 0.0, 0.0)).unwrap();
        let root3 = 3.0_f64.sqrt();
        assert!((found.bulk() - root3 / 2.0 * 2.0).abs() < 1e-13, "{found:?}");
        assert!((found.shear() - root3 / 4.0 * 2.0).abs() < 1e-13, "{found:?}");
        assert_eq!(found.signature.smallest(), 1);
    }

    #[test]
    fn triangular_lattice_with_tangential_and_rolling_springs() {
        // Rotations vanish by symmetry: B = √3/2 K_N and G = √3/4 (K_N + K_T), whatever K_R is.
        for rolling in [0.0, 0.3] {
            let found = moduli(&triangular(5, 4, 2.0, 0.7, rolling)).unwrap();
            let root3 = 3.0_f64.sqrt();
            assert!((found.bulk() - root3).abs() < 1e-13, "{found:?}");
            assert!((found.shear() - root3 / 4.0 * 2.7).abs() < 1e-13, "{found:?}");
        }
    }

    #[test]
    fn a_missing_contact_softens_and_a_tensile_bond_can_destabilise() {
        let full = moduli(&triangular(4, 2, 1.0, 1.0, 0.0)).unwrap();
        let mut weaker = triangular(4, 2, 1.0, 1.0, 0.0);
        weaker.bonds.swap_remove(7);
        assert!(moduli(&weaker).unwrap().bulk() < full.bulk());
        let mut unstable = triangular(4, 2, 1.0, 0.0, 0.0);
        for bond in unstable.bonds.iter_mut().filter(|bond| bond.i == 3 || bond.j == 3) {
            bond.normal = -0.01;
        }
        assert_eq!(moduli(&unstable).unwrap().signature.smallest(), -1);
    }

    #[test]
    fn square_lattice_without_friction_is_a_mechanism() {
        let side = 4;
        let id = |x: usize, y: usize| (y % side) * side + x % side;
        let mut bonds = Vec::new();
        for y in 0..side {
            for x in 0..side {
                for (j, branch) in [(id(x + 1, y), [1.0, 0.0]), (id(x, y + 1), [0.0, 1.0])] {
                    let base = Bond {
                        i: id(x, y),
                        j,
                        branch,
                        arm_i: 0.5,
                        arm_j: 0.5,
                        normal: 1.0,
                        tangential: 0.0,
                        rolling: 0.0,
                    };
                    bonds.push(base);
                }
            }
        }
        let network = Network { discs: side * side, area: 16.0, bonds };
        // Rows and columns slide freely, yet C_11 = C_22 = K_N, C_12 = 0.
        let found = moduli(&network).unwrap();
        assert_eq!(found.signature.smallest(), 0);
        assert!(
            (found.c11[0] - 1.0).abs() < 1e-12
                && (found.c11[1] - 1.0).abs() < 1e-12
                && found.c12.abs() < 1e-12
        );
    }

    #[test]
    fn a_free_disc_does_not_matter() {
        let full = triangular(4, 2, 1.0, 1.0, 0.1);
        let mut with_rattler = full.clone();
        with_rattler.discs += 1;
        assert_eq!(moduli(&full).unwrap(), moduli(&with_rattler).unwrap());
    }

    #[test]
    fn nothing_carries_load_without_bonds() {
        let empty = Network { discs: 3, area: 1.0, bonds: Vec::new() };
        assert_eq!(moduli(&empty), Err(ElasticError::NoNetwork));
    }
}
