//! Particle records.

use super::{Gain, Kinematics};
use crate::lane::{Gather, Lane, Number, Real};

/// Kinematics of one particle: three rows of four numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Body<T: Number> {
    /// Where a body may begin.
    pub aligned: [T::Alignment; 0],
    /// x, y, z at t_n [d]; the fourth number is the inverse of the particle's displacement budget [1/d].
    pub position: [f64; 4],
    /// Velocity at t_n − dt/2 [d/τ]; the fourth number is zero.
    pub velocity: [T; 4],
    /// Angular velocity at t_n − dt/2 [1/τ]; the fourth number is zero.
    pub spin: [T; 4],
}

/// Force and torque on one particle [k_n d, k_n d²].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Force<T: Number> {
    /// F_x, F_y, F_z, the torque from [`Number::TORQUE`] on, zeros.
    pub numbers: [T; 8],
}

impl<T: Number> Force<T> {
    /// F [k_n d].
    #[must_use]
    pub fn force(&self) -> [T; 3] {
        std::array::from_fn(|axis| self.numbers[axis])
    }
    /// M [k_n d²].
    #[must_use]
    pub fn torque(&self) -> [T; 3] {
        std::array::from_fn(|axis| self.numbers[T::TORQUE + axis])
    }
    /// One component of F, to write.
    pub fn force_mut(&mut self, axis: usize) -> &mut T {
        &mut self.numbers[axis]
    }
    /// One component of M, to write.
    pub fn torque_mut(&mut self, axis: usize) -> &mut T {
        &mut self.numbers[T::TORQUE + axis]
    }
}

impl<T: Number> Kinematics for Body<T> {
    fn new(position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]) -> Self {
        let row = |v: [f64; 3]| [v[0], v[1], v[2], 0.0].map(T::of);
        let [x, y, z] = position;
        Self { aligned: [], position: [x, y, z, 0.0], velocity: row(velocity), spin: row(spin) }
    }
    #[inline(always)]
    fn position(&self) -> [f64; 3] {
        [self.position[0], self.position[1], self.position[2]]
    }
    #[inline(always)]
    fn motion(&self) -> ([f64; 3], [f64; 3]) {
        let three = |v: &[T; 4]| [v[0], v[1], v[2]].map(T::into);
        (three(&self.velocity), three(&self.spin))
    }
    fn move_to(&mut self, position: [f64; 3]) {
        self.position[..3].copy_from_slice(&position);
    }
    #[inline(always)]
    fn inverse_budget(&self) -> f64 {
        self.position[3]
    }
    #[inline(always)]
    fn set_budget(&mut self, budget: f64) {
        self.position[3] = 1.0 / budget;
    }
    fn with_budget_of(mut self, other: &Self) -> Self {
        self.position[3] = other.position[3];
        self
    }
}

impl<T: Real> Gain for Force<T> {
    #[inline(always)]
    fn gain(&mut self, other: &Self) {
        // All of it is read before it is written: then a row is an operation or two.
        self.numbers = std::array::from_fn(|k| self.numbers[k].add(other.numbers[k]));
    }
}

/// Sizes and masses of the particles.
pub trait Grains: Send + Sync + 'static {
    /// Whether all are equal: then both torques of a contact are equal and one register holds them.
    const EQUAL: bool;

    /// Numbers per listed pair that are worked out once, when the pair is listed.
    const CONSTANTS: usize;

    /// These numbers: R_a, R_b [d] and √ of the mass in the dashpot [√m]; not asked for when there are none.
    fn constants(&self, a: usize, b: usize) -> [f64; 3];
    /// R_a, R_b and √ of the mass in the dashpot of pairs, from their constants in groups of four.
    ///
    /// # Safety
    /// `constants` points to [`Grains::CONSTANTS`] rows of a group at the first lane.
    unsafe fn pair<L: Lane>(&self, constants: *const L::Scalar) -> [L; 3];
    /// Radii of `L::WIDTH` particles [d].
    ///
    /// # Safety
    /// `at` points to `L::WIDTH` valid indices.
    unsafe fn radii<L: Gather>(&self, at: *const u32) -> L;
    /// √ of the mass in the dashpot of pairs [√m].
    ///
    /// # Safety
    /// As for [`Grains::radii`].
    unsafe fn root_pair_mass<L: Gather>(&self, a: *const u32, b: *const u32) -> L;
    /// √ of the mass in the dashpot of wall contacts [√m].
    ///
    /// # Safety
    /// As for [`Grains::radii`].
    unsafe fn root_wall_mass<L: Gather>(&self, a: *const u32) -> L;
    /// Radius of one particle [d].
    fn radius(&self, at: usize) -> f64;
    /// Mass of one particle [m].
    fn mass(&self, at: usize) -> f64;
    /// Moment of inertia of one particle [m d²].
    fn inertia(&self, at: usize) -> f64;
    /// 1/mass of one particle, as the integrator uses it [1/m].
    fn inverse_mass(&self, at: usize) -> f64;
    /// 1/inertia of one particle, as the integrator uses it [1/(m d²)].
    fn inverse_inertia(&self, at: usize) -> f64;
    /// Largest radius [d].
    fn largest_radius(&self) -> f64;
    /// Follows a new order of the particles: slot k now holds what was in slot `order[k]`.
    fn permute(&mut self, order: &[u32]);
}

/// Equal spheres with d = m = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equal {
    /// √ of the mass in the dashpot of pairs [√m]: √½ with the effective mass, 1 with the particle mass.
    pub root_pair_mass: f64,
}

impl Equal {
    /// Radius [d].
    pub const RADIUS: f64 = 0.5;
    /// Moment of inertia of a solid sphere, m d²/10.
    pub const INERTIA: f64 = 0.1;
}

impl Grains for Equal {
    const EQUAL: bool = true;
    const CONSTANTS: usize = 0;

    fn constants(&self, _: usize, _: usize) -> [f64; 3] {
        [Self::RADIUS, Self::RADIUS, self.root_pair_mass]
    }
    #[inline(always)]
    unsafe fn pair<L: Lane>(&self, _: *const L::Scalar) -> [L; 3] {
        [L::splat(Self::RADIUS), L::splat(Self::RADIUS), L::splat(self.root_pair_mass)]
    }
    #[inline(always)]
    unsafe fn radii<L: Gather>(&self, _: *const u32) -> L {
        L::splat(Self::RADIUS)
    }
    #[inline(always)]
    unsafe fn root_pair_mass<L: Gather>(&self, _: *const u32, _: *const u32) -> L {
        L::splat(self.root_pair_mass)
    }
    #[inline(always)]
    unsafe fn root_wall_mass<L: Gather>(&self, _: *const u32) -> L {
        L::splat(1.0)
    }
    #[inline(always)]
    fn radius(&self, _: usize) -> f64 {
        Self::RADIUS
    }
    #[inline(always)]
    fn mass(&self, _: usize) -> f64 {
        1.0
    }
    #[inline(always)]
    fn inertia(&self, _: usize) -> f64 {
        Self::INERTIA
    }
    #[inline(always)]
    fn inverse_mass(&self, _: usize) -> f64 {
        1.0
    }
    #[inline(always)]
    fn inverse_inertia(&self, _: usize) -> f64 {
        10.0
    }
    fn largest_radius(&self) -> f64 {
        Self::RADIUS
    }
    fn permute(&mut self, _: &[u32]) {}
}
