//! Records of discs with AVX2: one look at 32 bytes per disc for where it is and how it moves, in mixed precision with its
//! spin too. See [`super::Avx2`] for the rules of use; no closures, which are not always inlined.

use std::arch::x86_64::{
    __m128, __m128d, __m256, _mm_add_ps, _mm_castps_pd, _mm_load_pd, _mm_load_ps, _mm_store_ps, _mm_sub_pd,
    _mm_sub_ps, _mm_unpacklo_pd, _mm256_add_pd, _mm256_castps256_ps128, _mm256_load_pd, _mm256_load_ps,
    _mm256_permute2f128_pd, _mm256_permute2f128_ps, _mm256_set_m128d, _mm256_shuffle_ps, _mm256_store_pd,
    _mm256_sub_pd, _mm256_sub_ps, _mm256_unpackhi_pd, _mm256_unpackhi_ps, _mm256_unpacklo_pd,
    _mm256_unpacklo_ps,
};

use super::{Avx2, Avx2Single, Lane, Plane, Two};
use crate::state::{PlanarBody, PlanarForce};

/// Doubles before the third and fourth number of the motion of a disc in double precision.
const SPIN: usize = 4;

/// Spins of two discs in double precision.
#[inline(always)]
pub(super) unsafe fn two_spins(bodies: *const PlanarBody<f64>, at: *const u32, other: *const u32) -> __m128d {
    // SAFETY: the caller vouches for the indices; a disc is six doubles at the head of a cache line.
    unsafe {
        let first = _mm_load_pd(bodies.add(*at as usize).cast::<f64>().add(SPIN));
        let second = _mm_load_pd(bodies.add(*other as usize).cast::<f64>().add(SPIN));
        _mm_unpacklo_pd(first, second)
    }
}

impl Plane for Avx2 {
    #[inline(always)]
    unsafe fn discs_apart(
        bodies: *const PlanarBody<f64>,
        a: *const u32,
        b: *const u32,
    ) -> ([Self; 2], [Self; 2]) {
        // SAFETY: the caller vouches for the indices; a disc begins with x, y, v_x, v_y, aligned.
        unsafe {
            let mut rows = [_mm256_load_pd(bodies.add(*b as usize).cast::<f64>()); 4];
            for lane in 0..4 {
                let of_a = _mm256_load_pd(bodies.add(*a.add(lane) as usize).cast::<f64>());
                let of_b = _mm256_load_pd(bodies.add(*b.add(lane) as usize).cast::<f64>());
                rows[lane] = _mm256_sub_pd(of_b, of_a);
            }
            let (xu01, yv01) = (_mm256_unpacklo_pd(rows[0], rows[1]), _mm256_unpackhi_pd(rows[0], rows[1]));
            let (xu23, yv23) = (_mm256_unpacklo_pd(rows[2], rows[3]), _mm256_unpackhi_pd(rows[2], rows[3]));
            (
                [
                    Self(_mm256_permute2f128_pd::<0x20>(xu01, xu23)),
                    Self(_mm256_permute2f128_pd::<0x20>(yv01, yv23)),
                ],
                [
                    Self(_mm256_permute2f128_pd::<0x31>(xu01, xu23)),
                    Self(_mm256_permute2f128_pd::<0x31>(yv01, yv23)),
                ],
            )
        }
    }
    #[inline(always)]
    unsafe fn disc_spins(bodies: *const PlanarBody<f64>, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let (low, high) = (two_spins(bodies, at, at.add(1)), two_spins(bodies, at.add(2), at.add(3)));
            Self(_mm256_set_m128d(high, low))
        }
    }
    #[inline(always)]
    unsafe fn scatter_discs(
        of_a: *mut PlanarForce<f64>,
        a: *const u32,
        of_b: *mut PlanarForce<f64>,
        b: *const u32,
        force: [Self; 2],
        torque_a: Self,
        torque_b: Self,
    ) {
        let [x, y] = force;
        let (on_a, on_b) = (Self::rows([x, y, torque_a]), Self::rows([x, y, Self::splat(0.0).sub(torque_b)]));
        // SAFETY: the caller vouches for the indices; a force is an aligned row of four doubles.
        unsafe {
            for lane in 0..4 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_sub_pd(_mm256_load_pd(to), on_b[lane]));
            }
        }
    }
}

