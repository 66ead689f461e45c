//! One disc between rigid walls (Section 3 of the paper) against finite elements.

use sim_core::mpm::world::World;

use super::reference::rows;
use super::scenes::{D, press, run};

struct State {
    hardening: &'static str,
    strain: f64,
    force: f64,
    work: f64,
    area_ratio: f64,
    plastic_share: f64,
}

fn course(across: usize, hardening: &'static str) -> Vec<State> {
    let mut world = press(across, hardening, 0.5);
    let mut states = Vec::new();
    let area: f64 = world.bodies[0].volumes().sum();
    // 0.06 µs: a strain of 0.0005 per step, so that every tabulated strain is met
    run(&mut world, 0.06, 340, |world, step| {
        let body = &world.bodies[0];
        let flowing = body.points.plastic.iter().zip(body.volumes()).filter(|(plastic, _)| **plastic > 1e-6);
        states.push(State {
            hardening,
            strain: 5e-4 * step as f64,
            force: 0.5 * (world.wall_force(0) + world.wall_force(1)) / D,
            work: world.energies.work / area,
            area_ratio: body.volumes().sum::<f64>() / area,
            plastic_share: flowing.map(|(_, volume)| volume).sum::<f64>() / body.volumes().sum::<f64>(),
        });
    });
    if across > 12 {
        energy_closes(&world, hardening);
    }
    states
}

/// The balance of the integrator closes to its tolerance, and the work of the stresses is what the law stores and
/// dissipates but for the hypoelastic law's own gap: 1 % at the end point for the elastic disc, 0.3 % for plastic ones
/// (specification, section 11).
fn energy_closes(world: &World, hardening: &str) {
    let e = world.energies;
    let open = e.work - world.kinetic_energy() - e.internal - e.numerical - e.contact - e.friction;
    assert!((open / e.work).abs() < 1e-3, "H = {hardening}: {} of the work is missing", open / e.work);
    let gap = (e.internal - world.elastic_energy() - e.plastic) / e.internal;
    let bound = if hardening == "el" { 0.015 } else { 0.005 };
    assert!(gap.abs() < bound, "H = {hardening}: hypoelastic gap {gap}");
    // what backward Euler and the closing of contacts take is small at this step
    assert!((0.0..0.01).contains(&(e.numerical / e.work)) && (e.contact / e.work).abs() < 0.01, "{e:?}");
}

fn compare(quantity: &str, states: &[State], bound: impl Fn(f64) -> f64, value: impl Fn(&State) -> f64) {
    let mut compared = 0;
    for row in rows("diam_single_disc", quantity) {
        let meets = |state: &&State| state.hardening == row.hardening && (state.strain - row.x).abs() < 1e-9;
        // below 0.03 the start of the dynamic test shows (0.8 % at 0.02 in the reference) and the contact is one edge wide
        let Some(state) = states.iter().find(meets).filter(|_| row.x > 0.03) else { continue };
        compared += 1;
        let found = value(state);
        assert!(
            (found - row.y).abs() <= bound(row.y),
            "{quantity}, H = {}, strain {}: {found}, reference {}",
            row.hardening,
            row.x,
            row.y
        );
    }
    assert!(compared >= 6, "{quantity}: {compared} rows compared");
}

#[test]
fn follows_the_finite_element_reference_at_16_cells() {
    let states: Vec<State> = ["el", "0", "1", "3"].into_iter().flat_map(|h| course(16, h)).collect();
    // bilinear cells of this size scatter by 3 % in force as contact nodes enter, and by 1.5 % in work
    // (`diam_mesh_convergence`, Q4 n = 4 … 6)
    compare("F_over_D_MPa", &states, |y| 0.03 * y, |state| state.force);
    compare("work_over_A0_MPa", &states, |y| 0.02 * y, |state| state.work);
    compare("area_ratio", &states, |_| 2e-3, |state| state.area_ratio);
    compare("f_p_eps_gt_1e-6", &states, |_| 0.04, |state| state.plastic_share);
}

#[test]
fn work_converges_with_the_cells() {
    let reference = rows("diam_single_disc", "work_over_A0_MPa");
    let exact = reference.iter().find(|row| row.hardening == "el" && row.x == 0.17).unwrap().y;
    let error = |across| course(across, "el").last().unwrap().work / exact - 1.0;
    let (coarse, fine) = (error(6), error(12));
    // from below, at first order or better: the outline meets the wall edge by edge
    assert!(coarse < 0.0 && fine < 0.0 && coarse / fine > 2.0, "{coarse} {fine}");
}
