//! Records of discs with AVX-512: one look at 32 bytes per disc, as with AVX2. See [`super::Avx2`] for the rules of use; no closures.

use std::arch::x86_64::{
    __m512, __m512d, _mm_add_ps, _mm_load_ps, _mm_store_ps, _mm_sub_ps, _mm256_add_pd, _mm256_load_pd,
    _mm256_set_m128d, _mm256_store_pd, _mm256_sub_pd, _mm512_castpd256_pd512, _mm512_insertf64x4,
    _mm512_setzero_pd, _mm512_setzero_ps, _mm512_shuffle_f32x4, _mm512_shuffle_ps, _mm512_sub_pd,
    _mm512_sub_ps, _mm512_unpackhi_pd, _mm512_unpackhi_ps, _mm512_unpacklo_pd, _mm512_unpacklo_ps,
};

use super::avx2_plane::{apart, disc, two_spins};
use super::avx512::{beside, even_pairs, odd_pairs, rows, single_rows};
use super::avx512_single::{beside as beside_single, records};
use super::{Avx512, Avx512Single, Lane, Plane, Two};
use crate::state::{PlanarBody, PlanarForce};

/// Doubles of the position and velocity of a disc; also how far apart the discs of one register are in their bundle.
const ROW: usize = 4;

/// Position and velocity of discs l and l + 4.
///
/// # Safety
/// `at` points to five indices of discs.
#[inline(always)]
unsafe fn two_discs(bodies: *const PlanarBody<f64>, at: *const u32) -> __m512d {
    // SAFETY: a disc begins with x, y, v_x, v_y, aligned; the caller vouches for the indices.
    unsafe {
        beside(
            _mm256_load_pd(bodies.add(*at as usize).cast::<f64>()),
            _mm256_load_pd(bodies.add(*at.add(ROW) as usize).cast::<f64>()),
        )
    }
}

impl Plane for Avx512 {
    #[inline(always)]
    unsafe fn discs_apart(
        bodies: *const PlanarBody<f64>,
        a: *const u32,
        b: *const u32,
    ) -> ([Self; 2], [Self; 2]) {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let mut rows = [_mm512_setzero_pd(); 4];
            for lane in 0..4 {
                rows[lane] = _mm512_sub_pd(two_discs(bodies, b.add(lane)), two_discs(bodies, a.add(lane)));
            }
            let (xu01, yv01) = (_mm512_unpacklo_pd(rows[0], rows[1]), _mm512_unpackhi_pd(rows[0], rows[1]));
            let (xu23, yv23) = (_mm512_unpacklo_pd(rows[2], rows[3]), _mm512_unpackhi_pd(rows[2], rows[3]));
            (
                [Self(even_pairs(xu01, xu23)), Self(even_pairs(yv01, yv23))],
                [Self(odd_pairs(xu01, xu23)), Self(odd_pairs(yv01, yv23))],
            )
        }
    }
    #[inline(always)]
    unsafe fn disc_spins(bodies: *const PlanarBody<f64>, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            Self(beside(
                _mm256_set_m128d(two_spins(bodies, at.add(2), at.add(3)), two_spins(bodies, at, at.add(1))),
                _mm256_set_m128d(
                    two_spins(bodies, at.add(6), at.add(7)),
                    two_spins(bodies, at.add(4), at.add(5)),
                ),
            ))
        }
    }
    #[inline(always)]
    unsafe fn scatter_discs(
        of_a: *mut PlanarForce<f64>,
        a: *const u32,
        of_b: *mut PlanarForce<f64>,
        b: *const u32,
        [x, y]: [Self; 2],
        torque_a: Self,
        torque_b: Self,
    ) {
        let zero = Self::splat(0.0);
        let (on_a, on_b) = (rows(x, y, torque_a, zero), rows(x, y, zero.sub(torque_b), zero));
        let (on_a, on_b) = (single_rows(on_a), single_rows(on_b));
        // SAFETY: the caller vouches for the indices; a force is an aligned row of four doubles.
        unsafe {
            for lane in 0..8 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f64>();
                _mm256_store_pd(to, _mm256_sub_pd(_mm256_load_pd(to), on_b[lane]));
            }
        }
    }
}

