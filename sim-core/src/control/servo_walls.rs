//! Six rigid plane walls of a box, each with one degree of freedom along its normal and mass m_w, driven by p S with
//! S the product of the other two current gaps (spheres, paper 2024, section 2.2).

use serde::{Deserialize, Serialize};

/// Walls in the order x low, x high, y low, y high, z low, z high.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ServoWalls {
    /// Inner faces at t_n [d].
    pub position: [f64; 6],
    /// Velocities along the axis at t_n − dt/2 [d/τ].
    pub velocity: [f64; 6],
    /// Mass of one wall [m].
    pub mass: f64,
    /// Pressure p [k_n/d].
    pub pressure: f64,
    /// Which walls move.
    pub moving: [bool; 6],
}

impl ServoWalls {
    /// Axis of a wall.
    #[must_use]
    pub fn axis(wall: usize) -> usize {
        wall / 2
    }

    /// +1 for a high wall, −1 for a low one: the outward direction along the axis.
    #[must_use]
    pub fn outward(wall: usize) -> f64 {
        if wall % 2 == 1 { 1.0 } else { -1.0 }
    }

    /// Distance between the two walls of an axis [d].
    #[must_use]
    pub fn gap(&self, axis: usize) -> f64 {
        self.position[2 * axis + 1] - self.position[2 * axis]
    }

    /// p S on a wall [k_n d].
    #[must_use]
    pub fn load(&self, wall: usize) -> f64 {
        let axis = Self::axis(wall);
        self.pressure * (self.gap((axis + 1) % 3) * self.gap((axis + 2) % 3))
    }

    /// Volume between the walls [d³].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.gap(0) * self.gap(1) * self.gap(2)
    }

    /// Acceleration along the axis under the outward force of the particles [d/τ²]; zero for a fixed wall.
    #[must_use]
    pub fn acceleration(&self, wall: usize, force: f64) -> f64 {
        if self.moving[wall] { Self::outward(wall) * ((force - self.load(wall)) / self.mass) } else { 0.0 }
    }

    /// Velocities to t_n + dt/2, then positions to t_n + dt.
    pub fn advance(&mut self, force: [f64; 6], dt: f64) {
        // All loads belong to the gaps of t_n.
        let acceleration: [f64; 6] = std::array::from_fn(|wall| self.acceleration(wall, force[wall]));
        for wall in 0..6 {
            self.velocity[wall] = dt.mul_add(acceleration[wall], self.velocity[wall]);
            self.position[wall] = dt.mul_add(self.velocity[wall], self.position[wall]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn load_is_pressure_times_the_other_two_gaps() {
        let walls = ServoWalls {
            position: [0.0, 2.0, -1.0, 2.0, 1.0, 6.0],
            velocity: [0.0; 6],
            mass: 1.0,
            pressure: 0.1,
            moving: [true; 6],
        };
        assert_eq!([walls.load(0), walls.load(2), walls.load(5)], [1.5, 1.0, 0.1 * 6.0]);
        assert_eq!(walls.volume(), 30.0);
        assert_eq!(walls.acceleration(0, 0.0), 1.5);
        assert_eq!(walls.acceleration(1, 0.0), -1.5);
    }
}
