//! SI units to the groups of `cohesive_spheres`.

use super::{ReducedSpheres, Spheres};
use crate::description::Description;
use crate::spheres::keys::KEYS;
use crate::spheres::quantities::{QUANTITIES, out_of_model};
use crate::table::Key;
use crate::{Model, Problem, Quantity, round12};

/// Pressure that sets the agitation, p0 = 0.01 MPa [Pa].
const P0: f64 = 1.0e4;

/// Number of spheres for which the paper gives the wall mass.
const PAPER_N: f64 = 17_657.0;

/// v_k / √(p0 d³/m): kinetic pressure ρ φ v_k² 57 times below p0 at e_i = 1.72.
const AGITATION: f64 = 0.158;

impl Description for Spheres {
    type Reduced = ReducedSpheres;
    const MODEL: Model = Model::CohesiveSpheres;
    const KEYS: &'static [Key] = KEYS;
    const QUANTITIES: &'static [Quantity<Self>] = QUANTITIES;

    fn conflicts(&self) -> Vec<Problem> {
        super::keys::conflicts(self)
    }

    /// p/σe, σc/σe, v_k = agitation · 0.158 √(p0/σe), m_w scaled by wall area when asked, … .
    fn reduce(&self) -> ReducedSpheres {
        #[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
        let size_ratio = self.n as f64 / PAPER_N;
        // N^(2/3) by libm: the same bits on every machine, as the scene key needs.
        let area_ratio = libm::cbrt(size_ratio * size_ratio);
        let wall_mass = if self.scale_wall_mass { self.mw * area_ratio } else { self.mw };
        ReducedSpheres {
            n: self.n,
            seed: self.seed,
            pressure: round12(self.p / self.sigma_e),
            adhesion: round12(self.sigma_c / self.sigma_e),
            alpha_n: round12(self.alpha_n),
            mu: round12(self.mu),
            kt_over_kn: round12(self.kt_over_kn),
            wall_mass: round12(wall_mass),
            ei: round12(self.ei),
            mu_wall: round12(self.mu_wall),
            wall_adhesion: round12(self.wall_adhesion),
            moving_walls: self.moving_walls,
            agitation_speed: round12(self.agitation * AGITATION * (P0 / self.sigma_e).sqrt()),
            damping_mass: self.damping_mass,
            clamp_viscous: self.clamp_viscous,
            dt: self.dt.map(round12),
            max_steps: self.max_steps,
            stop: self.stop.rounded(),
            approach: self.approach,
            precision: self.precision,
        }
    }

    fn out_of_model(&self) -> Option<String> {
        out_of_model(self)
    }
}
