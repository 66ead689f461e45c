//! An order of particles in which neighbours in space are near in memory.

/// Particles along a Morton curve through cells of one diameter: the new order, as indices into the old one. Ties
/// keep their old order, so the result is determined by positions and old order.
#[must_use]
pub fn spatial_order(count: usize, position: impl Fn(usize) -> [f64; 3]) -> Vec<u32> {
    let mut low = [f64::INFINITY; 3];
    for particle in 0..count {
        let x = position(particle);
        for axis in 0..3 {
            low[axis] = low[axis].min(x[axis]);
        }
    }
    let mut keyed: Vec<(u64, u32)> = (0..count)
        .map(|particle| {
            let x = position(particle);
            let key = (0..3).fold(0, |key, axis| key | spread((x[axis] - low[axis]) as u64) << axis);
            (key, particle as u32)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, particle)| particle).collect()
}

/// Puts two zero bits between the bits of a number below 2²¹.
fn spread(number: u64) -> u64 {
    let mut bits = number.min((1 << 21) - 1);
    bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_a_permutation_and_keeps_cells_together() {
        let positions: Vec<[f64; 3]> =
            (0..512).map(|k| [f64::from(k % 8), f64::from(k / 8 % 8), f64::from(k / 64)]).collect();
        let order = spatial_order(positions.len(), |i| positions[i]);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..512).collect::<Vec<u32>>());
        // Eight consecutive cells are a cube of two.
        for block in order.chunks(8) {
            for axis in 0..3 {
                let span = block
                    .iter()
                    .map(|&i| positions[i as usize][axis])
                    .fold((9.0_f64, -9.0_f64), |s, x| (s.0.min(x), s.1.max(x)));
                assert_eq!(span.1 - span.0, 1.0);
            }
        }
    }
}
