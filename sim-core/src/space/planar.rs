//! Two dimensions.

use super::{Passing, Space, V1, V2, Vector};
use std::marker::PhantomData;

use crate::lane::{Gather, Lane, Real, WIDEST};
use crate::state::{PlanarBody, PlanarForce};

/// Motion across the normal in the plane, along t = (−n_y, n_x).
#[derive(Clone, Copy)]
pub struct PlanarAcross<L> {
    /// w = v·t [d/τ].
    speed: L,
    /// Angle by which the normal turns in half a step [1].
    turn: L,
}

/// Discs in the plane; a spin is a number, positive from x to y. `R` is what velocities, forces and memories of contacts
/// are kept in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Planar<R = f64>(PhantomData<R>);

impl<R: Real> Space for Planar<R> {
    type Real = R;
    const DIMENSION: usize = 2;
    const LATE_ROOTS: bool = true;
    type Vector<L: Lane> = V2<L>;
    type Spin<L: Lane> = V1<L>;
    type Across<L: Lane> = PlanarAcross<L>;
    type Slide<L: Lane> = L;
    type Shear<L: Lane> = V1<L>;

    #[inline(always)]
    fn vector<L: Lane>(record: [L; 3]) -> V2<L> {
        V2([record[0], record[1]])
    }
    #[inline(always)]
    fn vector_record<L: Lane>(vector: V2<L>) -> [L; 3] {
        [vector.0[0], vector.0[1], L::splat(0.0)]
    }
    #[inline(always)]
    fn spin<L: Lane>(record: [L; 3]) -> V1<L> {
        V1([record[2]])
    }
    #[inline(always)]
    fn spin_record<L: Lane>(spin: V1<L>) -> [L; 3] {
        [L::splat(0.0), L::splat(0.0), spin.0[0]]
    }
    /// With w = v·t: dn/dt = (w/d) t, so u = −v·n + (dt/2) w²/d.
    #[inline(always)]
    fn approach<L: Lane>(
        normal: V2<L>,
        velocity: V2<L>,
        inverse_distance: L,
        half_dt: L,
    ) -> (L, PlanarAcross<L>) {
        let ([x, y], [u, v]) = (normal.0, velocity.0);
        let speed = u.neg_mul_add(y, v.mul(x));
        let turn = half_dt.mul(inverse_distance).mul(speed);
        let opening = velocity.dot(normal);
        (turn.mul(speed).sub(opening), PlanarAcross { speed, turn })
    }
    /// Along t: w − u (dt/2) w/d − rim; what the turned normal does to the rim is along n.
    #[inline(always)]
    fn slide<L: Lane>(passing: &Passing<Self, L>, rim: V1<L>) -> L {
        let PlanarAcross { speed, turn } = passing.across;
        passing.approach.neg_mul_add(turn, speed.sub(rim.0[0]))
    }
    #[inline(always)]
    fn contact_force<L: Lane>(normal: V2<L>, push: L, shear: V1<L>) -> V2<L> {
        let ([x, y], shear) = (normal.0, shear.0[0]);
        let zero = L::splat(0.0);
        V2([shear.neg_mul_add(y, zero.sub(push.mul(x))), push.neg_mul_add(y, shear.mul(x))])
    }
    #[inline(always)]
    fn couple<L: Lane>(_: V2<L>, shear: V1<L>) -> V1<L> {
        shear
    }
    #[inline(always)]
    fn limit_moment<L: Lane>(moment: V1<L>, bound: L) -> V1<L> {
        V1([moment.0[0].min(bound).max(L::splat(0.0).sub(bound))])
    }
    #[inline(always)]
    fn shear_vector<L: Lane>(normal: V2<L>, shear: V1<L>) -> V2<L> {
        let ([x, y], shear) = (normal.0, shear.0[0]);
        V2([L::splat(0.0).sub(shear.mul(y)), shear.mul(x)])
    }

    type Body = PlanarBody<R>;
    type Force = PlanarForce<R>;

