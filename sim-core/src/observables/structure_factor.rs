//! Scattering intensity of a packing of discs in a periodic rectangle.
//!
//! I(k) = |χ̂(k)|²/A with χ = 1 inside discs and 0 outside, sampled on a regular mesh, averaged over shells of
//! |k| (Gilabert, Roux and Castellanos 2008, section IV).

use core::f64::consts::PI;

use rustfft::FftPlannerScalar;
use rustfft::num_complex::Complex;

/// Mesh points per largest diameter, at least.
const POINTS_PER_DIAMETER: f64 = 12.0;
/// Largest mesh in one direction.
const LARGEST_MESH: usize = 4096;

/// Discs in a periodic rectangle, as the structure observables see them.
#[derive(Clone, Copy, Debug)]
pub struct DiscsInCell<'a> {
    /// Centres [a].
    pub positions: &'a [[f64; 2]],
    /// Radii [a].
    pub radii: &'a [f64],
    /// Edges L_1, L_2 of the cell [a].
    pub cell: [f64; 2],
}

/// A mesh over the cell: whether its points lie inside a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidMesh {
    /// Points in both directions.
    pub points: [usize; 2],
    /// Distance of the points in both directions [a].
    pub spacing: [f64; 2],
    /// Row by row along x: whether the point is inside a disc.
    pub solid: Vec<bool>,
}

impl SolidMesh {
    /// Samples the density field at the centres of a mesh with at least twelve points per diameter a.
    #[must_use]
    pub fn sample(discs: &DiscsInCell<'_>) -> Self {
        let points = discs.cell.map(|edge| {
            let wanted = libm::ceil(edge * POINTS_PER_DIAMETER) as usize;
            wanted.next_power_of_two().clamp(16, LARGEST_MESH)
        });
        Self::sample_with(discs, points)
    }

    /// Samples the density field on a mesh of the given size.
    #[must_use]
    pub fn sample_with(discs: &DiscsInCell<'_>, points: [usize; 2]) -> Self {
        let spacing = [discs.cell[0] / points[0] as f64, discs.cell[1] / points[1] as f64];
        let mut mesh = Self { points, spacing, solid: vec![false; points[0] * points[1]] };
        for (&centre, &radius) in discs.positions.iter().zip(discs.radii) {
            mesh.fill_disc(centre, radius);
        }
        mesh
    }

    /// Marks the points along a segment, whatever lies there.
    pub fn draw_segment(&mut self, from: [f64; 2], along: [f64; 2]) {
        let finest = self.spacing[0].min(self.spacing[1]);
        let pieces = libm::ceil(2.0 * libm::hypot(along[0], along[1]) / finest).max(1.0);
        for piece in 0..=pieces as usize {
            let part = piece as f64 / pieces;
            let column = libm::floor((from[0] + part * along[0]) / self.spacing[0]) as i64;
            let row = libm::floor((from[1] + part * along[1]) / self.spacing[1]) as i64;
            let index = self.index(column, row);
            self.solid[index] = true;
        }
    }

    /// Share of the points inside discs.
    #[must_use]
    pub fn solid_share(&self) -> f64 {
        self.solid.iter().filter(|&&inside| inside).count() as f64 / self.solid.len() as f64
    }

    /// Position of a point, periodically, in the row-by-row order.
    #[must_use]
    pub fn index(&self, column: i64, row: i64) -> usize {
        let wrap = |value: i64, count: usize| value.rem_euclid(count as i64) as usize;
        wrap(row, self.points[1]) * self.points[0] + wrap(column, self.points[0])
    }

    fn fill_disc(&mut self, centre: [f64; 2], radius: f64) {
        let first_row = libm::floor((centre[1] - radius) / self.spacing[1]) as i64;
        let last_row = libm::ceil((centre[1] + radius) / self.spacing[1]) as i64;
        for row in first_row..=last_row {
            let height = (row as f64 + 0.5) * self.spacing[1] - centre[1];
            let squared = radius * radius - height * height;
            if squared < 0.0 {
                continue;
            }
            let half_width = libm::sqrt(squared);
            // Points with |x − c_x| ≤ half width.
            let first = libm::ceil((centre[0] - half_width) / self.spacing[0] - 0.5) as i64;
            let last = libm::floor((centre[0] + half_width) / self.spacing[0] - 0.5) as i64;
            for column in first..=last {
                let index = self.index(column, row);
                self.solid[index] = true;
            }
        }
    }
}

/// A shell of wave vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// Mean |k| of the wave vectors in the shell [1/a].
    pub wavenumber: f64,
    /// Mean intensity I(k) = |χ̂|²/A per unit area [a²].
    pub intensity: f64,
    /// Number of independent wave vectors (k and −k count once).
    pub vectors: usize,
}

