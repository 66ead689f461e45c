//! Spheres: three rows a body, one after the other.

use super::DragRates;
use crate::dem::kernel::Path;
use crate::lane::Real;
use crate::state::{Body, Force, Grains};

/// See [`super::Moves::advance`].
///
/// # Safety
/// `path` was chosen by [`Path::choose`] on this machine.
pub(super) unsafe fn advance<T: Real, G: Grains, const SPIN: bool>(
    path: Path,
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    drag: DragRates<'_>,
    dt: f64,
) -> f64 {
    // SAFETY: the path was detected.
    unsafe {
        match path {
            Path::Plain => plain::<T, G, SPIN>(bodies, forces, first, grains, drag, dt),
            #[cfg(target_arch = "x86_64")]
            Path::PlainFma => plain_fma::<T, G, SPIN>(bodies, forces, first, grains, drag, dt),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2 | Path::Avx512 => avx2::<T, G, SPIN>(bodies, forces, first, grains, drag, dt),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "fma")]
fn plain_fma<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    drag: DragRates<'_>,
    dt: f64,
) -> f64 {
    plain::<T, G, SPIN>(bodies, forces, first, grains, drag, dt)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    drag: DragRates<'_>,
    dt: f64,
) -> f64 {
    plain::<T, G, SPIN>(bodies, forces, first, grains, drag, dt)
}

#[inline(always)]
fn plain<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    drag: DragRates<'_>,
    dt: f64,
) -> f64 {
    match drag {
        DragRates::None => free::<T, G, SPIN>(bodies, forces, first, grains, dt),
        DragRates::All(rate) => dragged::<T, G, SPIN>(bodies, forces, first, grains, dt, |_| rate),
        DragRates::Each(rates) => {
            dragged::<T, G, SPIN>(bodies, forces, first, grains, dt, |slot| rates[slot])
        }
    }
}

#[inline(always)]
fn free<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    dt: f64,
) -> f64 {
    let mut rush = [0.0_f64; 4];
    for (k, (body, force)) in bodies.iter_mut().zip(forces).enumerate() {
        let per_mass = T::of(dt * grains.inverse_mass(first + k));
        let per_inertia = T::of(dt * grains.inverse_inertia(first + k));
        let inverse_budget = body.position[3];
        // One row after the other, each in one register.
        // In space the fourth number of a force may be one of the torque, which moves nothing here.
        let gain = [per_mass, per_mass, per_mass, T::default()];
        let pull = force.numbers;
        let velocity: [T; 4] = std::array::from_fn(|c| pull[c].mul_add(gain[c], body.velocity[c]));
        body.velocity = velocity;
        let velocity = velocity.map(T::into);
        for c in 0..4 {
            body.position[c] = velocity[c].mul_add(dt, body.position[c]);
        }
        for c in 0..4 {
            let hurry = velocity[c].abs() * inverse_budget;
            rush[c] = if hurry > rush[c] { hurry } else { rush[c] };
        }
        if SPIN {
            for c in 0..4 {
                body.spin[c] = pull[T::TORQUE + c].mul_add(per_inertia, body.spin[c]);
            }
        }
        clear::<T, SPIN>(force);
    }
    rush[0].max(rush[1]).max(rush[2])
}

/// Makes a force zero, row by row: put together first, it would be stored in pieces and read whole.
#[inline(always)]
fn clear<T: Real, const SPIN: bool>(force: &mut Force<T>) {
    let (force, torque) = force.numbers.split_at_mut(4);
    force.fill(T::default());
    if SPIN {
        torque.fill(T::default());
    }
}

/// v(t+dt/2) = [v(t−dt/2)(1 − γ dt/2) + dt a]/(1 + γ dt/2): drag centred at t, second order.
#[inline(always)]
fn dragged<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    dt: f64,
    rate: impl Fn(usize) -> f64,
) -> f64 {
    let mut rush = 0.0_f64;
    for (k, (body, force)) in bodies.iter_mut().zip(forces).enumerate() {
        let half = 0.5 * dt * rate(first + k);
        let (keep, share) = ((1.0 - half) / (1.0 + half), dt / (1.0 + half));
        let keep = T::of(keep);
        let per_mass = T::of(share * grains.inverse_mass(first + k));
        let per_inertia = T::of(share * grains.inverse_inertia(first + k));
        let inverse_budget = body.position[3];
        for c in 0..3 {
            body.velocity[c] = force.numbers[c].mul_add(per_mass, keep.mul(body.velocity[c]));
            let velocity: f64 = body.velocity[c].into();
            body.position[c] = velocity.mul_add(dt, body.position[c]);
            let hurry = velocity.abs() * inverse_budget;
            rush = if hurry > rush { hurry } else { rush };
            if SPIN {
                body.spin[c] = force.numbers[T::TORQUE + c].mul_add(per_inertia, keep.mul(body.spin[c]));
            }
        }
        clear::<T, SPIN>(force);
    }
    rush
}
