//! Observables of one equilibrium state.

use core::f64::consts::PI;

use record::{NotFinite, Row};
use scene::discs::ReducedDiscs;

use super::scales::Scales;
use crate::dem::CellPicture;
use crate::elasticity::{Bond, BoundInputs, Network, moduli, reuss_bulk, voigt_bulk, voigt_shear, z2_ratio};
use crate::observables::bond_changes::BondChanges;
use crate::observables::disc_contacts::{
    DiscContact, LoadRules, coordination, expected_mean_normal, force_histogram,
};
use crate::observables::fractal::{LARGEST_WAVENUMBER, fit_fractal};
use crate::observables::pores::pore_gyration_radius;
use crate::observables::structure_factor::{DiscsInCell, Shell, SolidMesh, scattering};

/// Forces below this count as zero [F1].
pub const ZERO_FORCE: f64 = 1e-4;

/// Largest force of the histogram [unit of forces, times max(1, P*)], bins on each side of zero.
const HISTOGRAM_RANGE: f64 = 8.0;
const HISTOGRAM_BINS: usize = 80;

/// Everything measured on one state.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Columns of the state.
    pub row: Row,
    /// Scattering intensity by shells.
    pub shells: Vec<Shell>,
    /// Normal forces: middle of bin [unit of forces] and density.
    pub histogram: Vec<[f64; 2]>,
    /// Interacting pairs, sorted.
    pub pairs: Vec<(u32, u32)>,
}

/// Which interactions make a disc part of the load-carrying structure: with adhesion every one does.
#[must_use]
pub fn load_rules(scene: &ReducedDiscs) -> LoadRules {
    let needed = if scene.kr > 0.0 && scene.f0 > 0.0 { 1 } else { 2 };
    LoadRules { needed, unloaded_contacts_hold: scene.f0 > 0.0 }
}

/// The springs of a state.
#[must_use]
pub fn network(scene: &ReducedDiscs, picture: &CellPicture) -> Network {
    let bond = |contact: &DiscContact| {
        let touching = contact.gap < 0.0;
        let spring = |stiffness: f64| if touching { stiffness } else { 0.0 };
        let (i, j) = (contact.i as usize, contact.j as usize);
        Bond {
            i,
            j,
            branch: contact.branch,
            arm_i: picture.radii[i] + 0.5 * contact.gap,
            arm_j: picture.radii[j] + 0.5 * contact.gap,
            normal: if touching { 1.0 } else { -scene.f0 / scene.d0 },
            tangential: spring(scene.kt),
            rolling: spring(scene.kr),
        }
    };
    Network {
        discs: picture.radii.len(),
        area: picture.edges[0] * picture.edges[1],
        bonds: picture.contacts.iter().map(bond).collect(),
    }
}

/// Solid fraction Φ [1].
#[must_use]
pub fn solid_fraction(picture: &CellPicture) -> f64 {
    let solid: f64 = picture.radii.iter().map(|r| PI * r * r).sum();
    solid / (picture.edges[0] * picture.edges[1])
}

/// Measures a state.
///
/// # Errors
/// [`NotFinite`] when an observable is not a number.
pub fn measure(
    scene: &ReducedDiscs,
    scales: &Scales,
    picture: &CellPicture,
    before: Option<&[(u32, u32)]>,
) -> Result<Measured, NotFinite> {
    let mut row = Row::new();
    let phi = solid_fraction(picture);
    row.number("phi", phi)?.number("inverse_phi", 1.0 / phi)?.number("e", 1.0 / phi - 1.0)?;
    row.number("l1", picture.edges[0])?.number("l2", picture.edges[1])?;
    for (axis, name) in ["sigma_1", "sigma_2"].into_iter().enumerate() {
        row.number(name, picture.stress[axis] / scales.force)?;
    }
    let z = put_coordination(&mut row, scene, scales, picture)?;
    put_elasticity(&mut row, scene, scales, picture, z)?;
    let shells = put_structure(&mut row, picture)?;
    let pairs: Vec<(u32, u32)> = picture.contacts.iter().map(|contact| (contact.i, contact.j)).collect();
    if let Some(before) = before {
        let changes = BondChanges::between(before, &pairs);
        let count = |number: usize| i64::try_from(number).unwrap_or(i64::MAX);
        row.put("contacts_kept", count(changes.kept))
            .put("contacts_lost", count(changes.lost))
            .put("contacts_gained", count(changes.gained));
    }
    let range = HISTOGRAM_RANGE * (scales.pressure / scales.force).max(1.0);
    let forces = picture.contacts.iter().map(|contact| contact.normal / scales.force);
    let histogram = force_histogram(forces, -range, range, 2 * HISTOGRAM_BINS);
    let histogram = histogram.centres.iter().zip(&histogram.densities).map(|(&f, &p)| [f, p]).collect();
    Ok(Measured { row, shells, histogram, pairs })
}

