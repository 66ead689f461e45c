//! Sixteen `f32` at a time with AVX-512 and FMA; positions are two registers of `f64`.
//!
//! See [`super::Avx512`] for the rules of use, [`super::Avx2Single`] for the records. Registers hold rows of force and torque, or of
//! velocity and spin, of contacts l and l + 4 side by side; single rows of four numbers of contacts l, l + 4, l + 8 and l + 12.

use std::arch::x86_64::{
    __m128, __m256, __m512, __mmask16, _CMP_LT_OQ, _mm_add_ps, _mm_load_ps, _mm_store_ps, _mm_sub_ps,
    _mm256_add_ps, _mm256_fmadd_ps, _mm256_load_ps, _mm256_set_m128, _mm256_setr_ps, _mm256_store_ps,
    _mm512_abs_ps, _mm512_add_ps, _mm512_castps256_ps512, _mm512_castps512_ps128, _mm512_castps512_ps256,
    _mm512_cmp_ps_mask, _mm512_cvtpd_ps, _mm512_cvtps_pd, _mm512_div_ps, _mm512_extractf32x4_ps,
    _mm512_extractf32x8_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps, _mm512_insertf32x8, _mm512_loadu_ps,
    _mm512_mask_blend_ps, _mm512_maskz_mov_ps, _mm512_max_ps, _mm512_min_ps, _mm512_mul_ps,
    _mm512_permutex2var_ps, _mm512_set1_ps, _mm512_setr_epi32, _mm512_setr_ps, _mm512_setzero_ps,
    _mm512_shuffle_f32x4, _mm512_shuffle_ps, _mm512_sqrt_ps, _mm512_storeu_ps, _mm512_sub_ps,
    _mm512_unpackhi_ps, _mm512_unpacklo_ps, _mm512_xor_ps,
};

use super::vector::one_instruction_each;
use super::{Avx512, Gather, Lane, OTHER, Two, Widen};
use crate::state::{Body, Force};

/// Sixteen floats in one register.
#[derive(Clone, Copy)]
pub struct Avx512Single(pub(super) __m512);

/// Two rows side by side.
#[inline(always)]
pub(super) fn beside(low: __m256, high: __m256) -> __m512 {
    // SAFETY: only called where AVX-512 was detected; so for every function below.
    unsafe { _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high) }
}

/// Rows of four numbers: four registers to three columns, in every quarter (the fourth is not used).
#[inline(always)]
fn columns([r0, r1, r2, r3]: [__m512; 4]) -> [__m512; 3] {
    // SAFETY: see `beside`.
    unsafe {
        let (xy01, z01) = (_mm512_unpacklo_ps(r0, r1), _mm512_unpackhi_ps(r0, r1));
        let (xy23, z23) = (_mm512_unpacklo_ps(r2, r3), _mm512_unpackhi_ps(r2, r3));
        [
            _mm512_shuffle_ps::<0x44>(xy01, xy23),
            _mm512_shuffle_ps::<0xEE>(xy01, xy23),
            _mm512_shuffle_ps::<0x44>(z01, z23),
        ]
    }
}

/// Three columns to rows of four numbers, in every quarter; fourth component +0.
#[inline(always)]
fn rows([x, y, z]: [__m512; 3]) -> [__m512; 4] {
    // SAFETY: see `beside`.
    unsafe {
        let zero = _mm512_setzero_ps();
        let (xy01, xy23) = (_mm512_unpacklo_ps(x, y), _mm512_unpackhi_ps(x, y));
        let (z01, z23) = (_mm512_unpacklo_ps(z, zero), _mm512_unpackhi_ps(z, zero));
        [
            _mm512_shuffle_ps::<0x44>(xy01, z01),
            _mm512_shuffle_ps::<0xEE>(xy01, z01),
            _mm512_shuffle_ps::<0x44>(xy23, z23),
            _mm512_shuffle_ps::<0xEE>(xy23, z23),
        ]
    }
}

/// Velocity and spin of a body, four numbers each.
///
/// # Safety
/// `index` points to the index of a body.
#[inline(always)]
unsafe fn motion_row(bodies: *const Body<f32>, index: *const u32) -> *const f32 {
    // SAFETY: a body is four doubles and eight floats; the caller vouches for the index.
    unsafe { bodies.add(*index as usize).cast::<f32>().add(8) }
}

