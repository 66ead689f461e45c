//! Exact volume of a ball inside an axis-aligned box.
//!
//! The box is an inclusion–exclusion over octants {x ≥ a, y ≥ b, z ≥ c}, one at each corner; the volume of a ball in
//! an octant has a closed form, obtained here by integrating the area of a disc in a quadrant along z. Corners,
//! edges and faces in any position are covered, a ball larger than the box too. Error: round-off, some 1e-15 R³.

use std::f64::consts::{FRAC_PI_2, PI};

/// Volume of the ball around `centre` with radius `radius` inside the box [`low`, `high`].
pub(crate) fn volume(centre: [f64; 3], radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
    let near = [0, 1, 2].map(|k| (low[k] - centre[k]) / radius);
    let far = [0, 1, 2].map(|k| (high[k] - centre[k]) / radius);
    if (0..3).any(|k| near[k] >= 1.0 || far[k] <= -1.0 || far[k] <= near[k]) {
        return 0.0;
    }
    let cube = radius * radius * radius;
    if (0..3).all(|k| near[k] <= -1.0 && far[k] >= 1.0) {
        return 4.0 / 3.0 * PI * cube;
    }
    let mut sum = 0.0;
    for corner in 0..8_usize {
        let pick = |k: usize| if corner >> k & 1 == 1 { far[k] } else { near[k] };
        let sign = if corner.count_ones() % 2 == 1 { -1.0 } else { 1.0 };
        sum += sign * octant([pick(0), pick(1), pick(2)]);
    }
    sum.max(0.0) * cube
}

/// Volume of the unit ball in {x ≥ a, y ≥ b, z ≥ c}.
fn octant([a, b, c]: [f64; 3]) -> f64 {
    if a >= 1.0 || b >= 1.0 || c >= 1.0 {
        return 0.0;
    }
    // a plane beyond the ball, or behind the centre, is mirrored: |x ≥ −a| = |all| − |x ≥ a|
    if a < 0.0 {
        quadrant(b, c) - if a <= -1.0 { 0.0 } else { octant([-a, b, c]) }
    } else if b < 0.0 {
        quadrant(a, c) - if b <= -1.0 { 0.0 } else { octant([a, -b, c]) }
    } else if c < 0.0 {
        quadrant(a, b) - if c <= -1.0 { 0.0 } else { octant([a, b, -c]) }
    } else {
        inner_octant(a, b, c)
    }
}

/// Volume of the unit ball in {y ≥ b, z ≥ c}: twice the octant with a = 0.
fn quadrant(b: f64, c: f64) -> f64 {
    if b >= 1.0 || c >= 1.0 {
        0.0
    } else if b < 0.0 {
        cap(c) - if b <= -1.0 { 0.0 } else { quadrant(-b, c) }
    } else if c < 0.0 {
        cap(b) - if c <= -1.0 { 0.0 } else { quadrant(b, -c) }
    } else {
        2.0 * inner_octant(0.0, b, c)
    }
}

/// Volume of the unit ball in {z ≥ c}.
fn cap(c: f64) -> f64 {
    let c = c.clamp(-1.0, 1.0);
    PI / 3.0 * (1.0 - c) * (1.0 - c) * (2.0 + c)
}

/// The octant for a, b, c ≥ 0: ∫ A(z) dz from c to √(1 − a² − b²), where the disc of radius ρ(z) = √(1 − z²) has in
/// the quadrant the area A = ab − a√(ρ² − a²)/2 − b√(ρ² − b²)/2 + ρ² (π/2 − asin(a/ρ) − asin(b/ρ))/2.
fn inner_octant(a: f64, b: f64, c: f64) -> f64 {
    let top_squared = 1.0 - a * a - b * b;
    if top_squared <= c * c {
        return 0.0;
    }
    let top = top_squared.sqrt();
    let at = |z: f64| 0.5 * FRAC_PI_2 * (z - z * z * z / 3.0) + a * b * z - side(a, z) - side(b, z);
    at(top) - at(c)
}

