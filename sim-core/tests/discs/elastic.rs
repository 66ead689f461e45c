//! The stiffness matrix against an explicit small loading.

use sim_core::dem::{CellControl, DiscParameters, InitialDiscs, discs};
use sim_core::elasticity::{Bond, Network, moduli};

use crate::support::{FAST, settle, triangular};

#[test]
fn moduli_predict_the_strain_of_a_small_load() {
    // A lattice with three vacancies (so that discs turn and displace), hardly prestressed: forces are 1e-6 K_N a,
    // their geometric stiffness is 1e-6 of that of the springs; the load step strains by 1e-7 and the secant over
    // overlaps is linear.
    let parameters = DiscParameters {
        f0: 1e-6,
        d0: 1e-3,
        restitution: 0.015,
        kt: 0.7,
        mu: 1e3,
        kr: 1e-2,
        mu_r: 1e3,
        mixed: false,
    };
    let control = |pressure: f64| CellControl::Pressure { pressure, mass: 50.0, cap: 1e-2 };
    let mut initial = triangular(6, 3, 0.999_999, control(1e-6));
    for vacancy in [29, 15, 14] {
        for list in [&mut initial.positions, &mut initial.velocities] {
            list.swap_remove(vacancy);
        }
        initial.radii.swap_remove(vacancy);
        initial.spins.swap_remove(vacancy);
    }
    let mut dem = discs(&parameters, &initial, 0.1, &FAST);
    settle(dem.as_mut(), 60_000);
    let picture = dem.picture();
    let bond = |contact: &sim_core::observables::disc_contacts::DiscContact| Bond {
        i: contact.i as usize,
        j: contact.j as usize,
        branch: contact.branch,
        arm_i: 0.5 + 0.5 * contact.gap,
        arm_j: 0.5 + 0.5 * contact.gap,
        normal: 1.0,
        tangential: 0.7,
        rolling: 1e-2,
    };
    let network = Network {
        discs: picture.radii.len(),
        area: dem.cell().area(),
        bonds: picture.contacts.iter().map(bond).collect(),
    };
    let found = moduli(&network).unwrap();
    assert_eq!(found.signature.smallest(), 1);
    // Strains under an isotropic increment: C ε = (−dP, −dP).
    let step = 1e-7;
    let before = dem.cell().edges;
    dem.set_control(control(1e-6 + step));
    settle(dem.as_mut(), 60_000);
    let after = dem.cell().edges;
    let determinant = found.c11[0] * found.c11[1] - found.c12 * found.c12;
    for axis in 0..2 {
        let predicted = -step * (found.c11[1 - axis] - found.c12) / determinant;
        let strain = after[axis] / before[axis] - 1.0;
        assert!((strain / predicted - 1.0).abs() < 1e-4, "axis {axis}: {strain:e} {predicted:e}");
    }
}

#[test]
fn moduli_of_a_lattice_with_mechanisms() {
    // Frictionless discs that stick to a square lattice, without prestress: every row and every column slides freely,
    // yet C_11 = C_22 = K_N and C_12 = 0, at the bound of Voigt; and so the lattice strains.
    let parameters = DiscParameters {
        f0: 1e-6,
        d0: 1e-3,
        restitution: 0.015,
        kt: 0.0,
        mu: 0.0,
        kr: 0.0,
        mu_r: 0.0,
        mixed: false,
    };
    let control = |pressure: f64| CellControl::Pressure { pressure, mass: 50.0, cap: 1e-2 };
    let (side, spacing) = (6_usize, 1.0 - 1e-6);
    let initial = InitialDiscs {
        positions: (0..side * side)
            .map(|k| [((k % side) as f64 + 0.5) * spacing, ((k / side) as f64 + 0.5) * spacing])
            .collect(),
        radii: vec![0.5; side * side],
        velocities: vec![[0.0; 2]; side * side],
        spins: vec![0.0; side * side],
        edges: [side as f64 * spacing; 2],
        control: control(0.0),
    };
    let mut dem = discs(&parameters, &initial, 0.1, &FAST);
    settle(dem.as_mut(), 20_000);
    let picture = dem.picture();
    let bonds = picture.contacts.iter().map(|contact| Bond {
        i: contact.i as usize,
        j: contact.j as usize,
        branch: contact.branch,
        arm_i: 0.5,
        arm_j: 0.5,
        normal: 1.0,
        tangential: 0.0,
        rolling: 0.0,
    });
    let network = Network { discs: side * side, area: dem.cell().area(), bonds: bonds.collect() };
    let found = moduli(&network).unwrap();
    // One displacement of each row and each column, less the two translations.
    assert_eq!((found.signature.zero, found.signature.negative), (2 * side - 2, 0));
    assert!((found.bulk() - 0.5).abs() < 1e-9 && (found.shear() - 0.5).abs() < 1e-9, "{found:?}");
    let before = dem.cell().edges;
    dem.set_control(control(1e-7));
    settle(dem.as_mut(), 60_000);
    for axis in 0..2 {
        let strain = dem.cell().edges[axis] / before[axis] - 1.0;
        let predicted = -1e-7 / (found.c11[axis] + found.c12);
        assert!((strain / predicted - 1.0).abs() < 1e-4, "axis {axis}: {strain:e} {predicted:e}");
    }
}
