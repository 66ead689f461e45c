//! Two dimensions.

use super::{Space, V1, V2};
use crate::lane::Lane;

/// Discs in the plane; a spin is a number, positive from x to y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Planar;

impl Space for Planar {
    const DIMENSION: usize = 2;
    type Vector<L: Lane> = V2<L>;
    type Spin<L: Lane> = V1<L>;

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
    #[inline(always)]
    fn spin_cross<L: Lane>(spin: V1<L>, arm: V2<L>) -> V2<L> {
        let omega = spin.0[0];
        V2([L::splat(0.0).sub(omega.mul(arm.0[1])), omega.mul(arm.0[0])])
    }
    #[inline(always)]
    fn moment<L: Lane>(arm: V2<L>, force: V2<L>) -> V1<L> {
        V1([arm.0[1].neg_mul_add(force.0[0], arm.0[0].mul(force.0[1]))])
    }
    #[inline(always)]
    fn turn<L: Lane>(_: V2<L>, _: V1<L>, _: L) -> L {
        L::splat(0.0)
    }
    #[inline(always)]
    fn twist<L: Lane>(tangent: V2<L>, _: V2<L>, _: L) -> V2<L> {
        tangent
    }
}
