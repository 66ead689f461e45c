//! A contact network at rest, as springs.

/// One interaction of a frozen network, linearised: three springs between two discs.
///
/// With u the displacements, θ the rotations, ε the diagonal strains of the cell, n the unit vector from `i` to `j`
/// and t = (−n_y, n_x), the springs are stretched by
/// δ_n = n·(u_j − u_i + ε r), δ_t = t·(u_j − u_i + ε r) − R_i θ_i − R_j θ_j and δ_r = θ_j − θ_i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// First disc.
    pub i: usize,
    /// Second disc.
    pub j: usize,
    /// Vector r from the centre of `i` to the (nearest image of the) centre of `j` [a].
    pub branch: [f64; 2],
    /// Lever arm R_i [a].
    pub arm_i: f64,
    /// Lever arm R_j [a].
    pub arm_j: f64,
    /// Normal stiffness: K_N for a contact, −F0/D0 for a distant attractive bond [F0/a].
    pub normal: f64,
    /// Tangential stiffness: K_T, zero for a distant bond [F0/a].
    pub tangential: f64,
    /// Rolling stiffness per radian: K_R, zero without rolling resistance or for a distant bond [F0 a].
    pub rolling: f64,
}

/// A frozen contact network in a periodic cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Number of discs.
    pub discs: usize,
    /// Area of the cell [a²].
    pub area: f64,
    /// The interactions.
    pub bonds: Vec<Bond>,
}

impl Network {
    /// The discs that can carry load: the largest connected part of what is left after removing, again and again,
    /// every disc with fewer bonds than it needs to stand still (one with rolling resistance, two with friction,
    /// three without). Ties between parts go to the one with the lowest disc.
    #[must_use]
    pub fn load_carrying(&self) -> Vec<bool> {
        let needed = self.bonds_needed();
        let neighbours = self.neighbours();
        let mut degree: Vec<usize> = neighbours.iter().map(Vec::len).collect();
        let mut carries = vec![true; self.discs];
        let mut loose: Vec<usize> = (0..self.discs).filter(|&disc| degree[disc] < needed).collect();
        while let Some(disc) = loose.pop() {
            if !carries[disc] {
                continue;
            }
            carries[disc] = false;
            for &other in &neighbours[disc] {
                degree[other] -= 1;
                if carries[other] && degree[other] < needed {
                    loose.push(other);
                }
            }
        }
        largest_part(&neighbours, &carries)
    }

    fn bonds_needed(&self) -> usize {
        if self.bonds.iter().any(|bond| bond.rolling != 0.0) {
            1
        } else if self.bonds.iter().any(|bond| bond.tangential != 0.0) {
            2
        } else {
            3
        }
    }

    fn neighbours(&self) -> Vec<Vec<usize>> {
        let mut neighbours = vec![Vec::new(); self.discs];
        for bond in &self.bonds {
            neighbours[bond.i].push(bond.j);
            neighbours[bond.j].push(bond.i);
        }
        neighbours
    }
}

fn largest_part(neighbours: &[Vec<usize>], allowed: &[bool]) -> Vec<bool> {
    let mut part = vec![usize::MAX; allowed.len()];
    let mut sizes = Vec::new();
    for start in 0..allowed.len() {
        if !allowed[start] || part[start] != usize::MAX {
            continue;
        }
        let label = sizes.len();
        let mut size = 0;
        let mut stack = vec![start];
        part[start] = label;
        while let Some(disc) = stack.pop() {
            size += 1;
            for &other in &neighbours[disc] {
                if allowed[other] && part[other] == usize::MAX {
                    part[other] = label;
                    stack.push(other);
                }
            }
        }
        sizes.push(size);
    }
    let largest = sizes.iter().enumerate().max_by_key(|&(label, &size)| (size, usize::MAX - label));
    let Some((label, _)) = largest else {
        return vec![false; allowed.len()];
    };
    part.iter().map(|&own| own == label).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bond(i: usize, j: usize, rolling: f64) -> Bond {
        Bond { i, j, branch: [1.0, 0.0], arm_i: 0.5, arm_j: 0.5, normal: 1.0, tangential: 1.0, rolling }
    }

    /// A ring 0-1-2 with a tail 2-3-4, a pair 5-6 and a free disc 7.
    fn ring_with_tail(rolling: f64) -> Network {
        let bonds = [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (5, 6)];
        Network { discs: 8, area: 1.0, bonds: bonds.iter().map(|&(i, j)| bond(i, j, rolling)).collect() }
    }

    #[test]
    fn tails_carry_load_only_with_rolling_resistance() {
        let with = ring_with_tail(1.0).load_carrying();
        assert_eq!(with, [true, true, true, true, true, false, false, false]);
        let without = ring_with_tail(0.0).load_carrying();
        assert_eq!(without, [true, true, true, false, false, false, false, false]);
    }
}