/// Velocity and spin of bodies l and l + 4.
///
/// # Safety
/// `at` points to five indices of bodies.
#[inline(always)]
unsafe fn two_motions(bodies: *const Body<f32>, at: *const u32) -> __m512 {
    // SAFETY: the caller vouches for the indices; these rows are 32-byte aligned.
    unsafe { beside(_mm256_load_ps(motion_row(bodies, at)), _mm256_load_ps(motion_row(bodies, at.add(4)))) }
}

/// v_b − v_a and ω_b + ω_a of pairs l and l + 4.
///
/// # Safety
/// `a` and `b` point to five indices of bodies.
#[inline(always)]
unsafe fn motion_of_two(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> __m512 {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        // Times ±1 and a sum rounded once is a difference or a sum.
        let signs = _mm512_setr_ps(
            -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0,
        );
        _mm512_fmadd_ps(two_motions(bodies, a), signs, two_motions(bodies, b))
    }
}

/// The same of eight pairs, two to a row.
///
/// # Safety
/// `a` and `b` point to eight indices of bodies.
#[inline(always)]
unsafe fn motion_of_eight(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [__m512; 4] {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        [
            motion_of_two(bodies, a, b),
            motion_of_two(bodies, a.add(1), b.add(1)),
            motion_of_two(bodies, a.add(2), b.add(2)),
            motion_of_two(bodies, a.add(3), b.add(3)),
        ]
    }
}

/// One record of bodies l, l + 4, l + 8 and l + 12.
///
/// # Safety
/// `at` points to thirteen indices of bodies.
#[inline(always)]
unsafe fn quarters<const FIELD: usize>(bodies: *const Body<f32>, at: *const u32) -> __m512 {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        let shift = (FIELD - 1) * 4;
        let first = _mm_load_ps(motion_row(bodies, at).add(shift));
        let second = _mm_load_ps(motion_row(bodies, at.add(4)).add(shift));
        let third = _mm_load_ps(motion_row(bodies, at.add(8)).add(shift));
        let fourth = _mm_load_ps(motion_row(bodies, at.add(12)).add(shift));
        beside(_mm256_set_m128(second, first), _mm256_set_m128(fourth, third))
    }
}

/// One record of sixteen bodies, four to a row.
///
/// # Safety
/// `at` points to sixteen indices of bodies.
#[inline(always)]
unsafe fn four_quarters<const FIELD: usize>(bodies: *const Body<f32>, at: *const u32) -> [__m512; 4] {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        [
            quarters::<FIELD>(bodies, at),
            quarters::<FIELD>(bodies, at.add(1)),
            quarters::<FIELD>(bodies, at.add(2)),
            quarters::<FIELD>(bodies, at.add(3)),
        ]
    }
}

/// Quarters 0 and 1 of one and the other in turn: a0 b0 a1 b1.
#[inline(always)]
fn first_quarters(a: __m512, b: __m512) -> __m512 {
    // SAFETY: see `beside`.
    unsafe {
        let order = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
        _mm512_permutex2var_ps(a, order, b)
    }
}