    #[inline(always)]
    unsafe fn separation<L: Gather<Scalar = R>>(
        bodies: *const PlanarBody<R>,
        a: *const u32,
        b: *const u32,
    ) -> V2<L::Wide> {
        // SAFETY: the caller vouches for the indices; so throughout.
        V2(unsafe { L::discs_apart(bodies, a, b) }.0)
    }
    #[inline(always)]
    unsafe fn velocity<L: Gather<Scalar = R>>(
        bodies: *const PlanarBody<R>,
        a: *const u32,
        b: *const u32,
    ) -> V2<L> {
        // SAFETY: see `separation`.
        V2(unsafe { L::discs_apart(bodies, a, b) }.1)
    }
    #[inline(always)]
    unsafe fn motion<L: Gather<Scalar = R>>(
        bodies: *const PlanarBody<R>,
        a: *const u32,
        b: *const u32,
    ) -> (V2<L>, V1<L>) {
        // SAFETY: see `separation`.
        unsafe {
            let sum = L::disc_spins(bodies, a).add(L::disc_spins(bodies, b));
            (Self::velocity::<L>(bodies, a, b), V1([sum]))
        }
    }
    #[inline(always)]
    unsafe fn spins<L: Gather<Scalar = R>>(bodies: *const PlanarBody<R>, at: *const u32) -> V1<L> {
        // SAFETY: see `separation`.
        V1([unsafe { L::disc_spins(bodies, at) }])
    }
    /// Lane by lane: walls stand in space only.
    #[inline(always)]
    unsafe fn places<L: Gather<Scalar = R>>(
        bodies: *const PlanarBody<R>,
        at: *const u32,
    ) -> ([L::Wide; 3], [L; 3]) {
        let (mut positions, mut velocities) = ([[0.0; WIDEST]; 2], [[R::default(); WIDEST]; 2]);
        // SAFETY: see `separation`; no bundle is wider than the buffers.
        unsafe {
            for lane in 0..L::WIDTH {
                let body = &*bodies.add(*at.add(lane) as usize);
                for axis in 0..2 {
                    positions[axis][lane] = body.position[axis];
                    velocities[axis][lane] = body.motion[axis];
                }
            }
            let ([x, y], [u, v]) = (positions, velocities);
            (
                [L::Wide::load(x.as_ptr()), L::Wide::load(y.as_ptr()), L::Wide::splat(0.0)],
                [L::load(u.as_ptr()), L::load(v.as_ptr()), L::splat(0.0)],
            )
        }
    }
    #[inline(always)]
    unsafe fn scatter<L: Gather<Scalar = R>, const SPIN: bool>(
        forces: *mut PlanarForce<R>,
        at: *const u32,
        force: V2<L>,
        torque: V1<L>,
    ) {
        let mut columns = [[R::default(); WIDEST]; 3];
        // SAFETY: see `separation`; no bundle is wider than the buffers.
        unsafe {
            for (column, part) in columns.iter_mut().zip([force.0[0], force.0[1], torque.0[0]]) {
                part.store(column.as_mut_ptr());
            }
            for lane in 0..L::WIDTH {
                let numbers = &mut (*forces.wrapping_add(*at.add(lane) as usize)).numbers;
                for (number, column) in numbers.iter_mut().zip(&columns) {
                    *number = number.add(column[lane]);
                }
            }
        }
    }
    /// Force and torque lie in one row, so torques cost nothing.
    #[inline(always)]
    unsafe fn scatter_pair<L: Gather<Scalar = R>, const TORQUES: u8>(
        of_a: *mut PlanarForce<R>,
        a: *const u32,
        of_b: *mut PlanarForce<R>,
        b: *const u32,
        force: V2<L>,
        torques: [V1<L>; 2],
    ) {
        let [on_a, on_b] = torques;
        // SAFETY: see `separation`.
        unsafe { L::scatter_discs(of_a, a, of_b, b, force.0, on_a.0[0], on_b.0[0]) };
    }
}
