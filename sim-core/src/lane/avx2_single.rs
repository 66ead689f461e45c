//! Eight `f32` at a time with AVX2 and FMA; positions are two registers of `f64`.
//!
//! See [`super::Avx2`] for the rules of use; no closures, which are not always inlined into a caller with the features. A body is 32 bytes of position and 32 of velocity and spin, so whatever two
//! bodies do past each other takes one look at each; force and torque are 32 bytes, so both are added in one go.

use std::arch::x86_64::{
    __m128, __m256, _CMP_LT_OQ, _mm_add_ps, _mm_load_ps, _mm_store_ps, _mm_sub_ps, _mm256_add_ps,
    _mm256_and_ps, _mm256_andnot_ps, _mm256_blendv_ps, _mm256_castps256_ps128, _mm256_cmp_ps,
    _mm256_cvtpd_ps, _mm256_cvtps_pd, _mm256_div_ps, _mm256_extractf128_ps, _mm256_fmadd_ps,
    _mm256_fnmadd_ps, _mm256_load_ps, _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps,
    _mm256_mul_ps, _mm256_permute2f128_ps, _mm256_set_m128, _mm256_set1_ps, _mm256_setzero_ps,
    _mm256_shuffle_ps, _mm256_sqrt_ps, _mm256_store_ps, _mm256_storeu_ps, _mm256_sub_ps, _mm256_unpackhi_ps,
    _mm256_unpacklo_ps, _mm256_xor_ps,
};

use super::vector::one_instruction_each;
use super::{Avx2, Gather, Lane, OTHER, Two, Widen};
use crate::state::{Body, Force};

/// Eight floats in one register.
#[derive(Clone, Copy)]
pub struct Avx2Single(pub(super) __m256);

/// Sign bits of the first four.
const LOWER: [f32; 8] = [-0.0, -0.0, -0.0, -0.0, 0.0, 0.0, 0.0, 0.0];

impl Avx2Single {
    /// Velocity and spin of a body, four numbers each.
    #[inline(always)]
    unsafe fn motion_row(bodies: *const Body<f32>, index: *const u32) -> *const f32 {
        // SAFETY: a body is four doubles and eight floats; the caller vouches for the index.
        unsafe { bodies.add(*index as usize).cast::<f32>().add(8) }
    }

