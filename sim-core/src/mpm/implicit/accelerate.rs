//! Anderson's acceleration of an iteration that creeps.
//!
//! Contact normals turn as discs slide along each other, which the tangent does not know: a disc that only its
//! frictionless contacts hold sways to and fro, or away, by a nearly constant factor from iterate to iterate. The
//! combination of the last iterates whose change would be least (Anderson 1965, two of them back) ends that. It is used in
//! turns with plain iterations, which the residual is judged by.

use std::collections::VecDeque;

use super::Work;
use crate::mpm::body::Body;

/// Iterates looked back to.
const DEPTH: usize = 2;

/// Determinant of the normalised normal equations below which the second iterate back says nothing new.
const PARALLEL: f64 = 1e-6;

/// The last iterates of all bodies, one after another, the newest first.
#[derive(Default)]
pub(super) struct Accelerator {
    past: VecDeque<Iterate>,
}

struct Iterate {
    /// What the iteration changed.
    change: Vec<f64>,
    /// What it came to.
    end: Vec<f64>,
}

impl Accelerator {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.past.clear();
    }

    /// Takes down the iteration just done.
    pub(super) fn remember(&mut self, work: &[Work]) {
        self.past.truncate(DEPTH);
        let all = |of: fn(&Work) -> &Vec<f64>| work.iter().flat_map(of).copied().collect();
        self.past.push_front(Iterate { change: all(|work| &work.change), end: all(|work| &work.velocity) });
    }

    /// Replaces the velocities by the best combination, no node further than `limit` from where it was; `false` when there
    /// is none.
    pub(super) fn apply(&self, work: &mut [Work], bodies: &[Body], limit: f64) -> bool {
        let masses: Vec<f64> = bodies.iter().flat_map(|body| &body.mass).flat_map(|&m| [m, m]).collect();
        let Some(weights) = self.weights(&masses) else { return false };
        let newest = &self.past[0];
        let correction: Vec<f64> = (0..masses.len())
            .map(|k| {
                let back = |(w, one): (&f64, &Iterate)| w * (one.end[k] - newest.end[k]);
                weights.iter().zip(self.past.iter().skip(1)).map(back).sum()
            })
            .collect();
        let most = correction.iter().fold(limit, |most, one| most.max(one.abs()));
        let velocities = work.iter_mut().flat_map(|work| &mut work.velocity);
        for (v, one) in velocities.zip(&correction) {
            *v += limit / most * one;
        }
        true
    }

    /// Weights of the earlier iterates: the least change in the norm of the kinetic energy.
    fn weights(&self, masses: &[f64]) -> Option<Vec<f64>> {
        let newest = &self.past.front()?.change;
        let product = |a: &dyn Fn(usize) -> f64, b: &dyn Fn(usize) -> f64| -> f64 {
            masses.iter().enumerate().map(|(k, m)| m * a(k) * b(k)).sum()
        };
        let back = |i: usize| move |k: usize| newest[k] - self.past[i].change[k];
        let now = |k: usize| newest[k];
        if self.past.len() < 2 {
            return None;
        }
        let (aa, a) = (product(&back(1), &back(1)), product(&back(1), &now));
        if aa <= 0.0 {
            return None;
        }
        if self.past.len() > 2 {
            let (ab, bb) = (product(&back(1), &back(2)), product(&back(2), &back(2)));
            let (b, det) = (product(&back(2), &now), aa * bb - ab * ab);
            if det > PARALLEL * aa * bb {
                return Some(vec![(a * bb - b * ab) / det, (b * aa - a * ab) / det]);
            }
        }
        Some(vec![a / aa])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration with two modes that do not die out: v → c + Λ (v − c).
    #[test]
    fn two_modes_are_found_after_three_iterates() {
        let (centre, rates) = ([0.3, -1.2, 0.7], [-0.98, 1.05, -0.98]);
        let masses = [1.0, 2.0, 0.5];
        let (mut accelerator, mut v) = (Accelerator::default(), [1.0, 0.5, -0.4]);
        for _ in 0..3 {
            let end: Vec<f64> = (0..3).map(|k| centre[k] + rates[k] * (v[k] - centre[k])).collect();
            let change = (0..3).map(|k| end[k] - v[k]).collect();
            v.copy_from_slice(&end);
            accelerator.past.push_front(Iterate { change, end });
        }
        let weights = accelerator.weights(&masses).unwrap();
        for (k, exact) in centre.iter().enumerate() {
            let back = |i: usize| weights[i - 1] * (accelerator.past[i].end[k] - v[k]);
            assert!((v[k] + back(1) + back(2) - exact).abs() < 1e-9);
        }
    }

    #[test]
    fn one_iterate_says_nothing() {
        let mut accelerator = Accelerator::default();
        assert!(accelerator.weights(&[1.0]).is_none());
        accelerator.past.push_front(Iterate { change: vec![0.5], end: vec![1.0] });
        assert!(accelerator.weights(&[1.0]).is_none());
        accelerator.past.push_front(Iterate { change: vec![0.5], end: vec![1.5] });
        assert!(accelerator.weights(&[1.0]).is_none());
    }
}
