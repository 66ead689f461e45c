//! The four equilibrium criteria and the rules of the final stage.
//!
//! Criteria: Gilabert, Roux and Castellanos (2008), section II D 1. With normal dashpots alone the weak bending and
//! rolling modes of a loose network decay over hundreds of T0, so a final stage adds local (non-viscous) damping.
//! It may act only while nothing slides: otherwise a sample creeps under it without converging and collapses at the
//! next pressure step.

/// What is measured on the undamped forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Largest net force on a disc [F1].
    pub force: f64,
    /// Largest net moment on a disc [F1 a].
    pub moment: f64,
    /// Largest |σ_α − P| [F1/a].
    pub stress: f64,
    /// Kinetic energy per disc, rattlers of cohesionless packings left out [F1 a].
    pub kinetic: f64,
    /// Contacts at their Coulomb bound.
    pub sliding: usize,
}

/// Tolerances of the criteria, in units of F1 = max(F0, P a) and a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Net force on each disc [F1].
    pub force: f64,
    /// Net moment on each disc [F1 a].
    pub moment: f64,
    /// Deviation of the stresses [F1/a].
    pub stress: f64,
    /// Kinetic energy per disc [F1 a].
    pub kinetic: f64,
}

impl Default for Tolerances {
    /// The paper's values.
    fn default() -> Self {
        Self { force: 1e-5, moment: 1e-5, stress: 1e-5, kinetic: 5e-8 }
    }
}

impl Tolerances {
    /// All tolerances multiplied by one factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            force: self.force * factor,
            moment: self.moment * factor,
            stress: self.stress * factor,
            kinetic: self.kinetic * factor,
        }
    }
}

/// Which criteria hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Criteria {
    /// Forces balance.
    pub force: bool,
    /// Moments balance.
    pub moment: bool,
    /// Stresses are those imposed.
    pub stress: bool,
    /// Nothing moves.
    pub kinetic: bool,
    /// No contact slides.
    pub no_sliding: bool,
}

impl Criteria {
    /// Compares residuals with tolerances.
    #[must_use]
    pub fn of(residuals: &Residuals, tolerances: &Tolerances) -> Self {
        Self {
            force: residuals.force < tolerances.force,
            moment: residuals.moment < tolerances.moment,
            stress: residuals.stress < tolerances.stress,
            kinetic: residuals.kinetic < tolerances.kinetic,
            no_sliding: residuals.sliding == 0,
        }
    }

    /// Whether all hold.
    #[must_use]
    pub fn all(self) -> bool {
        self.force && self.moment && self.stress && self.kinetic && self.no_sliding
    }
}

/// Stage of the search for equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// Undisturbed dynamics.
    #[default]
    Natural,
    /// Local damping acts.
    Final,
}

/// What to do after a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Go on, damped or not.
    Continue(Stage),
    /// Equilibrium: record the state and take the next.
    Reached,
}

/// The search for one equilibrium state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    tolerances: Tolerances,
    stage: Stage,
}

/// The final stage starts below this kinetic energy [tolerance].
const START_KINETIC: f64 = 20.0;
/// The final stage starts below this stress deviation [F1/a].
const START_STRESS: f64 = 2e-3;
/// The final stage ends above this kinetic energy [tolerance].
const END_KINETIC: f64 = 400.0;

impl Equilibrium {
    /// Starts in the natural stage.
    #[must_use]
    pub fn new(tolerances: Tolerances) -> Self {
        Self { tolerances, stage: Stage::Natural }
    }

    /// Continues in a given stage, after a checkpoint.
    #[must_use]
    pub fn resume(tolerances: Tolerances, stage: Stage) -> Self {
        Self { tolerances, stage }
    }

    /// Present stage.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Takes one set of residuals.
    pub fn check(&mut self, residuals: &Residuals) -> Verdict {
        if Criteria::of(residuals, &self.tolerances).all() {
            return Verdict::Reached;
        }
        let kinetic = residuals.kinetic / self.tolerances.kinetic;
        self.stage = match self.stage {
            Stage::Natural
                if kinetic < START_KINETIC && residuals.stress < START_STRESS && residuals.sliding == 0 =>
            {
                Stage::Final
            }
            Stage::Final if kinetic > END_KINETIC || residuals.sliding > 0 => Stage::Natural,
            unchanged => unchanged,
        };
        Verdict::Continue(self.stage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALM: Residuals = Residuals { force: 1e-3, moment: 1e-4, stress: 1e-3, kinetic: 5e-7, sliding: 0 };

    #[test]
    fn every_criterion_is_needed() {
        let good = Residuals { force: 9e-6, moment: 9e-6, stress: 9e-6, kinetic: 4e-8, sliding: 0 };
        assert_eq!(Equilibrium::new(Tolerances::default()).check(&good), Verdict::Reached);
        for bad in [
            Residuals { force: 1.1e-5, ..good },
            Residuals { moment: 1.1e-5, ..good },
            Residuals { stress: 1.1e-5, ..good },
            Residuals { kinetic: 6e-8, ..good },
            Residuals { sliding: 1, ..good },
        ] {
            assert_ne!(Equilibrium::new(Tolerances::default()).check(&bad), Verdict::Reached, "{bad:?}");
        }
    }

    #[test]
    fn damping_starts_when_calm_and_stops_when_something_slides_or_falls() {
        let mut search = Equilibrium::new(Tolerances::default());
        assert_eq!(search.check(&Residuals { kinetic: 2e-6, ..CALM }), Verdict::Continue(Stage::Natural));
        assert_eq!(search.check(&Residuals { stress: 3e-3, ..CALM }), Verdict::Continue(Stage::Natural));
        assert_eq!(search.check(&Residuals { sliding: 2, ..CALM }), Verdict::Continue(Stage::Natural));
        assert_eq!(search.check(&CALM), Verdict::Continue(Stage::Final));
        assert_eq!(search.check(&Residuals { kinetic: 2e-6, ..CALM }), Verdict::Continue(Stage::Final));
        assert_eq!(search.check(&Residuals { sliding: 1, ..CALM }), Verdict::Continue(Stage::Natural));
        assert_eq!(search.check(&CALM), Verdict::Continue(Stage::Final));
        assert_eq!(search.check(&Residuals { kinetic: 3e-5, ..CALM }), Verdict::Continue(Stage::Natural));
    }

    #[test]
    fn a_nan_never_passes() {
        let broken = Residuals { force: f64::NAN, moment: 0.0, stress: 0.0, kinetic: 0.0, sliding: 0 };
        assert_ne!(Equilibrium::new(Tolerances::default()).check(&broken), Verdict::Reached);
    }
}
