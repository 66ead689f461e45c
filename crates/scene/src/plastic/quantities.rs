//! Derived quantities of `plastic_discs`.

use super::{Material, Plastic, Setup};
use crate::Quantity;

const PAPER: &str = "plastic-disc-packings-2021";

pub(super) const QUANTITIES: &[Quantity<Plastic>] = &[
    Quantity {
        name: "plastic",
        unit: "1",
        meaning: "1 with a yield stress, 0 without",
        source: PAPER,
        of: |scene| if scene.material == Material::Plastic { 1.0 } else { 0.0 },
    },
    Quantity {
        name: "sigma_y_over_young",
        unit: "1",
        meaning: "yield strain σ_y/E; 0 if elastic",
        source: PAPER,
        of: |scene| if scene.material == Material::Plastic { scene.sigma_y / scene.young } else { 0.0 },
    },
    Quantity {
        name: "h_over_young",
        unit: "1",
        meaning: "plastic modulus over Young's modulus; 0 if elastic",
        source: PAPER,
        of: |scene| {
            if scene.material == Material::Plastic { scene.plastic_modulus() / scene.young } else { 0.0 }
        },
    },
    Quantity {
        name: "wall_mach",
        unit: "1",
        meaning: "closing speed over the P-wave speed √(M/ρ), M = E (1 − ν)/((1 + ν)(1 − 2ν))",
        source: PAPER,
        of: |scene| {
            let nu = scene.nu;
            let modulus = (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
            scene.speed() / (scene.speed_unit() * libm::sqrt(modulus))
        },
    },
    Quantity {
        name: "mean_diameter",
        unit: "m",
        meaning: "⟨d⟩ for diameters uniform by area: d ln(1/r)/(1/r − 1) with r = size_ratio",
        source: PAPER,
        of: |scene| {
            if scene.setup != Setup::Assembly || scene.size_ratio == 1.0 {
                scene.diameter()
            } else {
                let inverse = 1.0 / scene.size_ratio;
                scene.diameter() * libm::log(inverse) / (inverse - 1.0)
            }
        },
    },
];
