//! An order of particles in which neighbours in space are near in memory.

/// Bits per axis of a place on a curve: three times as many fit into a number of 64 bits.
const MOST_BITS: u32 = 21;

/// Particles in space along a Hilbert curve through the box they fill: the new order, as indices into the old one. The box is cut
/// into 2^k cells along every axis, so that equal parts of the order are cubes of it where the particles are evenly
/// spread, and parts that follow each other share a face. Ties keep their old order, so the result is determined by positions
/// and old order.
#[must_use]
pub fn hilbert_order(count: usize, position: impl Fn(usize) -> [f64; 3]) -> Vec<u32> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for particle in 0..count {
        let x = position(particle);
        for axis in 0..3 {
            low[axis] = low[axis].min(x[axis]);
            high[axis] = high[axis].max(x[axis]);
        }
    }
    let extent: [f64; 3] = std::array::from_fn(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
    // Cells of at most a diameter.
    let longest = extent.into_iter().fold(1.0, f64::max);
    let bits = (1..MOST_BITS).find(|&bits| f64::from(1 << bits) >= longest).unwrap_or(MOST_BITS);
    let cells = f64::from(1_u32 << bits);
    ordered(count, |particle| {
        let x = position(particle);
        let cell = std::array::from_fn(|axis| {
            ((x[axis] - low[axis]) / extent[axis] * cells).min(cells - 1.0) as u64
        });
        hilbert_place(cell, bits)
    })
}

/// Particles of a plane along a Morton curve through cells of one diameter; else as [`hilbert_order`].
#[must_use]
pub fn morton_order(count: usize, position: impl Fn(usize) -> [f64; 3]) -> Vec<u32> {
    let mut low = [f64::INFINITY; 3];
    for particle in 0..count {
        let x = position(particle);
        for axis in 0..3 {
            low[axis] = low[axis].min(x[axis]);
        }
    }
    ordered(count, |particle| {
        let x = position(particle);
        (0..3).fold(0, |place, axis| place | spread((x[axis] - low[axis]) as u64) << axis)
    })
}

/// The order by place on a curve, ties by index.
fn ordered(count: usize, place: impl Fn(usize) -> u64) -> Vec<u32> {
    let mut keyed: Vec<(u64, u32)> = (0..count).map(|particle| (place(particle), particle as u32)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, particle)| particle).collect()
}

/// Puts two zero bits between the bits of a number below 2²¹.
fn spread(number: u64) -> u64 {
    let mut bits = number.min((1 << MOST_BITS) - 1);
    bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

/// Place of a cell on the Hilbert curve through (2^bits)³ cells: from the highest bit down, the half-spaces of the axes are
/// mirrored or exchanged so that each octant holds a turned copy of the whole curve; Gray code then counts the octants (J.
/// Skilling, AIP Conf. Proc. 707, 381, 2004).
fn hilbert_place(mut cell: [u64; 3], bits: u32) -> u64 {
    for bit in (1..bits).rev() {
        let below = (1 << bit) - 1;
        for axis in 0..3 {
            if cell[axis] >> bit & 1 == 1 {
                cell[0] ^= below;
            } else {
                let exchanged = (cell[0] ^ cell[axis]) & below;
                cell[0] ^= exchanged;
                cell[axis] ^= exchanged;
            }
        }
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    let flip = (1..bits).filter(|bit| cell[2] >> bit & 1 == 1).fold(0, |flip, bit| flip ^ ((1 << bit) - 1));
    // Bit by bit, the first axis highest: as Morton places of the axes in reverse.
    (0..3).fold(0, |place, axis| place | spread(cell[axis] ^ flip) << (2 - axis))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_cell_once_and_steps_to_a_neighbour() {
        for bits in 1..=4 {
            let side = 1_u64 << bits;
            let mut cells: Vec<(u64, [u64; 3])> = Vec::new();
            for x in 0..side {
                for y in 0..side {
                    for z in 0..side {
                        cells.push((hilbert_place([x, y, z], bits), [x, y, z]));
                    }
                }
            }
            cells.sort_unstable();
            assert!((0_u64..).zip(&cells).all(|(place, cell)| cell.0 == place));
            for step in cells.windows(2) {
                let far: u64 = (0..3).map(|axis| step[0].1[axis].abs_diff(step[1].1[axis])).sum();
                assert_eq!(far, 1);
            }
        }
    }

    #[test]
    fn eighths_of_a_box_of_any_size_are_its_octants() {
        // 20³ particles, not a power of two; a box that is not a cube.
        let positions: Vec<[f64; 3]> = (0..8000)
            .map(|k| [f64::from(k % 20), 1.3 * f64::from(k / 20 % 20), 0.9 * f64::from(k / 400)])
            .collect();
        let order = hilbert_order(positions.len(), |i| positions[i]);
        let octant = |i: u32| {
            let x = positions[i as usize];
            [x[0] > 9.5, x[1] > 9.5 * 1.3, x[2] > 9.5 * 0.9]
        };
        for part in order.chunks(1000) {
            assert!(part.iter().all(|&i| octant(i) == octant(part[0])));
        }
    }

    #[test]
    fn orders_are_permutations_whatever_the_positions() {
        for positions in [vec![], vec![[0.3; 3]], vec![[1.0, 2.0, 3.0]; 5], vec![[0.0; 3], [1e9, 0.0, -1e9]]]
        {
            for order in [
                hilbert_order(positions.len(), |i| positions[i]),
                morton_order(positions.len(), |i| positions[i]),
            ] {
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert_eq!(sorted, (0..positions.len() as u32).collect::<Vec<u32>>());
            }
        }
    }

    #[test]
    fn the_order_of_the_plane_keeps_cells_together() {
        let positions: Vec<[f64; 3]> = (0..64).map(|k| [f64::from(k % 8), f64::from(k / 8), 0.0]).collect();
        let order = morton_order(positions.len(), |i| positions[i]);
        // Four consecutive cells are a square of two.
        for block in order.chunks(4) {
            for axis in 0..2 {
                let span = block
                    .iter()
                    .map(|&i| positions[i as usize][axis])
                    .fold((9.0_f64, -9.0_f64), |s, x| (s.0.min(x), s.1.max(x)));
                assert_eq!(span.1 - span.0, 1.0);
            }
        }
    }
}
