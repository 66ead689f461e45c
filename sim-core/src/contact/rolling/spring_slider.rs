//! Rolling resistance: an elastic hinge that slips (discs 2008, section II B).

use super::Rolling;
use crate::lane::Lane;
use crate::space::{Space, Vector};

/// Γ grows by K_R (ω_b − ω_a) dt and is bounded by |Γ| ≤ μ_R f_e, f_e the elastic normal force alone. K_R is a moment
/// per radian of relative rotation: no radius enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringSlider {
    /// K_R [k_n d²].
    pub kr: f64,
    /// μ_R [d].
    pub mu_r: f64,
}

impl<S: Space> Rolling<S> for SpringSlider {
    const SLOTS: usize = <S::Spin<f64> as Vector<f64>>::COMPONENTS;
    const ROLLS: bool = true;
    const NAME: &'static str = "+spring_slider";

    #[inline(always)]
    unsafe fn moment<L: Lane>(
        &self,
        spin_difference: S::Spin<L>,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> S::Spin<L> {
        // SAFETY: the caller vouches for the slots.
        let old: S::Spin<L> = unsafe { S::Spin::load(memory) };
        let moment = old.add_scaled(L::splat(self.kr).mul(dt), spin_difference);
        let bound = L::splat(self.mu_r).mul(elastic);
        let moment = S::limit_moment(moment, bound).keep(active);
        // SAFETY: as above.
        unsafe { moment.store(memory) };
        moment
    }
    fn stiffness(&self) -> f64 {
        self.kr
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Planar, V1};

    fn turn(law: &SpringSlider, memory: &mut f64, rate: f64, elastic: f64, dt: f64) -> f64 {
        // SAFETY: one slot.
        let moment = unsafe {
            <SpringSlider as Rolling<Planar>>::moment::<f64>(
                law,
                V1([rate]),
                elastic,
                elastic > 0.0,
                dt,
                memory,
            )
        };
        moment.0[0]
    }

    #[test]
    fn follows_the_elastic_plastic_hinge() {
        // Back and forth by the angle θ: Γ = clamp(Γ + K_R dθ, ±μ_R f_e).
        let law = SpringSlider { kr: 2.0, mu_r: 0.1 };
        let (mut memory, mut expected) = (0.0, 0.0_f64);
        for step in 0..2000 {
            let rate = libm::cos(0.01 * f64::from(step));
            expected = (expected + 2.0 * rate * 1e-3).clamp(-0.05, 0.05);
            assert!((turn(&law, &mut memory, rate, 0.5, 1e-3) - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn an_open_contact_forgets() {
        let law = SpringSlider { kr: 2.0, mu_r: 0.1 };
        let mut memory = 0.0;
        assert!(turn(&law, &mut memory, 1.0, 0.5, 1e-3) > 0.0);
        assert_eq!(turn(&law, &mut memory, 1.0, 0.0, 1e-3), 0.0);
        assert_eq!(memory, 0.0);
    }
}