fn put_coordination(
    row: &mut Row,
    scene: &ReducedDiscs,
    scales: &Scales,
    picture: &CellPicture,
) -> Result<f64, NotFinite> {
    let discs = picture.radii.len();
    let counts = coordination(discs, &picture.contacts, ZERO_FORCE * scales.f1, load_rules(scene));
    row.number("z", counts.all)?
        .number("z_plus", counts.compressive)?
        .number("z_minus", counts.tensile)?
        .number("z_zero", counts.unloaded)?
        .number("z_distant", counts.distant)?
        .number("rattler_share", counts.rattler_share)?
        .number("z_star", counts.backbone)?
        .number("x22", counts.two_by_two)?
        .number("mean_normal_force", counts.mean_normal / scales.force)?;
    if counts.all > 0.0 {
        let diameters: Vec<f64> = picture.radii.iter().map(|r| 2.0 * r).collect();
        let expected = expected_mean_normal(scales.pressure, counts.all, solid_fraction(picture), &diameters);
        row.number("mean_normal_force_expected", expected / scales.force)?;
    }
    Ok(counts.all)
}

fn put_elasticity(
    row: &mut Row,
    scene: &ReducedDiscs,
    scales: &Scales,
    picture: &CellPicture,
    z: f64,
) -> Result<(), NotFinite> {
    let count = picture.radii.len() as f64;
    let inputs = BoundInputs {
        coordination: z,
        solid_fraction: solid_fraction(picture),
        mean_diameter: picture.radii.iter().map(|r| 2.0 * r).sum::<f64>() / count,
        mean_square_diameter: picture.radii.iter().map(|r| 4.0 * r * r).sum::<f64>() / count,
        normal_stiffness: 1.0,
        tangential_stiffness: scene.kt,
    };
    row.number("bulk_voigt", voigt_bulk(&inputs))?.number("shear_voigt", voigt_shear(&inputs))?;
    let loaded: Vec<(f64, f64, f64)> = picture
        .contacts
        .iter()
        .filter(|contact| scene.f0 > 0.0 || contact.normal > ZERO_FORCE * scales.f1)
        .map(|contact| (contact.normal, contact.tangential, contact.rolling))
        .collect();
    if scales.pressure > 0.0
        && let Some(z2) = z2_ratio(&loaded, 1.0, scene.kt, scene.kr)
    {
        row.number("z2_ratio", z2)?.number("bulk_reuss", reuss_bulk(&inputs, z2))?;
    }
    // No moduli: the network carries nothing, or a pivot vanished; the columns stay absent and the sign says why.
    if let Ok(found) = moduli(&network(scene, picture)) {
        let sign = found.signature.smallest();
        row.put("stiffness_sign", i64::from(sign));
        row.put("unstable_modes", i64::try_from(found.signature.negative).unwrap_or(i64::MAX));
        row.number("bulk", found.bulk())?
            .number("shear", found.shear())?
            .number("c11", found.c11[0])?
            .number("c22", found.c11[1])?
            .number("c12", found.c12)?;
    }
    Ok(())
}

fn put_structure(row: &mut Row, picture: &CellPicture) -> Result<Vec<Shell>, NotFinite> {
    let discs = DiscsInCell { positions: &picture.positions, radii: &picture.radii, cell: picture.edges };
    let shells = scattering(&SolidMesh::sample(&discs), 2.0 * LARGEST_WAVENUMBER);
    if let Some(fit) = fit_fractal(&shells) {
        row.number("fractal_dimension", fit.dimension)?
            .number("correlation_length", fit.correlation_length)?
            .number("fractal_fit_rms", fit.rms)?;
    }
    let links: Vec<_> = picture
        .contacts
        .iter()
        .filter(|contact| contact.gap < 0.0)
        .map(|contact| (contact.i as usize, contact.branch))
        .collect();
    if let Some(radius) = pore_gyration_radius(&discs, &links) {
        row.number("pore_radius", radius)?;
    }
    Ok(shells)
}
