//! Three dimensions.

use super::{Passing, Space, V3, Vector};
use std::marker::PhantomData;

use crate::lane::{Gather, Lane, NONE, Real};
use crate::state::{Body, Force};

/// Spheres in space; `R` is what velocities, forces and memories of contacts are kept in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spatial<R = f64>(PhantomData<R>);

/// How contact points slide past each other in space, at t_n − dt/2.
#[derive(Clone, Copy)]
pub struct SpatialSlide<L: Lane> {
    /// Velocity of the contact point of b minus that of a [d/τ]: the slip, and −u along the normal of that time.
    pub between: V3<L>,
    /// n − (dt/2) dn/dt: the normal of that time [1].
    pub normal_between: V3<L>,
    /// (ω·n) dt with the mean spin of the two bodies: angle by which the contact turns about its normal [1].
    pub turn: L,
}

/// a × b.
#[inline(always)]
pub fn cross<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    let ([ax, ay, az], [bx, by, bz]) = (a.0, b.0);
    V3([az.neg_mul_add(by, ay.mul(bz)), ax.neg_mul_add(bz, az.mul(bx)), ay.neg_mul_add(bx, ax.mul(by))])
}

/// start − a·b.
#[inline(always)]
pub fn sub_dot<L: Lane>(start: L, a: V3<L>, b: V3<L>) -> L {
    let ([ax, ay, az], [bx, by, bz]) = (a.0, b.0);
    az.neg_mul_add(bz, ay.neg_mul_add(by, ax.neg_mul_add(bx, start)))
}

/// start − a × b.
#[inline(always)]
fn sub_cross<L: Lane>(start: V3<L>, a: V3<L>, b: V3<L>) -> V3<L> {
    let ([x, y, z], [ax, ay, az], [bx, by, bz]) = (start.0, a.0, b.0);
    V3([
        az.mul_add(by, ay.neg_mul_add(bz, x)),
        ax.mul_add(bz, az.neg_mul_add(bx, y)),
        ay.mul_add(bx, ax.neg_mul_add(by, z)),
    ])
}

impl<R: Real> Space for Spatial<R> {
    type Real = R;
    const DIMENSION: usize = 3;
    const LATE_ROOTS: bool = false;
    type Vector<L: Lane> = V3<L>;
    type Spin<L: Lane> = V3<L>;
    /// n − (dt/2) dn/dt [1].
    type Across<L: Lane> = V3<L>;
    type Slide<L: Lane> = SpatialSlide<L>;
    type Shear<L: Lane> = V3<L>;

    #[inline(always)]
    fn vector<L: Lane>(record: [L; 3]) -> V3<L> {
        V3(record)
    }
    #[inline(always)]
    fn vector_record<L: Lane>(vector: V3<L>) -> [L; 3] {
        vector.0
    }
    #[inline(always)]
    fn spin<L: Lane>(record: [L; 3]) -> V3<L> {
        V3(record)
    }
    #[inline(always)]
    fn spin_record<L: Lane>(spin: V3<L>) -> [L; 3] {
        spin.0
    }

