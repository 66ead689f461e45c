//! The keys of `plastic_discs`.

use serde_json::Value;

use super::{Contact, DEFAULT_POINTS, HardeningMeaning, Material, Method, Plastic, Setup, Variant};
use crate::Problem;
use crate::table::{Absent, Bound, Domain, Key, Word};

const SETUPS: &[Word] = &[
    Word { name: "assembly", meaning: "polydisperse discs in a box whose top wall comes down" },
    Word {
        name: "diametrical",
        meaning: "one disc between a fixed bottom wall and a top wall that comes down",
    },
    Word {
        name: "cell",
        meaning: "one disc in a box as wide as itself, closed from top and bottom: the cell of a square lattice",
    },
];

const MATERIALS: &[Word] = &[
    Word { name: "elastic", meaning: "elastic without limit" },
    Word { name: "plastic", meaning: "elastic up to σ_y, then linear isotropic hardening" },
];

const MEANINGS: &[Word] = &[
    Word { name: "plastic_modulus", meaning: "dσ_y/dε_p, as E_p = E H/(E + H) takes it" },
    Word {
        name: "tangent_modulus",
        meaning: "slope of the uniaxial line past yield; dσ_y/dε_p = E H/(E − H)",
    },
];

const METHODS: &[Word] = &[
    Word { name: "implicit", meaning: "contact solved inside each Newton iteration: the reference" },
    Word {
        name: "explicit",
        meaning: "same bodies, law and contact, explicit steps on lumped masses: fast at 2 m/s",
    },
];

const VARIANTS: &[Word] = &[
    Word {
        name: "total_bilinear",
        meaning: "body-fitted bilinear cells in the undeformed configuration: the most accurate for its cost",
    },
    Word { name: "total_cubic", meaning: "cubic splines on a regular grid in the undeformed configuration" },
    Word {
        name: "updated_cubic",
        meaning: "cubic splines on a grid that is new at every step, one per particle: the paper's method; `cells` is across the largest diameter",
    },
];

const CONTACTS: &[Word] = &[
    Word { name: "markers", meaning: "markers on the true outlines, by their gap" },
    Word {
        name: "common_mesh",
        meaning: "nodes of a common mesh, by their velocities, as in the paper: acts at a distance of cells",
    },
];

const STARTS: &[Word] = &[
    Word { name: "rest", meaning: "nothing moves; the wall sends a front ahead of itself" },
    Word {
        name: "uniform",
        meaning: "as if the box had always been closing, v_y = −v y/h: no front, less inertia by (h/d)²",
    },
];

const ROTATIONS: &[Word] = &[
    Word { name: "jaumann", meaning: "midpoint strain, stress rotated with the material: objective" },
    Word { name: "infinitesimal", meaning: "infinitesimal strain taken literally, no rotation" },
];

