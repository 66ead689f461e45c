//! Discs in a plane that deforms: x(t+dt) = x + dt (v + e x), v relative to the deformation.

use super::{Deformation, DragRates};
use crate::dem::kernel::Path;
use crate::lane::Real;
use crate::state::{PlanarBody, PlanarForce};

/// See [`super::Moves::advance`].
///
/// # Safety
/// As there.
pub(super) unsafe fn advance<T: Real>(
    path: Path,
    bodies: &mut [PlanarBody<T>],
    forces: &mut [PlanarForce<T>],
    first: usize,
    deformation: Deformation<'_, T>,
    dt: f64,
) -> f64 {
    // SAFETY: the path was detected.
    unsafe {
        match path {
            Path::Plain => with_space(bodies, forces, first, deformation, dt),
            #[cfg(target_arch = "x86_64")]
            Path::PlainFma => with_space_fma(bodies, forces, first, deformation, dt),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2 | Path::Avx512 => with_space_avx2(bodies, forces, first, deformation, dt),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "fma")]
fn with_space_fma<T: Real>(
    bodies: &mut [PlanarBody<T>],
    forces: &mut [PlanarForce<T>],
    first: usize,
    deformation: Deformation<'_, T>,
    dt: f64,
) -> f64 {
    with_space(bodies, forces, first, deformation, dt)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_space_avx2<T: Real>(
    bodies: &mut [PlanarBody<T>],
    forces: &mut [PlanarForce<T>],
    first: usize,
    deformation: Deformation<'_, T>,
    dt: f64,
) -> f64 {
    with_space(bodies, forces, first, deformation, dt)
}

#[inline(always)]
fn with_space<T: Real>(
    bodies: &mut [PlanarBody<T>],
    forces: &mut [PlanarForce<T>],
    first: usize,
    deformation: Deformation<'_, T>,
    dt: f64,
) -> f64 {
    let Deformation { rate, local_damping: strength, drag, gains } = deformation;
    let damped = |force: T, velocity: T| {
        let (force, velocity): (f64, f64) = (force.into(), velocity.into());
        let power = force * velocity;
        let opposes = if power > 0.0 { -strength } else { strength };
        let opposes = if power == 0.0 { 0.0 } else { opposes };
        T::of(force.mul_add(opposes, force))
    };
    match drag {
        DragRates::None if strength == 0.0 => {
            let faster = |_: usize, pull: [T; 4], gain: [T; 4], old: [T; 4]| -> [T; 4] {
                std::array::from_fn(|c| pull[c].mul_add(gain[c], old[c]))
            };
            follow(bodies, forces, first, gains, rate, dt, faster)
        }
        DragRates::None => {
            let faster = |_: usize, pull: [T; 4], gain: [T; 4], old: [T; 4]| -> [T; 4] {
                std::array::from_fn(|c| damped(pull[c], old[c]).mul_add(gain[c], old[c]))
            };
            follow(bodies, forces, first, gains, rate, dt, faster)
        }
        DragRates::All(_) | DragRates::Each(_) => {
            let faster = |slot: usize, pull: [T; 4], gain: [T; 4], old: [T; 4]| -> [T; 4] {
                // v(t+dt/2) = [v(t−dt/2)(1 − γ dt/2) + dt a]/(1 + γ dt/2): drag centred at t, second order.
                let half = 0.5 * dt * drag.of(slot);
                let (keep, share) = (T::of((1.0 - half) / (1.0 + half)), T::of(1.0 / (1.0 + half)));
                let keep = [keep, keep, keep, T::of(1.0)];
                std::array::from_fn(|c| {
                    damped(pull[c], old[c]).mul_add(share.mul(gain[c]), keep[c].mul(old[c]))
                })
            };
            follow(bodies, forces, first, gains, rate, dt, faster)
        }
    }
}

/// One step of the plane; `faster` takes slot, (F_x, F_y, M, 0), (dt/m, dt/m, dt/I, 0) and (v_x, v_y, ω, inverse budget) at
/// t − dt/2 to that at t + dt/2. The fourth number gains nothing, so it stays as it is.
#[inline(always)]
fn follow<T: Real>(
    bodies: &mut [PlanarBody<T>],
    forces: &mut [PlanarForce<T>],
    first: usize,
    gains: &[[T; 4]],
    rate: [f64; 3],
    dt: f64,
    faster: impl Fn(usize, [T; 4], [T; 4], [T; 4]) -> [T; 4],
) -> f64 {
    let mut rush = [T::default(); 4];
    for (k, ((body, force), gain)) in bodies.iter_mut().zip(forces).zip(gains).enumerate() {
        // Row by row, each in one register.
        let motion = faster(first + k, force.numbers, *gain, body.motion);
        force.numbers = [T::default(); 4];
        body.motion = motion;
        for c in 0..2 {
            let velocity: f64 = motion[c].into();
            let carried = body.position[c].mul_add(rate[c], velocity);
            body.position[c] = carried.mul_add(dt, body.position[c]);
        }
        for c in 0..4 {
            let hurry = motion[c].abs().mul(motion[3]);
            rush[c] = if rush[c].less(hurry) { hurry } else { rush[c] };
        }
    }
    rush[0].max(rush[1]).into()
}
