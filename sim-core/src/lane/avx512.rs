//! Eight numbers at a time with AVX-512 (F, VL, DQ, BW) and FMA.
//!
//! See [`super::Avx2`] for the rules of use: methods melt into a caller that enables the features; no closures. Bodies are read and forces
//! written as there, 32 bytes a row; registers hold the rows of contacts l and l + 4 side by side.

use std::arch::x86_64::{
    __m128d, __m256d, __m512d, __mmask8, _CMP_LT_OQ, _mm_add_pd, _mm_load_pd, _mm_store_pd, _mm256_add_pd,
    _mm256_fmadd_pd, _mm256_load_pd, _mm256_setr_pd, _mm256_store_pd, _mm256_sub_pd, _mm512_abs_pd,
    _mm512_add_pd, _mm512_castpd256_pd512, _mm512_castpd512_pd128, _mm512_castpd512_pd256,
    _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_extractf64x2_pd, _mm512_extractf64x4_pd, _mm512_fmadd_pd,
    _mm512_fnmadd_pd, _mm512_insertf64x4, _mm512_loadu_pd, _mm512_mask_blend_pd, _mm512_maskz_mov_pd,
    _mm512_max_pd, _mm512_min_pd, _mm512_mul_pd, _mm512_permutex2var_pd, _mm512_set1_pd, _mm512_setr_epi64,
    _mm512_setzero_pd, _mm512_sqrt_pd, _mm512_storeu_pd, _mm512_sub_pd, _mm512_unpackhi_pd,
    _mm512_unpacklo_pd,
};

use super::vector::{one_instruction_each, wide_already};
use super::{Gather, Lane, Number, OTHER, Widen};
use crate::state::{Body, Force};

/// Eight doubles in one register.
#[derive(Clone, Copy)]
pub struct Avx512(pub(super) __m512d);

/// Doubles per row of a record.
const ROW: usize = 4;

/// Two rows side by side.
#[inline(always)]
pub(super) fn beside(low: __m256d, high: __m256d) -> __m512d {
    // SAFETY: only called where AVX-512 was detected; so for every function below.
    unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high) }
}

/// The first row of two.
#[inline(always)]
fn low(rows: __m512d) -> __m256d {
    // SAFETY: see `beside`.
    unsafe { _mm512_castpd512_pd256(rows) }
}

/// The second one.
#[inline(always)]
fn high(rows: __m512d) -> __m256d {
    // SAFETY: see `beside`.
    unsafe { _mm512_extractf64x4_pd::<1>(rows) }
}

/// Pairs 0 and 2 of one and the other in turn: a0 b0 a2 b2.
#[inline(always)]
pub(super) fn even_pairs(a: __m512d, b: __m512d) -> __m512d {
    // SAFETY: see `beside`.
    unsafe { _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), b) }
}

/// Pairs 1 and 3: a1 b1 a3 b3.
#[inline(always)]
pub(super) fn odd_pairs(a: __m512d, b: __m512d) -> __m512d {
    // SAFETY: see `beside`.
    unsafe { _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15), b) }
}

/// Row `FIELD` of bodies l and l + 4.
///
/// # Safety
/// `at` points to five indices of bodies.
#[inline(always)]
unsafe fn two_rows<T: Number, const FIELD: usize>(bodies: *const Body<T>, at: *const u32) -> __m512d {
    // SAFETY: a body of doubles is three aligned rows of four, of others the first one is; the caller vouches for the indices.
    unsafe {
        let first = bodies.add(*at as usize).cast::<f64>().add(FIELD * ROW);
        let second = bodies.add(*at.add(ROW) as usize).cast::<f64>().add(FIELD * ROW);
        beside(_mm256_load_pd(first), _mm256_load_pd(second))
    }
}

/// Four registers of two rows to three columns (the fourth is not used).
#[inline(always)]
fn columns(r0: __m512d, r1: __m512d, r2: __m512d, r3: __m512d) -> [Avx512; 3] {
    // SAFETY: see `beside`.
    unsafe {
        let (xz01, yw01) = (_mm512_unpacklo_pd(r0, r1), _mm512_unpackhi_pd(r0, r1));
        let (xz23, yw23) = (_mm512_unpacklo_pd(r2, r3), _mm512_unpackhi_pd(r2, r3));
        [Avx512(even_pairs(xz01, xz23)), Avx512(even_pairs(yw01, yw23)), Avx512(odd_pairs(xz01, xz23))]
    }
}

