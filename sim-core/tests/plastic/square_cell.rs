//! One disc in a box that closes from top and bottom: the cell of a square lattice, up to Φ = 0.97.

use std::sync::Arc;

use sim_core::mpm::body::Body;
use sim_core::mpm::contact::detect::Outline;
use sim_core::mpm::template::symmetric_disc;
use sim_core::mpm::world::World;

use super::reference::rows;
use super::scenes::{D, law, level, run, upright};

struct State {
    phi: f64,
    top: f64,
    side: f64,
    area_gap: f64,
    overlap: f64,
}

fn course(across: usize, hardening: &str, strain: f64) -> Vec<State> {
    let law = law(hardening);
    let mut body = Body::new(Arc::new(symmetric_disc(across)), D / 2.0, [0.0, 0.0], &law.material);
    // without friction nothing but the mesh holds the spin of a disc; the reference is a quarter disc
    body.hold_symmetric();
    let r = D / 2.0;
    let walls = vec![level(-r, 1.0, 0.25), level(r, -1.0, -0.25), upright(-r, 1.0), upright(r, -1.0)];
    let mut world = World::new(vec![body], walls, law);
    let mut states = Vec::new();
    let mut outline = Outline::default();
    run(&mut world, 0.12, (strain * D / 0.5 / 0.12) as usize, |world, _| {
        let height = world.walls[1].point[1] - world.walls[0].point[1];
        let body = &world.bodies[0];
        let area: f64 = body.volumes().sum();
        body.outline_at(&body.displacement, &mut outline.points);
        outline.refresh();
        let outside = |x: &[f64; 2]| {
            let beyond = |wall: &sim_core::mpm::contact::Wall| {
                (wall.point[0] - x[0]) * wall.normal[0] + (wall.point[1] - x[1]) * wall.normal[1]
            };
            world.walls.iter().map(beyond).fold(0.0, f64::max)
        };
        states.push(State {
            phi: area / (D * height),
            top: 0.5 * (world.wall_force(0) + world.wall_force(1)) / D,
            side: 0.5 * (world.wall_force(2) + world.wall_force(3)) / height,
            area_gap: (outline.area() / area - 1.0).abs(),
            overlap: outline.points.iter().map(outside).fold(0.0, f64::max) / D,
        });
    });
    states
}

fn at(states: &[State], phi: f64, value: impl Fn(&State) -> f64) -> Option<f64> {
    let k = states.iter().position(|state| state.phi >= phi)?;
    let (a, b) = (&states[k.checked_sub(1)?], &states[k]);
    let share = (phi - a.phi) / (b.phi - a.phi);
    Some(value(a) + share * (value(b) - value(a)))
}

#[test]
fn follows_the_finite_element_reference_to_phi_097() {
    for (hardening, strain) in [("el", 0.262), ("0", 0.208), ("1", 0.214), ("3", 0.225)] {
        let states = course(24, hardening, strain);
        let mut compared = 0;
        for (quantity, bound) in [("sigma_top_MPa", 0.04), ("sigma_side_MPa", 0.06)] {
            for row in rows("square_cell_by_Phi", quantity) {
                if row.hardening != hardening || row.x < 0.82 {
                    continue;
                }
                let value = |state: &State| if quantity == "sigma_top_MPa" { state.top } else { state.side };
                let Some(found) = at(&states, row.x, value) else { continue };
                let bound = if row.x > 0.96 { 0.06 } else { bound };
                compared += 1;
                let error = (found / row.y - 1.0).abs();
                assert!(
                    error < bound,
                    "H = {hardening}, {quantity}, Φ = {}: {found}, reference {}",
                    row.x,
                    row.y
                );
            }
        }
        assert!(compared >= 6, "{compared} rows");
        let worst = states.iter().map(|state| state.overlap).fold(0.0, f64::max);
        assert!(worst < 1e-3, "overlap with a wall: {worst} D");
        let worst = states.iter().map(|state| state.area_gap).fold(0.0, f64::max);
        assert!(worst < 3e-3, "area of the points and of the outline differ by {worst}");
    }
}
