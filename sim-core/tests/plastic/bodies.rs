//! Blocks and pairs of discs: patch test, waves, friction, symmetry of contact.

use std::sync::Arc;

use sim_core::mpm::body::Body;
use sim_core::mpm::template::{block, disc, symmetric_disc};
use sim_core::mpm::world::World;

use super::reference::rows;
use super::scenes::{D, law, level, run, upright};

/// A square block of side 10 µm in 4 × 4 cells under a wall that comes down slowly.
fn squeezed(hardening: &str, confined: bool, mut look: impl FnMut(&World, f64)) {
    const L: f64 = 10.0;
    let law = law(hardening);
    let body = Body::new(Arc::new(block(L, L, 4, 4)), 1.0, [0.0, 0.0], &law.material);
    let mut walls = vec![level(0.0, 1.0, 0.0), level(L, -1.0, -0.1)];
    if confined {
        walls.extend([upright(0.0, 1.0), upright(L, -1.0)]);
    }
    let mut world = World::new(vec![body], walls, law);
    // strain 0.001 per step, 0.1 m/s: quasi-static to 1e-3 of c_S
    run(&mut world, 0.1, 200, |world, step| look(world, 1e-3 * step as f64));
}

#[test]
fn a_block_deforms_homogeneously_as_the_rate_equations_say() {
    for (case, confined) in [("block_free_sides", false), ("block_confined", true)] {
        for hardening in ["el", "0", "1", "3"] {
            let reference = rows(case, "F_over_L0_MPa");
            let mut compared = 0;
            squeezed(hardening, confined, |world, strain| {
                let meets = |row: &&super::reference::Row| {
                    row.hardening == hardening && (row.x - strain).abs() < 1e-9 && row.x > 0.025
                };
                let Some(row) = reference.iter().find(meets) else { return };
                compared += 1;
                let force = 0.5 * (world.wall_force(0) + world.wall_force(1)) / 10.0;
                let error = (force / row.y - 1.0).abs();
                assert!(error < 0.01, "{case}, H = {hardening}, {strain}: {force}, reference {}", row.y);
                let stresses = &world.bodies[0].points.stress;
                let mean = stresses.iter().map(|s| s.yy).sum::<f64>() / stresses.len() as f64;
                let spread = stresses.iter().map(|s| (s.yy / mean - 1.0).abs()).fold(0.0, f64::max);
                assert!(spread < 0.01, "{case}, H = {hardening}, {strain}: stress varies by {spread}");
            });
            assert!(compared >= 2, "{case}, H = {hardening}: {compared} rows");
        }
    }
}

/// The first mode of a bar of 60 µm, clamped at one end and held laterally.
fn bar() -> World {
    let law = law("el");
    let mut body = Body::new(Arc::new(block(60.0, 1.0, 60, 1)), 1.0, [0.0, 0.0], &law.material);
    for node in 0..body.template.nodes.len() {
        let x = body.template.nodes[node][0];
        body.fixed.push(2 * node as u32 + 1);
        if x == 0.0 {
            body.fixed.push(2 * node as u32);
        }
        body.velocity[2 * node] = 0.1 * libm::sin(std::f64::consts::FRAC_PI_2 * x / 60.0);
    }
    World::new(vec![body], Vec::new(), law)
}

/// Angular frequency from the zero crossings of the tip velocity, and energy factor per step.
fn ring(theta: f64, dt: f64) -> (f64, f64) {
    let mut world = bar();
    world.numerics.theta = theta;
    world.numerics.residual = 1e-9;
    let start = world.kinetic_energy();
    let tip = 2 * 60;
    let (mut crossings, mut before) = (Vec::new(), world.bodies[0].velocity[tip]);
    let steps = (2.2 * 1.232_29 / dt) as usize;
    let mut end = 0.0;
    run(&mut world, dt, steps, |world, step| {
        let v = world.bodies[0].velocity[tip];
        if before * v < 0.0 {
            crossings.push(dt * (step as f64 - 1.0 + before / (before - v)));
        }
        before = v;
        end = world.kinetic_energy() + world.elastic_energy();
    });
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    let omega = std::f64::consts::PI * (crossings.len() - 1) as f64 / (last - first);
    (omega, (end / start).powf(1.0 / steps as f64))
}

#[test]
fn a_wave_in_a_bar_has_the_frequency_and_damping_of_the_integrator() {
    for dt in [0.01, 0.02] {
        let value = |quantity: &str| rows("wave_bar", quantity).iter().find(|row| row.x == dt).unwrap().y;
        let (omega, factor) = ring(1.0, dt);
        assert!((omega / value("BE_apparent_omega_rad_per_us") - 1.0).abs() < 0.01, "{omega}");
        let decay = factor.ln() / value("BE_energy_factor_per_step").ln();
        assert!((decay - 1.0).abs() < 0.05, "energy decay {decay} of the prediction");
        let (omega, factor) = ring(0.5, dt);
        assert!((omega / value("Newmark_quarter_omega_rad_per_us") - 1.0).abs() < 0.01, "{omega}");
        assert!((factor - 1.0).abs() < 1e-4, "the trapezoidal rule keeps energy: {factor}");
    }
}

