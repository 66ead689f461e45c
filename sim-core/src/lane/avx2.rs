//! Four numbers at a time with AVX2 and FMA.
//!
//! Every method is `#[inline(always)]` without target features of its own, so it melts into a caller that enables
//! them; only functions with `#[target_feature(enable = "avx2,fma")]` may use this type (a value of it must only
//! be made after the features were detected).

use std::arch::x86_64::{
    __m128d, __m256d, _CMP_LT_OQ, _mm_add_pd, _mm_load_pd, _mm_store_pd, _mm256_add_pd, _mm256_and_pd,
    _mm256_andnot_pd, _mm256_blendv_pd, _mm256_castpd256_pd128, _mm256_cmp_pd, _mm256_div_pd,
    _mm256_extractf128_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd, _mm256_load_pd, _mm256_loadu_pd, _mm256_max_pd,
    _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_permute2f128_pd, _mm256_set1_pd, _mm256_setr_pd,
    _mm256_setzero_pd, _mm256_sqrt_pd, _mm256_store_pd, _mm256_storeu_pd, _mm256_sub_pd, _mm256_unpackhi_pd,
    _mm256_unpacklo_pd, _mm256_xor_pd,
};

use super::vector::{one_instruction_each, wide_already};
use super::{Gather, Lane, Number, OTHER, Widen};
use crate::state::{Body, Force};

/// Four doubles in one register.
#[derive(Clone, Copy)]
pub struct Avx2(pub(super) __m256d);

/// Doubles per body record and per force record.
const ROW: usize = 4;

impl Avx2 {
    /// Address of a record of a body.
    #[inline(always)]
    unsafe fn row<T: Number, const FIELD: usize>(bodies: *const Body<T>, index: u32) -> *const f64 {
        // SAFETY: a body of doubles is three rows of four, of others the first one is; the caller vouches for the index.
        unsafe { bodies.add(index as usize).cast::<f64>().add(FIELD * ROW) }
    }

    /// Four rows to three columns (the fourth is not used).
    #[inline(always)]
    fn columns(r0: __m256d, r1: __m256d, r2: __m256d, r3: __m256d) -> [Self; 3] {
        // SAFETY: values of this type only exist where AVX2 was detected.
        unsafe {
            let lo01 = _mm256_unpacklo_pd(r0, r1); // x0 x1 z0 z1
            let hi01 = _mm256_unpackhi_pd(r0, r1); // y0 y1 w0 w1
            let lo23 = _mm256_unpacklo_pd(r2, r3);
            let hi23 = _mm256_unpackhi_pd(r2, r3);
            [
                Self(_mm256_permute2f128_pd::<0x20>(lo01, lo23)),
                Self(_mm256_permute2f128_pd::<0x20>(hi01, hi23)),
                Self(_mm256_permute2f128_pd::<0x31>(lo01, lo23)),
            ]
        }
    }

    /// Three columns to four rows, fourth component +0.
    #[inline(always)]
    pub(super) fn rows(value: [Self; 3]) -> [__m256d; 4] {
        // SAFETY: values of this type only exist where AVX2 was detected.
        unsafe {
            let zero = _mm256_setzero_pd();
            let lo_xy = _mm256_unpacklo_pd(value[0].0, value[1].0); // x0 y0 x2 y2
            let hi_xy = _mm256_unpackhi_pd(value[0].0, value[1].0); // x1 y1 x3 y3
            let lo_z = _mm256_unpacklo_pd(value[2].0, zero);
            let hi_z = _mm256_unpackhi_pd(value[2].0, zero);
            [
                _mm256_permute2f128_pd::<0x20>(lo_xy, lo_z),
                _mm256_permute2f128_pd::<0x20>(hi_xy, hi_z),
                _mm256_permute2f128_pd::<0x31>(lo_xy, lo_z),
                _mm256_permute2f128_pd::<0x31>(hi_xy, hi_z),
            ]
        }
    }

