//! Periodic triangular lattices, where everything is known.

use core::f64::consts::PI;

use sim_core::dem::{CellControl, DiscParameters, discs};

use crate::support::{ELASTIC, FAST, TABLE_1, gas, settle, triangular};

#[test]
fn stress_of_a_compressed_lattice() {
    // σ = √3 F/d with F = K_N (1 − d) − F0.
    let spacing = 0.9995;
    for parameters in [ELASTIC, TABLE_1] {
        let dem = discs(&parameters, &triangular(8, 4, spacing, CellControl::Fixed), 0.1, &FAST);
        let force = (1.0 - spacing) - parameters.f0;
        let exact = 3.0_f64.sqrt() * force / spacing;
        for stress in dem.residuals().stress.into_iter().chain(dem.picture().stress) {
            assert!((stress / exact - 1.0).abs() < 1e-11, "{stress} {exact}");
        }
    }
}

#[test]
fn lattice_under_pressure_has_the_analytic_solid_fraction() {
    // d = √3 (1 − F0)/(P + √3), Φ = π/(2√3 d²).
    for (parameters, pressure) in [(TABLE_1, 3e-4), (TABLE_1, 0.0), (ELASTIC, 1e-3)] {
        let control = CellControl::Pressure { pressure, mass: 50.0, cap: 1e-2 };
        let mut dem = discs(&parameters, &triangular(8, 4, 0.99999, control), 0.1, &FAST);
        settle(dem.as_mut(), 20_000);
        let root3 = 3.0_f64.sqrt();
        let spacing = root3 * (1.0 - parameters.f0) / (pressure + root3);
        let exact = PI / (2.0 * root3 * spacing * spacing);
        let found = 64.0 * PI / 4.0 / dem.cell().area();
        assert!((found / exact - 1.0).abs() < 1e-9, "P = {pressure}: {found} {exact}");
        let residuals = dem.residuals();
        assert!(residuals.forces.iter().all(|force| *force < 1e-10));
        assert_eq!(residuals.pairs.len(), 3 * 64);
    }
}

#[test]
fn energy_is_conserved_without_dissipation() {
    // Fixed cell: kinetic energy and potential, order two. Free cell: the cell adds ½ Σ M L² e² and P A; the equation
    // of motion loses ∫ Σ M L² e³ dt of it by construction, which is added up.
    let parameters = DiscParameters { f0: 1e-4, d0: 0.01, ..ELASTIC };
    let drift = |control: CellControl, dt: f64| {
        let mut dem = discs(&parameters, &gas(control), dt, &FAST);
        let mut lost = 0.0;
        let (mass, pressure) = match control {
            CellControl::Fixed => (0.0, 0.0),
            CellControl::Pressure { pressure, mass, .. } => (mass, pressure),
        };
        let mut total = |dem: &dyn sim_core::dem::CellDynamics, before: [f64; 2]| {
            let view = dem.view();
            let kinetic = view.energies.translation + view.energies.rotation;
            let cell = dem.cell();
            let mut energy = kinetic + dem.picture().potential.iter().sum::<f64>() + pressure * cell.area();
            for axis in 0..2 {
                // Rate at t_n: mean of the half steps around it would need the next one; the last is good to dt.
                let rate = 0.5 * (3.0 * cell.rate[axis] - before[axis]);
                let inertia = mass * cell.edges[axis] * cell.edges[axis];
                energy += 0.5 * inertia * rate * rate;
                lost += inertia * rate * rate * rate * dt;
            }
            energy - lost
        };
        let start = total(dem.as_ref(), dem.cell().rate);
        let mut worst = 0.0_f64;
        for _ in 0..(150.0 / dt).round() as u64 {
            let before = dem.cell().rate;
            dem.run(1).unwrap();
            worst = worst.max((total(dem.as_ref(), before) - start).abs());
        }
        worst / start.abs()
    };
    let free = CellControl::Pressure { pressure: 1e-5, mass: 20.0, cap: 1.0 };
    for control in [CellControl::Fixed, free] {
        let errors = [0.1, 0.05, 0.025].map(|dt| drift(control, dt));
        let order = (errors[0] / errors[2]).log2() / 2.0;
        assert!(errors[2] < 2e-3 && order > 1.5, "{control:?}: {errors:?}");
    }
}

#[test]
fn momentum_is_conserved_in_a_fixed_cell() {
    let mut dem = discs(&TABLE_1, &gas(CellControl::Fixed), 0.1, &FAST);
    dem.run(5000).unwrap();
    let picture = dem.picture();
    for axis in 0..2 {
        let momentum: f64 =
            picture.velocities.iter().zip(&picture.radii).map(|(v, r)| 4.0 * r * r * v[axis]).sum();
        assert!(momentum.abs() < 1e-15 * 5000.0, "{momentum}");
    }
}