/// Quarters 2 and 3: a2 b2 a3 b3.
#[inline(always)]
fn last_quarters(a: __m512, b: __m512) -> __m512 {
    // SAFETY: see `beside`.
    unsafe {
        let order = _mm512_setr_epi32(8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
        _mm512_permutex2var_ps(a, order, b)
    }
}

/// Rows of eight, force and torque, contact after contact.
#[inline(always)]
fn force_rows([x, y, z]: [Avx512Single; 3], [u, v, w]: [Avx512Single; 3]) -> [__m256; 16] {
    // SAFETY: see `beside`.
    unsafe {
        let [r0, r1, r2, r3] =
            rows([first_quarters(x.0, u.0), first_quarters(y.0, v.0), first_quarters(z.0, w.0)]);
        let [s0, s1, s2, s3] =
            rows([last_quarters(x.0, u.0), last_quarters(y.0, v.0), last_quarters(z.0, w.0)]);
        [
            _mm512_castps512_ps256(r0),
            _mm512_castps512_ps256(r1),
            _mm512_castps512_ps256(r2),
            _mm512_castps512_ps256(r3),
            _mm512_extractf32x8_ps::<1>(r0),
            _mm512_extractf32x8_ps::<1>(r1),
            _mm512_extractf32x8_ps::<1>(r2),
            _mm512_extractf32x8_ps::<1>(r3),
            _mm512_castps512_ps256(s0),
            _mm512_castps512_ps256(s1),
            _mm512_castps512_ps256(s2),
            _mm512_castps512_ps256(s3),
            _mm512_extractf32x8_ps::<1>(s0),
            _mm512_extractf32x8_ps::<1>(s1),
            _mm512_extractf32x8_ps::<1>(s2),
            _mm512_extractf32x8_ps::<1>(s3),
        ]
    }
}

/// Rows of four, contact after contact.
#[inline(always)]
pub(super) fn records([x, y, z]: [Avx512Single; 3]) -> [__m128; 16] {
    let [r0, r1, r2, r3] = rows([x.0, y.0, z.0]);
    // SAFETY: see `beside`.
    unsafe {
        [
            _mm512_castps512_ps128(r0),
            _mm512_castps512_ps128(r1),
            _mm512_castps512_ps128(r2),
            _mm512_castps512_ps128(r3),
            _mm512_extractf32x4_ps::<1>(r0),
            _mm512_extractf32x4_ps::<1>(r1),
            _mm512_extractf32x4_ps::<1>(r2),
            _mm512_extractf32x4_ps::<1>(r3),
            _mm512_extractf32x4_ps::<2>(r0),
            _mm512_extractf32x4_ps::<2>(r1),
            _mm512_extractf32x4_ps::<2>(r2),
            _mm512_extractf32x4_ps::<2>(r3),
            _mm512_extractf32x4_ps::<3>(r0),
            _mm512_extractf32x4_ps::<3>(r1),
            _mm512_extractf32x4_ps::<3>(r2),
            _mm512_extractf32x4_ps::<3>(r3),
        ]
    }
}

impl Lane for Avx512Single {
    type Scalar = f32;
    type Mask = __mmask16;
    const WIDTH: usize = 16;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: only called where AVX-512 was detected; so for every method below.
        Self(unsafe { _mm512_set1_ps(value as f32) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> __mmask16 {
        // SAFETY: see `splat`.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask16, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_mask_blend_ps(mask, no.0, yes.0) })
    }
    #[inline(always)]
    fn keep(self, mask: __mmask16) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_maskz_mov_ps(mask, self.0) })
    }
    #[inline(always)]
    fn both(a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }
    #[inline(always)]
    fn any(mask: __mmask16) -> bool {
        mask != 0
    }

    one_instruction_each!(
        _mm512_add_ps,
        _mm512_sub_ps,
        _mm512_mul_ps,
        _mm512_div_ps,
        _mm512_fmadd_ps,
        _mm512_fnmadd_ps,
        _mm512_sqrt_ps,
        _mm512_max_ps,
        _mm512_min_ps,
        _mm512_loadu_ps,
        _mm512_storeu_ps
    );
}

impl Widen for Avx512Single {
    type Wide = Two<Avx512>;

    #[inline(always)]
    fn narrow(wide: Two<Avx512>) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { beside(_mm512_cvtpd_ps(wide.0.0), _mm512_cvtpd_ps(wide.1.0)) })
    }
    #[inline(always)]
    fn widen(self) -> Two<Avx512> {
        // SAFETY: see `splat`.
        unsafe {
            Two(
                Avx512(_mm512_cvtps_pd(_mm512_castps512_ps256(self.0))),
                Avx512(_mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(self.0))),
            )
        }
    }
    #[inline(always)]
    fn gauge(square: Two<Avx512>, radius_a: Self, radius_b: Self) -> [Self; 2] {
        let reach = radius_a.widen().add(radius_b.widen());
        [Self::narrow(square), Self::narrow(reach.neg_mul_add(reach, square))]
    }
    #[inline(always)]
    fn meet([square, gap]: [Self; 2], radius_a: Self, radius_b: Self) -> [Self; 2] {
        // The same operations as in the plain path, which says why.
        let (distance, inverse_square) = (square.sqrt(), Self::splat(1.0).div(square));
        let minus = Self::splat(-0.0);
        // SAFETY: see `splat`.
        let opposite = Self(unsafe { _mm512_xor_ps(gap.0, minus.0) });
        [opposite.div(distance.add(radius_a.add(radius_b))), distance.mul(inverse_square)]
    }
}

