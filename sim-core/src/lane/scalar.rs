//! One number at a time: the plain path, lane for lane the arithmetic of the vector path.

use super::{Gather, Lane, Number, OTHER, Plane, Real, Widen};
use crate::state::{Body, Force, PlanarBody, PlanarForce};

macro_rules! scalar {
    ($number:ty, $gauge:expr, $meet:expr) => {
        impl Lane for $number {
            type Scalar = Self;
            type Mask = bool;
            const WIDTH: usize = 1;

            #[inline(always)]
            fn splat(value: f64) -> Self {
                Self::of(value)
            }
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self - other
            }
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                self / other
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                <$number>::mul_add(self, factor, addend)
            }
            #[inline(always)]
            fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
                <$number>::mul_add(-self, factor, addend)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$number>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$number>::abs(self)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn keep(self, mask: bool) -> Self {
                if mask { self } else { 0.0 }
            }
            #[inline(always)]
            fn both(a: bool, b: bool) -> bool {
                a && b
            }
            #[inline(always)]
            fn any(mask: bool) -> bool {
                mask
            }

            #[inline(always)]
            unsafe fn load(from: *const Self) -> Self {
                // SAFETY: the caller vouches for one readable number.
                unsafe { *from }
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut Self) {
                // SAFETY: the caller vouches for one writable number.
                unsafe { *to = self }
            }
        }

        impl Widen for $number {
            type Wide = f64;

            #[inline(always)]
            fn narrow(wide: f64) -> Self {
                Self::of(wide)
            }
            #[inline(always)]
            fn widen(self) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn gauge(square: f64, radius_a: Self, radius_b: Self) -> [Self; 2] {
                $gauge(square, radius_a, radius_b)
            }
            #[inline(always)]
            fn meet(gauge: [Self; 2], radius_a: Self, radius_b: Self) -> [Self; 2] {
                $meet(gauge, radius_a, radius_b)
            }
        }

        impl Plane for $number {
            #[inline(always)]
            unsafe fn discs_apart(
                bodies: *const PlanarBody<Self>,
                a: *const u32,
                b: *const u32,
            ) -> ([f64; 2], [Self; 2]) {
                // SAFETY: the caller vouches for the indices.
                let (p, q) = unsafe { (&*bodies.add(*a as usize), &*bodies.add(*b as usize)) };
                (
                    [q.position[0] - p.position[0], q.position[1] - p.position[1]],
                    [q.motion[0] - p.motion[0], q.motion[1] - p.motion[1]],
                )
            }
            #[inline(always)]
            unsafe fn disc_spins(bodies: *const PlanarBody<Self>, at: *const u32) -> Self {
                // SAFETY: the caller vouches for the index.
                unsafe { (*bodies.add(*at as usize)).motion[2] }
            }
            #[inline(always)]
            unsafe fn scatter_discs(
                of_a: *mut PlanarForce<Self>,
                a: *const u32,
                of_b: *mut PlanarForce<Self>,
                b: *const u32,
                force: [Self; 2],
                torque_a: Self,
                torque_b: Self,
            ) {
                // SAFETY: the caller vouches for the indices; the two references do not live at the same time.
                unsafe {
                    let numbers = &mut (*of_a.wrapping_add(*a as usize)).numbers;
                    numbers[0] += force[0];
                    numbers[1] += force[1];
                    numbers[2] += torque_a;
                    let numbers = &mut (*of_b.wrapping_add(*b as usize)).numbers;
                    numbers[0] -= force[0];
                    numbers[1] -= force[1];
                    numbers[2] += torque_b;
                }
            }
        }

        impl Gather for $number {
            #[inline(always)]
            unsafe fn gather(table: *const f64, at: *const u32) -> Self {
                // SAFETY: the caller vouches for the index.
                unsafe { Self::of(*table.add(*at as usize)) }
            }

            #[inline(always)]
            unsafe fn separation(bodies: *const Body<Self>, a: *const u32, b: *const u32) -> [f64; 3] {
                // SAFETY: the caller vouches for the indices.
                let (p, q) = unsafe { (Self::position(bodies, a), Self::position(bodies, b)) };
                [q[0] - p[0], q[1] - p[1], q[2] - p[2]]
            }
            #[inline(always)]
            unsafe fn position(bodies: *const Body<Self>, a: *const u32) -> [f64; 3] {
                // SAFETY: the caller vouches for the index.
                let [x, y, z, _] = unsafe { (*bodies.add(*a as usize)).position };
                [x, y, z]
            }
            #[inline(always)]
            unsafe fn difference<const FIELD: usize>(
                bodies: *const Body<Self>,
                a: *const u32,
                b: *const u32,
            ) -> [Self; 3] {
                // SAFETY: the caller vouches for the indices.
                let (p, q) = unsafe { (Self::record::<FIELD>(bodies, a), Self::record::<FIELD>(bodies, b)) };
                [q[0] - p[0], q[1] - p[1], q[2] - p[2]]
            }
            #[inline(always)]
            unsafe fn motion(bodies: *const Body<Self>, a: *const u32, b: *const u32) -> [[Self; 3]; 2] {
                // SAFETY: the caller vouches for the indices.
                unsafe {
                    let (p, q) = (Self::record::<2>(bodies, a), Self::record::<2>(bodies, b));
                    [Self::difference::<1>(bodies, a, b), [p[0] + q[0], p[1] + q[1], p[2] + q[2]]]
                }
            }
            #[inline(always)]
            unsafe fn record<const FIELD: usize>(bodies: *const Body<Self>, a: *const u32) -> [Self; 3] {
                // SAFETY: the caller vouches for the index.
                let body = unsafe { &*bodies.add(*a as usize) };
                let row = if FIELD == 1 { &body.velocity } else { &body.spin };
                [row[0], row[1], row[2]]
            }
            #[inline(always)]
            unsafe fn scatter(forces: *mut Force<Self>, at: *const u32, value: [Self; 3]) {
                // SAFETY: the caller vouches for the index and for exclusive access.
                let force = unsafe { &mut *forces.wrapping_add(*at as usize) };
                for axis in 0..3 {
                    force.numbers[axis] += value[axis];
                }
            }
            #[inline(always)]
            unsafe fn scatter_pair(
                of_a: *mut Force<Self>,
                a: *const u32,
                of_b: *mut Force<Self>,
                b: *const u32,
                value: [Self; 3],
            ) {
                let [x, y, z] = value;
                // SAFETY: the caller vouches for the indices; the two references do not live at the same time.
                unsafe {
                    Self::scatter(of_a, a, value);
                    Self::scatter(of_b, b, [-x, -y, -z]);
                }
            }
            #[inline(always)]
            unsafe fn scatter_contact<const MODE: u8>(
                of_a: *mut Force<Self>,
                a: *const u32,
                of_b: *mut Force<Self>,
                b: *const u32,
                force: [Self; 3],
                torque_a: [Self; 3],
                torque_b: [Self; 3],
            ) {
                let [x, y, z] = force;
                // SAFETY: as for `scatter_pair`.
                unsafe {
                    Self::scatter_both(of_a, a, force, torque_a);
                    Self::scatter_both(
                        of_b,
                        b,
                        [-x, -y, -z],
                        if MODE == OTHER { torque_b } else { torque_a },
                    );
                }
            }
            #[inline(always)]
            unsafe fn scatter_both(
                forces: *mut Force<Self>,
                at: *const u32,
                force: [Self; 3],
                torque: [Self; 3],
            ) {
                // SAFETY: as for `scatter`.
                unsafe { Self::scatter(forces, at, force) };
                // SAFETY: as for `scatter`.
                let numbers = unsafe { &mut (*forces.wrapping_add(*at as usize)).numbers };
                for axis in 0..3 {
                    numbers[Self::TORQUE + axis] += torque[axis];
                }
            }
        }
    };
}

