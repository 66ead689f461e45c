//! Counter streams: random numbers as a pure function of (seed, stream, counter), so that nothing about them has to
//! be saved and no order of evaluation can change them.

/// SplitMix64 finaliser (Steele, Lea, Flood 2014, doi:10.1145/2660193.2660195), a bijection of 64 bits.
const fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

/// Golden-ratio increment of SplitMix64.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// A stream of random numbers addressed by a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    key: u64,
    counter: u64,
}

impl Stream {
    /// The stream `stream` of `seed`, at its first number.
    pub(crate) const fn new(seed: u64, stream: u64) -> Self {
        let key = mix(mix(seed.wrapping_add(GOLDEN)) ^ mix(stream.wrapping_mul(GOLDEN).wrapping_add(1)));
        Self { key, counter: 0 }
    }

    /// The sub-stream of item `item`: independent of every other item of this stream.
    pub(crate) const fn item(self, item: u64) -> Self {
        Self { key: mix(self.key ^ mix(item.wrapping_add(1).wrapping_mul(GOLDEN))), counter: 0 }
    }

    /// The next 64 random bits.
    pub(crate) const fn bits(&mut self) -> u64 {
        self.counter = self.counter.wrapping_add(1);
        mix(self.key.wrapping_add(self.counter.wrapping_mul(GOLDEN)))
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact in an f64")]
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// A direction uniform on the sphere (Marsaglia 1972: two uniforms in the disc, no transcendental function).
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let (a, b) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let s = a * a + b * b;
            if s < 1.0 {
                let scale = 2.0 * (1.0 - s).sqrt();
                return [a * scale, b * scale, 1.0 - 2.0 * s];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_numbers_have_the_moments_of_a_uniform() {
        let n = 100_000;
        let mut stream = Stream::new(1, 7);
        let values: Vec<f64> = (0..n).map(|_| stream.unit()).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let second = values.iter().map(|v| v * v).sum::<f64>() / n as f64;
        // five standard errors
        assert!((mean - 0.5).abs() < 5.0 * (1.0 / 12.0_f64 / n as f64).sqrt());
        assert!((second - 1.0 / 3.0).abs() < 5.0 * (4.0 / 45.0_f64 / n as f64).sqrt());
    }

    #[test]
    fn directions_are_unit_and_isotropic() {
        let n = 50_000;
        let mut sum = [0.0; 3];
        let mut square = [0.0; 3];
        for item in 0..n {
            let u = Stream::new(3, 1).item(item).direction();
            assert!((u.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-14);
            for k in 0..3 {
                sum[k] += u[k] / n as f64;
                square[k] += u[k] * u[k] / n as f64;
            }
        }
        for k in 0..3 {
            assert!(sum[k].abs() < 5.0 * (1.0 / 3.0 / n as f64).sqrt());
            assert!((square[k] - 1.0 / 3.0).abs() < 5.0 * (4.0 / 45.0 / n as f64).sqrt());
        }
    }

    #[test]
    fn neighbouring_seeds_streams_and_items_differ() {
        let mut seen: Vec<u64> = Vec::new();
        for seed in 0..10 {
            for stream in 0..10 {
                let base = Stream::new(seed, stream);
                seen.push({ base }.bits());
                seen.extend((0..10).map(|item| base.item(item).bits()));
            }
        }
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}