/// The key table.
pub(super) const KEYS: &[Key] = &[
    Key {
        name: "setup",
        unit: "-",
        domain: Domain::Word(SETUPS),
        absent: Absent::Default("\"assembly\""),
        meaning: "what is compressed",
        source: "2021, sections 3 and 4",
    },
    Key {
        name: "material",
        unit: "-",
        domain: Domain::Word(MATERIALS),
        absent: Absent::Default("\"plastic\""),
        meaning: "what the discs are made of",
        source: "2021, section 2",
    },
    Key {
        name: "young",
        unit: "Pa",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1e15)),
        absent: Absent::Default("1e7"),
        meaning: "Young's modulus E",
        source: "2021, section 3",
    },
    Key {
        name: "nu",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(0.495)),
        absent: Absent::Default("0.45"),
        meaning: "Poisson's ratio ν",
        source: "2021, section 3",
    },
    Key {
        name: "rho",
        unit: "kg/m^3",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1e6)),
        absent: Absent::Default("1000"),
        meaning: "density ρ",
        source: "2021, section 3",
    },
    Key {
        name: "sigma_y",
        unit: "Pa",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1e15)),
        absent: Absent::Default("4e5"),
        meaning: "yield stress σ_y; no effect if elastic",
        source: "2021, section 3",
    },
    Key {
        name: "h",
        unit: "Pa",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(1e15)),
        absent: Absent::Default("1e6"),
        meaning: "hardening constant H; no effect if elastic",
        source: "2021, section 3",
    },
    Key {
        name: "h_meaning",
        unit: "-",
        domain: Domain::Word(MEANINGS),
        absent: Absent::Default("\"plastic_modulus\""),
        meaning: "how H is meant",
        source: "2021, (14) and reference 12",
    },
    Key {
        name: "n",
        unit: "1",
        domain: Domain::Integer(2, 10_000),
        absent: Absent::Default("300"),
        meaning: "number of discs of an assembly",
        source: "2021, section 4",
    },
    Key {
        name: "d",
        unit: "m",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(1e3))),
        absent: Absent::Default("\"auto\""),
        meaning: "diameter of the disc, or of the largest one; \"auto\": 4e-6 in an assembly, else 60e-6",
        source: "2021, sections 3 and 4",
    },
    Key {
        name: "size_ratio",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.1), Bound::Including(1.0)),
        absent: Absent::Default("0.5"),
        meaning: "smallest over largest diameter of an assembly; diameters are uniform by area between",
        source: "2021, section 4",
    },
    Key {
        name: "phi_i",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.05), Bound::Including(0.8)),
        absent: Absent::Default("0.75"),
        meaning: "solid fraction of an assembly before compression, below jamming; the paper gives none",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "seed",
        unit: "-",
        domain: Domain::SEED,
        absent: Absent::Default("1"),
        meaning: "seed of the positions in an assembly",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "mu",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.0), Bound::Including(10.0)),
        absent: Absent::Default("0"),
        meaning: "Coulomb friction coefficient μ of all contacts",
        source: "2021, section 4",
    },
    Key {
        name: "wall_speed",
        unit: "m/s",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(1e4))),
        absent: Absent::Default("\"auto\""),
        meaning: "speed at which the box closes; \"auto\": 2 in an assembly, else 0.5",
        source: "2021, sections 3 and 4",
    },
    Key {
        name: "wall_speed_start",
        unit: "m/s",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(1e4))),
        absent: Absent::Default("\"auto\""),
        meaning: "speed at which the box begins to close; it rises to wall_speed as inertia_ratio allows; \"auto\": wall_speed throughout",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "inertia_ratio",
        unit: "1",
        domain: Domain::Real(Bound::Excluding(0.0), Bound::Including(1.0)),
        absent: Absent::Default("0.01"),
        meaning: "kinetic energy of uniform closing (m v²/6) over elastic energy that the speed may rise to; no effect without wall_speed_start",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "start_velocity",
        unit: "-",
        domain: Domain::Word(STARTS),
        absent: Absent::Default("\"rest\""),
        meaning: "how the discs of an assembly move before the first step",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "phi_end",
        unit: "1",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(1.2))),
        absent: Absent::Default("\"auto\""),
        meaning: "solid fraction at which the run ends; \"auto\": 0.97, none for diametrical compression",
        source: "2021, figure 4",
    },
    Key {
        name: "strain_end",
        unit: "1",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(0.9))),
        absent: Absent::Default("\"auto\""),
        meaning: "nominal strain 1 − h/h_i at which the run ends at the latest; \"auto\": 0.17 for diametrical compression, else 0.45",
        source: "2021, figure 1",
    },
    Key {
        name: "method",
        unit: "-",
        domain: Domain::Word(METHODS),
        absent: Absent::Default("\"implicit\""),
        meaning: "how the motion is integrated",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "variant",
        unit: "-",
        domain: Domain::Word(VARIANTS),
        absent: Absent::Default("\"total_bilinear\""),
        meaning: "how the motion is discretised; splines are implicit only",
        source: "2021, section 2",
    },
    Key {
        name: "contact",
        unit: "-",
        domain: Domain::Word(CONTACTS),
        absent: Absent::Default("\"markers\""),
        meaning: "between what contact acts; a common mesh needs grids: variant updated_cubic",
        source: "2021, section 2",
    },
    Key {
        name: "dt",
        unit: "s",
        domain: Domain::Auto(&Domain::Real(Bound::Excluding(0.0), Bound::Including(1e6))),
        absent: Absent::Default("\"auto\""),
        meaning: "time step; \"auto\": the wall moves by at most a quarter of the smallest cell and a thousandth of the height; the explicit method takes its stable step where that is shorter",
        source: "2021, section 3: 1e-7",
    },
    Key {
        name: "theta",
        unit: "1",
        domain: Domain::Real(Bound::Including(0.5), Bound::Including(1.0)),
        absent: Absent::Default("1"),
        meaning: "parameter θ of the implicit method; 1: backward Euler",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "cells",
        unit: "1",
        domain: Domain::Auto(&Domain::Integer(2, 64)),
        absent: Absent::Default("\"auto\""),
        meaning: "cells across a diameter, even; \"auto\": 12 in an assembly, else 24",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "points_across",
        unit: "1",
        domain: Domain::Integer(1, 4),
        absent: Absent::Default("2"),
        meaning: "material points across a cell of a variant with splines; 2 is four per cell",
        source: "2021, section 3: four per cell",
    },
    Key {
        name: "rotation",
        unit: "-",
        domain: Domain::Word(ROTATIONS),
        absent: Absent::Default("\"jaumann\""),
        meaning: "how strain and rotation are read from the motion",
        source: "2021, section 2",
    },
    Key {
        name: "f_bar",
        unit: "-",
        domain: Domain::Bool,
        absent: Absent::Default("true"),
        meaning: "whether the stress sees the mean volume change of a cell; without it cells lock under plastic flow",
        source: "choice, see docs/notation.md",
    },
    Key {
        name: "strain_step",
        unit: "1",
        domain: Domain::Real(Bound::Including(1e-5), Bound::Including(0.1)),
        absent: Absent::Default("0.002"),
        meaning: "nominal strain between two recorded states",
        source: "choice, see docs/notation.md",
    },
];

