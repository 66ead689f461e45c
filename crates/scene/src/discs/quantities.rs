//! Derived quantities of `cohesive_discs`.

use super::{Assembly, Discs};
use crate::Quantity;

const PAPER: &str = "cohesive-powder-consolidation-2008";

pub(super) const QUANTITIES: &[Quantity<Discs>] = &[
    Quantity {
        name: "cohesive",
        unit: "1",
        meaning: "1 with cohesion, 0 without",
        source: PAPER,
        of: |scene| if scene.assembly == Assembly::Cohesionless { 0.0 } else { 1.0 },
    },
    Quantity {
        name: "assembly_type",
        unit: "1",
        meaning: "assembling procedure: 1, 2, or 0 for cohesionless",
        source: PAPER,
        of: |scene| match scene.assembly {
            Assembly::Cohesionless => 0.0,
            Assembly::Type1 => 1.0,
            Assembly::Type2 => 2.0,
        },
    },
    Quantity {
        name: "rolling_length",
        unit: "a",
        meaning: "distance of the two contact points behind rolling resistance l = μ_R/μ",
        source: PAPER,
        of: |scene| if scene.mu > 0.0 { scene.mu_r / scene.mu } else { 0.0 },
    },
];
