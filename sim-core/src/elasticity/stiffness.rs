//! Assembly of the stiffness matrix of a network.

use super::network::{Bond, Network};

/// Which displacements and rotations are unknowns, and their positions in the matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct DegreesOfFreedom {
    index: Vec<[Option<usize>; 3]>,
    count: usize,
}

impl DegreesOfFreedom {
    /// Two translations, and with `rotations` one rotation, of every disc of `carries`; the first of them does not
    /// translate, which removes the free translations of the whole sample.
    #[must_use]
    pub fn of_periodic(carries: &[bool], rotations: bool) -> Self {
        let pinned = carries.iter().position(|&carried| carried);
        let mut free = vec![[false; 3]; carries.len()];
        for (disc, &carried) in carries.iter().enumerate() {
            let translates = carried && Some(disc) != pinned;
            free[disc] = [translates, translates, carried && rotations];
        }
        Self::of_free(&free)
    }

    /// The unknowns marked true: (u_x, u_y, θ) of every disc.
    #[must_use]
    pub fn of_free(free: &[[bool; 3]]) -> Self {
        let mut count = 0;
        let index = free
            .iter()
            .map(|flags| {
                flags.map(|is_free| {
                    is_free.then(|| {
                        count += 1;
                        count - 1
                    })
                })
            })
            .collect();
        Self { index, count }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Position of the unknown `component` (0: u_x, 1: u_y, 2: θ) of a disc.
    #[must_use]
    pub fn position(&self, disc: usize, component: usize) -> Option<usize> {
        self.index[disc][component]
    }
}

/// The stiffness matrix, with the cell strains apart: energy = ½ u·K u + u·(K_uε ε) + ½ ε·(K_εε ε).
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    /// Number of displacement unknowns.
    pub count: usize,
    /// Upper triangle of K: (row, column, value), row ≤ column; duplicates add up.
    pub upper: Vec<(usize, usize, f64)>,
    /// K_uε, one column per strain ε_1, ε_2.
    pub strain_coupling: [Vec<f64>; 2],
    /// K_εε.
    pub strain: [[f64; 2]; 2],
}

impl Stiffness {
    /// Adds up K_N, K_T and K_R of every bond whose discs both have unknowns or are held.
    #[must_use]
    pub fn assemble(network: &Network, carries: &[bool], unknowns: &DegreesOfFreedom) -> Self {
        let mut matrix = Self {
            count: unknowns.count(),
            upper: Vec::with_capacity(36 * network.bonds.len()),
            strain_coupling: [vec![0.0; unknowns.count()], vec![0.0; unknowns.count()]],
            strain: [[0.0; 2]; 2],
        };
        for bond in network.bonds.iter().filter(|bond| carries[bond.i] && carries[bond.j]) {
            for (stiffness, row) in spring_rows(bond) {
                if stiffness != 0.0 {
                    matrix.add_spring(stiffness, bond, &row, unknowns);
                }
            }
        }
        matrix
    }

    fn add_spring(&mut self, stiffness: f64, bond: &Bond, spring: &Spring, unknowns: &DegreesOfFreedom) {
        let mut entries = [(0, 0.0); 6];
        let mut used = 0;
        for (disc, gradient) in [(bond.i, spring.first), (bond.j, spring.second)] {
            for (component, &value) in gradient.iter().enumerate() {
                if let Some(position) = unknowns.position(disc, component) {
                    entries[used] = (position, value);
                    used += 1;
                }
            }
        }
        let entries = &entries[..used];
        for &(row, left) in entries {
            for &(column, right) in entries {
                if row <= column {
                    self.upper.push((row, column, stiffness * left * right));
                }
            }
            for (direction, coupling) in self.strain_coupling.iter_mut().enumerate() {
                coupling[row] += stiffness * left * spring.strain[direction];
            }
        }
        for (first, row) in self.strain.iter_mut().enumerate() {
            for (second, value) in row.iter_mut().enumerate() {
                *value += stiffness * spring.strain[first] * spring.strain[second];
            }
        }
    }
}

/// Gradient of one spring's stretch: by (u_x, u_y, θ) of both discs and by the strains.
struct Spring {
    first: [f64; 3],
    second: [f64; 3],
    strain: [f64; 2],
}

