//! Ghost penalty on nodes that hardly any material point holds.
//!
//! A grid that does not fit the body has nodes whose functions reach only a sliver of it: the tangent is nearly
//! singular there. For every row of three neighbours with such a node among them γ E |u₁ − 2u₂ + u₃|²/2 is added to the
//! energy: it ties weak nodes to a continuation of the motion inside and vanishes where that is affine.

use super::Law;
use crate::mpm::body::Body;
use crate::mpm::skyline::Skyline;

/// γ. Without it a quasi-static disc on a grid of splines does not converge at all.
const PENALTY: f64 = 1e-3;

const BEND: [f64; 3] = [1.0, -2.0, 1.0];

/// Adds the force of the penalty for a displacement.
pub fn add_force(body: &Body, displacement: &[f64], law: &Law, force: &mut [f64]) {
    let stiffness = PENALTY * law.material.young;
    for triple in &body.template.ghost {
        for axis in 0..2 {
            let at = triple.map(|node| 2 * node as usize + axis);
            let bent = displacement[at[0]] - 2.0 * displacement[at[1]] + displacement[at[2]];
            for (unknown, share) in at.into_iter().zip(BEND) {
                force[unknown] += stiffness * share * bent;
            }
        }
    }
}

/// Adds `factor` times its tangent.
pub(super) fn add_tangent(body: &Body, law: &Law, factor: f64, matrix: &mut Skyline) {
    let stiffness = factor * PENALTY * law.material.young;
    let profile = &body.template.profile;
    for triple in &body.template.ghost {
        for axis in 0..2 {
            let at = triple.map(|node| 2 * node as usize + axis);
            for a in 0..3 {
                for b in 0..=a {
                    matrix.add(profile.entry(at[a], at[b]), stiffness * BEND[a] * BEND[b]);
                }
            }
        }
    }
}
