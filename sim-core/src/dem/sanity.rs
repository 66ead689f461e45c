//! Whether a state still makes sense.

use super::Fault;
use super::engine::Dem;
use super::lists::speed;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::space::Space;
use crate::state::{Grains, Kinematics};

/// Largest distance a particle or wall may move in a step [d].
const FASTEST: f64 = 0.25;

/// How far outside the walls a centre may be [d].
const OUTSIDE: f64 = 1.0;

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Whether the state makes sense.
    pub(super) fn look(&self) -> Result<(), Fault> {
        let fault = |what: String| Err(Fault { step: self.step, what });
        if let Some(what) = self.boundary.fault() {
            return fault(what);
        }
        if self.looks_sane() {
            return Ok(());
        }
        for (slot, body) in self.bodies.iter().enumerate() {
            let (x, (v, w)) = (body.position(), body.motion());
            if !(0..3).all(|k| x[k].is_finite() && v[k].is_finite() && w[k].is_finite()) {
                return fault(format!("particle {} is not finite", self.original[slot]));
            }
            let travel = speed::<S>(body) * self.dt;
            if travel > FASTEST {
                return fault(format!("particle {} moves {travel:.3e} d in a step", self.original[slot]));
            }
            if let Some(walls) = &self.walls {
                for axis in 0..3 {
                    let beyond =
                        (walls.position[2 * axis] - x[axis]).max(x[axis] - walls.position[2 * axis + 1]);
                    if beyond > OUTSIDE {
                        return fault(format!(
                            "particle {} is {beyond:.3e} d outside the walls",
                            self.original[slot]
                        ));
                    }
                }
            }
        }
        if let Some(walls) = &self.walls {
            for wall in 0..6 {
                if !walls.position[wall].is_finite() || !walls.velocity[wall].is_finite() {
                    return fault(format!("wall {wall} is not finite"));
                }
                let travel = walls.velocity[wall].abs() * self.dt;
                if travel > FASTEST {
                    return fault(format!("wall {wall} moves {travel:.3e} d in a step"));
                }
            }
        }
        Ok(())
    }
    /// Whether nothing needs a closer look. Without branches: this comes often. A NaN or infinity is not below anything.
    fn looks_sane(&self) -> bool {
        let square = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let (per_time, edge) = (self.dt * self.dt, f64::INFINITY);
        let (mut low, mut high) = ([edge; 3], [-edge; 3]);
        let mut sane = true;
        for body in &self.bodies {
            let (x, (v, w)) = (body.position(), body.motion());
            let square_speed = square(v);
            sane &= (square_speed * per_time <= FASTEST * FASTEST) & (square_speed < edge);
            sane &= (square(x) < edge) & (square(w) < edge);
            for axis in 0..3 {
                low[axis] = if x[axis] < low[axis] { x[axis] } else { low[axis] };
                high[axis] = if x[axis] > high[axis] { x[axis] } else { high[axis] };
            }
        }
        sane && self.walls.as_ref().is_none_or(|walls| {
            (0..3).all(|axis| {
                let inside = low[axis] >= walls.position[2 * axis] - OUTSIDE
                    && high[axis] <= walls.position[2 * axis + 1] + OUTSIDE;
                let slow = |wall: usize| walls.velocity[wall].abs() * self.dt <= FASTEST;
                inside && slow(2 * axis) && slow(2 * axis + 1)
            })
        })
    }
}
