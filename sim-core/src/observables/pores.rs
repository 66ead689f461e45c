//! Pores: connected parts of the void, closed off by contacts.

use super::structure_factor::{DiscsInCell, SolidMesh};

/// A touching pair: disc and branch vector to the disc that it touches [a].
pub type Link = (usize, [f64; 2]);

/// Mean radius of gyration ξ' of the pores, each weighted by its area [a]; `None` without void.
///
/// A pore is a set of void points of the mesh joined over their edges; `links` are the branch vectors (from disc
/// `i`) of touching discs, drawn as walls so that the narrow void beside a contact does not join two pores. A pore
/// that winds around the cell is unrolled along the walk that finds it.
#[must_use]
pub fn pore_gyration_radius(discs: &DiscsInCell<'_>, links: &[Link]) -> Option<f64> {
    let mut mesh = SolidMesh::sample(discs);
    for &(disc, branch) in links {
        mesh.draw_segment(discs.positions[disc], branch);
    }
    let (mut weighted, mut total) = (0.0, 0.0);
    for pore in pores(&mesh) {
        weighted += pore.area * pore.gyration_radius;
        total += pore.area;
    }
    (total > 0.0).then(|| weighted / total)
}

struct Pore {
    area: f64,
    gyration_radius: f64,
}

fn pores(mesh: &SolidMesh) -> Vec<Pore> {
    let [columns, rows] = mesh.points;
    let mut seen = mesh.solid.clone();
    let mut found = Vec::new();
    let mut stack = Vec::new();
    for row in 0..rows as i64 {
        for column in 0..columns as i64 {
            let start = mesh.index(column, row);
            if seen[start] {
                continue;
            }
            seen[start] = true;
            stack.push((column, row));
            let mut moments = Moments::default();
            while let Some((x, y)) = stack.pop() {
                moments.add((x - column) as f64 * mesh.spacing[0], (y - row) as f64 * mesh.spacing[1]);
                for (next_x, next_y) in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
                    let next = mesh.index(next_x, next_y);
                    if !seen[next] {
                        seen[next] = true;
                        stack.push((next_x, next_y));
                    }
                }
            }
            found.push(moments.pore(mesh.spacing));
        }
    }
    found
}

#[derive(Default)]
struct Moments {
    count: f64,
    first: [f64; 2],
    second: f64,
}

impl Moments {
    fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        self.first[0] += x;
        self.first[1] += y;
        self.second += x * x + y * y;
    }

    fn pore(&self, spacing: [f64; 2]) -> Pore {
        let mean = [self.first[0] / self.count, self.first[1] / self.count];
        let variance = self.second / self.count - mean[0] * mean[0] - mean[1] * mean[1];
        // A mesh cell is a small rectangle, not a point.
        let own = (spacing[0] * spacing[0] + spacing[1] * spacing[1]) / 12.0;
        Pore {
            area: self.count * spacing[0] * spacing[1],
            gyration_radius: libm::sqrt(variance.max(0.0) + own),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square lattice of touching unit discs: one pore per cell of the lattice.
    fn square_lattice(side: u32) -> (Vec<[f64; 2]>, Vec<Link>) {
        let mut positions = Vec::new();
        let mut links = Vec::new();
        for row in 0..side {
            for column in 0..side {
                links.push((positions.len(), [1.0, 0.0]));
                links.push((positions.len(), [0.0, 1.0]));
                positions.push([f64::from(column) + 0.37, f64::from(row) + 0.11]);
            }
        }
        (positions, links)
    }

    #[test]
    fn pores_of_the_square_lattice() {
        let (positions, links) = square_lattice(12);
        let radii = vec![0.5; positions.len()];
        let discs = DiscsInCell { positions: &positions, radii: &radii, cell: [12.0, 12.0] };
        // Unit square minus four quarter discs about its centre: area 1 − π/4, second moment
        // 1/6 − π/4 (1/8 + (√2/2)²) + 2·(√2/2)·(quarter-disc offset 4R/(3π)·√2)·π/4, done here by quadrature.
        let steps = 2000;
        let (mut area, mut second) = (0.0, 0.0);
        for row in 0..steps {
            for column in 0..steps {
                let x = (f64::from(column) + 0.5) / f64::from(steps) - 0.5;
                let y = (f64::from(row) + 0.5) / f64::from(steps) - 0.5;
                let (to_x, to_y) = (0.5 - x.abs(), 0.5 - y.abs());
                if to_x * to_x + to_y * to_y > 0.25 {
                    area += 1.0;
                    second += x * x + y * y;
                }
            }
        }
        let exact = libm::sqrt(second / area);
        let found = pore_gyration_radius(&discs, &links).unwrap();
        assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
    }

    #[test]
    fn without_walls_the_void_is_one_pore() {
        let discs = DiscsInCell { positions: &[[2.0, 2.0]], radii: &[0.5], cell: [4.0, 4.0] };
        assert!(pore_gyration_radius(&discs, &[]).unwrap() > 1.0);
    }

    #[test]
    fn moments_do_not_depend_on_the_origin() {
        let (positions, links) = square_lattice(5);
        let radii = vec![0.5; positions.len()];
        let shifted: Vec<[f64; 2]> = positions.iter().map(|at| [at[0] + 1.25, at[1] - 2.5]).collect();
        let here = DiscsInCell { positions: &positions, radii: &radii, cell: [5.0, 5.0] };
        let there = DiscsInCell { positions: &shifted, radii: &radii, cell: [5.0, 5.0] };
        let (first, second) =
            (pore_gyration_radius(&here, &links).unwrap(), pore_gyration_radius(&there, &links).unwrap());
        assert!((first / second - 1.0).abs() < 1e-9);
    }
}
