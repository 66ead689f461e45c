//! Keys to the groups of `plastic_discs`.

use super::keys::KEYS;
use super::quantities::QUANTITIES;
use super::{HardeningMeaning, Material, Pace, Plastic, ReducedPlastic, Setup, StartVelocity};
use crate::description::Description;
use crate::table::Key;
use crate::{Model, Problem, Quantity, round12};

impl Description for Plastic {
    type Reduced = ReducedPlastic;
    const MODEL: Model = Model::PlasticDiscs;
    const KEYS: &'static [Key] = KEYS;
    const QUANTITIES: &'static [Quantity<Self>] = QUANTITIES;

    fn conflicts(&self) -> Vec<Problem> {
        super::keys::conflicts(self)
    }

    fn reduce(&self) -> ReducedPlastic {
        let assembly = self.setup == Setup::Assembly;
        let plastic = self.material == Material::Plastic;
        let in_assembly = |value: f64, single: f64| if assembly { round12(value) } else { single };
        ReducedPlastic {
            setup: self.setup,
            nu: round12(self.nu),
            sigma_y: plastic.then(|| round12(self.sigma_y / self.young)),
            h: if plastic { round12(self.plastic_modulus() / self.young) } else { 0.0 },
            n: if assembly { self.n } else { 1 },
            size_ratio: in_assembly(self.size_ratio, 1.0),
            phi_i: in_assembly(self.phi_i, 0.0),
            seed: if assembly { self.seed } else { 0 },
            mu: round12(self.mu),
            wall_speed: round12(self.speed() / self.speed_unit()),
            pace: self.wall_speed_start.map(|speed| Pace {
                speed: round12(speed / self.speed_unit()),
                ratio: round12(self.inertia_ratio),
            }),
            start_velocity: if assembly { self.start_velocity } else { StartVelocity::Rest },
            phi_end: self.last_solid_fraction().map(round12),
            strain_end: round12(self.last_strain()),
            method: self.method,
            variant: self.variant,
            contact: self.contact,
            dt: self.dt.map(|dt| round12(dt * self.speed_unit() / self.diameter())),
            theta: round12(self.theta),
            cells: self.cells_across(),
            points_across: self.points_across,
            rotation: self.rotation,
            f_bar: self.f_bar,
            strain_step: round12(self.strain_step),
        }
    }
}

impl Plastic {
    /// √(E/ρ), the unit of speed [m/s].
    #[must_use]
    pub fn speed_unit(&self) -> f64 {
        libm::sqrt(self.young / self.rho)
    }

    /// Largest diameter with the default resolved [m].
    #[must_use]
    pub fn diameter(&self) -> f64 {
        self.d.unwrap_or(if self.setup == Setup::Assembly { 4e-6 } else { 60e-6 })
    }

    /// Closing speed with the default resolved [m/s].
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.wall_speed.unwrap_or(if self.setup == Setup::Assembly { 2.0 } else { 0.5 })
    }

    /// Solid fraction at the end, if the run ends by it [1].
    #[must_use]
    pub fn last_solid_fraction(&self) -> Option<f64> {
        self.phi_end.or((self.setup != Setup::Diametrical).then_some(0.97))
    }

    /// Strain at which the run ends at the latest [1].
    #[must_use]
    pub fn last_strain(&self) -> f64 {
        self.strain_end.unwrap_or(if self.setup == Setup::Diametrical { 0.17 } else { 0.45 })
    }

    /// Cells across a diameter with the default resolved.
    #[must_use]
    pub fn cells_across(&self) -> u64 {
        self.cells.unwrap_or(if self.setup == Setup::Assembly { 12 } else { 24 })
    }

    /// Plastic modulus dσ_y/dε_p [Pa].
    #[must_use]
    pub fn plastic_modulus(&self) -> f64 {
        match self.h_meaning {
            HardeningMeaning::PlasticModulus => self.h,
            HardeningMeaning::TangentModulus => self.young * self.h / (self.young - self.h),
        }
    }
}
