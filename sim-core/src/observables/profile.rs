//! Profile e(r): void ratio inside a centred cube of side 2r (the paper's Fig. 15).

use super::void_ratio;

/// Number of probes.
const PROBES: u32 = 40;

/// One point of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ProfilePoint {
    /// Half the side of the probe [d].
    pub(crate) r: f64,
    /// r over the shortest edge of the box [1]; 1/2 reaches its walls.
    pub(crate) r_over_l: f64,
    /// Void ratio inside the probe [1].
    pub(crate) e: f64,
}

/// Void ratio in cubes around the centre of the box, from exact sphere–cube volumes, up to the nearest walls.
/// Probes that hold no solid are left out.
pub(crate) fn profile(positions: &[[f64; 3]], walls: &[f64; 6]) -> Vec<ProfilePoint> {
    let centre = [0, 1, 2].map(|k| 0.5 * (walls[2 * k] + walls[2 * k + 1]));
    let shortest = (0..3).map(|k| walls[2 * k + 1] - walls[2 * k]).fold(f64::INFINITY, f64::min);
    (1..=PROBES)
        .filter_map(|probe| {
            let r_over_l = 0.5 * f64::from(probe) / f64::from(PROBES);
            let r = r_over_l * shortest;
            let e = void_ratio::within(positions, centre.map(|c| c - r), centre.map(|c| c + r))?;
            Some(ProfilePoint { r, r_over_l, e })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn one_sphere_in_the_middle() {
        let points = profile(&[[2.0; 3]], &[0.0, 4.0, 0.0, 4.0, 0.0, 8.0]);
        // the box is not centred on the sphere along z: only the large probes hold all of it
        let last = points.last().unwrap();
        assert!((last.r_over_l - 0.5).abs() < 1e-15);
        assert!((last.e - (4.0_f64.powi(3) / (PI / 12.0) - 1.0)).abs() < 1e-9);
    }
}
