//! Cells of at least the search distance: a particle's neighbours lie in its own cell and the 26 around it.

/// Largest number of cells along an axis; a wider spread of particles gets larger cells.
const MOST_CELLS: usize = 256;

/// Particles sorted by cell.
#[derive(Clone, Debug, Default)]
pub struct CellList {
    low: [f64; 3],
    inverse_size: [f64; 3],
    cells: [usize; 3],
    /// Particles of cell c: `members[start[c]..start[c + 1]]`, ascending.
    start: Vec<u32>,
    members: Vec<u32>,
}

impl CellList {
    /// Sorts `count` particles into cells of at least `size` along each axis.
    pub fn build(&mut self, count: usize, size: f64, position: impl Fn(usize) -> [f64; 3]) {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for particle in 0..count {
            let x = position(particle);
            for axis in 0..3 {
                low[axis] = low[axis].min(x[axis]);
                high[axis] = high[axis].max(x[axis]);
            }
        }
        for axis in 0..3 {
            let extent = (high[axis] - low[axis]).max(0.0);
            let cells = ((extent / size) as usize).clamp(1, MOST_CELLS);
            self.cells[axis] = cells;
            self.inverse_size[axis] = if extent > 0.0 { cells as f64 / extent } else { 0.0 };
        }
        self.low = low;
        let total = self.cells.iter().product::<usize>();
        self.start.clear();
        self.start.resize(total + 1, 0);
        for particle in 0..count {
            let cell = self.flat(self.cell(position(particle)));
            self.start[cell + 1] += 1;
        }
        for cell in 0..total {
            self.start[cell + 1] += self.start[cell];
        }
        self.members.clear();
        self.members.resize(count, 0);
        for particle in (0..count).rev() {
            let cell = self.flat(self.cell(position(particle)));
            self.start[cell + 1] -= 1;
            self.members[self.start[cell + 1] as usize] = particle as u32;
        }
        // Filling from the back moved every start by one cell: start[c + 1] is now the start of c.
        for cell in 0..total {
            self.start[cell] = self.start[cell + 1];
        }
        self.start[total] = count as u32;
    }

    /// Cell coordinates of a point; points outside belong to the nearest cell.
    fn cell(&self, x: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| {
            (((x[axis] - self.low[axis]) * self.inverse_size[axis]) as usize).min(self.cells[axis] - 1)
        })
    }

    fn flat(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.cells[1] + cell[1]) * self.cells[0] + cell[0]
    }

    /// Calls `visit` with every particle in the cell of `x` and the cells around it.
    #[inline]
    pub fn around(&self, x: [f64; 3], mut visit: impl FnMut(u32)) {
        let cell = self.cell(x);
        let range = |axis: usize| cell[axis].saturating_sub(1)..=(cell[axis] + 1).min(self.cells[axis] - 1);
        for cz in range(2) {
            for cy in range(1) {
                // Cells along x lie one after another, so do their members.
                let xs = range(0);
                let first = self.start[self.flat([*xs.start(), cy, cz])] as usize;
                let last = self.start[self.flat([*xs.end(), cy, cz]) + 1] as usize;
                for &member in &self.members[first..last] {
                    visit(member);
                }
            }
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (self.start.capacity() + self.members.capacity()) * size_of::<u32>()
    }
}

/// Pairs (i, j) of particles i of a range with those of a higher index j closer than `cutoff(i, j)`, ascending. `real` gives
/// the particle that a place in the cells is an image of.
pub fn near_pairs(
    cells: &CellList,
    range: std::ops::Range<usize>,
    position: impl Fn(usize) -> [f64; 3],
    real: impl Fn(u32) -> u32,
    cutoff: impl Fn(usize, usize) -> f64,
    near: &mut Vec<(u32, u32)>,
) {
    near.clear();
    for i in range {
        let from = near.len();
        let x = position(i);
        cells.around(x, |place| {
            let j = real(place);
            if j as usize > i {
                let y = position(place as usize);
                let square = (y[0] - x[0]).powi(2) + (y[1] - x[1]).powi(2) + (y[2] - x[2]).powi(2);
                if square < cutoff(i, j as usize).powi(2) {
                    near.push((i as u32, j));
                }
            }
        });
        near[from..].sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::neighbour::all_pairs;

    proptest! {
        #[test]
        fn cell_list_finds_what_all_pairs_finds(
            positions in prop::collection::vec(prop::array::uniform3(-4.0..4.0_f64), 0..120),
            flat in 0..3_usize,
            cutoff in 0.2..3.0_f64,
        ) {
            let positions: Vec<[f64; 3]> = positions
                .into_iter()
                .map(|mut x| { if flat > 0 { x[flat] = 0.5; } x })
                .collect();
            let mut cells = CellList::default();
            cells.build(positions.len(), cutoff, |i| positions[i]);
            let mut near = Vec::new();
            near_pairs(&cells, 0..positions.len(), |i| positions[i], |i| i, |_, _| cutoff, &mut near);
            prop_assert_eq!(near, all_pairs(&positions, |_, _| cutoff));
        }
    }
}
