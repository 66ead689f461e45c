//! A rectangle, periodic in both directions, whose edges are free or follow the stress.
//!
//! The strain rate e_α of direction α obeys de_α/dt = A (σ_α − P)/(M L_α²), clipped at a largest rate; positions move
//! affinely with the cell, dx/dt = v + e x, and velocities v are those relative to it. The relative velocity of a pair
//! includes the affine part e r, so images follow. Positive e is expansion, positive σ compression.

use serde::{Deserialize, Serialize};

use super::Boundary;
use crate::lane::{Lane, Real};
use crate::space::{Planar, V2};

/// Adding and subtracting 1.5 · 2⁵² rounds to the nearest whole number, ties to even, with the same bits everywhere.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// What the cell does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CellControl {
    /// The edges stay.
    Fixed,
    /// The edges move until σ_1 = σ_2 = P.
    Pressure {
        /// P [k_n/d].
        pressure: f64,
        /// Mass M of the cell coordinate [m].
        mass: f64,
        /// Largest strain rate [1/τ].
        cap: f64,
    },
}

/// The cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeriodicCell {
    /// Edges L_1, L_2 at t_n [d].
    pub edges: [f64; 2],
    /// Strain rates e_1, e_2 at t_n − dt/2 [1/τ].
    pub rate: [f64; 2],
    /// What moves the edges.
    pub control: CellControl,
    /// Coefficient of the local (non-viscous) damping of discs and cell: forces count 1 − c sign(F v) [1].
    pub local_damping: f64,
    /// Edges when the near pairs were found; no part of the state [d].
    #[serde(skip)]
    marked: [f64; 2],
}

impl PeriodicCell {
    /// A cell at rest.
    #[must_use]
    pub fn new(edges: [f64; 2], control: CellControl) -> Self {
        Self { edges, rate: [0.0; 2], control, local_damping: 0.0, marked: edges }
    }

    /// L_1 L_2 [d²].
    #[must_use]
    pub fn area(&self) -> f64 {
        self.edges[0] * self.edges[1]
    }

    /// Stresses σ_α = Σ F_α r_α/A, compression positive [k_n/d].
    #[must_use]
    pub fn stress(&self, virial: [f64; 2]) -> [f64; 2] {
        virial.map(|sum| sum / self.area())
    }

    fn rates(&self, virial: [f64; 3], dt: f64) -> [f64; 2] {
        let CellControl::Pressure { pressure, mass, cap } = self.control else {
            return [0.0; 2];
        };
        let area = self.area();
        std::array::from_fn(|axis| {
            let excess = virial[axis] / area - pressure;
            let power = excess * self.rate[axis];
            let share = if power > 0.0 {
                1.0 - self.local_damping
            } else if power < 0.0 {
                1.0 + self.local_damping
            } else {
                1.0
            };
            let gained = area * excess * share / (mass * self.edges[axis] * self.edges[axis]);
            (self.rate[axis] + dt * gained).clamp(-cap, cap)
        })
    }
}

impl<R: Real> Boundary<Planar<R>> for PeriodicCell {
    const DEFORMS: bool = true;

    #[inline(always)]
    fn nearest<L: Lane>(&self, separation: V2<L>) -> V2<L> {
        let [x, y] = separation.0;
        V2([nearest_along(x, self.edges[0]), nearest_along(y, self.edges[1])])
    }
    #[inline(always)]
    fn carried<L: Lane>(&self, separation: V2<L>, velocity: V2<L>) -> V2<L> {
        let ([x, y], [u, v]) = (separation.0, velocity.0);
        V2([x.mul_add(L::splat(self.rate[0]), u), y.mul_add(L::splat(self.rate[1]), v)])
    }

    fn separation(&self, separation: [f64; 3]) -> [f64; 3] {
        // Without fused operations, which are calls where the machine's own are not asked for; nothing but lists looks at it.
        let nearest = |axis: usize| {
            let (along, edge) = (separation[axis], self.edges[axis]);
            along - (along * (1.0 / edge) + ROUND - ROUND) * edge
        };
        [nearest(0), nearest(1), 0.0]
    }

    fn crosses(&self, separation: [f64; 3]) -> bool {
        let crossings = |axis: usize| separation[axis] * (1.0 / self.edges[axis]) + ROUND - ROUND;
        (crossings(0) != 0.0) | (crossings(1) != 0.0)
    }

    fn inside(&self, position: [f64; 3]) -> [f64; 3] {
        let wrap = |axis: usize| {
            let edge = self.edges[axis];
            let wrapped = position[axis] - edge * (position[axis] / edge).floor();
            if wrapped < edge { wrapped } else { 0.0 }
        };
        [wrap(0), wrap(1), 0.0]
    }

    fn images(&self, position: [f64; 3], reach: f64, visit: &mut dyn FnMut([f64; 3])) {
        let shifts = |axis: usize| {
            let edge = self.edges[axis];
            [
                Some(0.0),
                (position[axis] < reach).then_some(edge),
                (position[axis] > edge - reach).then_some(-edge),
            ]
        };
        for across in shifts(0).into_iter().flatten() {
            for up in shifts(1).into_iter().flatten() {
                if across != 0.0 || up != 0.0 {
                    visit([position[0] + across, position[1] + up, 0.0]);
                }
            }
        }
    }