/// Combinations that no run can make sense of.
pub(super) fn conflicts(scene: &Plastic) -> Vec<Problem> {
    let mut problems = Vec::new();
    let tangent = scene.h_meaning == HardeningMeaning::TangentModulus;
    if scene.material == Material::Plastic && tangent && scene.h >= scene.young {
        let remedy = "lower h, or give it as plastic_modulus";
        problems.push(Problem::new("h", &Value::from(scene.h), "a tangent modulus is below young", remedy));
    }
    if let Some(cells) = scene.cells.filter(|cells| cells % 2 == 1) {
        let remedy = format!("use {} or {}", cells - 1, cells + 1);
        problems.push(Problem::new("cells", &Value::from(cells), "is not even", remedy));
    }
    if scene.points_across != DEFAULT_POINTS && scene.variant == Variant::TotalBilinear {
        let remedy = "leave it out, or use variant total_cubic or updated_cubic";
        let value = Value::from(scene.points_across);
        problems.push(Problem::new("points_across", &value, "bilinear cells have 2 × 2 points", remedy));
    }
    if scene.method == Method::Explicit && scene.variant != Variant::TotalBilinear {
        let value = serde_json::to_value(scene.variant).unwrap_or_default();
        let remedy = "use method implicit, or variant total_bilinear";
        problems.push(Problem::new("variant", &value, "has no explicit method", remedy));
    }
    if scene.contact == Contact::CommonMesh && scene.variant != Variant::UpdatedCubic {
        let value = serde_json::to_value(scene.contact).unwrap_or_default();
        let remedy = "use variant updated_cubic, or contact markers";
        problems.push(Problem::new("contact", &value, "needs bodies on grids with common nodes", remedy));
    }
    if let Some(start) = scene.wall_speed_start.filter(|start| *start > scene.speed()) {
        let remedy = "lower it, or raise wall_speed: the speed only rises on the way";
        problems.push(Problem::new("wall_speed_start", &Value::from(start), "is above wall_speed", remedy));
    }
    if let (Setup::Assembly, Some(phi)) = (scene.setup, scene.phi_end.filter(|phi| *phi <= scene.phi_i)) {
        let remedy = "raise it above phi_i";
        problems.push(Problem::new("phi_end", &Value::from(phi), "is reached before the start", remedy));
    }
    problems
}
