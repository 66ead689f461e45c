//! Rounding that makes equal numbers equal bits.

/// Rounds to 12 significant decimal digits, so that equal groups reached by different arithmetic are equal bits.
///
/// The error of a few floating-point operations is some 1e-16, so two ways to one number differ after rounding
/// only when it lies within that distance of a rounding boundary: a chance of about 1e-4 for an arbitrary number,
/// and none for the short decimal numbers people write. The price of a miss is a point run twice, never a wrong
/// result.
#[must_use]
pub fn round12(value: f64) -> f64 {
    let rounded: f64 = format!("{value:.11e}").parse().expect("a formatted number parses");
    // −0 and 0 are one value.
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_arithmetic_gives_equal_bits() {
        assert_eq!(round12(0.1 + 0.2).to_bits(), 0.3_f64.to_bits());
        assert_eq!(round12(3e6 / 1e10).to_bits(), round12(3.0 / 1e4).to_bits());
        assert_eq!(round12(-0.0).to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn rounding_twice_is_rounding_once() {
        for exponent in -300..300 {
            let value = 1.234_567_890_123_456_7 * 10_f64.powi(exponent);
            let once = round12(value);
            assert_eq!(round12(once).to_bits(), once.to_bits());
            assert!(((once - value) / value).abs() < 5e-12);
        }
    }
}
