//! Worlds shared by the tests, in µm, MPa, µs.

use std::sync::Arc;

use sim_core::mpm::body::Body;
use sim_core::mpm::constitutive::Kinematics;
use sim_core::mpm::contact::Wall;
use sim_core::mpm::element::Law;
use sim_core::mpm::implicit::Implicit;
use sim_core::mpm::template::disc;
use sim_core::mpm::world::World;

use super::reference::material;

/// Diameter of the paper's single disc [µm].
pub const D: f64 = 60.0;

pub fn law(hardening: &str) -> Law {
    Law { material: material(hardening), kinematics: Kinematics::Jaumann, mean_dilatation: true }
}

/// A horizontal wall at `y` facing up (`side` = 1) or down (−1), moving at `speed` along y.
pub fn level(y: f64, side: f64, speed: f64) -> Wall {
    Wall { point: [0.0, y], normal: [0.0, side], velocity: [0.0, speed] }
}

/// A vertical wall at `x` facing right (`side` = 1) or left (−1).
pub fn upright(x: f64, side: f64) -> Wall {
    Wall { point: [x, 0.0], normal: [side, 0.0], velocity: [0.0; 2] }
}

/// One disc of 60 µm between a fixed bottom wall (0) and a top wall (1) that comes down at `speed` [m/s].
pub fn press(across: usize, hardening: &str, speed: f64) -> World {
    let law = law(hardening);
    let body = Body::new(Arc::new(disc(across)), D / 2.0, [0.0, D / 2.0], &law.material);
    World::new(vec![body], vec![level(0.0, 1.0, 0.0), level(D, -1.0, -speed)], law)
}

/// Steps with a look at the world after each.
pub fn run(world: &mut World, dt: f64, steps: usize, mut look: impl FnMut(&World, usize)) {
    let mut solver = Implicit::new(world);
    for step in 1..=steps {
        solver.step(world, dt).unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        look(world, step);
    }
}
