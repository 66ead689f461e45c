//! Incremental tangential spring with Coulomb limit in the plane (discs 2008, Table I).
//!
//! As [`super::CoulombSpring`], where the tangent plane is a line: a force F_T along t = (−n_y, n_x), which turns with
//! the contact by itself, grows by K_T times the slip along t and is cut to |F_T| ≤ μ f_e. One number to remember, no
//! projection, no root.

use super::Tangential;
use crate::lane::{Lane, Real};
use crate::space::{Planar, V1, V2};

/// Spring k_t, limit μ f_e, in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarSpring {
    /// k_t [k_n].
    pub kt: f64,
    /// μ [1].
    pub mu: f64,
}

impl<R: Real> Tangential<Planar<R>> for PlanarSpring {
    const SLOTS: usize = 1;
    const NEEDS_SPIN: bool = true;
    // Swapped bodies reverse n, t and the slip, and with them nothing of what is along t.
    const REVERSES: bool = false;
    const NAME: &'static str = "+planar_coulomb";

    #[inline(always)]
    unsafe fn stretch<L: Lane>(
        &self,
        _: V2<L>,
        slip: &L,
        _: L,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (V1<L>, L::Mask) {
        // SAFETY: the caller vouches for the slot.
        let old = unsafe { L::load(memory) };
        let grown = slip.mul_add(L::splat(self.kt).mul(dt), old);
        let bound = L::splat(self.mu).mul(elastic);
        let force = grown.min(bound).max(L::splat(0.0).sub(bound)).keep(active);
        // SAFETY: as above.
        unsafe { force.store(memory) };
        (V1([force]), active)
    }
    fn stiffness(&self) -> f64 {
        self.kt
    }
    fn bound(&self, elastic: f64) -> f64 {
        self.mu * elastic
    }
}

#[cfg(test)]
mod tests {
    use super::super::CoulombSpring;
    use super::*;
    use crate::lane::Number;
    use crate::space::{Space, Spatial, SpatialSlide, V3};

    /// Force on a closed contact, bound and all; one that is open has no elastic force.
    ///
    /// # Safety
    /// There is room for every slot.
    unsafe fn force<S: Space, T: Tangential<S>>(
        law: &T,
        normal: S::Vector<f64>,
        slide: &S::Slide<f64>,
        elastic: f64,
        dt: f64,
        memory: &mut [f64],
    ) -> S::Shear<f64> {
        let memory = memory.as_mut_ptr();
        // SAFETY: the caller vouches.
        unsafe {
            let (force, sliding) = law.stretch::<f64>(normal, slide, 0.0, elastic, elastic > 0.0, dt, memory);
            if !(T::BOUNDED && sliding) {
                return force;
            }
            law.limit(elastic, memory);
            law.held(memory)
        }
    }

    /// Force of both laws on a contact whose normal turns steadily by 2 rad while it slips to and fro.
    fn shear(mu: f64, steps: u32) -> [[f64; 2]; 2] {
        let (plane, space) = (PlanarSpring { kt: 0.7, mu }, CoulombSpring { kt: 0.7, mu });
        let (time, turn) = (2.0, 1.0);
        let dt = time / f64::from(steps);
        let (mut one, mut three) = ([0.0; f64::GROUP], [0.0; 3 * f64::GROUP]);
        let mut last = [[0.0; 2]; 2];
        for step in 1..=steps {
            let now = f64::from(step) * dt;
            let (x, y) = (libm::cos(turn * now), libm::sin(turn * now));
            let middle = turn * (now - 0.5 * dt);
            let rate = 0.3 * libm::cos(3.0 * (now - 0.5 * dt));
            let (u, v) = (-libm::sin(middle), libm::cos(middle));
            let slide = SpatialSlide {
                between: V3([u * rate, v * rate, 0.0]),
                normal_between: V3([x - 0.5 * dt * turn * u, y - 0.5 * dt * turn * v, 0.0]),
                turn: 0.0,
            };
            // Slip along the tangent of t_n.
            let slip = rate * (v * x - u * y);
            // SAFETY: there is room for every slot.
            let (a, b) = unsafe {
                let a = force::<Planar, _>(&plane, V2([x, y]), &slip, 0.05, dt, &mut one);
                let b = force::<Spatial, _>(&space, V3([x, y, 0.0]), &slide, 0.05, dt, &mut three);
                (a.0[0], b.0)
            };
            last = [[-a * y, a * x], [b[0], b[1]]];
        }
        last
    }

    #[test]
    fn agrees_with_the_spring_of_space_in_second_order() {
        for mu in [0.5, 1e3] {
            let difference = |steps: u32| {
                let [[a, b], [x, y]] = shear(mu, steps);
                libm::hypot(a - x, b - y)
            };
            let (coarse, fine) = (difference(200), difference(800));
            assert!(fine < 1e-5 && fine <= coarse / 10.0 + 1e-15, "{mu}: {coarse:e} {fine:e}");
        }
    }

    #[test]
    fn an_open_contact_forgets() {
        let law = PlanarSpring { kt: 1.0, mu: 0.5 };
        let mut memory = [0.0];
        // SAFETY: one slot.
        let mut at = |elastic: f64| unsafe {
            force::<Planar, _>(&law, V2([1.0, 0.0]), &1.0, elastic, 0.1, &mut memory).0[0]
        };
        assert_eq!(at(1.0), 0.1);
        assert_eq!(at(0.1), 0.05);
        assert_eq!(at(0.0), 0.0);
        assert_eq!(at(1.0), 0.1);
    }
}