fn spring_rows(bond: &Bond) -> [(f64, Spring); 3] {
    let length = libm::hypot(bond.branch[0], bond.branch[1]);
    let normal = [bond.branch[0] / length, bond.branch[1] / length];
    let tangent = [-normal[1], normal[0]];
    let along = |direction: [f64; 2], spin_i: f64, spin_j: f64| Spring {
        first: [-direction[0], -direction[1], spin_i],
        second: [direction[0], direction[1], spin_j],
        strain: [direction[0] * bond.branch[0], direction[1] * bond.branch[1]],
    };
    let rolling = Spring { first: [0.0, 0.0, -1.0], second: [0.0, 0.0, 1.0], strain: [0.0; 2] };
    [
        (bond.normal, along(normal, 0.0, 0.0)),
        (bond.tangential, along(tangent, -bond.arm_i, -bond.arm_j)),
        (bond.rolling, rolling),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::factor::Factor;
    use super::*;

    const RADIUS: f64 = 0.4;
    const NORMAL: f64 = 3.0;
    const TANGENTIAL: f64 = 2.0;
    const ROLLING: f64 = 0.01;

    /// A straight chain of n discs along x, the first one held.
    fn chain(discs: usize) -> (Factor, usize) {
        let bonds = (1..discs)
            .map(|j| Bond {
                i: j - 1,
                j,
                branch: [2.0 * RADIUS, 0.0],
                arm_i: RADIUS,
                arm_j: RADIUS,
                normal: NORMAL,
                tangential: TANGENTIAL,
                rolling: ROLLING,
            })
            .collect();
        let network = Network { discs, area: 1.0, bonds };
        let mut free = vec![[true; 3]; discs];
        free[0] = [false; 3];
        let unknowns = DegreesOfFreedom::of_free(&free);
        let stiffness = Stiffness::assemble(&network, &vec![true; discs], &unknowns);
        (Factor::new(stiffness.count, &stiffness.upper).unwrap(), stiffness.count)
    }

    /// Displacement (u_x, u_y, θ) of the last disc under a force and a moment on it.
    fn response(discs: usize, load: [f64; 3]) -> [f64; 3] {
        let (factor, count) = chain(discs);
        let mut solution = vec![0.0; count];
        solution[count - 3..].copy_from_slice(&load);
        factor.solve(&mut solution);
        [solution[count - 3], solution[count - 2], solution[count - 1]]
    }

    /// Compliances of the contact that replaces the chain: two discs of radius (n − 1) R touching in the middle.
    fn effective_compliances(discs: usize) -> [f64; 3] {
        let arm = (discs as f64 - 1.0) * RADIUS;
        let pulled = response(discs, [1.0, 0.0, 0.0])[0];
        // A shear force through the effective contact point acts on the last disc with the lever arm −(n − 1) R.
        let sheared = response(discs, [0.0, 1.0, -arm]);
        let rolled = response(discs, [0.0, 0.0, 1.0])[2];
        [pulled, sheared[1] - arm * sheared[2], rolled]
    }

    #[test]
    fn chain_compliances_in_closed_form() {
        // 1/K_N^(n) = (n−1)/K_N and 1/K_R^(n) = (n−1)/K_R, as in eq. (16). The tangential one is
        // (n−1)/K_T + n(n−1)(n−2) R²/(3 K_R): with the moment T R (2c − n) in contact c, c = 1 … n−1.
        for discs in [2, 3, 4, 7, 20, 60] {
            let n = discs as f64;
            let bending = n * (n - 1.0) * (n - 2.0) * RADIUS * RADIUS / (3.0 * ROLLING);
            let expected = [(n - 1.0) / NORMAL, (n - 1.0) / TANGENTIAL + bending, (n - 1.0) / ROLLING];
            for (found, wanted) in effective_compliances(discs).into_iter().zip(expected) {
                assert!((found / wanted - 1.0).abs() < 1e-9, "n = {discs}: {found} against {wanted}");
            }
        }
    }

    #[test]
    fn printed_polynomial_of_equation_16_is_not_that_of_the_chain() {
        // (n−1)(4n² − 11n + 6) as printed agrees for n = 2 only; it is what remains of the transverse deflection of
        // the held chain, (n−1)(4n² − 8n + 3) R²/(3 K_R), when (n−1)² instead of (n−1)³ is taken off for rolling.
        for discs in [2, 3, 10] {
            let n = discs as f64;
            let printed = (n - 1.0) * (4.0 * n * n - 11.0 * n + 6.0) * RADIUS * RADIUS / (3.0 * ROLLING);
            let bending = effective_compliances(discs)[1] - (n - 1.0) / TANGENTIAL;
            let agrees = (printed - bending).abs() < 1e-8 * printed.max(1.0);
            assert_eq!(agrees, discs == 2, "n = {discs}: printed {printed}, assembled {bending}");
            let deflection = response(discs, [0.0, 1.0, 0.0])[1] - (n - 1.0) / TANGENTIAL;
            let cantilever = (n - 1.0) * (4.0 * n * n - 8.0 * n + 3.0) * RADIUS * RADIUS / (3.0 * ROLLING);
            assert!((deflection / cantilever - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn rigid_motion_costs_nothing() {
        let bond = Bond {
            i: 0,
            j: 1,
            branch: [0.6, -0.3],
            arm_i: 0.3,
            arm_j: libm::hypot(0.6, 0.3) - 0.3,
            normal: 1.0,
            tangential: 1.0,
            rolling: 1.0,
        };
        for (_, spring) in spring_rows(&bond) {
            // u_j = u_i + θ × r with θ_i = θ_j = θ = 1.
            let rotated = [0.3, 0.6];
            let turned = spring.second[0] * rotated[0] + spring.second[1] * rotated[1];
            assert!((turned + spring.first[2] + spring.second[2]).abs() < 1e-15);
            assert_eq!(spring.first[0] + spring.second[0], 0.0);
            assert_eq!(spring.first[1] + spring.second[1], 0.0);
        }
    }
}