#[test]
fn a_block_slides_to_a_stop_by_coulombs_law() {
    // stiff block, pressed on by 0.01 µm/µs², starting at 0.1 m/s: v₀²/(2 μ g) = 5 µm in 100 µs at μ = 0.1
    let mut law = law("el");
    law.material.young = 1e3;
    let body = Body::new(Arc::new(block(4.0, 2.0, 2, 1)), 1.0, [0.0, 0.0], &law.material);
    let mut world = World::new(vec![body], vec![level(0.0, 1.0, 0.0)], law);
    world.friction = 0.1;
    world.acceleration = [0.0, -0.01];
    world.numerics.residual = 1e-7;
    let mass: f64 = world.bodies[0].mass.iter().sum();
    let centre = |world: &World| {
        let body = &world.bodies[0];
        body.mass.iter().enumerate().map(|(node, m)| m * body.displacement[2 * node]).sum::<f64>() / mass
    };
    run(&mut world, 0.5, 40, |_, _| {});
    for velocity in world.bodies[0].velocity.iter_mut().step_by(2) {
        *velocity += 0.1;
    }
    let start = centre(&world);
    let before = world.energies;
    let kinetic = world.kinetic_energy();
    let mut at_two = 0.0;
    run(&mut world, 0.5, 260, |world, step| {
        if step == 4 {
            at_two = centre(world) - start;
        }
    });
    let exact = rows("friction_block_slide", "slide_distance_um").iter().find(|row| row.x == 0.1).unwrap().y;
    let slid = centre(&world) - start;
    assert!((slid / exact - 1.0).abs() < 0.01, "{slid}");
    assert!((at_two - 0.198).abs() < 0.001, "{at_two}");
    assert!(world.momentum()[0].abs() < 1e-6 * mass * 0.1, "it rests");
    // all of the kinetic energy went into friction but for what backward Euler takes: ½ m μ g Δt per v₀
    let rubbed = world.energies.friction - before.friction;
    let taken = world.energies.numerical - before.numerical;
    assert!((rubbed / kinetic - 1.0).abs() < 0.01, "friction took {rubbed} of {kinetic}");
    assert!(((rubbed + taken) / kinetic - 1.0).abs() < 2e-3, "{rubbed} and {taken} of {kinetic}");
}

#[test]
fn two_discs_press_each_other_as_the_wall_does() {
    let law = law("1");
    let template = Arc::new(symmetric_disc(16));
    let mut bodies =
        [0.5, 1.5].map(|y| Body::new(template.clone(), D / 2.0, [0.0, y * D], &law.material)).to_vec();
    // a column without friction buckles: its axis is held on the line of load, as in the reference
    for body in &mut bodies {
        let on_axis = template.nodes.iter().enumerate().filter(|(_, at)| at[0].abs() < 1e-9);
        body.fixed.extend(on_axis.map(|(node, _)| 2 * node as u32));
    }
    let mut world = World::new(bodies, vec![level(0.0, 1.0, 0.0), level(2.0 * D, -1.0, -0.5)], law);
    let reference = rows("two_disc_column", "F_over_D_MPa");
    let mut compared = 0;
    run(&mut world, 0.12, 340, |world, step| {
        let strain = 5e-4 * step as f64;
        let meets = |row: &&super::reference::Row| row.hardening == "1" && (row.x - strain).abs() < 1e-9;
        let Some(row) = reference.iter().find(meets) else { return };
        compared += 1;
        let force = 0.5 * (world.wall_force(0) + world.wall_force(1)) / D;
        // three contacts of 16-cell discs in series, each with the scatter of the single disc
        assert!((force / row.y - 1.0).abs() < 0.04, "{strain}: {force}, reference {}", row.y);
    });
    assert!(compared >= 3, "{compared} rows compared");
    // held still until inertia has died out, the two outlines carry what the walls carry
    world.walls[1].velocity = [0.0; 2];
    world.numerics.residual = 1e-6;
    world.numerics.impulse = 1e-7;
    run(&mut world, 20.0, 10, |_, _| {});
    let mut mutual = [0.0; 2];
    for ((key, impulse), normal) in world.impulses.iter().zip(&world.normals) {
        if let sim_core::mpm::contact::Partner::Body(_) = key.partner {
            let sign = if key.body == 1 { 1.0 } else { -1.0 };
            mutual = [0, 1].map(|axis| mutual[axis] + sign * impulse[0] * normal[axis] / world.last_dt);
        }
    }
    for wall in [0, 1] {
        let force = world.wall_force(wall);
        assert!((mutual[1] / force - 1.0).abs() < 1e-3, "mutual force {}, wall {wall}: {force}", mutual[1]);
        assert!(mutual[0].abs() < 1e-3 * force, "no side force: {}", mutual[0]);
    }
}

#[test]
fn a_collision_keeps_momentum() {
    let law = law("el");
    let template = Arc::new(disc(8));
    let mut bodies =
        [0.0, 2.02].map(|x| Body::new(template.clone(), 1.0, [x, 0.3 * x], &law.material)).to_vec();
    bodies[0].velocity.iter_mut().step_by(2).for_each(|v| *v = 2.0);
    let mut world = World::new(bodies, Vec::new(), law);
    let before = world.momentum();
    let mut touched = false;
    run(&mut world, 0.005, 120, |world, _| {
        touched |= !world.impulses.is_empty();
        let now = world.momentum();
        for axis in 0..2 {
            let change = (now[axis] - before[axis]).abs();
            assert!(change < 1e-12 * before[0], "momentum changed by {change}");
        }
    });
    assert!(touched);
}
