//! Records of discs: half as large as those of spheres, because the plane has half as many numbers.

use super::{Gain, Kinematics};
use crate::lane::{Number, Real};

/// Kinematics of one disc: 48 bytes at the head of a cache line in double precision, half a cache line in mixed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PlanarBody<T: Number> {
    /// Where a body may begin.
    pub aligned: [T::PlanarAlignment; 0],
    /// x, y at t_n [d].
    pub position: [f64; 2],
    /// v_x, v_y [d/τ] and ω [1/τ] at t_n − dt/2; the fourth number is the inverse of the displacement budget [1/d].
    pub motion: [T; 4],
}

/// Force and torque on one disc: F_x, F_y [k_n d], M [k_n d²], zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PlanarForce<T: Number> {
    /// Begins where it is fetched in one piece.
    pub aligned: [T::RowAlignment; 0],
    /// F_x, F_y, M, zero.
    pub numbers: [T; 4],
}

impl<T: Number> Kinematics for PlanarBody<T> {
    fn new(position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]) -> Self {
        Self {
            aligned: [],
            position: [position[0], position[1]],
            motion: [velocity[0], velocity[1], spin[2], 0.0].map(T::of),
        }
    }
    #[inline(always)]
    fn position(&self) -> [f64; 3] {
        [self.position[0], self.position[1], 0.0]
    }
    #[inline(always)]
    fn motion(&self) -> ([f64; 3], [f64; 3]) {
        let [u, v, spin, _] = self.motion.map(T::into);
        ([u, v, 0.0], [0.0, 0.0, spin])
    }
    fn move_to(&mut self, position: [f64; 3]) {
        self.position = [position[0], position[1]];
    }
    #[inline(always)]
    fn inverse_budget(&self) -> f64 {
        self.motion[3].into()
    }
    /// A millionth more, so that rounding to single precision gives nobody a larger budget.
    #[inline(always)]
    fn set_budget(&mut self, budget: f64) {
        self.motion[3] = T::of(1.000_001 / budget);
    }
    fn with_budget_of(mut self, other: &Self) -> Self {
        self.motion[3] = other.motion[3];
        self
    }
}

impl<T: Real> Gain for PlanarForce<T> {
    #[inline(always)]
    fn gain(&mut self, other: &Self) {
        // All of it is read before it is written: then a row is one operation.
        self.numbers = std::array::from_fn(|k| self.numbers[k].add(other.numbers[k]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_small() {
        assert_eq!((size_of::<PlanarBody<f64>>(), size_of::<PlanarBody<f32>>()), (64, 32));
        assert_eq!((size_of::<PlanarForce<f64>>(), size_of::<PlanarForce<f32>>()), (32, 16));
    }

    #[test]
    fn a_rounded_budget_is_not_larger() {
        let mut disc = PlanarBody::<f32>::new([1.0, 2.0, 0.0], [0.5, 0.25, 0.0], [0.0, 0.0, 3.0]);
        for budget in [4e-4, 0.013, 0.06] {
            disc.set_budget(budget);
            assert!(disc.inverse_budget() >= 1.0 / budget && disc.inverse_budget() < 1.000_002 / budget);
        }
        assert_eq!(disc.motion(), ([0.5, 0.25, 0.0], [0.0, 0.0, 3.0]));
        assert_eq!(disc.position(), [1.0, 2.0, 0.0]);
    }
}
