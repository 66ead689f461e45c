//! A bound on the stable time step from the network that is really there.
//!
//! Every contact is a set of springs that pull on the coordinates of two bodies. With masses divided out, the
//! stiffness matrix is K = Σ_c B_c B_cᵀ, and since |B_ca x_a + B_cb x_b|² ≤ 2|B_ca x_a|² + 2|B_cb x_b|²,
//! the largest eigenvalue obeys λ ≤ 2 max_a λ(K_aa): twice the largest eigenvalue of the diagonal block of one body
//! (translation and rotation, six by six), computed only where Gershgorin's row sums leave a doubt.
//! The same holds for the dashpots. Rotation enters: with k_t = 1.5 k_n and I = m d²/10 the rotational modes are the
//! stiffest.
//!
//! Leapfrog with a rate extrapolated over half a step is stable for ω² dt² + 4 γ dt ≤ 4 (γ: dashpot over mass): a
//! root of its characteristic polynomial passes through −1 there (unit test).

use nalgebra::{Matrix6, Vector6};

use super::engine::Dem;
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, Stiffness};
use crate::space::Space;
use crate::state::Grains;

/// Largest stable time step for a squared frequency ω² [1/τ²] and a damping rate γ = c/m [1/τ].
#[must_use]
pub fn largest_step(omega_squared: f64, gamma: f64) -> f64 {
    if omega_squared <= 0.0 && gamma <= 0.0 {
        return f64::INFINITY;
    }
    // ω² dt² + 4 γ dt − 4 = 0, in the form that has no cancellation.
    2.0 / (gamma + (gamma * gamma + omega_squared).sqrt())
}

/// Diagonal block of one body: stiffness and dashpots over mass, translation first.
#[derive(Clone)]
struct Block {
    stiffness: Matrix6<f64>,
    damping: Matrix6<f64>,
}

impl Block {
    /// Adds a contact with unit normal `n`, lever arm `arm` and dashpot `dashpot`.
    fn add(&mut self, n: [f64; 3], arm: f64, law: &Stiffness, dashpot: f64, mass: f64, inertia: f64) {
        let outer = |x: [f64; 3], w: [f64; 3]| {
            let direction = Vector6::new(x[0], x[1], x[2], w[0], w[1], w[2]);
            direction * direction.transpose()
        };
        let over = |v: [f64; 3], scale: f64| v.map(|x| x * scale);
        let (per_mass, per_inertia) = (1.0 / mass.sqrt(), 1.0 / inertia.sqrt());
        let along = outer(over(n, per_mass), [0.0; 3]);
        self.stiffness += along * law.normal;
        self.damping += along * dashpot;
        let (t, s) = tangents(n);
        // A contact point moves along t by translation and by rotation about n × t = s, along s about −t.
        for (direction, axis) in [(t, s), (s, over(t, -1.0))] {
            self.stiffness +=
                outer(over(direction, per_mass), over(axis, arm * per_inertia)) * law.tangential;
            if law.rolling > 0.0 {
                self.stiffness += outer([0.0; 3], over(direction, per_inertia)) * law.rolling;
            }
        }
    }

    /// Gershgorin: the largest absolute row sum bounds every eigenvalue.
    fn row_sum(matrix: &Matrix6<f64>) -> f64 {
        matrix.row_iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max)
    }
}

/// Two unit vectors that make a right-handed frame with n.
fn tangents(n: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let mut axis = [0.0; 3];
    let least = if n[0].abs() <= n[1].abs() && n[0].abs() <= n[2].abs() {
        0
    } else if n[1].abs() <= n[2].abs() {
        1
    } else {
        2
    };
    axis[least] = 1.0;
    let t = cross(axis, n);
    let length = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]).sqrt();
    let t = t.map(|x| x / length);
    (t, cross(n, t))
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Largest time step that is certainly stable for the contacts of this instant [τ].
    pub(super) fn network_limit(&self) -> f64 {
        let view = self.picture();
        let empty = Block { stiffness: Matrix6::zeros(), damping: Matrix6::zeros() };
        let mut blocks = vec![empty; self.len()];
        let mut slot_of = vec![0_usize; self.len()];
        for (slot, &particle) in self.original.iter().enumerate() {
            slot_of[particle as usize] = slot;
        }
        let (law, wall_law) = (self.law.stiffness(), self.wall_law.stiffness());
        for contact in &view.contacts {
            let slots = [slot_of[contact.i] as u32, slot_of[contact.j] as u32];
            // SAFETY: both are valid slots.
            let root = unsafe { self.grains.root_pair_mass::<f64>(&raw const slots[0], &raw const slots[1]) };
            for slot in slots.map(|slot| slot as usize) {
                let (mass, inertia) = (self.grains.mass(slot), self.grains.inertia(slot));
                let arm = self.grains.radius(slot);
                blocks[slot].add(contact.normal, arm, &law, law.damping * root, mass, inertia);
            }
        }
        let mut wall_sums = [(0.0, 0.0); 6];
        for contact in &view.wall_contacts {
            let slot = slot_of[contact.particle];
            let index = slot as u32;
            // SAFETY: a valid slot.
            let dashpot = wall_law.damping * unsafe { self.grains.root_wall_mass::<f64>(&raw const index) };
            let mut normal = [0.0; 3];
            normal[contact.wall / 2] = 1.0;
            let (mass, inertia) = (self.grains.mass(slot), self.grains.inertia(slot));
            blocks[slot].add(normal, self.grains.radius(slot), &wall_law, dashpot, mass, inertia);
            wall_sums[contact.wall].0 += wall_law.normal;
            wall_sums[contact.wall].1 += dashpot;
        }
        let mut limit = f64::INFINITY;
        if let Some(walls) = &self.walls {
            for (wall, (stiffness, damping)) in wall_sums.into_iter().enumerate() {
                if walls.moving[wall] {
                    limit = limit.min(largest_step(2.0 * stiffness / walls.mass, 2.0 * damping / walls.mass));
                }
            }
        }
        for block in &blocks {
            let rough =
                largest_step(2.0 * Block::row_sum(&block.stiffness), 2.0 * Block::row_sum(&block.damping));
            if rough < limit {
                let stiffness = block.stiffness.symmetric_eigenvalues().max();
                let damping = block.damping.symmetric_eigenvalues().max();
                limit = limit.min(largest_step(2.0 * stiffness, 2.0 * damping));
            }
        }
        limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest |x| after many steps of the scheme for one damped oscillator started at 1.
    fn amplitude(omega_squared: f64, gamma: f64, dt: f64) -> f64 {
        let (mut x, mut v, mut before) = (1.0_f64, 0.0, 0.0);
        for _ in 0..4000 {
            let rate = v + 0.5 * (v - before);
            before = v;
            v -= dt * (omega_squared * x + gamma * rate);
            x += dt * v;
            if x.abs() > 1e9 {
                break;
            }
        }
        x.abs()
    }

    #[test]
    fn scheme_is_stable_just_below_the_limit_and_unstable_just_above() {
        for (omega_squared, gamma) in [(1.0, 0.0), (2.0, 0.7), (1.0, 2.0), (0.1, 5.0), (30.0, 11.0)] {
            let limit = largest_step(omega_squared, gamma);
            assert!(amplitude(omega_squared, gamma, 0.98 * limit) < 1e3, "{omega_squared} {gamma}");
            assert!(amplitude(omega_squared, gamma, 1.02 * limit) > 1e6, "{omega_squared} {gamma}");
        }
    }
}
