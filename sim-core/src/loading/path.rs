//! Pressures of a loading path.

/// One leg: from the pressure reached to `target` in geometric steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Last pressure of the leg (P* or P a/K_N, in the units of the path) [1].
    pub target: f64,
    /// Steps per decade of pressure; the paper compresses with 8.
    pub per_decade: f64,
}

/// Direction of a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Pressure grows beyond all pressures before.
    Compression,
    /// Pressure falls.
    Unloading,
    /// Pressure grows up to the largest pressure before.
    Reloading,
}

impl Branch {
    /// Word for the record.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Compression => "compression",
            Self::Unloading => "unloading",
            Self::Reloading => "reloading",
        }
    }
}

/// One state of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathState {
    /// Pressure to equilibrate at [1].
    pub pressure: f64,
    /// How it is approached.
    pub branch: Branch,
    /// Leg it belongs to; 0 is the start.
    pub leg: usize,
}

/// All states of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadingPath {
    states: Vec<PathState>,
}

impl LoadingPath {
    /// The states from `start` along the legs. A leg is cut into equal ratios, as many as `per_decade` asks for,
    /// rounded to the nearest whole number: 0.01 → 13.33 with 8 per decade is 25 steps of 10^(1/8). The target
    /// itself is met exactly.
    #[must_use]
    pub fn new(start: f64, legs: &[Leg]) -> Self {
        let mut states = vec![PathState { pressure: start, branch: Branch::Compression, leg: 0 }];
        let (mut from, mut largest) = (start, start);
        for (leg, &Leg { target, per_decade }) in legs.iter().enumerate() {
            let decades = libm::log10(target / from);
            if decades == 0.0 {
                continue;
            }
            let steps = libm::round(decades.abs() * per_decade).max(1.0);
            for step in 1..=steps as u64 {
                let part = step as f64 / steps;
                let pressure = if part == 1.0 { target } else { from * libm::pow(10.0, decades * part) };
                let branch = if decades < 0.0 {
                    Branch::Unloading
                } else if pressure > largest * (1.0 + 1e-9) {
                    Branch::Compression
                } else {
                    Branch::Reloading
                };
                states.push(PathState { pressure, branch, leg: leg + 1 });
                largest = largest.max(pressure);
            }
            from = target;
        }
        Self { states }
    }

    /// The states in order.
    #[must_use]
    pub fn states(&self) -> &[PathState] {
        &self.states
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_cycle() {
        let legs = [Leg { target: 13.335_214_3, per_decade: 8.0 }, Leg { target: 0.01, per_decade: 2.0 }];
        let path = LoadingPath::new(0.01, &legs);
        let up: Vec<_> = path.states().iter().filter(|state| state.branch == Branch::Compression).collect();
        assert_eq!(up.len(), 26);
        for pair in up.windows(2) {
            assert!((pair[1].pressure / pair[0].pressure - 1.333_521_4).abs() < 1e-6);
        }
        assert!((up[10].pressure - 0.177_828).abs() < 1e-6);
        assert_eq!(path.states().len(), 26 + 6);
        assert_eq!(path.states().last().unwrap().pressure.to_bits(), 0.01_f64.to_bits());
    }

    #[test]
    fn reloading_ends_at_the_consolidation_pressure() {
        let legs = [
            Leg { target: 1.0, per_decade: 4.0 },
            Leg { target: 0.01, per_decade: 1.0 },
            Leg { target: 10.0, per_decade: 1.0 },
        ];
        let branches: Vec<_> = LoadingPath::new(0.01, &legs).states().iter().map(|s| s.branch).collect();
        let words: String = branches.iter().map(|branch| branch.name().chars().next().unwrap()).collect();
        assert_eq!(words, "cccccccccuurrc");
    }
}
