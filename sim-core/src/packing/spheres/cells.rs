//! A cell grid for building pair lists of an initial state.

/// Particles sorted into cells at least as wide as the asked range.
pub(super) struct Cells {
    counts: [usize; 3],
    /// First entry of each cell in `members`; one more at the end.
    starts: Vec<usize>,
    members: Vec<usize>,
}

impl Cells {
    /// Sorts `positions` (inside [0, lengths]) into cells of width at least `range`.
    pub(super) fn new(positions: &[[f64; 3]], lengths: [f64; 3], range: f64) -> Self {
        // a loose box must not cost more cells than particles
        let most = libm::cbrt(positions.len() as f64 + 1.0).ceil() * 2.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and small")]
        let counts = lengths.map(|edge| (edge / range).floor().clamp(1.0, most) as usize);
        let cell_of = |x: &[f64; 3]| {
            let mut index = 0;
            for k in 0..3 {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "clamped at both ends"
                )]
                let along = ((x[k] / lengths[k] * counts[k] as f64).max(0.0) as usize).min(counts[k] - 1);
                index = index * counts[k] + along;
            }
            index
        };
        let mut starts = vec![0; counts.iter().product::<usize>() + 1];
        for x in positions {
            starts[cell_of(x) + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; positions.len()];
        for (particle, x) in positions.iter().enumerate() {
            let slot = &mut next[cell_of(x)];
            members[*slot] = particle;
            *slot += 1;
        }
        Self { counts, starts, members }
    }

    /// Calls `visit(i, j)` once for every pair closer than the range, in an order fixed by the positions.
    pub(super) fn pairs_within(
        &self,
        positions: &[[f64; 3]],
        range: f64,
        mut visit: impl FnMut(usize, usize),
    ) {
        let [nx, ny, nz] = self.counts;
        for cx in 0..nx {
            for cy in 0..ny {
                for cz in 0..nz {
                    let here = self.members_of([cx, cy, cz]);
                    for (rank, &i) in here.iter().enumerate() {
                        for &j in &here[rank + 1..] {
                            if distance_squared(&positions[i], &positions[j]) < range * range {
                                visit(i, j);
                            }
                        }
                    }
                    self.for_each_later_neighbour([cx, cy, cz], |there| {
                        for &i in here {
                            for &j in there {
                                if distance_squared(&positions[i], &positions[j]) < range * range {
                                    visit(i, j);
                                }
                            }
                        }
                    });
                }
            }
        }
    }

    fn members_of(&self, [x, y, z]: [usize; 3]) -> &[usize] {
        let cell = (x * self.counts[1] + y) * self.counts[2] + z;
        &self.members[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The 13 of the 26 neighbours that come later in the order of the cells.
    fn for_each_later_neighbour(&self, [x, y, z]: [usize; 3], mut visit: impl FnMut(&[usize])) {
        const SHIFTS: [isize; 3] = [-1, 0, 1];
        for dx in SHIFTS {
            for dy in SHIFTS {
                for dz in SHIFTS {
                    if (dx, dy, dz) <= (0, 0, 0) {
                        continue;
                    }
                    let shifted =
                        (x.checked_add_signed(dx), y.checked_add_signed(dy), z.checked_add_signed(dz));
                    if let (Some(x), Some(y), Some(z)) = shifted
                        && x < self.counts[0]
                        && y < self.counts[1]
                        && z < self.counts[2]
                    {
                        visit(self.members_of([x, y, z]));
                    }
                }
            }
        }
    }
}

pub(super) fn distance_squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn finds_the_pairs_of_all_pairs() {
        for (n, lengths) in [(200, [4.0, 5.0, 9.0]), (50, [1.1, 1.1, 40.0]), (30, [60.0, 60.0, 60.0])] {
            let mut stream = Stream::new(11, 1);
            let positions: Vec<[f64; 3]> = (0..n).map(|_| lengths.map(|edge| edge * stream.unit())).collect();
            let range = 1.3;
            let mut found = Vec::new();
            Cells::new(&positions, lengths, range)
                .pairs_within(&positions, range, |i, j| found.push((i.min(j), i.max(j))));
            found.sort_unstable();
            let mut expected = Vec::new();
            for i in 0..n {
                for j in i + 1..n {
                    if distance_squared(&positions[i], &positions[j]) < range * range {
                        expected.push((i, j));
                    }
                }
            }
            assert_eq!(found, expected);
        }
    }
}