/// Antiderivative in z of a√(q² − z²)/2 + (1 − z²) asin(a/√(1 − z²))/2 with q² = 1 − a².
fn side(a: f64, z: f64) -> f64 {
    let q_squared = (1.0 - a * a).max(0.0);
    let root = (q_squared - z * z).max(0.0).sqrt();
    // asin(z/q) and atan(a z/√(q² − z²)) written with atan2, which stays exact at root = 0
    let theta = libm::atan2(z, root);
    let twist = libm::atan2(a * z, root);
    let chord = 0.5 * (z * root + q_squared * theta);
    let rest = (z * z * z / 3.0).mul_add(-1.0, z) * libm::atan2(a, root)
        - a * ((0.5 * (q_squared * theta - z * root)) / 3.0 - 2.0 / 3.0 * theta)
        - 2.0 / 3.0 * twist;
    0.5 * (a * chord + rest)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The volume by Simpson's rule over slices whose areas are exact, refined until two levels agree.
    fn by_quadrature(centre: [f64; 3], radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
        let area = |z: f64| {
            let rho_squared = radius * radius - (z - centre[2]).powi(2);
            if rho_squared <= 0.0 { 0.0 } else { disc_rectangle(rho_squared.sqrt(), centre, low, high) }
        };
        let (z0, z1) = (low[2].max(centre[2] - radius), high[2].min(centre[2] + radius));
        if z1 <= z0 {
            return 0.0;
        }
        let panels = 200_000;
        let h = (z1 - z0) / f64::from(panels);
        let inner: f64 =
            (1..panels).map(|k| (if k % 2 == 1 { 4.0 } else { 2.0 }) * area(z0 + f64::from(k) * h)).sum();
        h / 3.0 * (area(z0) + inner + area(z1))
    }

    /// Area of a disc in a rectangle: ∫ of clipped chord lengths, in closed form by the antiderivative of √(ρ² − x²).
    fn disc_rectangle(rho: f64, centre: [f64; 3], low: [f64; 3], high: [f64; 3]) -> f64 {
        let (y0, y1) = (low[1] - centre[1], high[1] - centre[1]);
        let (x0, x1) = ((low[0] - centre[0]).max(-rho), (high[0] - centre[0]).min(rho));
        if x1 <= x0 || y0 >= rho || y1 <= -rho {
            return 0.0;
        }
        let arc = |x: f64| {
            0.5 * (x * (rho * rho - x * x).max(0.0).sqrt() + rho * rho * (x / rho).clamp(-1.0, 1.0).asin())
        };
        let mut cuts = vec![x0, x1];
        for y in [y0, y1] {
            if y.abs() < rho {
                let x = (rho * rho - y * y).sqrt();
                cuts.extend([-x, x].into_iter().filter(|x| *x > x0 && *x < x1));
            }
        }
        cuts.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        for pair in cuts.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let middle = 0.5 * (a + b);
            let half_chord = (rho * rho - middle * middle).max(0.0).sqrt();
            let (bottom, top) = (y0.max(-half_chord), y1.min(half_chord));
            if top <= bottom {
                continue;
            }
            let edge = |flat: bool, y: f64| if flat { y * (b - a) } else { arc(b) - arc(a) };
            sum +=
                edge(y1 < half_chord, y1) + if y0 > -half_chord { -edge(true, y0) } else { edge(false, 0.0) };
        }
        sum
    }

    #[test]
    fn closed_form_cases() {
        let ball = 4.0 / 3.0 * PI;
        let far = 10.0;
        let cases = [
            ([-far, -far, -far], [far, far, far], ball),
            ([0.0, -far, -far], [far, far, far], ball / 2.0),
            ([0.0, 0.0, -far], [far, far, far], ball / 4.0),
            ([0.0, 0.0, 0.0], [far, far, far], ball / 8.0),
            ([0.5, -far, -far], [far, far, far], PI / 3.0 * 0.25 * 2.5),
            ([-0.5, -0.5, -0.5], [0.5, 0.5, 0.5], 1.0),
            ([0.6, 0.6, 0.6], [far, far, far], 0.0),
            ([2.0, 0.0, 0.0], [far, far, far], 0.0),
        ];
        for (low, high, expected) in cases {
            let found = volume([0.0; 3], 1.0, low, high);
            assert!((found - expected).abs() < 1e-14, "{low:?} {high:?}: {found} for {expected}");
        }
    }

    #[test]
    fn tiles_add_up_to_the_ball() {
        let cuts = [-9.0, -0.91, -0.3, 0.0, 0.17, 0.62, 0.999, 9.0];
        let mut sum = 0.0;
        for x in cuts.windows(2) {
            for y in cuts.windows(2) {
                for z in cuts.windows(2) {
                    sum += volume([0.0; 3], 1.0, [x[0], y[0], z[0]], [x[1], y[1], z[1]]);
                }
            }
        }
        assert!((sum - 4.0 / 3.0 * PI).abs() < 1e-12, "{sum}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn agrees_with_quadrature(
            centre in prop::array::uniform3(-1.5_f64..1.5),
            low in prop::array::uniform3(-1.2_f64..0.5),
            size in prop::array::uniform3(0.05_f64..2.0),
            radius in 0.2_f64..2.0,
        ) {
            let high = [0, 1, 2].map(|k| low[k] + size[k]);
            let exact = volume(centre, radius, low, high);
            let numeric = by_quadrature(centre, radius, low, high);
            // Simpson over 2e5 panels meets square-root ends of the area: h^1.5
            prop_assert!((exact - numeric).abs() < 2e-7, "{exact} {numeric}");
        }
    }
}