    /// One record of bodies l and l + 4.
    #[inline(always)]
    unsafe fn halves<const FIELD: usize>(bodies: *const Body<f32>, at: *const u32) -> __m256 {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let (low, high) = (Self::motion_row(bodies, at), Self::motion_row(bodies, at.add(4)));
            let shift = (FIELD - 1) * 4;
            _mm256_set_m128(_mm_load_ps(high.add(shift)), _mm_load_ps(low.add(shift)))
        }
    }

    /// One record of eight bodies, two to a row.
    #[inline(always)]
    unsafe fn four_halves<const FIELD: usize>(bodies: *const Body<f32>, at: *const u32) -> [__m256; 4] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            [
                Self::halves::<FIELD>(bodies, at),
                Self::halves::<FIELD>(bodies, at.add(1)),
                Self::halves::<FIELD>(bodies, at.add(2)),
                Self::halves::<FIELD>(bodies, at.add(3)),
            ]
        }
    }

    /// v_b − v_a and ω_b + ω_a of one pair.
    #[inline(always)]
    unsafe fn motion_of_pair(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> __m256 {
        // SAFETY: the caller vouches for the indices; these rows are 32-byte aligned.
        unsafe {
            let lower = _mm256_loadu_ps(LOWER.as_ptr());
            let of_a = _mm256_xor_ps(lower, _mm256_load_ps(Self::motion_row(bodies, a)));
            _mm256_add_ps(of_a, _mm256_load_ps(Self::motion_row(bodies, b)))
        }
    }

    /// The same of four pairs.
    #[inline(always)]
    unsafe fn four_motions(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [__m256; 4] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            [
                Self::motion_of_pair(bodies, a, b),
                Self::motion_of_pair(bodies, a.add(1), b.add(1)),
                Self::motion_of_pair(bodies, a.add(2), b.add(2)),
                Self::motion_of_pair(bodies, a.add(3), b.add(3)),
            ]
        }
    }

    #[inline(always)]
    fn three([x, y, z]: [__m256; 3]) -> [Self; 3] {
        [Self(x), Self(y), Self(z)]
    }

    /// Four rows to three columns, in both halves (the fourth is not used).
    #[inline(always)]
    fn columns([r0, r1, r2, r3]: [__m256; 4]) -> [__m256; 3] {
        // SAFETY: values of this type only exist where AVX2 was detected.
        unsafe {
            let (xy01, z01) = (_mm256_unpacklo_ps(r0, r1), _mm256_unpackhi_ps(r0, r1));
            let (xy23, z23) = (_mm256_unpacklo_ps(r2, r3), _mm256_unpackhi_ps(r2, r3));
            [
                _mm256_shuffle_ps::<0x44>(xy01, xy23),
                _mm256_shuffle_ps::<0xEE>(xy01, xy23),
                _mm256_shuffle_ps::<0x44>(z01, z23),
            ]
        }
    }

    /// Three columns to four rows, in both halves; fourth component +0.
    #[inline(always)]
    fn rows([x, y, z]: [__m256; 3]) -> [__m256; 4] {
        // SAFETY: see `columns`.
        unsafe {
            let zero = _mm256_setzero_ps();
            let (xy01, xy23) = (_mm256_unpacklo_ps(x, y), _mm256_unpackhi_ps(x, y));
            let (z01, z23) = (_mm256_unpacklo_ps(z, zero), _mm256_unpackhi_ps(z, zero));
            [
                _mm256_shuffle_ps::<0x44>(xy01, z01),
                _mm256_shuffle_ps::<0xEE>(xy01, z01),
                _mm256_shuffle_ps::<0x44>(xy23, z23),
                _mm256_shuffle_ps::<0xEE>(xy23, z23),
            ]
        }
    }

    /// Rows of four, contact after contact.
    #[inline(always)]
    pub(super) fn records([x, y, z]: [Self; 3]) -> [__m128; 8] {
        let [r0, r1, r2, r3] = Self::rows([x.0, y.0, z.0]);
        // SAFETY: see `columns`.
        unsafe {
            [
                _mm256_castps256_ps128(r0),
                _mm256_castps256_ps128(r1),
                _mm256_castps256_ps128(r2),
                _mm256_castps256_ps128(r3),
                _mm256_extractf128_ps::<1>(r0),
                _mm256_extractf128_ps::<1>(r1),
                _mm256_extractf128_ps::<1>(r2),
                _mm256_extractf128_ps::<1>(r3),
            ]
        }
    }

    /// Rows of eight, force and torque, contact after contact.
    #[inline(always)]
    fn force_rows(force: [Self; 3], torque: [Self; 3]) -> [__m256; 8] {
        // SAFETY: see `columns`.
        unsafe {
            let ([x, y, z], [u, v, w]) = (force, torque);
            let [r0, r1, r2, r3] = Self::rows([
                _mm256_permute2f128_ps::<0x20>(x.0, u.0),
                _mm256_permute2f128_ps::<0x20>(y.0, v.0),
                _mm256_permute2f128_ps::<0x20>(z.0, w.0),
            ]);
            let [r4, r5, r6, r7] = Self::rows([
                _mm256_permute2f128_ps::<0x31>(x.0, u.0),
                _mm256_permute2f128_ps::<0x31>(y.0, v.0),
                _mm256_permute2f128_ps::<0x31>(z.0, w.0),
            ]);
            [r0, r1, r2, r3, r4, r5, r6, r7]
        }
    }
}

impl Lane for Avx2Single {
    type Scalar = f32;
    type Mask = Self;
    const WIDTH: usize = 8;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: only called where AVX2 was detected; so for every method below.
        Self(unsafe { _mm256_set1_ps(value as f32) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_blendv_ps(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn keep(self, mask: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_and_ps(self.0, mask.0) })
    }
    #[inline(always)]
    fn both(a: Self, b: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_and_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn any(mask: Self) -> bool {
        // SAFETY: see `splat`.
        unsafe { _mm256_movemask_ps(mask.0) != 0 }
    }

    one_instruction_each!(
        _mm256_add_ps,
        _mm256_sub_ps,
        _mm256_mul_ps,
        _mm256_div_ps,
        _mm256_fmadd_ps,
        _mm256_fnmadd_ps,
        _mm256_sqrt_ps,
        _mm256_max_ps,
        _mm256_min_ps,
        _mm256_loadu_ps,
        _mm256_storeu_ps
    );
}

impl Widen for Avx2Single {
    type Wide = Two<Avx2>;

    #[inline(always)]
    fn narrow(wide: Two<Avx2>) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(wide.1.0), _mm256_cvtpd_ps(wide.0.0)) })
    }
    #[inline(always)]
    fn widen(self) -> Two<Avx2> {
        // SAFETY: see `splat`.
        unsafe {
            Two(
                Avx2(_mm256_cvtps_pd(_mm256_castps256_ps128(self.0))),
                Avx2(_mm256_cvtps_pd(_mm256_extractf128_ps::<1>(self.0))),
            )
        }
    }
    #[inline(always)]
    fn gauge(square: Two<Avx2>, radius_a: Self, radius_b: Self) -> [Self; 2] {
        let reach = radius_a.widen().add(radius_b.widen());
        [Self::narrow(square), Self::narrow(reach.neg_mul_add(reach, square))]
    }
    #[inline(always)]
    fn meet([square, gap]: [Self; 2], radius_a: Self, radius_b: Self) -> [Self; 2] {
        // The same operations as in the plain path, which says why.
        let (distance, inverse_square) = (square.sqrt(), Self::splat(1.0).div(square));
        let minus = Self::splat(-0.0);
        // SAFETY: see `splat`.
        let opposite = Self(unsafe { _mm256_xor_ps(gap.0, minus.0) });
        [opposite.div(distance.add(radius_a.add(radius_b))), distance.mul(inverse_square)]
    }
}