    /// Force and torque of four contacts, contact after contact: a row (F_x, F_y, F_z, M_x) and half a row (M_y, M_z).
    #[inline(always)]
    fn force_rows([x, y, z]: [Self; 3], [u, v, w]: [Self; 3]) -> ([__m256d; 4], [__m128d; 4]) {
        // SAFETY: values of this type only exist where AVX2 was detected.
        unsafe {
            let (xy02, xy13) = (_mm256_unpacklo_pd(x.0, y.0), _mm256_unpackhi_pd(x.0, y.0));
            let (zu02, zu13) = (_mm256_unpacklo_pd(z.0, u.0), _mm256_unpackhi_pd(z.0, u.0));
            let (vw02, vw13) = (_mm256_unpacklo_pd(v.0, w.0), _mm256_unpackhi_pd(v.0, w.0));
            (
                [
                    _mm256_permute2f128_pd::<0x20>(xy02, zu02),
                    _mm256_permute2f128_pd::<0x20>(xy13, zu13),
                    _mm256_permute2f128_pd::<0x31>(xy02, zu02),
                    _mm256_permute2f128_pd::<0x31>(xy13, zu13),
                ],
                [
                    _mm256_castpd256_pd128(vw02),
                    _mm256_castpd256_pd128(vw13),
                    _mm256_extractf128_pd::<1>(vw02),
                    _mm256_extractf128_pd::<1>(vw13),
                ],
            )
        }
    }

    /// Adds force and torque of one contact to a force.
    ///
    /// # Safety
    /// `to` points to a writable force.
    #[inline(always)]
    unsafe fn add_row(to: *mut f64, row: __m256d, half: __m128d) {
        // SAFETY: the caller vouches; a force is aligned.
        unsafe {
            _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), row));
            let to = to.add(ROW);
            _mm_store_pd(to, _mm_add_pd(_mm_load_pd(to), half));
        }
    }

    /// Difference of one record of two bodies, b − a.
    ///
    /// # Safety
    /// The indices are below the number of bodies; `FIELD` is 0 (position) or, of doubles, 1 (velocity) or
    /// 2 (spin).
    #[inline(always)]
    pub(super) unsafe fn rows_less<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices; records are 32-byte aligned.
        unsafe {
            let r0 = _mm256_sub_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(0))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(0))),
            );
            let r1 = _mm256_sub_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(1))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(1))),
            );
            let r2 = _mm256_sub_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(2))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(2))),
            );
            let r3 = _mm256_sub_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(3))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(3))),
            );
            Self::columns(r0, r1, r2, r3)
        }
    }

    /// Sum of one record of two bodies.
    ///
    /// # Safety
    /// The indices are below the number of bodies; `FIELD` is 0 (position) or, of doubles, 1 (velocity) or
    /// 2 (spin).
    #[inline(always)]
    pub(super) unsafe fn rows_sum<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices; records are 32-byte aligned.
        unsafe {
            let r0 = _mm256_add_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(0))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(0))),
            );
            let r1 = _mm256_add_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(1))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(1))),
            );
            let r2 = _mm256_add_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(2))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(2))),
            );
            let r3 = _mm256_add_pd(
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(3))),
                _mm256_load_pd(Self::row::<T, FIELD>(bodies, *b.add(3))),
            );
            Self::columns(r0, r1, r2, r3)
        }
    }

    /// One record of one body.
    ///
    /// # Safety
    /// The indices are below the number of bodies; `FIELD` is 0 (position) or, of doubles, 1 (velocity) or
    /// 2 (spin).
    #[inline(always)]
    pub(super) unsafe fn row_of<T: Number, const FIELD: usize>(
        bodies: *const Body<T>,
        a: *const u32,
    ) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices; records are 32-byte aligned.
        unsafe {
            let r0 = _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(0)));
            let r1 = _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(1)));
            let r2 = _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(2)));
            let r3 = _mm256_load_pd(Self::row::<T, FIELD>(bodies, *a.add(3)));
            Self::columns(r0, r1, r2, r3)
        }
    }
}

