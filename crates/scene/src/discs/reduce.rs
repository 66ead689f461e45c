//! Keys to the groups of `cohesive_discs`.

use super::keys::KEYS;
use super::quantities::QUANTITIES;
use super::{Assembly, Discs, PathLeg, ReducedDiscs};
use crate::description::Description;
use crate::table::Key;
use crate::{Model, Problem, Quantity, round12};

/// Time step without other word: stable and accurate; above 0.15 runs fail silently [√(m/K_N)].
const STEP: f64 = 0.1;

/// V0/V* of type 2 without other word (section II C).
const AGITATION: f64 = 9.5;

impl Description for Discs {
    type Reduced = ReducedDiscs;
    const MODEL: Model = Model::CohesiveDiscs;
    const KEYS: &'static [Key] = KEYS;
    const QUANTITIES: &'static [Quantity<Self>] = QUANTITIES;

    fn conflicts(&self) -> Vec<Problem> {
        super::keys::conflicts(self)
    }

    fn reduce(&self) -> ReducedDiscs {
        let cohesive = self.assembly != Assembly::Cohesionless;
        let friction = self.mu > 0.0;
        let rolling = friction && self.mu_r > 0.0;
        let with = |wanted: bool, value: f64| if wanted { round12(value) } else { 0.0 };
        let legs = self.path.clone().unwrap_or_else(|| paper_path(cohesive, self.first_pressure()));
        ReducedDiscs {
            n: self.n,
            seed: self.seed,
            assembly: self.assembly,
            mu: round12(self.mu),
            mu_r: with(rolling, self.mu_r),
            kr: with(rolling, self.rolling_stiffness()),
            f0: with(cohesive, 1.0 / self.kappa),
            kt: with(friction, self.kt_over_kn),
            d0: with(cohesive, self.d0),
            en: round12(self.en),
            size_ratio: round12(self.size_ratio),
            phi_i: round12(self.phi_i),
            fluid_sweeps: self.fluid_sweeps,
            v0: match self.assembly {
                Assembly::Type1 => 0.0,
                Assembly::Type2 => round12(self.v0.unwrap_or(AGITATION)),
                Assembly::Cohesionless => round12(self.v0.unwrap_or_else(|| self.gas_speed())),
            },
            p0: round12(self.first_pressure()),
            path: legs
                .iter()
                .map(|leg| PathLeg { to: round12(leg.to), per_decade: round12(leg.per_decade) })
                .collect(),
            ia: round12(self.ia),
            cell_mass: round12(self.cell_mass),
            assembly_cell_mass: match (self.assembly_cell_mass, self.assembly) {
                (Some(mass), _) => Some(round12(mass)),
                (None, Assembly::Type2) => Some(round12(self.cell_mass)),
                (None, Assembly::Type1 | Assembly::Cohesionless) => None,
            },
            tolerance: round12(self.tolerance),
            final_damping: round12(self.final_damping),
            final_drag: if self.final_damping > 0.0 { round12(self.final_drag) } else { 0.0 },
            dt: round12(self.dt.unwrap_or_else(|| self.automatic_step())),
            max_time: round12(self.max_time),
            precision: self.precision,
        }
    }

    fn out_of_model(&self) -> Option<String> {
        (self.assembly != Assembly::Cohesionless && self.kappa < 1e3).then(|| {
            format!("kappa = {} is below 1000: contacts are not small against the discs", self.kappa)
        })
    }
}

impl Discs {
    /// First pressure with the default resolved, P* (P/K_N without cohesion) [1].
    #[must_use]
    pub fn first_pressure(&self) -> f64 {
        self.p0.unwrap_or(if self.assembly == Assembly::Cohesionless { 1e-5 } else { 0.01 })
    }

    /// K_R/(K_N a²) with the default resolved: l²/a² with l = μ_R/μ [1].
    #[must_use]
    pub fn rolling_stiffness(&self) -> f64 {
        let length = if self.mu > 0.0 { self.mu_r / self.mu } else { 0.0 };
        self.kr.unwrap_or(length * length)
    }

