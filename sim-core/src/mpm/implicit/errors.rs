//! How far an iterate is from the solution, and which bodies hold it up.

use super::{Implicit, SLOW};
use crate::mpm::world::World;

impl Implicit {
    /// Relative force residual with the present impulses, and worst overlap or gap under load in cells.
    pub(super) fn errors(&mut self, world: &World, dt: f64, cell: f64) -> (f64, f64) {
        self.contact_impulse.iter_mut().for_each(|vector| vector.fill(0.0));
        self.rows.scatter(&mut self.contact_impulse);
        let (mut residual, mut forces, mut contact, mut inertia) = (0.0, 0.0, 0.0, 0.0);
        for ((body, work), impulse) in world.bodies.iter().zip(&mut self.work).zip(&self.contact_impulse) {
            let profile = &body.template.profile;
            let inner = profile.size() - profile.contact_size();
            let mut own = 0.0;
            for (unknown, r) in work.residual.iter().enumerate() {
                let row = profile.row_of(unknown);
                let p = if row >= inner { impulse[row - inner] } else { 0.0 };
                // what holds an unknown at rest also takes the impulse on it
                let left = if body.fixed.contains(&(unknown as u32)) { 0.0 } else { r - p };
                own += left * left;
                contact += p * p;
                let force = dt * work.force[unknown];
                forces += force * force;
                let momentum = body.mass[unknown / 2] * work.velocity[unknown];
                inertia += momentum * momentum;
            }
            residual += own;
            work.left = [own.sqrt(), work.left[0]];
        }
        let scale = f64::max(forces, contact).max(1e-6 * inertia);
        let relative = if scale > 0.0 { (residual / scale).sqrt() } else { 0.0 };
        let loads: f64 = self.rows.rows.iter().map(|row| row.impulse[0]).sum();
        let mean = loads / self.rows.rows.iter().filter(|row| row.impulse[0] > 0.0).count().max(1) as f64;
        let mut worst = 0.0_f64;
        for (row, candidate) in self.rows.rows.iter().zip(self.candidates.iter().flatten()) {
            let under_load = if row.impulse[0] > 1e-3 * mean { candidate.gap } else { 0.0 };
            worst = worst.max(-candidate.gap).max(under_load);
        }
        (relative, worst / cell)
    }

    /// Asks for new factors of the bodies whose residual no longer falls and makes up at least the share `least` of the
    /// whole: of hundreds of discs one is in trouble, seldom two.
    pub(super) fn renew(&mut self, least: f64) {
        let whole: f64 = self.work.iter().map(|work| work.left[0] * work.left[0]).sum::<f64>().sqrt();
        for work in &mut self.work {
            work.fresh = work.left[0] > SLOW * work.left[1] && work.left[0] > least * whole;
        }
    }
}
