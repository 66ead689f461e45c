//! Two dimensions.

use super::{Passing, Space, V1, V2, Vector};
use std::marker::PhantomData;

use crate::lane::{Lane, Real};
use crate::state::Body;

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

    fn body(position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]) -> Body<R> {
        Body {
            aligned: [],
            position: [position[0], position[1], 0.0, 0.0],
            velocity: [velocity[0], velocity[1], spin[2], 0.0].map(R::of),
            spin: [R::default(); 4],
        }
    }
    fn motion(body: &Body<R>) -> ([f64; 3], [f64; 3]) {
        let [u, v, spin, _] = body.velocity.map(R::into);
        ([u, v, 0.0], [0.0, 0.0, spin])
    }
    const SPIN_ROW: usize = 1;
}
