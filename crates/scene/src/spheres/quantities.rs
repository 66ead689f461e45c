//! Derived quantities of `cohesive_spheres`.

use super::Spheres;
use crate::Quantity;

/// σc/σe above which the equilibrium overlap of a pair exceeds 5 % of d: the contact law loses its meaning.
const LARGEST_OVERLAP: f64 = 0.05;

const PAPER: &str = "cohesive-dynamic-compaction-2024";

pub(super) const QUANTITIES: &[Quantity<Spheres>] = &[
    Quantity {
        name: "eta",
        unit: "1",
        meaning: "cohesion number η = σc/p",
        source: PAPER,
        of: |scene| scene.sigma_c / scene.p,
    },
    Quantity {
        name: "eta_star",
        unit: "1",
        meaning: "modified cohesion number η* = σc/√(p σe)",
        source: PAPER,
        of: |scene| scene.sigma_c / (scene.p * scene.sigma_e).sqrt(),
    },
    Quantity {
        name: "p_crit",
        unit: "Pa",
        meaning: "critical pressure p_crit = σc²/σe",
        source: PAPER,
        of: |scene| scene.sigma_c * scene.sigma_c / scene.sigma_e,
    },
    Quantity {
        name: "sigma_c_over_sigma_e",
        unit: "1",
        meaning: "equilibrium overlap of a pair over d: σc/σe",
        source: PAPER,
        of: |scene| scene.sigma_c / scene.sigma_e,
    },
    Quantity {
        name: "p_over_sigma_e",
        unit: "1",
        meaning: "reduced pressure p/σe, the inverse of the stiffness number",
        source: PAPER,
        of: |scene| scene.p / scene.sigma_e,
    },
    Quantity {
        name: "phi_i",
        unit: "1",
        meaning: "initial solid fraction φ_i = 1/(1 + e_i)",
        source: PAPER,
        of: |scene| 1.0 / (1.0 + scene.ei),
    },
];

pub(super) fn out_of_model(scene: &Spheres) -> Option<String> {
    let overlap = scene.sigma_c / scene.sigma_e;
    (overlap > LARGEST_OVERLAP).then(|| {
        format!("sigma_c/sigma_e = {overlap} exceeds {LARGEST_OVERLAP}: the equilibrium overlap of a pair is above 5 % of d")
    })
}
