//! The oracle: every pair is tested.

/// Pairs (i, j), i < j, closer than `cutoff(i, j)`, sorted.
#[must_use]
pub fn all_pairs(positions: &[[f64; 3]], mut cutoff: impl FnMut(usize, usize) -> f64) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    for i in 0..positions.len() {
        for j in i + 1..positions.len() {
            let square: f64 = (0..3).map(|k| (positions[j][k] - positions[i][k]).powi(2)).sum();
            if square < cutoff(i, j).powi(2) {
                pairs.push((i as u32, j as u32));
            }
        }
    }
    pairs
}