/// A disc in mixed precision: position and motion.
#[inline(always)]
pub(super) unsafe fn disc(bodies: *const PlanarBody<f32>, at: *const u32) -> __m256 {
    // SAFETY: the caller vouches for the index; a disc is 32 bytes, aligned.
    unsafe { _mm256_load_ps(bodies.add(*at as usize).cast::<f32>()) }
}

/// Difference of the positions of two discs in mixed precision.
#[inline(always)]
pub(super) unsafe fn apart(bodies: *const PlanarBody<f32>, a: *const u32, b: *const u32) -> __m128d {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        let (of_a, of_b) = (_mm256_castps256_ps128(disc(bodies, a)), _mm256_castps256_ps128(disc(bodies, b)));
        _mm_sub_pd(_mm_castps_pd(of_b), _mm_castps_pd(of_a))
    }
}

/// Differences of the positions of four pairs of discs in mixed precision.
#[inline(always)]
unsafe fn four_apart(bodies: *const PlanarBody<f32>, a: *const u32, b: *const u32) -> [Avx2; 2] {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        let of_02 = _mm256_set_m128d(apart(bodies, a.add(2), b.add(2)), apart(bodies, a, b));
        let of_13 = _mm256_set_m128d(apart(bodies, a.add(3), b.add(3)), apart(bodies, a.add(1), b.add(1)));
        [Avx2(_mm256_unpacklo_pd(of_02, of_13)), Avx2(_mm256_unpackhi_pd(of_02, of_13))]
    }
}

/// Motions of discs l and l + 4.
#[inline(always)]
unsafe fn motions(bodies: *const PlanarBody<f32>, at: *const u32) -> __m256 {
    // SAFETY: the caller vouches for the indices.
    unsafe { _mm256_permute2f128_ps::<0x31>(disc(bodies, at), disc(bodies, at.add(4))) }
}

impl Plane for Avx2Single {
    #[inline(always)]
    unsafe fn discs_apart(
        bodies: *const PlanarBody<f32>,
        a: *const u32,
        b: *const u32,
    ) -> ([Two<Avx2>; 2], [Self; 2]) {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y] = four_apart(bodies, a, b);
            let [u, v] = four_apart(bodies, a.add(4), b.add(4));
            let mut rows = [motions(bodies, b); 4];
            for lane in 0..4 {
                rows[lane] = _mm256_sub_ps(motions(bodies, b.add(lane)), motions(bodies, a.add(lane)));
            }
            let (uv01, uv23) = (_mm256_unpacklo_ps(rows[0], rows[1]), _mm256_unpacklo_ps(rows[2], rows[3]));
            (
                [Two(x, u), Two(y, v)],
                [Self(_mm256_shuffle_ps::<0x44>(uv01, uv23)), Self(_mm256_shuffle_ps::<0xEE>(uv01, uv23))],
            )
        }
    }
    #[inline(always)]
    unsafe fn disc_spins(bodies: *const PlanarBody<f32>, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let of_01 = _mm256_unpackhi_ps(motions(bodies, at), motions(bodies, at.add(1)));
            let of_23 = _mm256_unpackhi_ps(motions(bodies, at.add(2)), motions(bodies, at.add(3)));
            Self(_mm256_shuffle_ps::<0x44>(of_01, of_23))
        }
    }
    #[inline(always)]
    unsafe fn scatter_discs(
        of_a: *mut PlanarForce<f32>,
        a: *const u32,
        of_b: *mut PlanarForce<f32>,
        b: *const u32,
        force: [Self; 2],
        torque_a: Self,
        torque_b: Self,
    ) {
        let [x, y] = force;
        let on_a: [__m128; 8] = Self::records([x, y, torque_a]);
        let on_b: [__m128; 8] = Self::records([x, y, Self::splat(0.0).sub(torque_b)]);
        // SAFETY: the caller vouches for the indices; a force is an aligned row of four floats.
        unsafe {
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_add_ps(_mm_load_ps(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_sub_ps(_mm_load_ps(to), on_b[lane]));
            }
        }
    }
}