/// Differences of the positions of eight pairs of discs.
///
/// # Safety
/// `a` and `b` point to eight indices of discs.
#[inline(always)]
unsafe fn eight_apart(bodies: *const PlanarBody<f32>, a: *const u32, b: *const u32) -> [Avx512; 2] {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        let of_02 = _mm256_set_m128d(apart(bodies, a.add(2), b.add(2)), apart(bodies, a, b));
        let of_13 = _mm256_set_m128d(apart(bodies, a.add(3), b.add(3)), apart(bodies, a.add(1), b.add(1)));
        let of_46 = _mm256_set_m128d(apart(bodies, a.add(6), b.add(6)), apart(bodies, a.add(4), b.add(4)));
        let of_57 = _mm256_set_m128d(apart(bodies, a.add(7), b.add(7)), apart(bodies, a.add(5), b.add(5)));
        let even = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(of_02), of_46);
        let odd = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(of_13), of_57);
        [Avx512(_mm512_unpacklo_pd(even, odd)), Avx512(_mm512_unpackhi_pd(even, odd))]
    }
}

/// Motions of discs l, l + 4, l + 8 and l + 12.
///
/// # Safety
/// `at` points to thirteen indices of discs.
#[inline(always)]
unsafe fn motions(bodies: *const PlanarBody<f32>, at: *const u32) -> __m512 {
    // SAFETY: the caller vouches for the indices.
    unsafe {
        let (of_04, of_8c) = (
            beside_single(disc(bodies, at), disc(bodies, at.add(4))),
            beside_single(disc(bodies, at.add(8)), disc(bodies, at.add(12))),
        );
        _mm512_shuffle_f32x4::<0xDD>(of_04, of_8c)
    }
}

impl Plane for Avx512Single {
    #[inline(always)]
    unsafe fn discs_apart(
        bodies: *const PlanarBody<f32>,
        a: *const u32,
        b: *const u32,
    ) -> ([Two<Avx512>; 2], [Self; 2]) {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let [x, y] = eight_apart(bodies, a, b);
            let [u, v] = eight_apart(bodies, a.add(8), b.add(8));
            let mut rows = [_mm512_setzero_ps(); 4];
            for lane in 0..4 {
                rows[lane] = _mm512_sub_ps(motions(bodies, b.add(lane)), motions(bodies, a.add(lane)));
            }
            let (uv01, uv23) = (_mm512_unpacklo_ps(rows[0], rows[1]), _mm512_unpacklo_ps(rows[2], rows[3]));
            (
                [Two(x, u), Two(y, v)],
                [Self(_mm512_shuffle_ps::<0x44>(uv01, uv23)), Self(_mm512_shuffle_ps::<0xEE>(uv01, uv23))],
            )
        }
    }
    #[inline(always)]
    unsafe fn disc_spins(bodies: *const PlanarBody<f32>, at: *const u32) -> Self {
        // SAFETY: the caller vouches for the indices.
        unsafe {
            let of_01 = _mm512_unpackhi_ps(motions(bodies, at), motions(bodies, at.add(1)));
            let of_23 = _mm512_unpackhi_ps(motions(bodies, at.add(2)), motions(bodies, at.add(3)));
            Self(_mm512_shuffle_ps::<0x44>(of_01, of_23))
        }
    }
    #[inline(always)]
    unsafe fn scatter_discs(
        of_a: *mut PlanarForce<f32>,
        a: *const u32,
        of_b: *mut PlanarForce<f32>,
        b: *const u32,
        [x, y]: [Self; 2],
        torque_a: Self,
        torque_b: Self,
    ) {
        let on_a = records([x, y, torque_a]);
        let on_b = records([x, y, Self::splat(0.0).sub(torque_b)]);
        // SAFETY: the caller vouches for the indices; a force is an aligned row of four floats.
        unsafe {
            for lane in 0..16 {
                let to = of_a.wrapping_add(*a.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_add_ps(_mm_load_ps(to), on_a[lane]));
                let to = of_b.wrapping_add(*b.add(lane) as usize).cast::<f32>();
                _mm_store_ps(to, _mm_sub_ps(_mm_load_ps(to), on_b[lane]));
            }
        }
    }
}
