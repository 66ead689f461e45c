//! The keys of `cohesive_spheres`.

use serde_json::Value;

use super::Spheres;
use crate::Problem;
use crate::table::{Absent, Bound, Domain, Key, Variant, Word};

const PAPER: &str = "2024, section 2";
const OURS: &str = "choice, see docs/notation.md";

const E_DRIFT: Key = Key {
    name: "e_drift",
    unit: "1",
    domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
    absent: Absent::Default("0.001"),
    meaning: "largest change of e while the number of steps grows by a quarter",
    source: OURS,
};

const WALL_IMBALANCE: Key = Key {
    name: "wall_imbalance",
    unit: "1",
    domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
    absent: Absent::Default("0.01"),
    meaning: "largest relative deviation of a wall force from p S, in the mean over the last fifth of the time",
    source: OURS,
};

const KE_OVER_EEL: Key = Key {
    name: "ke_over_eel",
    unit: "1",
    domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
    absent: Absent::Default("2e-7"),
    meaning: "largest kinetic over elastic energy",
    source: "2024, section 2: 2e-7",
};

const KE_CONTACTS: Key = Key {
    name: "ke_contacts",
    unit: "1",
    domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
    absent: Absent::Default("2e-6"),
    meaning: "largest kinetic energy of the motion along normals between particles with four or more contacts, over the \
              elastic energy",
    source: OURS,
};

const Z_REST: Key = Key {
    name: "z_rest",
    unit: "1",
    domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(10.0)),
    absent: Absent::Default("0.05"),
    meaning: "largest change that Z+ or Z- still has before it, extrapolated in 1/t",
    source: OURS,
};

const STOPS: &[Variant] = &[
    Variant {
        name: "settled",
        meaning: "e stands still and the walls carry p; Z, Z+ and Z- may still rise",
        keys: &[E_DRIFT, WALL_IMBALANCE],
    },
    Variant {
        name: "evidence",
        meaning: "validated equilibrium: settled, hardly any motion that deforms the network, Z+ and Z- near the limits \
                  that their trend has",
        keys: &[E_DRIFT, WALL_IMBALANCE, KE_CONTACTS, Z_REST],
    },
    Variant {
        name: "kinetic_energy",
        meaning: "the paper's criterion: kinetic over elastic energy of all particles; rattlers can keep it from ever \
                  being met",
        keys: &[KE_OVER_EEL],
    },
    Variant { name: "steps", meaning: "run to `max_steps`", keys: &[] },
];