    /// Root mean square speed at which a gas of hard discs has the pressure P, every disc with the same mean energy E
    /// [√(a P/m)]: P = n E Z with n = 4Φ/(π⟨d²⟩) and scaled-particle theory's Z = 1/(1−Φ) + Φ⟨d⟩²/(⟨d²⟩(1−Φ)²)
    /// (Helfand, Frisch and Lebowitz 1961), V0² = 2E⟨1/m⟩, and for diameters uniform in [q a, a] ⟨1/d²⟩ = 1/(q a²).
    fn gas_speed(&self) -> f64 {
        let (q, phi) = (self.size_ratio, self.phi_i);
        let (mean, square) = (0.5 * (1.0 + q), (1.0 + q + q * q) / 3.0);
        let density = 4.0 * phi / (core::f64::consts::PI * square);
        let compressibility = 1.0 / (1.0 - phi) + phi * mean * mean / (square * (1.0 - phi) * (1.0 - phi));
        libm::sqrt(2.0 / (q * density * compressibility))
    }

    /// 0.1 √(m/K_N), or less where the smallest disc, of mass (d/a)² m and moment of inertia (d/a)⁴ m a²/8, is faster
    /// than that. It moves with a frequency that grows as √(max(K_N, K_T)/mass): 0.2 d/a over its root, so that Table I
    /// keeps 0.1. It rolls on its contacts with ω² ≤ 2 z K_R/I: with z = 4 two over ω is (d/a)²/(4 √K_R); of that 0.64
    /// is taken [τ].
    pub(super) fn automatic_step(&self) -> f64 {
        let friction = self.mu > 0.0;
        let rolling = if friction && self.mu_r > 0.0 { self.rolling_stiffness() } else { 0.0 };
        let stiffest = if friction { self.kt_over_kn.max(1.0) } else { 1.0 };
        let (smallest, mass) = (self.size_ratio, self.size_ratio * self.size_ratio);
        STEP.min(0.2 * smallest / libm::sqrt(stiffest)).min(0.16 * mass / libm::sqrt(rolling))
    }
}