    /// With c = −v·n: dn/dt = (v + c n)/d, so u = c + (dt/2) (v² − c²)/d and n − (dt/2) dn/dt = (1 − c dt/2d) n − (dt/2d) v. v²
    /// beside c, not what is left of v without c n: the way from positions to forces is what a step waits for.
    #[inline(always)]
    fn approach<L: Lane>(normal: V3<L>, velocity: V3<L>, inverse_distance: L, half_dt: L) -> (L, V3<L>) {
        let zero = L::splat(0.0);
        let share = inverse_distance.mul(zero.sub(half_dt));
        let closing = sub_dot(zero, velocity, normal);
        let square_across = closing.neg_mul_add(closing, velocity.dot(velocity));
        let along = share.mul_add(closing, L::splat(1.0));
        let normal_between = velocity.scale(share).add_scaled(along, normal);
        (share.neg_mul_add(square_across, closing), normal_between)
    }
    #[inline(always)]
    fn slide<L: Lane>(passing: &Passing<Self, L>, rim: V3<L>) -> SpatialSlide<L> {
        let Passing { normal, velocity, across: normal_between, spin_sum, half_dt, .. } = *passing;
        let between = sub_cross(velocity, rim, normal_between);
        SpatialSlide { between, normal_between, turn: spin_sum.dot(normal).mul(half_dt) }
    }
    #[inline(always)]
    fn contact_force<L: Lane>(normal: V3<L>, push: L, shear: V3<L>) -> V3<L> {
        shear.sub_scaled(push, normal)
    }
    #[inline(always)]
    fn couple<L: Lane>(normal: V3<L>, shear: V3<L>) -> V3<L> {
        cross(normal, shear)
    }
    #[inline(always)]
    fn limit_moment<L: Lane>(moment: V3<L>, bound: L) -> V3<L> {
        let square = moment.dot(moment);
        let slipping = bound.mul(bound).less(square);
        if L::any(slipping) {
            moment.scale(L::select(slipping, bound.div(square.sqrt()), L::splat(1.0)))
        } else {
            moment
        }
    }
    #[inline(always)]
    fn shear_vector<L: Lane>(_: V3<L>, shear: V3<L>) -> V3<L> {
        shear
    }

    type Body = Body<R>;
    type Force = Force<R>;

    #[inline(always)]
    unsafe fn separation<L: Gather<Scalar = R>>(
        bodies: *const Body<R>,
        a: *const u32,
        b: *const u32,
    ) -> V3<L::Wide> {
        // SAFETY: the caller vouches for the indices; so throughout.
        V3(unsafe { L::separation(bodies, a, b) })
    }
    #[inline(always)]
    unsafe fn velocity<L: Gather<Scalar = R>>(bodies: *const Body<R>, a: *const u32, b: *const u32) -> V3<L> {
        // SAFETY: see `separation`.
        V3(unsafe { L::difference::<1>(bodies, a, b) })
    }
    #[inline(always)]
    unsafe fn motion<L: Gather<Scalar = R>>(
        bodies: *const Body<R>,
        a: *const u32,
        b: *const u32,
    ) -> (V3<L>, V3<L>) {
        // SAFETY: see `separation`.
        let [velocity, spin_sum] = unsafe { L::motion(bodies, a, b) };
        (V3(velocity), V3(spin_sum))
    }
    #[inline(always)]
    unsafe fn spins<L: Gather<Scalar = R>>(bodies: *const Body<R>, at: *const u32) -> V3<L> {
        // SAFETY: see `separation`.
        V3(unsafe { L::record::<2>(bodies, at) })
    }
    #[inline(always)]
    unsafe fn places<L: Gather<Scalar = R>>(
        bodies: *const Body<R>,
        at: *const u32,
    ) -> ([L::Wide; 3], [L; 3]) {
        // SAFETY: see `separation`.
        unsafe { (L::position(bodies, at), L::record::<1>(bodies, at)) }
    }
    #[inline(always)]
    unsafe fn scatter<L: Gather<Scalar = R>, const SPIN: bool>(
        forces: *mut Force<R>,
        at: *const u32,
        force: V3<L>,
        torque: V3<L>,
    ) {
        // SAFETY: see `separation`.
        unsafe {
            if SPIN {
                L::scatter_both(forces, at, force.0, torque.0);
            } else {
                L::scatter(forces, at, force.0);
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_pair<L: Gather<Scalar = R>, const TORQUES: u8>(
        of_a: *mut Force<R>,
        a: *const u32,
        of_b: *mut Force<R>,
        b: *const u32,
        force: V3<L>,
        torques: [V3<L>; 2],
    ) {
        // SAFETY: see `separation`.
        unsafe {
            if TORQUES == NONE {
                L::scatter_pair(of_a, a, of_b, b, force.0);
            } else {
                L::scatter_contact::<TORQUES>(of_a, a, of_b, b, force.0, torques[0].0, torques[1].0);
            }
        }
    }
}