impl Gather for Avx2Single {
    #[inline(always)]
    unsafe fn gather(table: *const f64, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::narrow(Two(Avx2::gather(table, at), Avx2::gather(table, at.add(4)))) }
    }

    #[inline(always)]
    unsafe fn separation(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [Two<Avx2>; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = Avx2::rows_less::<f32, 0>(bodies, a, b);
            let [u, v, w] = Avx2::rows_less::<f32, 0>(bodies, a.add(4), b.add(4));
            [Two(x, u), Two(y, v), Two(z, w)]
        }
    }
    #[inline(always)]
    unsafe fn position(bodies: *const Body<f32>, a: *const u32) -> [Two<Avx2>; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = Avx2::row_of::<f32, 0>(bodies, a);
            let [u, v, w] = Avx2::row_of::<f32, 0>(bodies, a.add(4));
            [Two(x, u), Two(y, v), Two(z, w)]
        }
    }
    #[inline(always)]
    unsafe fn difference<const FIELD: usize>(
        bodies: *const Body<f32>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let ([p0, p1, p2, p3], [q0, q1, q2, q3]) =
                (Self::four_halves::<FIELD>(bodies, a), Self::four_halves::<FIELD>(bodies, b));
            Self::three(Self::columns([
                _mm256_sub_ps(q0, p0),
                _mm256_sub_ps(q1, p1),
                _mm256_sub_ps(q2, p2),
                _mm256_sub_ps(q3, p3),
            ]))
        }
    }
    #[inline(always)]
    unsafe fn motion(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [[Self; 3]; 2] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = Self::columns(Self::four_motions(bodies, a, b));
            let [u, v, w] = Self::columns(Self::four_motions(bodies, a.add(4), b.add(4)));
            [
                Self::three([
                    _mm256_permute2f128_ps::<0x20>(x, u),
                    _mm256_permute2f128_ps::<0x20>(y, v),
                    _mm256_permute2f128_ps::<0x20>(z, w),
                ]),
                Self::three([
                    _mm256_permute2f128_ps::<0x31>(x, u),
                    _mm256_permute2f128_ps::<0x31>(y, v),
                    _mm256_permute2f128_ps::<0x31>(z, w),
                ]),
            ]
        }
    }
    #[inline(always)]
    unsafe fn record<const FIELD: usize>(bodies: *const Body<f32>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::three(Self::columns(Self::four_halves::<FIELD>(bodies, a))) }
    }

    #[inline(always)]
    unsafe fn scatter(forces: *mut Force<f32>, at: *const u32, value: [Self; 3]) {
        // SAFETY: the caller vouches for the indices; a force is two rows of four floats.
        unsafe {
            let rows = Self::records(value);
            for lane in 0..8 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_add_ps(_mm_load_ps(to), rows[lane]));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_pair(
        of_a: *mut Force<f32>,
        a: *const u32,
        of_b: *mut Force<f32>,
        b: *const u32,
        value: [Self; 3],
    ) {
        let rows = Self::records(value);
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_add_ps(_mm_load_ps(to), rows[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_sub_ps(_mm_load_ps(to), rows[lane]));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_contact<const MODE: u8>(
        of_a: *mut Force<f32>,
        a: *const u32,
        of_b: *mut Force<f32>,
        b: *const u32,
        force: [Self; 3],
        torque_a: [Self; 3],
        torque_b: [Self; 3],
    ) {
        let on_a = Self::force_rows(force, torque_a);
        let on_b = if MODE == OTHER { Self::force_rows(force, torque_b) } else { on_a };
        // SAFETY: the caller vouches for the indices; a force is 32 bytes, aligned.
        unsafe {
            let lower = _mm256_loadu_ps(LOWER.as_ptr());
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f32>();
                _mm256_store_ps(to, _mm256_add_ps(_mm256_load_ps(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f32>();
                let on_b = _mm256_xor_ps(lower, on_b[lane]);
                _mm256_store_ps(to, _mm256_add_ps(_mm256_load_ps(to), on_b));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_both(forces: *mut Force<f32>, at: *const u32, force: [Self; 3], torque: [Self; 3]) {
        let rows = Self::force_rows(force, torque);
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..8 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f32>();
                _mm256_store_ps(to, _mm256_add_ps(_mm256_load_ps(to), rows[lane]));
            }
        }
    }
}