/// Four columns to rows, those of contacts l and l + 4 in register l.
#[inline(always)]
pub(super) fn rows(x: Avx512, y: Avx512, z: Avx512, w: Avx512) -> [__m512d; 4] {
    // SAFETY: see `beside`.
    unsafe {
        let (xy02, xy13) = (_mm512_unpacklo_pd(x.0, y.0), _mm512_unpackhi_pd(x.0, y.0));
        let (zw02, zw13) = (_mm512_unpacklo_pd(z.0, w.0), _mm512_unpackhi_pd(z.0, w.0));
        [even_pairs(xy02, zw02), even_pairs(xy13, zw13), odd_pairs(xy02, zw02), odd_pairs(xy13, zw13)]
    }
}

/// The same, contact after contact.
#[inline(always)]
pub(super) fn single_rows([r0, r1, r2, r3]: [__m512d; 4]) -> [__m256d; 8] {
    [low(r0), low(r1), low(r2), low(r3), high(r0), high(r1), high(r2), high(r3)]
}

/// Two columns to half rows, contact after contact.
#[inline(always)]
fn half_rows(v: Avx512, w: Avx512) -> [__m128d; 8] {
    // SAFETY: see `beside`.
    unsafe {
        let (even, odd) = (_mm512_unpacklo_pd(v.0, w.0), _mm512_unpackhi_pd(v.0, w.0));
        [
            _mm512_castpd512_pd128(even),
            _mm512_castpd512_pd128(odd),
            _mm512_extractf64x2_pd::<1>(even),
            _mm512_extractf64x2_pd::<1>(odd),
            _mm512_extractf64x2_pd::<2>(even),
            _mm512_extractf64x2_pd::<2>(odd),
            _mm512_extractf64x2_pd::<3>(even),
            _mm512_extractf64x2_pd::<3>(odd),
        ]
    }
}

/// Adds half a row.
///
/// # Safety
/// `to` points to two aligned writable numbers.
#[inline(always)]
unsafe fn add_half(to: *mut f64, half: __m128d) {
    // SAFETY: the caller vouches.
    unsafe { _mm_store_pd(to, _mm_add_pd(_mm_load_pd(to), half)) };
}

impl Avx512 {
    /// Difference of one row of two bodies, b − a.
    ///
    /// # Safety
    /// `a` and `b` point to eight indices of bodies.
    #[inline(always)]
    pub(super) unsafe fn rows_less<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches.
        unsafe {
            let mut rows = [_mm512_setzero_pd(); 4];
            for lane in 0..4 {
                let of_a = two_rows::<T, FIELD>(bodies, a.add(lane));
                rows[lane] = _mm512_sub_pd(two_rows::<T, FIELD>(bodies, b.add(lane)), of_a);
            }
            columns(rows[0], rows[1], rows[2], rows[3])
        }
    }

    /// Sum of one row of two bodies.
    ///
    /// # Safety
    /// As for `rows_less`.
    #[inline(always)]
    unsafe fn rows_sum<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches.
        unsafe {
            let mut rows = [_mm512_setzero_pd(); 4];
            for lane in 0..4 {
                let of_a = two_rows::<T, FIELD>(bodies, a.add(lane));
                rows[lane] = _mm512_add_pd(of_a, two_rows::<T, FIELD>(bodies, b.add(lane)));
            }
            columns(rows[0], rows[1], rows[2], rows[3])
        }
    }

    /// One row of bodies.
    ///
    /// # Safety
    /// As for `rows_less`.
    #[inline(always)]
    pub(super) unsafe fn row_of<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches.
        unsafe {
            columns(
                two_rows::<T, FIELD>(bodies, a),
                two_rows::<T, FIELD>(bodies, a.add(1)),
                two_rows::<T, FIELD>(bodies, a.add(2)),
                two_rows::<T, FIELD>(bodies, a.add(3)),
            )
        }
    }
}

