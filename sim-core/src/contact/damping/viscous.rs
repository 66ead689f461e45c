//! Linear dashpot: f_v = 2 α_n √(k_n m_eff) u (paper 2024, eq. 8), u = d(ov)/dt.
//!
//! The scheme knows velocities at half steps, the force is needed at t_n. Taking u(t_n − dt/2) would make the whole
//! scheme first order, so the rate is extrapolated from the last two half steps,
//! u_n = u_{n−1/2} + (u_{n−1/2} − u_{n−3/2})/2 + O(dt²): one number of memory per contact. In the first step of a
//! contact there is no earlier rate; the error of that one step is O(dt²) in the impulse.

use super::Damping;
use crate::lane::Lane;

/// Memory of a contact without an earlier rate.
const NO_RATE: f64 = 1e30;

/// f_v = c √m_eff u, with c = 2 α_n √k_n; with `CLAMP` the sum of elastic and viscous force never pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscous<const CLAMP: bool> {
    /// 2 α_n √k_n [√k_n].
    pub coefficient: f64,
}

impl<const CLAMP: bool> Viscous<CLAMP> {
    /// The dashpot of damping ratio α_n [1] on a spring k_n.
    #[must_use]
    pub fn new(alpha_n: f64, kn: f64) -> Self {
        Self { coefficient: 2.0 * alpha_n * kn.sqrt() }
    }
}

/// α_n = −ln e_n/√(ln² e_n + π²): damping ratio of a restitution coefficient without adhesion (paper 2024, eq. 9).
#[must_use]
pub fn damping_ratio(restitution: f64) -> f64 {
    let ln_e = libm::log(restitution);
    -ln_e / (ln_e * ln_e + std::f64::consts::PI * std::f64::consts::PI).sqrt()
}

impl<const CLAMP: bool> Damping for Viscous<CLAMP> {
    const SLOTS: usize = 1;
    const JUMPS: bool = true;
    const NAME: &'static str = if CLAMP { "+viscous_clamped" } else { "+viscous" };

    #[inline(always)]
    unsafe fn viscous<L: Lane>(
        &self,
        approach: L,
        root_mass: L,
        share: L,
        active: L::Mask,
        memory: *mut L::Scalar,
    ) -> L {
        // SAFETY: the caller vouches for the slot.
        let before = unsafe { L::load(memory) };
        let ahead = L::splat(0.5).mul_add(approach.sub(before), approach);
        let rate = L::select(before.less(L::splat(NO_RATE)), ahead, approach);
        // SAFETY: as above.
        unsafe { L::select(active, approach, L::splat(NO_RATE)).store(memory) };
        L::splat(self.coefficient).mul(root_mass).mul(rate).mul(share)
    }
    #[inline(always)]
    fn repulsion<L: Lane>(&self, elastic: L, viscous: L) -> L {
        let sum = elastic.add(viscous);
        if CLAMP { sum.max(L::splat(0.0)) } else { sum }
    }
    fn vacant() -> f64 {
        NO_RATE
    }
    fn coefficient(&self) -> f64 {
        self.coefficient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_is_extrapolated_to_the_full_step_and_forgotten_when_the_contact_opens() {
        let law = Viscous::<false>::new(0.25, 1.0);
        let mut memory = NO_RATE;
        let mut force = |u: f64, active: bool| {
            // SAFETY: one slot.
            unsafe { law.viscous(u, 1.0, 1.0, active, &raw mut memory) }
        };
        assert_eq!(force(0.1, true), 0.5 * 0.1);
        assert!((force(0.08, true) - 0.5 * 0.07).abs() < 1e-15);
        force(0.06, false);
        assert_eq!(force(0.02, true), 0.5 * 0.02);
    }

    #[test]
    fn damping_ratio_follows_equation_9() {
        assert!((damping_ratio(0.2_f64.sqrt()) - 0.248).abs() < 1e-3);
        for alpha in [0.05_f64, 0.25, 0.9] {
            let restitution = libm::exp(-alpha * std::f64::consts::PI / (1.0 - alpha * alpha).sqrt());
            assert!((damping_ratio(restitution) - alpha).abs() < 1e-14);
        }
    }

    #[test]
    fn clamp_keeps_the_sum_from_pulling() {
        assert_eq!(Viscous::<true>::new(0.5, 1.0).repulsion(1.0, -3.0), 0.0);
        assert_eq!(Viscous::<false>::new(0.5, 1.0).repulsion(1.0, -3.0), -2.0);
    }
}
