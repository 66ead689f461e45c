//! Three dimensions.

use super::{Space, V3, Vector};
use crate::lane::Lane;

/// Spheres in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spatial;

/// a × b.
#[inline(always)]
fn cross<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    let ([ax, ay, az], [bx, by, bz]) = (a.0, b.0);
    V3([az.neg_mul_add(by, ay.mul(bz)), ax.neg_mul_add(bz, az.mul(bx)), ay.neg_mul_add(bx, ax.mul(by))])
}

impl Space for Spatial {
    const DIMENSION: usize = 3;
    type Vector<L: Lane> = V3<L>;
    type Spin<L: Lane> = V3<L>;

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
    #[inline(always)]
    fn spin_cross<L: Lane>(spin: V3<L>, arm: V3<L>) -> V3<L> {
        cross(spin, arm)
    }
    #[inline(always)]
    fn moment<L: Lane>(arm: V3<L>, force: V3<L>) -> V3<L> {
        cross(arm, force)
    }
    #[inline(always)]
    fn turn<L: Lane>(normal: V3<L>, spin: V3<L>, dt: L) -> L {
        spin.dot(normal).mul(dt)
    }
    #[inline(always)]
    fn twist<L: Lane>(tangent: V3<L>, normal: V3<L>, angle: L) -> V3<L> {
        // t + θ n × t − θ²/2 t
        let turned = tangent.add_scaled(angle, cross(normal, tangent));
        turned.sub_scaled(angle.mul(angle).mul(L::splat(0.5)), tangent)
    }
}
