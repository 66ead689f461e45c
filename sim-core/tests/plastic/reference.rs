//! The reference table: finite-element, closed-form and ODE results of codes that are no part of this project.

use sim_core::mpm::constitutive::{Hardening, Material};

/// One row.
pub struct Row {
    /// `el`, or H [MPa].
    pub hardening: String,
    /// Abscissa; its meaning depends on the case.
    pub x: f64,
    /// Value.
    pub y: f64,
}

/// All rows of a case and quantity.
pub fn rows(case: &str, quantity: &str) -> Vec<Row> {
    let found: Vec<Row> = include_str!("reference.csv")
        .lines()
        .skip(1)
        .filter_map(|line| {
            let mut cells = line.splitn(6, ',');
            let row_case = cells.next()?;
            let hardening = cells.next()?;
            let row_quantity = cells.next()?;
            let (x, y) = (cells.next()?, cells.next()?);
            (row_case == case && row_quantity == quantity).then(|| Row {
                hardening: hardening.to_owned(),
                x: x.parse().unwrap(),
                y: y.parse().unwrap(),
            })
        })
        .collect();
    assert!(!found.is_empty(), "no reference rows for {case}, {quantity}");
    found
}

/// The paper's material in µm, MPa, µs; `el` is the purely elastic one.
pub fn material(hardening: &str) -> Material {
    let plasticity =
        (hardening != "el").then(|| Hardening { yield_stress: 0.4, modulus: hardening.parse().unwrap() });
    Material { young: 10.0, poisson: 0.45, density: 1e-3, plasticity }
}

/// Half a unit of the sixth digit, with which the table is printed.
pub fn printed(y: f64) -> f64 {
    5.1e-6 * y.abs() + 1e-12
}