/// Up in steps of 10^(1/8) and back in larger ones (section II D 2).
fn paper_path(cohesive: bool, first: f64) -> Vec<PathLeg> {
    let highest = if cohesive { 13.335_214_321_6 } else { 1.333_521_432_16e-3 };
    vec![PathLeg { to: highest, per_decade: 8.0 }, PathLeg { to: first, per_decade: 2.0 }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Reduced, Scene};
    use serde_json::{Value, json};

    fn reduced(keys: &Value) -> ReducedDiscs {
        let mut scene = json!({"model": "cohesive_discs"});
        scene.as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
        let Reduced::CohesiveDiscs(reduced) = Scene::from_json(&scene).unwrap().reduce() else {
            panic!("discs");
        };
        reduced
    }

    #[test]
    fn defaults_are_those_of_table_1() {
        let discs = reduced(&json!({}));
        assert_eq!((discs.f0, discs.d0, discs.mu, discs.mu_r), (1e-5, 1e-3, 0.5, 0.005));
        assert_eq!(discs.kr, 1e-4);
        assert_eq!((discs.p0, discs.path.len(), discs.path[0].per_decade), (0.01, 2, 8.0));
        assert_eq!(discs.assembly_cell_mass, Some(10.0));
    }

    #[test]
    fn keys_without_effect_do_not_make_another_run() {
        // Without cohesion κ and D0 mean nothing, without rolling resistance K_R, without friction K_T.
        let one = reduced(&json!({"assembly": "cohesionless", "kappa": 1e4, "d0": 1e-2}));
        assert_eq!(one, reduced(&json!({"assembly": "cohesionless"})));
        // Type 1 starts at rest.
        assert_eq!(reduced(&json!({"assembly": "type1", "v0": 3})), reduced(&json!({"assembly": "type1"})));
        assert_eq!(reduced(&json!({"mu_r": 0, "kr": 3})), reduced(&json!({"mu_r": 0})));
        assert_eq!(reduced(&json!({"mu": 0, "kt_over_kn": 0.5})), reduced(&json!({"mu": 0})));
    }

    #[test]
    fn the_gas_has_the_pressure_that_compresses_it() {
        let gas = |phi_i: f64, size_ratio: f64| {
            reduced(&json!({"assembly": "cohesionless", "phi_i": phi_i, "size_ratio": size_ratio})).v0
        };
        // A thin gas of equal discs is ideal: P = n m V0²/2 with n = 4Φ/(π a²).
        let thin = gas(0.01, 1.0);
        let ideal = 2.0 / (0.04 / core::f64::consts::PI);
        assert!((thin * thin / ideal - 1.0 / (1.0 / 0.99 + 0.01 / 0.9801)).abs() < 1e-11);
        assert!((gas(0.36, 0.5) - 1.453).abs() < 1e-3, "{}", gas(0.36, 0.5));
        assert_eq!(reduced(&json!({"assembly": "cohesionless", "v0": 0})).v0, 0.0);
        assert_eq!(reduced(&json!({"assembly": "cohesionless"})).assembly_cell_mass, None);
    }

    #[test]
    fn the_default_number_of_sweeps_is_not_part_of_the_key() {
        let written = |keys: &Value| serde_json::to_value(reduced(keys)).unwrap();
        assert!(written(&json!({})).get("fluid_sweeps").is_none());
        assert_eq!(written(&json!({"fluid_sweeps": 300})), written(&json!({})));
        let inserted = written(&json!({"fluid_sweeps": 0}));
        assert_eq!(inserted["fluid_sweeps"], 0);
        assert_eq!(serde_json::from_value::<ReducedDiscs>(inserted).unwrap().fluid_sweeps, 0);
    }

    #[test]
    fn large_rolling_resistance_is_stiff() {
        let stiff = reduced(&json!({"mu_r": 0.5}));
        assert_eq!((stiff.kr, stiff.dt), (1.0, 0.04));
        assert_eq!(reduced(&json!({"mu_r": 0.05})).dt, 0.1);
        assert_eq!(reduced(&json!({"mu_r": 0, "kr": 3})).dt, 0.1);
    }

    #[test]
    fn small_discs_and_stiff_tangential_springs_need_small_steps() {
        assert_eq!(reduced(&json!({"size_ratio": 0.25})).dt, 0.05);
        assert_eq!(reduced(&json!({"kt_over_kn": 4})).dt, 0.05);
        assert_eq!(reduced(&json!({"kt_over_kn": 4, "mu": 0})).dt, 0.1);
        assert_eq!(reduced(&json!({"size_ratio": 1})).dt, 0.1);
        // Up to 1.4 times the automatic step a given one is taken.
        assert_eq!(reduced(&json!({"mu_r": 0.5, "dt": 0.056})).dt, 0.056);
        assert_eq!(reduced(&json!({"dt": 0.14})).dt, 0.14);
    }

    #[test]
    fn bad_keys_are_named() {
        for (keys, field) in [
            (json!({"phi_i": 0.7}), "phi_i"),
            (json!({"path": [{"to": 1.0, "per_decade": 1e6}]}), "path[0].per_decade"),
            (json!({"p0": 0.0}), "p0"),
            (json!({"dt": 0.3}), "dt"),
            (json!({"mu_r": 0.5, "dt": 0.1}), "dt"),
            (json!({"size_ratio": 0.2, "dt": 0.1}), "dt"),
            (json!({"kt_over_kn": 4, "dt": 0.1}), "dt"),
            (json!({"assembly": "type3"}), "assembly"),
            (json!({"v0": 0}), "v0"),
            (json!({"en": 0}), "en"),
            (json!({"path": [{"to": 1.0, "steps": 3}]}), "path[0].steps"),
        ] {
            let mut scene = json!({"model": "cohesive_discs"});
            scene.as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
            let problems = Scene::from_json(&scene).unwrap_err();
            assert!(problems.0.iter().any(|problem| problem.field == field), "{field}: {problems}");
        }
    }
}