impl Lane for Avx512 {
    type Scalar = f64;
    type Mask = __mmask8;
    const WIDTH: usize = 8;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: only called where AVX-512 was detected; so for every method below.
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> __mmask8 {
        // SAFETY: see `splat`.
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask8, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
    }
    #[inline(always)]
    fn keep(self, mask: __mmask8) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_maskz_mov_pd(mask, self.0) })
    }
    #[inline(always)]
    fn both(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & b
    }
    #[inline(always)]
    fn any(mask: __mmask8) -> bool {
        mask != 0
    }

    one_instruction_each!(
        _mm512_add_pd,
        _mm512_sub_pd,
        _mm512_mul_pd,
        _mm512_div_pd,
        _mm512_fmadd_pd,
        _mm512_fnmadd_pd,
        _mm512_sqrt_pd,
        _mm512_max_pd,
        _mm512_min_pd,
        _mm512_loadu_pd,
        _mm512_storeu_pd
    );
}

wide_already!(Avx512);

impl Gather for Avx512 {
    #[inline(always)]
    unsafe fn gather(table: *const f64, at: *const u32) -> Self {
        let mut values = [0.0; 8];
        // SAFETY: the caller vouches for the indices.
        unsafe {
            for lane in 0..8 {
                values[lane] = *table.add(*at.add(lane) as usize);
            }
            Self::load(values.as_ptr())
        }
    }
    #[inline(always)]
    unsafe fn separation(bodies: *const Body<f64>, a: *const u32, b: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::rows_less::<f64, 0>(bodies, a, b) }
    }
    #[inline(always)]
    unsafe fn position(bodies: *const Body<f64>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::row_of::<f64, 0>(bodies, a) }
    }
    #[inline(always)]
    unsafe fn difference<const FIELD: usize>(
        bodies: *const Body<f64>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::rows_less::<f64, FIELD>(bodies, a, b) }
    }
    #[inline(always)]
    unsafe fn motion(bodies: *const Body<f64>, a: *const u32, b: *const u32) -> [[Self; 3]; 2] {
        // SAFETY: the caller vouches for the indices.
        unsafe { [Self::rows_less::<f64, 1>(bodies, a, b), Self::rows_sum::<f64, 2>(bodies, a, b)] }
    }
    #[inline(always)]
    unsafe fn record<const FIELD: usize>(bodies: *const Body<f64>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::row_of::<f64, FIELD>(bodies, a) }
    }
    #[inline(always)]
    unsafe fn scatter(forces: *mut Force<f64>, at: *const u32, [x, y, z]: [Self; 3]) {
        let rows = single_rows(rows(x, y, z, Self::splat(0.0)));
        // SAFETY: the caller vouches for the indices; a force is two aligned rows of four doubles.
        unsafe {
            for lane in 0..8 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), rows[lane]));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_pair(
        of_a: *mut Force<f64>,
        a: *const u32,
        of_b: *mut Force<f64>,
        b: *const u32,
        [x, y, z]: [Self; 3],
    ) {
        let rows = single_rows(rows(x, y, z, Self::splat(0.0)));
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), rows[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_sub_pd(_mm256_load_pd(to), rows[lane]));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_contact<const MODE: u8>(
        of_a: *mut Force<f64>,
        a: *const u32,
        of_b: *mut Force<f64>,
        b: *const u32,
        [x, y, z]: [Self; 3],
        [u, v, w]: [Self; 3],
        [of_u, of_v, of_w]: [Self; 3],
    ) {
        let (rows_a, halves_a) = (single_rows(rows(x, y, z, u)), half_rows(v, w));
        let (rows_b, halves_b) = if MODE == OTHER {
            (single_rows(rows(x, y, z, of_u)), half_rows(of_v, of_w))
        } else {
            (rows_a, halves_a)
        };
        // SAFETY: as for `scatter`.
        unsafe {
            // Times ±1 and a sum rounded once is a difference or a sum.
            let signs = _mm256_setr_pd(-1.0, -1.0, -1.0, 1.0);
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), rows_a[lane]));
                add_half(to.add(ROW), halves_a[lane]);
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_fmadd_pd(rows_b[lane], signs, _mm256_load_pd(to)));
                add_half(to.add(ROW), halves_b[lane]);
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_both(
        forces: *mut Force<f64>,
        at: *const u32,
        [x, y, z]: [Self; 3],
        [u, v, w]: [Self; 3],
    ) {
        let (rows, halves) = (single_rows(rows(x, y, z, u)), half_rows(v, w));
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..8 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), rows[lane]));
                add_half(to.add(ROW), halves[lane]);
            }
        }
    }
}
