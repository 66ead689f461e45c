//! Motion of the particles of a chunk: v(t+dt/2) = v(t−dt/2) + dt a(t), x(t+dt) = x(t) + dt v(t+dt/2), the velocity
//! Verlet scheme with velocities kept at half steps; one fused pass that also clears the forces.

use super::kernel::Path;
use crate::lane::Real;
use crate::state::{Body, Force, Grains};

/// Rates of drag by slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DragRates<'a> {
    /// None.
    None,
    /// The same for all [1/τ].
    All(f64),
    /// By slot [1/τ].
    Each(&'a [f64]),
}

impl DragRates<'_> {
    /// Rate of a slot [1/τ].
    pub fn of(self, slot: usize) -> f64 {
        match self {
            Self::None => 0.0,
            Self::All(rate) => rate,
            Self::Each(rates) => rates[slot],
        }
    }
}

/// Moves the bodies of a chunk (`first` is the slot of the first one); returns the largest |v component| over
/// displacement budget [1/τ].
///
/// # Safety
/// `path` was chosen by [`Path::choose`] on this machine.
pub unsafe fn advance<T: Real, G: Grains, const SPIN: bool>(
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
            Path::Avx2 => avx2::<T, G, SPIN>(bodies, forces, first, grains, drag, dt),
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

/// What a deforming space does to its particles in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformation<'a> {
    /// Strain rates at t_n + dt/2 [1/τ].
    pub rate: [f64; 3],
    /// Coefficient c of the local damping: every component of force and torque counts 1 − c sign(F v) [1].
    pub local_damping: f64,
    /// Drag on velocities relative to the deformation, and on spins.
    pub drag: DragRates<'a>,
}

/// As [`advance`], in a space that deforms: x(t+dt) = x + dt (v + e x), v relative to the deformation.
///
/// # Safety
/// `path` was chosen by [`Path::choose`] on this machine.
pub unsafe fn advance_with_space<T: Real, G: Grains, const SPIN: bool>(
    path: Path,
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    deformation: Deformation<'_>,
    dt: f64,
) -> f64 {
    // SAFETY: the path was detected.
    unsafe {
        match path {
            Path::Plain => with_space::<T, G, SPIN>(bodies, forces, first, grains, deformation, dt),
            #[cfg(target_arch = "x86_64")]
            Path::PlainFma => with_space_fma::<T, G, SPIN>(bodies, forces, first, grains, deformation, dt),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2 => with_space_avx2::<T, G, SPIN>(bodies, forces, first, grains, deformation, dt),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "fma")]
fn with_space_fma<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    deformation: Deformation<'_>,
    dt: f64,
) -> f64 {
    with_space::<T, G, SPIN>(bodies, forces, first, grains, deformation, dt)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_space_avx2<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    deformation: Deformation<'_>,
    dt: f64,
) -> f64 {
    with_space::<T, G, SPIN>(bodies, forces, first, grains, deformation, dt)
}

#[inline(always)]
fn with_space<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    deformation: Deformation<'_>,
    dt: f64,
) -> f64 {
    let Deformation { rate, local_damping: strength, drag } = deformation;
    let damped = |force: T, velocity: T| {
        let (force, velocity): (f64, f64) = (force.into(), velocity.into());
        let power = force * velocity;
        let opposes = if power > 0.0 { -strength } else { strength };
        let opposes = if power == 0.0 { 0.0 } else { opposes };
        T::of(force.mul_add(opposes, force))
    };
    match drag {
        DragRates::None if strength == 0.0 => {
            let faster = |_: usize, force: T, gain: T, old: T| force.mul_add(gain, old);
            follow::<T, G, SPIN>(bodies, forces, first, grains, rate, dt, faster)
        }
        DragRates::None => {
            let faster = |_: usize, force: T, gain: T, old: T| damped(force, old).mul_add(gain, old);
            follow::<T, G, SPIN>(bodies, forces, first, grains, rate, dt, faster)
        }
        DragRates::All(_) | DragRates::Each(_) => {
            let faster = |slot: usize, force: T, gain: T, old: T| {
                // As in `dragged`.
                let half = 0.5 * dt * drag.of(slot);
                let (keep, share) = (T::of((1.0 - half) / (1.0 + half)), T::of(1.0 / (1.0 + half)));
                damped(force, old).mul_add(share.mul(gain), keep.mul(old))
            };
            follow::<T, G, SPIN>(bodies, forces, first, grains, rate, dt, faster)
        }
    }
}

/// One step of the plane; `faster` takes slot, force, dt over mass and v(t−dt/2) to v(t+dt/2).
#[inline(always)]
fn follow<T: Real, G: Grains, const SPIN: bool>(
    bodies: &mut [Body<T>],
    forces: &mut [Force<T>],
    first: usize,
    grains: &G,
    rate: [f64; 3],
    dt: f64,
    faster: impl Fn(usize, T, T, T) -> T,
) -> f64 {
    // Rows of the plane: (x, y, 0, inverse budget), (v_x, v_y, ω, 0), (F_x, F_y, M, 0), one row after the other, each in
    // one register.
    let (mut rush, step) = ([0.0_f64; 4], [dt, dt, 0.0, 0.0]);
    let rate = [rate[0], rate[1], 0.0, 0.0];
    for (k, (body, force)) in bodies.iter_mut().zip(forces).enumerate() {
        let per_mass = T::of(dt * grains.inverse_mass(first + k));
        let per_inertia = T::of(if SPIN { dt * grains.inverse_inertia(first + k) } else { 0.0 });
        let gain = [per_mass, per_mass, per_inertia, T::default()];
        let inverse_budget = body.position[3];
        let (old, pull) = (body.velocity, force.numbers);
        let velocity: [T; 4] = std::array::from_fn(|c| faster(first + k, pull[c], gain[c], old[c]));
        body.velocity = velocity;
        let velocity = velocity.map(T::into);
        for c in 0..4 {
            let carried = body.position[c].mul_add(rate[c], velocity[c]);
            body.position[c] = carried.mul_add(step[c], body.position[c]);
        }
        for c in 0..4 {
            let hurry = velocity[c].abs() * inverse_budget;
            rush[c] = if hurry > rush[c] { hurry } else { rush[c] };
        }
        clear::<T, false>(force);
    }
    rush[0].max(rush[1])
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
