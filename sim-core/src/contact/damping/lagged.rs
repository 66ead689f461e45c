//! Linear dashpot on the rate of half a step before: f_v = 2 α_n √(k_n m_eff) u(t_n − dt/2).
//!
//! First order in the step where [`super::Viscous`] is of second, but stable up to twice its damping rate times step,
//! without memory, and without the weight of the step in which a contact opens or closes. For quasi-static runs,
//! where the dashpot only has to take energy away: local damping raises forces by up to 1.7, and the extrapolated rate
//! of a well-connected disc is unstable then at the usual step.

use super::Damping;
use crate::lane::Lane;

/// f_v = c √m_eff u with c = 2 α_n √k_n, while in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagged {
    /// 2 α_n √k_n [√k_n].
    pub coefficient: f64,
}

impl Lagged {
    /// The dashpot of damping ratio α_n [1] on a spring k_n.
    #[must_use]
    pub fn new(alpha_n: f64, kn: f64) -> Self {
        Self { coefficient: 2.0 * alpha_n * kn.sqrt() }
    }
}

impl Damping for Lagged {
    const SLOTS: usize = 0;
    const JUMPS: bool = false;
    const NAME: &'static str = "+lagged_viscous";

    #[inline(always)]
    unsafe fn viscous<L: Lane>(
        &self,
        approach: L,
        root_mass: L,
        share: L,
        _: L::Mask,
        _: *mut L::Scalar,
    ) -> L {
        L::splat(self.coefficient).mul(root_mass).mul(approach).mul(share)
    }
    #[inline(always)]
    fn repulsion<L: Lane>(&self, elastic: L, viscous: L) -> L {
        elastic.add(viscous)
    }
    fn vacant() -> f64 {
        0.0
    }
    /// Half of it: ω² dt² + 2 γ dt ≤ 4 is the limit of this scheme, ω² dt² + 4 γ dt ≤ 4 that of the extrapolated rate
    /// for which the time step asks.
    fn coefficient(&self) -> f64 {
        0.5 * self.coefficient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_follows_the_rate_in_contact() {
        let law = Lagged::new(0.25, 4.0);
        // SAFETY: no slot is touched.
        let force =
            |u: f64, share: f64| unsafe { law.viscous(u, 0.5, share, share > 0.0, std::ptr::null_mut()) };
        assert_eq!(force(0.1, 1.0), 0.05);
        assert_eq!(force(-0.1, 1.0), -0.05);
        assert_eq!(force(0.1, 0.0), 0.0);
    }
}
