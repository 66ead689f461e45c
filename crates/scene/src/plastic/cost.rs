//! Expected steps of `plastic_discs`.

use super::{Method, ReducedPlastic, Setup, Variant};
use crate::Cost;

/// Wall time of one material point in one implicit step, Newton iterations and contact included, one core [ns].
const IMPLICIT_NANOSECONDS: f64 = 6000.0;

/// The same with cubic splines.
const SPLINE_NANOSECONDS: f64 = 30_000.0;

/// Wall time of one material point in one explicit step, contact included, one core [ns].
const EXPLICIT_NANOSECONDS: f64 = 90.0;
/// Mean stable step of the explicit method over the time a P-wave takes through the smallest cell.
const STABLE: f64 = 0.5;

/// Solid fraction at which frictionless discs of the paper's sizes jam [1].
const JAMMED: f64 = 0.85;

impl ReducedPlastic {
    /// Material points: four per cell unless the scene says otherwise, about 0.97 cells per square of a cell's width.
    #[must_use]
    pub fn points(&self) -> u64 {
        let per_cell = self.points_across * self.points_across;
        self.n * (39 * per_cell * self.cells * self.cells / 40).max(4 * per_cell)
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
        self.time_step_at(self.wall_speed)
    }

    /// As [`ReducedPlastic::time_step`] while the wall goes at `speed`.
    #[must_use]
    pub fn time_step_at(&self, speed: f64) -> f64 {
        let height = self.height();
        #[expect(clippy::cast_precision_loss, reason = "counts stay small")]
        let cell = self.size_ratio / self.cells as f64;
        let by_wall = f64::min(0.25 * cell, 1e-3 * height) / speed;
        match self.method {
            Method::Implicit => self.whole_step(by_wall, speed),
            Method::Explicit => {
                let p_wave = libm::sqrt((1.0 - self.nu) / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu)));
                self.whole_step(f64::min(by_wall, STABLE * cell / p_wave), speed)
            }
        }
    }

    /// The longest step up to `most` (and to the one the scene asks for) that divides the time between two recorded
    /// states while the wall goes at `speed` [d √(ρ/E)].
    #[must_use]
    pub fn whole_step(&self, most: f64, speed: f64) -> f64 {
        let asked = match self.method {
            Method::Implicit => self.dt.unwrap_or(most),
            Method::Explicit => self.dt.map_or(most, |dt| dt.min(most)),
        };
        let between = self.strain_step * self.height() / speed;
        between / libm::ceil(between / asked - 1e-9)
    }

    /// Steps until the expected end.
    #[must_use]
    pub fn expected_steps(&self) -> u64 {
        let strain = self.expected_strain();
        // a programme keeps the slow start about until discs jam
        let slow = self.pace.map_or(0.0, |_| (1.0 - self.phi_i / JAMMED).clamp(0.0, strain));
        let steps = |strain: f64, speed: f64| strain * self.height() / speed / self.time_step_at(speed);
        let start = self.pace.map_or(self.wall_speed, |pace| pace.speed);
        let steps = steps(slow, start) + steps(strain - slow, self.wall_speed);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let steps = libm::ceil(steps - 1e-9).clamp(1.0, 1e12) as u64;
        steps
    }

    pub(crate) fn cost(&self) -> Cost {
        let nanoseconds = match self.method {
            Method::Implicit if self.variant == Variant::TotalBilinear => IMPLICIT_NANOSECONDS,
            Method::Implicit => SPLINE_NANOSECONDS,
            Method::Explicit => EXPLICIT_NANOSECONDS,
        };
        Cost::of(self.expected_steps(), self.points(), nanoseconds, 0.1)
    }
}
