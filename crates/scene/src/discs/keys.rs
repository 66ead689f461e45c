//! The keys of `cohesive_discs`.

use serde_json::Value;

use super::{Assembly, Discs};
use crate::Problem;
use crate::table::{Absent, Bound, Domain, Key, Word};

const TABLE_1: &str = "2008, Table I";
const OURS: &str = "choice, see docs/notation.md";

const ASSEMBLIES: &[Word] = &[
    Word { name: "type1", meaning: "velocities set to zero, pressure from the start" },
    Word {
        name: "type2",
        meaning: "agitated discs aggregate in a fixed cell until one cluster holds all, equilibrium at P = 0, then \
                  pressure",
    },
    Word {
        name: "cohesionless",
        meaning: "F0 = 0, a gas of agitated discs compressed from the start; pressures are P/K_N",
    },
];

const LEG: &[Key] = &[
    Key {
        name: "to",
        unit: "1",
        domain: Domain::Real(Bound::Including(1e-9), Bound::Including(1e6)),
        absent: Absent::Required,
        meaning: "last pressure of the leg, P* (P/K_N without cohesion)",
        source: "2008, section II D 2",
    },
    Key {
        name: "per_decade",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.01), Bound::Including(1000.0)),
        absent: Absent::Default("8"),
        meaning: "steps per decade of pressure, in equal ratios",
        source: "2008, section II D 2",
    },
];

/// The key table.
pub(super) const KEYS: &[Key] = &[
    Key {
        name: "n",
        unit: "1",
        domain: Domain::Integer(4, 1_000_000),
        absent: Absent::Default("1400"),
        meaning: "number of discs",
        source: "2008, Table II: 1400, 5600, 10976",
    },
    Key {
        name: "seed",
        unit: "-",
        domain: Domain::SEED,
        absent: Absent::Default("1"),
        meaning: "seed of radii, positions and velocities",
        source: OURS,
    },
    Key {
        name: "assembly",
        unit: "-",
        domain: Domain::Word(ASSEMBLIES),
        absent: Absent::Default("\"type2\""),
        meaning: "how the first equilibrium state is made from a hard-disc fluid",
        source: "2008, section II C",
    },
    Key {
        name: "mu",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(100.0)),
        absent: Absent::Default("0.5"),
        meaning: "friction coefficient μ; bounds the tangential force by the elastic normal force alone",
        source: TABLE_1,
    },
    Key {
        name: "mu_r",
        unit: "a",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(100.0)),
        absent: Absent::Default("0.005"),
        meaning: "rolling friction μ_R/a; 0: no rolling resistance",
        source: TABLE_1,
    },
    Key {
        name: "kr",
        unit: "1",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(100.0))),
        absent: Absent::Default("\"auto\""),
        meaning: "rolling stiffness K_R/(K_N a²), a moment per radian; \"auto\": (μ_R/(μ a))²",
        source: TABLE_1,
    },
    Key {
        name: "kappa",
        unit: "1",
        domain: Domain::Real(Bound::Including(10.0), Bound::Including(1e9)),
        absent: Absent::Default("1e5"),
        meaning: "stiffness number κ = a K_N/F0; no effect without cohesion",
        source: TABLE_1,
    },
    Key {
        name: "kt_over_kn",
        unit: "1",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(10.0)),
        absent: Absent::Default("1"),
        meaning: "tangential over normal stiffness K_T/K_N",
        source: TABLE_1,
    },
    Key {
        name: "d0",
        unit: "a",
        domain: Domain::Real(Bound::Including(1e-6), Bound::Including(0.1)),
        absent: Absent::Default("1e-3"),
        meaning: "range of the attraction D0/a; no effect without cohesion",
        source: TABLE_1,
    },
    Key {
        name: "en",
        unit: "1",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
        absent: Absent::Default("0.015"),
        meaning: "normal restitution e_N of a binary collision without adhesion",
        source: TABLE_1,
    },
    Key {
        name: "size_ratio",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.1), Bound::Including(1.0)),
        absent: Absent::Default("0.5"),
        meaning: "smallest over largest diameter; diameters are uniform between",
        source: "2008, section II A",
    },
    Key {
        name: "phi_i",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.01), Bound::Including(0.5)),
        absent: Absent::Default("0.36"),
        meaning: "solid fraction Φ_I of the hard-disc fluid",
        source: "2008, section II C",
    },
    Key {
        name: "fluid_sweeps",
        unit: "1",
        domain: Domain::Integer(0, 1_000_000),
        absent: Absent::Default("300"),
        meaning: "Metropolis sweeps that turn random sequential insertion, largest disc first, into the hard-disc fluid; 0: the insertion as it is, with a sixth fewer close pairs",
        source: OURS,
    },
    Key {
        name: "v0",
        unit: "1",
        domain: Domain::Auto(&Domain::Real(Bound::Including(0.0), Bound::Including(1e4))),
        absent: Absent::Default("\"auto\""),
        meaning: "agitation, V0 the root mean square speed: V0/V* of type 2 with V* = √(F0 D0/m), V0/√(a P/m) without cohesion; \"auto\": 9.5, and the gas whose pressure is P; no effect in type 1",
        source: "2008, (3), sections II C and III A",
    },
    Key {
        name: "p0",
        unit: "1",
        domain: Domain::Auto(&Domain::Real(Bound::Including(1e-9), Bound::Including(1e6))),
        absent: Absent::Default("\"auto\""),
        meaning: "first pressure P* = a P/F0, without cohesion P/K_N; \"auto\": 0.01, without cohesion 1e-5",
        source: "2008, Table II",
    },
    Key {
        name: "path",
        unit: "-",
        domain: Domain::Auto(&Domain::List { of: &Domain::Record(LEG), min: 0, max: 1000 }),
        absent: Absent::Default("\"auto\""),
        meaning: "legs of the loading path after the first state; \"auto\": to 13.33 (1.333e-3 without cohesion) with 8 steps per decade and back with 2",
        source: "2008, section II D 2",
    },
    Key {
        name: "ia",
        unit: "1",
        domain: Domain::Real(Bound::Including(1e-6), Bound::Including(1e6)),
        absent: Absent::Default("0.05"),
        meaning: "inertia parameter I_a: the strain rate is capped at I_a/T0, without cohesion at I_a √(P/m)",
        source: "2008, (5)",
    },
    Key {
        name: "cell_mass",
        unit: "m",
        domain: Domain::Real(Bound::Including(1.0), Bound::Including(1e9)),
        absent: Absent::Default("10"),
        meaning: "mass M of the cell coordinate along the path: dε̇/dt = A (σ − P)/(M L²)",
        source: OURS,
    },
    Key {
        name: "assembly_cell_mass",
        unit: "m",
        domain: Domain::Auto(&Domain::Real(Bound::Including(1.0), Bound::Including(1e9))),
        absent: Absent::Default("\"auto\""),
        meaning: "M while the first pressure is applied; \"auto\": `cell_mass` for type 2, else the mass of all discs",
        source: OURS,
    },
    Key {
        name: "tolerance",
        unit: "1",
        domain: Domain::Real(Bound::Including(1e-3), Bound::Including(1e3)),
        absent: Absent::Default("1"),
        meaning: "factor on the four equilibrium tolerances 1e-5, 1e-5, 1e-5, 5e-8",
        source: "2008, section II D 1",
    },
    Key {
        name: "final_damping",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(0.9)),
        absent: Absent::Default("0.7"),
        meaning: "coefficient of the local damping of the final stage, only while nearly at rest and nothing slides; 0: none",
        source: OURS,
    },
    Key {
        name: "final_drag",
        unit: "1/T0",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(10.0)),
        absent: Absent::Default("0"),
        meaning: "rate of a drag on all motion of discs, once the final stage of a state has lasted 100 T0: for arms that swing without a stiffness; 0: none",
        source: OURS,
    },
    Key {
        name: "dt",
        unit: "tau",
        domain: Domain::Auto(&Domain::Real(Bound::Including(1e-4), Bound::Including(0.14))),
        absent: Absent::Default("\"auto\""),
        meaning: "time step in √(m/K_N); \"auto\": the least of 0.1, 0.2 (d_min/a)/√(K_T/K_N) where K_T > K_N, 0.2 d_min/a and 0.16 (d_min/a)²/√(K_R/(K_N a²)); more than 1.4 times that is refused, the scheme would fail silently",
        source: OURS,
    },
    Key {
        name: "max_time",
        unit: "T0",
        domain: Domain::Real(Bound::Including(1.0), Bound::Including(1e6)),
        absent: Absent::Default("2000"),
        meaning: "time after which a state without equilibrium ends the run (it is recorded as not converged)",
        source: OURS,
    },
    crate::precision::KEY,
];

