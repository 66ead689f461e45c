//! What still moves in a packing: kinetic energy by number of contacts, and the part of it that deforms contacts.

use record::{Packing, Table};

/// Columns of [`motion`], all over the elastic energy.
pub const COLUMNS: [&str; 10] = [
    "ke_0",
    "ke_1",
    "ke_2",
    "ke_3",
    "ke_4",
    "ke_4_spin",
    "ke_inner",
    "ke_normal",
    "ke_shear",
    "ke_normal_held",
];

/// Contacts from which on a particle counts as held, as in the stop rule.
const HELD: f64 = 4.0;

/// Tangential over normal stiffness, the default of the scenes looked at [1].
const KT: f64 = 1.5;

type Vector = [f64; 3];

fn vectors(table: &Table, names: [&str; 3]) -> Vec<Vector> {
    let [x, y, z] = names.map(|name| table.column(name).expect("in every packing"));
    x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect()
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Kinetic over elastic energy: of particles with 0, 1, 2, 3, ≥ 4 contacts; the spin's part of the last; of
/// particles that, like all their neighbours, have at least four; and energies of the relative motion at contacts,
/// Σ m_eff u²/2 with m_eff = 1/2 along the normal and 1/7 across it (two free spheres, spins included): along normals,
/// across, along normals between held particles. Rolling and flying have none of these last three.
pub fn motion(packing: &Packing) -> [f64; 10] {
    let particles = &packing.0["particles"];
    let velocities = vectors(particles, ["vx", "vy", "vz"]);
    let spins = vectors(particles, ["wx", "wy", "wz"]);
    let touching = particles.column("contacts").expect("in every packing");
    let contacts = &packing.0["contacts"];
    let column = |name: &str| contacts.column(name).expect("in every packing");
    let normals = vectors(contacts, ["nx", "ny", "nz"]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "indices")]
    let pairs: Vec<(usize, usize)> =
        column("i").iter().zip(column("j")).map(|(&i, j)| (i as usize, j as usize)).collect();

    let elastic: f64 = ["contacts", "wall_contacts"]
        .iter()
        .map(|name| {
            let column = |of: &str| packing.0[*name].column(of).expect("in every packing");
            column("ov").iter().zip(column("ft")).map(|(ov, ft)| 0.5 * (ov * ov + ft * ft / KT)).sum::<f64>()
        })
        .sum();
    let mut inner: Vec<bool> = touching.iter().map(|&count| count >= HELD).collect();
    let mut found = [0.0; 10];
    for ((&(i, j), &normal), overlap) in pairs.iter().zip(&normals).zip(column("ov")) {
        let held = [i, j].map(|k| touching[k] >= HELD);
        inner[i] &= held[1];
        inner[j] &= held[0];
        let lever = 0.5 * (1.0 - overlap);
        let turning = cross([0, 1, 2].map(|k| lever * (spins[i][k] + spins[j][k])), normal);
        let relative = minus(minus(velocities[j], velocities[i]), turning);
        let along = dot(relative, normal);
        let across = (dot(relative, relative) - along * along).max(0.0);
        found[7] += 0.25 * along * along;
        found[8] += across / 14.0;
        if held == [true; 2] {
            found[9] += 0.25 * along * along;
        }
    }
    for (((velocity, spin), &count), inner) in velocities.iter().zip(&spins).zip(&touching).zip(inner) {
        let (translation, rotation) = (0.5 * dot(*velocity, *velocity), 0.05 * dot(*spin, *spin));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let class = (count as usize).min(4);
        found[class] += translation + rotation;
        if class == 4 {
            found[5] += rotation;
        }
        if inner {
            found[6] += translation + rotation;
        }
    }
    found.map(|energy| if elastic > 0.0 { energy / elastic } else { 0.0 })
}
