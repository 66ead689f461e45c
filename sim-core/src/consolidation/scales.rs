//! Units and tolerances of a scene.

use scene::discs::ReducedDiscs;

/// Scales of one imposed pressure, in units of K_N, a and m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// P [K_N/a].
    pub pressure: f64,
    /// F1 = max(F0, P a): unit of the tolerances [K_N a].
    pub f1: f64,
    /// Unit of forces in rows: F0, or P a without cohesion [K_N a].
    pub force: f64,
    /// T0 = √(a m/F0), or √(m/P) without cohesion [√(m/K_N)].
    pub time: f64,
}

impl Scales {
    /// Scales at the pressure P* (P/K_N without cohesion).
    #[must_use]
    pub fn of(scene: &ReducedDiscs, reduced_pressure: f64) -> Self {
        if scene.f0 > 0.0 {
            let pressure = reduced_pressure * scene.f0;
            Self { pressure, f1: scene.f0.max(pressure), force: scene.f0, time: libm::sqrt(1.0 / scene.f0) }
        } else {
            let unit = reduced_pressure;
            Self { pressure: unit, f1: unit, force: unit, time: libm::sqrt(1.0 / unit) }
        }
    }
}