/// Shell-averaged scattering intensity up to `largest` |k|; shells one 2π/min(L_1, L_2) wide, empty ones left out.
#[must_use]
pub fn scattering(mesh: &SolidMesh, largest: f64) -> Vec<Shell> {
    let [columns, rows] = mesh.points;
    let transform = transform(mesh);
    let edges = [columns as f64 * mesh.spacing[0], rows as f64 * mesh.spacing[1]];
    let steps = edges.map(|edge| 2.0 * PI / edge);
    let width = steps[0].max(steps[1]);
    let cell_of_mesh = mesh.spacing[0] * mesh.spacing[1];
    let area = edges[0] * edges[1];
    let count = libm::ceil(largest / width) as usize + 1;
    let mut sums = vec![(0.0, 0.0, 0_usize); count];
    for row in 0..rows {
        let along_y = signed(row, rows);
        // Half of the plane is enough: χ is real.
        for column in 0..=columns / 2 {
            if column == 0 && along_y <= 0 {
                continue;
            }
            let wavenumber = libm::hypot(column as f64 * steps[0], along_y as f64 * steps[1]);
            if wavenumber > largest {
                continue;
            }
            let amplitude = transform[row * columns + column] * cell_of_mesh;
            let shell = &mut sums[libm::round(wavenumber / width) as usize];
            shell.0 += wavenumber;
            shell.1 += amplitude.norm_sqr() / area;
            shell.2 += 1;
        }
    }
    sums.iter()
        .filter(|shell| shell.2 > 0)
        .map(|&(wavenumber, intensity, vectors)| Shell {
            wavenumber: wavenumber / vectors as f64,
            intensity: intensity / vectors as f64,
            vectors,
        })
        .collect()
}

fn signed(index: usize, count: usize) -> i64 {
    if 2 * index < count { index as i64 } else { index as i64 - count as i64 }
}

/// Two-dimensional discrete transform of the density field minus its mean.
fn transform(mesh: &SolidMesh) -> Vec<Complex<f64>> {
    let [columns, rows] = mesh.points;
    let mean = mesh.solid_share();
    let mut field: Vec<Complex<f64>> =
        mesh.solid.iter().map(|&inside| Complex::new(if inside { 1.0 - mean } else { -mean }, 0.0)).collect();
    let mut planner = FftPlannerScalar::new();
    planner.plan_fft_forward(columns).process(&mut field);
    let along_columns = planner.plan_fft_forward(rows);
    let mut column_values = vec![Complex::new(0.0, 0.0); rows];
    for column in 0..columns {
        for (row, value) in column_values.iter_mut().enumerate() {
            *value = field[row * columns + column];
        }
        along_columns.process(&mut column_values);
        for (row, value) in column_values.iter().enumerate() {
            field[row * columns + column] = *value;
        }
    }
    field
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_disc_scatters_like_a_disc() {
        // |χ̂(k)| = 2π R J_1(kR)/k.
        let (cell, radius) = ([20.0, 20.0], 3.0);
        let discs = DiscsInCell { positions: &[[1.0, 19.0]], radii: &[radius], cell };
        let mesh = SolidMesh::sample_with(&discs, [1024, 1024]);
        for shell in scattering(&mesh, 2.0).iter().filter(|shell| shell.wavenumber < 0.9) {
            let k = shell.wavenumber;
            let amplitude = 2.0 * PI * radius * libm::j1(k * radius) / k;
            let wanted = amplitude * amplitude / 400.0;
            // The shell has a width: compare where I varies slowly.
            assert!((shell.intensity / wanted - 1.0).abs() < 0.05, "{shell:?} against {wanted}");
        }
    }

    #[test]
    fn square_lattice_scatters_at_its_bragg_peaks_only() {
        // Spacing 2, sixteen discs: peaks at |k| = π √(h² + l²), between them nothing.
        let mut positions = Vec::new();
        for row in 0..4 {
            for column in 0..4 {
                positions.push([2.0 * f64::from(column) + 0.3, 2.0 * f64::from(row) + 0.7]);
            }
        }
        let radius = 0.45;
        let discs = DiscsInCell { positions: &positions, radii: &[radius; 16], cell: [8.0, 8.0] };
        let mesh = SolidMesh::sample_with(&discs, [512, 512]);
        let shells = scattering(&mesh, 4.0);
        let peak = shells.iter().find(|shell| (shell.wavenumber - PI).abs() < 0.4).unwrap();
        let off_peak = shells.iter().filter(|shell| shell.wavenumber < PI - 0.5);
        for shell in off_peak {
            assert!(shell.intensity < 1e-20, "{shell:?}");
        }
        // The shell holds `vectors` wave vectors, two of them (π, 0) and (0, π) on the peak.
        let amplitude = 16.0 * 2.0 * PI * radius * libm::j1(PI * radius) / PI;
        let wanted = 2.0 * amplitude * amplitude / 64.0 / peak.vectors as f64;
        assert!((peak.intensity / wanted - 1.0).abs() < 0.01, "{peak:?} against {wanted}");
    }

    #[test]
    fn the_mesh_measures_the_solid_fraction() {
        let discs = DiscsInCell {
            positions: &[[0.1, 0.2], [3.0, 2.0], [3.9, 4.9]],
            radii: &[0.4, 0.5, 0.25],
            cell: [5.0, 5.0],
        };
        let exact = PI * (0.16 + 0.25 + 0.0625) / 25.0;
        let share = SolidMesh::sample_with(&discs, [1024, 1024]).solid_share();
        assert!((share / exact - 1.0).abs() < 2e-3, "{share} {exact}");
    }
}
