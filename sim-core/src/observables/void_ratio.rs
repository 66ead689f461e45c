//! Void ratio: of the whole box, and of its core away from the walls.

use std::f64::consts::PI;

use super::sphere_box;

/// Depth of the layer along the walls that is left out of the core [d].
pub(crate) const CORE_MARGIN: f64 = 2.5;

/// e = V_box/(N π d³/6) − 1, with the nominal volume of the spheres: overlaps count twice.
#[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
pub(crate) fn void_ratio(walls: &[f64; 6], n: usize) -> f64 {
    let volume = (walls[1] - walls[0]) * (walls[3] - walls[2]) * (walls[5] - walls[4]);
    volume / (n as f64 * PI / 6.0) - 1.0
}

/// Void ratio inside a box, from exact sphere–box volumes; nothing when the box is empty or holds no solid.
pub(crate) fn within(positions: &[[f64; 3]], low: [f64; 3], high: [f64; 3]) -> Option<f64> {
    let edges = [0, 1, 2].map(|k| high[k] - low[k]);
    if edges.iter().any(|&edge| edge <= 0.0) {
        return None;
    }
    let solid: f64 = positions.iter().map(|&centre| sphere_box::volume(centre, 0.5, low, high)).sum();
    (solid > 0.0).then(|| edges.iter().product::<f64>() / solid - 1.0)
}

/// e_core: the void ratio [`CORE_MARGIN`] away from the walls; nothing when the box is too small to have a core.
pub(crate) fn core(positions: &[[f64; 3]], walls: &[f64; 6]) -> Option<f64> {
    let low = [0, 1, 2].map(|k| walls[2 * k] + CORE_MARGIN);
    let high = [0, 1, 2].map(|k| walls[2 * k + 1] - CORE_MARGIN);
    within(positions, low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_lattice_has_the_lattices_void_ratio() {
        let mut positions = Vec::new();
        for x in 0..9 {
            for y in 0..9 {
                for z in 0..9 {
                    positions.push([x, y, z].map(|k| f64::from(k) + 0.5));
                }
            }
        }
        let walls = [0.0, 9.0, 0.0, 9.0, 0.0, 9.0];
        let lattice = 6.0 / PI - 1.0;
        assert!((void_ratio(&walls, positions.len()) - lattice).abs() < 1e-14);
        // the core cuts spheres through their centres, edges and corners included: still whole cells
        assert!((core(&positions, &walls).unwrap() - lattice).abs() < 1e-12);
    }

    #[test]
    fn a_small_box_has_no_core() {
        assert_eq!(core(&[[2.0; 3]], &[0.0, 4.0, 0.0, 4.0, 0.0, 9.0]), None);
    }
}