scalar!(f64, gauge_double, meet_double);
scalar!(f32, gauge_single, meet_single);

/// The square is all there is to know.
#[inline(always)]
fn gauge_double(square: f64, _: f64, _: f64) -> [f64; 2] {
    [square; 2]
}

/// Overlap and 1/distance; root and quotient side by side rather than one after the other.
#[inline(always)]
fn meet_double([square, _]: [f64; 2], radius_a: f64, radius_b: f64) -> [f64; 2] {
    let (distance, inverse_square) = (square.sqrt(), 1.0 / square);
    [(radius_a + radius_b) - distance, distance * inverse_square]
}

/// The square, and d² − D²: in single precision reach − distance would be rounded to 1e-7 of the distance, more than
/// some overlaps; the difference of squares is exact where it is taken, in double precision.
#[inline(always)]
fn gauge_single(square: f64, radius_a: f32, radius_b: f32) -> [f32; 2] {
    let reach = f64::from(radius_a) + f64::from(radius_b);
    [f32::of(square), f32::of((-reach).mul_add(reach, square))]
}

/// Overlap and 1/distance.
#[inline(always)]
fn meet_single([square, gap]: [f32; 2], radius_a: f32, radius_b: f32) -> [f32; 2] {
    let (distance, inverse_square) = (square.sqrt(), 1.0 / square);
    [-gap / (distance + (radius_a + radius_b)), distance * inverse_square]
}

impl Real for f64 {
    #[cfg(target_arch = "x86_64")]
    type Fast = super::Avx2;
    #[cfg(not(target_arch = "x86_64"))]
    type Fast = Self;
    #[cfg(target_arch = "x86_64")]
    type Fastest = super::Avx512;
    #[cfg(not(target_arch = "x86_64"))]
    type Fastest = Self;
}

impl Real for f32 {
    #[cfg(target_arch = "x86_64")]
    type Fast = super::Avx2Single;
    #[cfg(not(target_arch = "x86_64"))]
    type Fast = Self;
    #[cfg(target_arch = "x86_64")]
    type Fastest = super::Avx512Single;
    #[cfg(not(target_arch = "x86_64"))]
    type Fastest = Self;
}
