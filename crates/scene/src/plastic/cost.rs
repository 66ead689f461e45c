//! Expected steps of `plastic_discs`.

use super::{ReducedPlastic, Setup};
use crate::Cost;

/// Wall time of one material point in one implicit step, Newton iterations and contact included, one core [ns].
const IMPLICIT_NANOSECONDS: f64 = 8000.0;

impl ReducedPlastic {
    /// Material points: four per cell, about 0.97 cells per square of a cell's width.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.n * (39 * self.cells * self.cells / 10).max(16)
    }

    /// Height of the box before compression [d].
    #[must_use]
    pub fn height(&self) -> f64 {
        if self.setup != Setup::Assembly {
            return 1.0;
        }
        // ⟨d²⟩ = r for diameters uniform by area between r and 1
        #[expect(clippy::cast_precision_loss, reason = "counts stay small")]
        let area = self.n as f64 * std::f64::consts::FRAC_PI_4 * self.size_ratio;
        libm::sqrt(area / self.phi_i)
    }

    /// Strain at which the run is expected to end: at constant area, the fraction Φ is reached at 1 − Φ_i/Φ.
    #[must_use]
    pub fn expected_strain(&self) -> f64 {
        let start = if self.setup == Setup::Cell { std::f64::consts::FRAC_PI_4 } else { self.phi_i };
        match self.phi_end {
            Some(phi) if self.setup != Setup::Diametrical => (1.0 - start / phi).clamp(0.0, self.strain_end),
            _ => self.strain_end,
        }
    }

    /// Time step: what the scene asks for, or the largest that moves the wall by no more than a quarter of the smallest
    /// cell and a thousandth of the height, cut so that recorded states fall on whole steps [d √(ρ/E)].
    #[must_use]
    pub fn time_step(&self) -> f64 {
        let height = self.height();
        #[expect(clippy::cast_precision_loss, reason = "counts stay small")]
        let cell = self.size_ratio / self.cells as f64;
        let asked = self.dt.unwrap_or_else(|| f64::min(0.25 * cell, 1e-3 * height) / self.wall_speed);
        let between = self.strain_step * height / self.wall_speed;
        between / libm::ceil(between / asked - 1e-9)
    }

    /// Steps until the expected end.
    #[must_use]
    pub fn expected_steps(&self) -> u64 {
        let time = self.expected_strain() * self.height() / self.wall_speed;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let steps = libm::ceil(time / self.time_step()).clamp(1.0, 1e12) as u64;
        steps
    }

    pub(crate) fn cost(&self) -> Cost {
        Cost::of(self.expected_steps(), self.points(), IMPLICIT_NANOSECONDS, 0.1)
    }
}