/// Combinations that no run can make sense of.
pub(super) fn conflicts(scene: &Discs) -> Vec<Problem> {
    /// Largest a P/K_N: overlaps beyond 5 % of a diameter.
    const LARGEST_PRESSURE: f64 = 0.05;
    /// Smallest agitation of type 2 [V*].
    const SLOWEST: f64 = 1e-3;

    let mut problems = Vec::new();
    if let (Assembly::Type2, Some(speed)) = (scene.assembly, scene.v0)
        && speed < SLOWEST
    {
        problems.push(Problem::new(
            "v0".to_owned(),
            &Value::from(speed),
            format!("discs of type 2 slower than {SLOWEST} V* never meet"),
            "raise v0",
        ));
    }
    let largest_step = 1.4 * scene.automatic_step();
    if let Some(step) = scene.dt
        && step > largest_step * (1.0 + 1e-12)
    {
        problems.push(Problem::new(
            "dt".to_owned(),
            &Value::from(step),
            format!(
                "exceeds {largest_step:.4} √(m/K_N): the stiffest springs of the smallest discs are unstable"
            ),
            "leave dt out or lower it",
        ));
    }
    let in_stiffness = if scene.assembly == Assembly::Cohesionless { 1.0 } else { 1.0 / scene.kappa };
    let mut refuse = |field: String, pressure: f64| {
        let reduced = pressure * in_stiffness;
        if reduced > LARGEST_PRESSURE {
            problems.push(Problem::new(
                field,
                &Value::from(pressure),
                format!(
                    "a P/K_N = {reduced:e} exceeds {LARGEST_PRESSURE}: discs would overlap by half a radius"
                ),
                "lower the pressure or raise kappa",
            ));
        }
    };
    refuse("p0".to_owned(), scene.first_pressure());
    for (index, leg) in scene.path.iter().flatten().enumerate() {
        refuse(format!("path[{index}].to"), leg.to);
    }
    problems
}
