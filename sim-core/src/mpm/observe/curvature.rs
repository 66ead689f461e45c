//! Largest curvature of an outline.

/// Points of the resampled outline.
const SAMPLES: usize = 256;

/// Largest curvature κ of a closed outline: resampled uniformly in arc length (cubic through four points), then
/// quadratic least squares in a window of arc length `window`; κ = (x′y″ − y′x″)/(x′² + y′²)^{3/2}. What is sharper
/// than about 1/`window` is not resolved.
#[must_use]
pub fn largest(outline: &[[f64; 2]], window: f64) -> f64 {
    let (points, spacing) = resample(outline);
    let half = (0.5 * window / spacing).round().clamp(2.0, SAMPLES as f64 / 4.0) as i64;
    // least-squares slope and second derivative on 2·half + 1 equal spacings (Savitzky & Golay 1964)
    let m = half as f64;
    let count = 2.0 * m + 1.0;
    let second_moment = m * (m + 1.0) * count / 3.0;
    let fourth_moment = second_moment * (3.0 * m * m + 3.0 * m - 1.0) / 5.0;
    let bend = fourth_moment - second_moment * second_moment / count;
    let mut most = f64::MIN;
    for centre in 0..SAMPLES as i64 {
        let (mut slope, mut curve) = ([0.0; 2], [0.0; 2]);
        for k in -half..=half {
            let p = points[(centre + k).rem_euclid(SAMPLES as i64) as usize];
            let s = k as f64;
            for axis in 0..2 {
                slope[axis] += s * p[axis] / second_moment;
                curve[axis] += 2.0 * (s * s - second_moment / count) * p[axis] / bend;
            }
        }
        let speed = slope[0] * slope[0] + slope[1] * slope[1];
        most = most.max((slope[0] * curve[1] - slope[1] * curve[0]) / (speed * speed.sqrt()));
    }
    most
}

/// The outline at equal arc lengths.
fn resample(outline: &[[f64; 2]]) -> (Vec<[f64; 2]>, f64) {
    const PER_SEGMENT: usize = 8;
    let n = outline.len();
    let mut fine = Vec::with_capacity(n * PER_SEGMENT + 1);
    for k in 0..n {
        let p = [k + n - 1, k, k + 1, k + 2].map(|index| outline[index % n]);
        for j in 0..PER_SEGMENT {
            let s = j as f64 / PER_SEGMENT as f64;
            let weights = [
                -s * (s - 1.0) * (s - 2.0) / 6.0,
                (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
                -(s + 1.0) * s * (s - 2.0) / 2.0,
                (s + 1.0) * s * (s - 1.0) / 6.0,
            ];
            fine.push([0, 1].map(|axis| p.iter().zip(weights).map(|(p, w)| w * p[axis]).sum::<f64>()));
        }
    }
    fine.push(fine[0]);
    let mut length = vec![0.0];
    for pair in fine.windows(2) {
        let step = libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
        length.push(length[length.len() - 1] + step);
    }
    let spacing = length[length.len() - 1] / SAMPLES as f64;
    let mut segment = 0;
    let points = (0..SAMPLES)
        .map(|k| {
            let at = k as f64 * spacing;
            while length[segment + 1] < at {
                segment += 1;
            }
            let share =
                (at - length[segment]) / (length[segment + 1] - length[segment]).max(f64::MIN_POSITIVE);
            [0, 1].map(|axis| fine[segment][axis] + share * (fine[segment + 1][axis] - fine[segment][axis]))
        })
        .collect();
    (points, spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_circle_and_of_an_ellipse() {
        let ellipse = |a: f64, b: f64| -> Vec<[f64; 2]> {
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / 80.0;
            (0..80).map(|k| [a * libm::cos(angle(k)), b * libm::sin(angle(k))]).collect()
        };
        assert!((largest(&ellipse(2.0, 2.0), 0.5) - 0.5).abs() < 0.003);
        // a/b² at the tip; the window rounds it off a little
        let tip = largest(&ellipse(2.0, 1.0), 0.25);
        assert!((tip / 2.0 - 1.0).abs() < 0.02, "{tip}");
    }
}