impl Gather for Avx512Single {
    #[inline(always)]
    unsafe fn gather(table: *const f64, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::narrow(Two(Avx512::gather(table, at), Avx512::gather(table, at.add(8)))) }
    }
    #[inline(always)]
    unsafe fn separation(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [Two<Avx512>; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = Avx512::rows_less::<f32, 0>(bodies, a, b);
            let [u, v, w] = Avx512::rows_less::<f32, 0>(bodies, a.add(8), b.add(8));
            [Two(x, u), Two(y, v), Two(z, w)]
        }
    }
    #[inline(always)]
    unsafe fn position(bodies: *const Body<f32>, a: *const u32) -> [Two<Avx512>; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = Avx512::row_of::<f32, 0>(bodies, a);
            let [u, v, w] = Avx512::row_of::<f32, 0>(bodies, a.add(8));
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
                (four_quarters::<FIELD>(bodies, a), four_quarters::<FIELD>(bodies, b));
            let [x, y, z] = columns([
                _mm512_sub_ps(q0, p0),
                _mm512_sub_ps(q1, p1),
                _mm512_sub_ps(q2, p2),
                _mm512_sub_ps(q3, p3),
            ]);
            [Self(x), Self(y), Self(z)]
        }
    }
    #[inline(always)]
    unsafe fn motion(bodies: *const Body<f32>, a: *const u32, b: *const u32) -> [[Self; 3]; 2] {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y, z] = columns(motion_of_eight(bodies, a, b));
            let [u, v, w] = columns(motion_of_eight(bodies, a.add(8), b.add(8)));
            [
                [
                    Self(_mm512_shuffle_f32x4::<0x88>(x, u)),
                    Self(_mm512_shuffle_f32x4::<0x88>(y, v)),
                    Self(_mm512_shuffle_f32x4::<0x88>(z, w)),
                ],
                [
                    Self(_mm512_shuffle_f32x4::<0xDD>(x, u)),
                    Self(_mm512_shuffle_f32x4::<0xDD>(y, v)),
                    Self(_mm512_shuffle_f32x4::<0xDD>(z, w)),
                ],
            ]
        }
    }
    #[inline(always)]
    unsafe fn record<const FIELD: usize>(bodies: *const Body<f32>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        let [x, y, z] = unsafe { columns(four_quarters::<FIELD>(bodies, a)) };
        [Self(x), Self(y), Self(z)]
    }
    #[inline(always)]
    unsafe fn scatter(forces: *mut Force<f32>, at: *const u32, value: [Self; 3]) {
        let rows = records(value);
        // SAFETY: the caller vouches for the indices; a force is two rows of four floats.
        unsafe {
            for lane in 0..16 {
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
        let rows = records(value);
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..16 {
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
        let on_a = force_rows(force, torque_a);
        let on_b = if MODE == OTHER { force_rows(force, torque_b) } else { on_a };
        // SAFETY: the caller vouches for the indices; a force is 32 bytes, aligned.
        unsafe {
            let signs = _mm256_setr_ps(-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0);
            for lane in 0..16 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f32>();
                _mm256_store_ps(to, _mm256_add_ps(_mm256_load_ps(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f32>();
                _mm256_store_ps(to, _mm256_fmadd_ps(on_b[lane], signs, _mm256_load_ps(to)));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_both(forces: *mut Force<f32>, at: *const u32, force: [Self; 3], torque: [Self; 3]) {
        let rows = force_rows(force, torque);
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..16 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f32>();
                _mm256_store_ps(to, _mm256_add_ps(_mm256_load_ps(to), rows[lane]));
            }
        }
    }
}