impl Lane for Avx2 {
    type Scalar = f64;
    type Mask = Self;
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: only called where AVX2 was detected.
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_blendv_pd(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn keep(self, mask: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_and_pd(self.0, mask.0) })
    }
    #[inline(always)]
    fn both(a: Self, b: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_and_pd(a.0, b.0) })
    }
    #[inline(always)]
    fn any(mask: Self) -> bool {
        // SAFETY: see `splat`.
        unsafe { _mm256_movemask_pd(mask.0) != 0 }
    }

    one_instruction_each!(
        _mm256_add_pd,
        _mm256_sub_pd,
        _mm256_mul_pd,
        _mm256_div_pd,
        _mm256_fmadd_pd,
        _mm256_fnmadd_pd,
        _mm256_sqrt_pd,
        _mm256_max_pd,
        _mm256_min_pd,
        _mm256_loadu_pd,
        _mm256_storeu_pd
    );
}

wide_already!(Avx2);

impl Gather for Avx2 {
    #[inline(always)]
    unsafe fn gather(table: *const f64, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let value = |lane: usize| *table.add(*at.add(lane) as usize);
            Self(_mm256_setr_pd(value(0), value(1), value(2), value(3)))
        }
    }

    #[inline(always)]
    unsafe fn separation(bodies: *const Body<f64>, a: *const u32, b: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::rows_less::<f64, 0>(bodies, a, b) }
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
    unsafe fn position(bodies: *const Body<f64>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::row_of::<f64, 0>(bodies, a) }
    }
    #[inline(always)]
    unsafe fn record<const FIELD: usize>(bodies: *const Body<f64>, a: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for the indices.
        unsafe { Self::row_of::<f64, FIELD>(bodies, a) }
    }
    #[inline(always)]
    unsafe fn scatter(forces: *mut Force<f64>, at: *const u32, value: [Self; 3]) {
        let rows = Self::rows(value);
        // SAFETY: the caller vouches for the indices; a force is two aligned rows of four doubles.
        unsafe {
            for lane in 0..4 {
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
        value: [Self; 3],
    ) {
        let rows = Self::rows(value);
        // SAFETY: the caller vouches for the indices; a force is two aligned rows of four doubles.
        unsafe {
            for lane in 0..4 {
                let row = rows[lane];
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), row));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_sub_pd(_mm256_load_pd(to), row));
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_contact<const MODE: u8>(
        of_a: *mut Force<f64>,
        a: *const u32,
        of_b: *mut Force<f64>,
        b: *const u32,
        force: [Self; 3],
        torque_a: [Self; 3],
        torque_b: [Self; 3],
    ) {
        let (rows_a, halves_a) = Self::force_rows(force, torque_a);
        let (rows_b, halves_b) =
            if MODE == OTHER { Self::force_rows(force, torque_b) } else { (rows_a, halves_a) };
        // SAFETY: the caller vouches for the indices; a force is two aligned rows of four doubles.
        unsafe {
            let minus = _mm256_setr_pd(-0.0, -0.0, -0.0, 0.0);
            for lane in 0..4 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                Self::add_row(to, rows_a[lane], halves_a[lane]);
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                Self::add_row(to, _mm256_xor_pd(rows_b[lane], minus), halves_b[lane]);
            }
        }
    }
    #[inline(always)]
    unsafe fn scatter_both(forces: *mut Force<f64>, at: *const u32, force: [Self; 3], torque: [Self; 3]) {
        let (rows, halves) = Self::force_rows(force, torque);
        // SAFETY: as for `scatter`.
        unsafe {
            for lane in 0..4 {
                let to = forces.wrapping_add(*at.add(lane) as usize).cast::<f64>();
                Self::add_row(to, rows[lane], halves[lane]);
            }
        }
    }
}