/// The key table.
pub(super) const KEYS: &[Key] = &[
    Key {
        name: "n",
        unit: "1",
        domain: Domain::Integer(1, 10_000_000),
        absent: Absent::Default("1000"),
        meaning: "number of spheres",
        source: "2024: 17657",
    },
    Key {
        name: "seed",
        unit: "-",
        domain: Domain::SEED,
        absent: Absent::Default("1"),
        meaning: "seed of initial positions and velocities",
        source: OURS,
    },
    Key {
        name: "p",
        unit: "Pa",
        domain: Domain::POSITIVE,
        absent: Absent::Required,
        meaning: "confining pressure p",
        source: PAPER,
    },
    Key {
        name: "sigma_c",
        unit: "Pa",
        domain: Domain::NOT_NEGATIVE,
        absent: Absent::Required,
        meaning: "cohesive stress σc = f_c/d²",
        source: PAPER,
    },
    Key {
        name: "sigma_e",
        unit: "Pa",
        domain: Domain::POSITIVE,
        absent: Absent::Required,
        meaning: "elastic stress σe = k_n/d",
        source: PAPER,
    },
    Key {
        name: "alpha_n",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(1.0)),
        absent: Absent::Default("0.25"),
        meaning: "damping ratio α_n of the normal dashpot, α_n = −ln e_n/√(ln² e_n + π²)",
        source: "2024, (8), (9)",
    },
    Key {
        name: "mu",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(100.0)),
        absent: Absent::Default("0.4"),
        meaning: "friction coefficient μ between spheres",
        source: "2024, (7)",
    },
    Key {
        name: "kt_over_kn",
        unit: "1",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(10.0)),
        absent: Absent::Default("1.5"),
        meaning: "tangential over normal stiffness k_t/k_n",
        source: "2024, (7)",
    },
    Key {
        name: "mw",
        unit: "1",
        domain: Domain::Real(Bound::Including(1e-3), Bound::Including(1e12)),
        absent: Absent::Default("96"),
        meaning: "mass of a wall over mass of a sphere m_w/m, at the paper's size (N = 17657) when `scale_wall_mass`",
        source: PAPER,
    },
    Key {
        name: "scale_wall_mass",
        unit: "-",
        domain: Domain::Bool,
        absent: Absent::Default("true"),
        meaning: "whether m_w is scaled by (N/17657)^(2/3), so that wall mass per area is the same at any N",
        source: OURS,
    },
    Key {
        name: "ei",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.7), Bound::Including(1e4)),
        absent: Absent::Default("1.704"),
        meaning: "initial void ratio e_i",
        source: "2024: 25 d × 25 d × 40 d for 17657 spheres",
    },
    Key {
        name: "mu_wall",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(100.0)),
        absent: Absent::SameAs("mu"),
        meaning: "friction coefficient between sphere and wall",
        source: OURS,
    },
    Key {
        name: "wall_adhesion",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(10.0)),
        absent: Absent::Default("0"),
        meaning: "adhesion between sphere and wall as a fraction of f_c",
        source: OURS,
    },
    Key {
        name: "moving_walls",
        unit: "1",
        domain: Domain::OneOf(&[3, 6]),
        absent: Absent::Default("6"),
        meaning: "moving walls: all six, or three with the opposite ones fixed",
        source: OURS,
    },
    Key {
        name: "agitation",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(1e4)),
        absent: Absent::Default("1"),
        meaning: "initial speed v_k in units of 0.158 √(p0 d³/m), p0 = 0.01 MPa",
        source: PAPER,
    },
    Key {
        name: "damping_mass",
        unit: "-",
        domain: Domain::Word(&[
            Word { name: "effective", meaning: "m/2 for a pair, m for a wall" },
            Word { name: "particle", meaning: "m for both" },
        ]),
        absent: Absent::Default("\"effective\""),
        meaning: "mass in the normal dashpot −2 α_n √(k_n m) dδ_n/dt",
        source: "2024, (8)",
    },
    Key {
        name: "clamp_viscous",
        unit: "-",
        domain: Domain::Bool,
        absent: Absent::Default("false"),
        meaning: "whether the viscous force is clamped so that it never pulls more than the elastic force pushes",
        source: OURS,
    },
    Key {
        name: "dt",
        unit: "tau",
        domain: Domain::Auto(&Domain::Real(Bound::Including(1e-9), Bound::Including(10.0))),
        absent: Absent::Default("\"auto\""),
        meaning: "time step in τ = √(m/k_n); \"auto\": from the stiffest mode of the contact network",
        source: OURS,
    },
    Key {
        name: "max_steps",
        unit: "1",
        domain: Domain::Auto(&Domain::Integer(1, 1_000_000_000_000)),
        absent: Absent::Default("\"auto\""),
        meaning: "step limit; \"auto\": from the estimated number of steps",
        source: OURS,
    },
    Key {
        name: "stop",
        unit: "-",
        domain: Domain::Tagged { tag: "rule", variants: STOPS },
        absent: Absent::Default("\"evidence\""),
        meaning: "when a run ends",
        source: PAPER,
    },
    Key {
        name: "approach",
        unit: "-",
        domain: Domain::Word(&[
            Word { name: "natural", meaning: "undisturbed dynamics" },
            Word {
                name: "rolling_kicks",
                meaning: "rolling kicks on particles with one or two contacts, then drag; recorded in the result",
            },
        ]),
        absent: Absent::Default("\"natural\""),
        meaning: "how equilibrium is sought after e has settled",
        source: OURS,
    },
    crate::precision::KEY,
];

/// Combinations that no run can make sense of.
pub(super) fn conflicts(scene: &Spheres) -> Vec<Problem> {
    /// Interval of p/σe: below it a run takes more than 1e8 steps, above it spheres overlap by half a diameter.
    const PRESSURE: (f64, f64) = (1e-10, 0.5);
    /// Largest σc/σe: at 1 a pair rests with its centres in one place.
    const ADHESION: f64 = 1.0;

    let mut problems = Vec::new();
    let pressure = scene.p / scene.sigma_e;
    if !(PRESSURE.0..=PRESSURE.1).contains(&pressure) {
        problems.push(Problem::new(
            "p",
            &Value::from(scene.p),
            format!("p/sigma_e = {pressure:e} is outside of [{:e}, {}]", PRESSURE.0, PRESSURE.1),
            "change p or sigma_e",
        ));
    }
    let adhesion = scene.sigma_c / scene.sigma_e;
    if adhesion >= ADHESION || adhesion.is_nan() {
        problems.push(Problem::new(
            "sigma_c",
            &Value::from(scene.sigma_c),
            format!("sigma_c/sigma_e = {adhesion:e} is not below {ADHESION}: the centres of a pair at rest coincide"),
            "lower sigma_c or raise sigma_e",
        ));
    }
    problems
}