    fn mark(&mut self) {
        self.marked = self.edges;
    }

    fn since_mark(&self, position: [f64; 3]) -> [f64; 3] {
        let now = |axis: usize| position[axis] * (self.edges[axis] / self.marked[axis]);
        [now(0), now(1), 0.0]
    }

    fn strain_since_mark(&self, apart: f64) -> f64 {
        let strain = |axis: usize| (self.edges[axis] / self.marked[axis] - 1.0).abs();
        apart * strain(0).max(strain(1))
    }

    fn fastest(&self) -> f64 {
        self.rate[0].abs().max(self.rate[1].abs())
    }

    fn next_rate(&self, virial: [f64; 3], dt: f64) -> [f64; 3] {
        let [across, up] = self.rates(virial, dt);
        [across, up, 0.0]
    }

    fn local_damping(&self) -> f64 {
        self.local_damping
    }

    fn advance(&mut self, virial: [f64; 3], dt: f64) {
        self.rate = self.rates(virial, dt);
        for (edge, rate) in self.edges.iter_mut().zip(self.rate) {
            *edge += dt * rate * *edge;
        }
    }

    fn fault(&self) -> Option<String> {
        /// Below this a disc could meet two images of another one [d].
        const SMALLEST: f64 = 2.5;
        // A NaN is not in any range.
        let bad = |axis: usize| !(SMALLEST..).contains(&self.edges[axis]) || !self.rate[axis].is_finite();
        (bad(0) || bad(1)).then(|| {
            format!(
                "cell {:.3} x {:.3} d with strain rates {:.3e}, {:.3e}",
                self.edges[0], self.edges[1], self.rate[0], self.rate[1]
            )
        })
    }
}

/// The nearest image along one edge. No closure: one that is not inlined makes a call of every vector instruction.
#[inline(always)]
fn nearest_along<L: Lane>(along: L, edge: f64) -> L {
    let crossings = along.mul_add(L::splat(1.0 / edge), L::splat(ROUND)).sub(L::splat(ROUND));
    crossings.neg_mul_add(L::splat(edge), along)
}

#[cfg(test)]
mod tests {
    use super::*;

    type Plane = Planar<f64>;

    fn cell(control: CellControl) -> PeriodicCell {
        let mut cell = PeriodicCell::new([8.0, 5.0], control);
        cell.rate = [0.01, -0.02];
        cell
    }

    #[test]
    fn nearest_image_and_affine_velocity() {
        let cell = cell(CellControl::Fixed);
        for (far, near) in
            [([7.5, 0.5], [-0.5, 0.5]), ([-4.5, 9.0], [3.5, -1.0]), ([20.0, -2.4], [4.0, -2.4])]
        {
            let image = Boundary::<Plane>::nearest::<f64>(&cell, V2(far));
            let velocity = Boundary::<Plane>::carried::<f64>(&cell, image, V2([1.0, 1.0]));
            assert!(
                (image.0[0].abs() - f64::abs(near[0])).abs() < 1e-14 && (image.0[1] - near[1]).abs() < 1e-14
            );
            assert_eq!(velocity.0[0], image.0[0].mul_add(0.01, 1.0));
            assert_eq!(velocity.0[1], image.0[1].mul_add(-0.02, 1.0));
        }
    }

    #[test]
    fn images_surround_the_cell() {
        let cell = cell(CellControl::Fixed);
        let mut found = Vec::new();
        Boundary::<Plane>::images(&cell, [0.5, 4.9, 0.0], 1.0, &mut |image| found.push(image));
        assert_eq!(found, [[0.5, 4.9 - 5.0, 0.0], [8.5, 4.9, 0.0], [8.5, 4.9 - 5.0, 0.0]]);
    }

    #[test]
    fn an_empty_cell_contracts_as_the_equation_says() {
        // σ = 0: de/dt = −A P/(M L²), L' = e L, second order in dt against a fine solution.
        let control = CellControl::Pressure { pressure: 1e-3, mass: 10.0, cap: 1.0 };
        let run = |dt: f64| {
            let mut cell = PeriodicCell::new([8.0, 5.0], control);
            // Start half a step back.
            cell.rate = cell.rates([0.0; 3], -0.5 * dt);
            for _ in 0..(20.0 / dt).round() as usize {
                Boundary::<Plane>::advance(&mut cell, [0.0; 3], dt);
            }
            cell.edges
        };
        let exact = run(1e-4);
        for axis in 0..2 {
            let errors = [0.2, 0.1, 0.05].map(|dt| (run(dt)[axis] - exact[axis]).abs());
            let order = (errors[0] / errors[2]).log2() / 2.0;
            assert!(order > 0.9, "{errors:?}");
        }
    }

    #[test]
    fn the_rate_is_capped() {
        let mut cell = cell(CellControl::Pressure { pressure: 1.0, mass: 1.0, cap: 0.03 });
        Boundary::<Plane>::advance(&mut cell, [0.0; 3], 1.0);
        assert_eq!(cell.rate, [-0.03, -0.03]);
    }
}
