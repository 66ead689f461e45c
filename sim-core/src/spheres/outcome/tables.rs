//! The tables of a run: time series, particles, contacts, walls, profile, force histogram.

use std::collections::BTreeMap;

use record::{Packing, Table, TableError};
use scene::spheres::ReducedSpheres;

use crate::dem::View;
use crate::equilibrium::sample::{Sample, walls_of};
use crate::observables::coordination::Coordination;
use crate::observables::{forces, profile};

/// Names of the walls in column names.
const WALLS: [&str; 6] = ["x_low", "x_high", "y_low", "y_high", "z_low", "z_high"];

#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
const fn real(count: u64) -> f64 {
    count as f64
}

fn column<T>(rows: &[T], of: impl FnMut(&T) -> f64) -> Vec<f64> {
    rows.iter().map(of).collect()
}

/// The time series.
pub(super) fn series(samples: &[Sample]) -> Result<Table, TableError> {
    let mut table = Table::new();
    table
        .push("step", "1", &column(samples, |s| real(s.step)))?
        .push("t", "tau", &column(samples, |s| s.time))?
        .push("dt", "tau", &column(samples, |s| s.dt))?
        .push("e", "1", &column(samples, |s| s.e))?
        .push("z", "1", &column(samples, |s| s.z))?
        .push("z_plus", "1", &column(samples, |s| s.z_plus))?
        .push("z_minus", "1", &column(samples, |s| s.z_minus))?
        .push("two_contact_particles", "1", &column(samples, |s| real(s.with_two)))?
        .push("ke", "kn d^2", &column(samples, |s| s.kinetic))?
        .push("ke_held", "kn d^2", &column(samples, |s| s.kinetic_held))?
        .push("ke_contacts", "kn d^2", &column(samples, |s| s.deforming))?
        .push("eel", "kn d^2", &column(samples, |s| s.elastic))?
        .push("unbalanced_force", "1", &column(samples, |s| s.unbalanced))?;
    for (wall, name) in WALLS.iter().enumerate() {
        table.push(&format!("force_{name}"), "kn d", &column(samples, |s| s.wall_forces[wall]))?;
        table.push(&format!("load_{name}"), "kn d", &column(samples, |s| s.wall_loads[wall]))?;
    }
    Ok(table)
}

/// The final packing.
pub(super) fn packing(
    scene: &ReducedSpheres,
    view: &View,
    counted: &Coordination,
) -> Result<Packing, TableError> {
    let mut tables = BTreeMap::new();
    tables.insert("particles".to_owned(), particles(view, counted)?);
    tables.insert("contacts".to_owned(), contacts(view)?);
    tables.insert("wall_contacts".to_owned(), wall_contacts(view)?);
    tables.insert("walls".to_owned(), walls(view)?);
    tables.insert("profile".to_owned(), void_profile(view)?);
    if let Some(histogram) = force_histogram(scene, view)? {
        tables.insert("force_histogram".to_owned(), histogram);
    }
    Ok(Packing(tables))
}

fn particles(view: &View, counted: &Coordination) -> Result<Table, TableError> {
    let mut table = Table::new();
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(axis, "d", &column(&view.positions, |x| x[k]))?;
    }
    for (k, axis) in ["vx", "vy", "vz"].into_iter().enumerate() {
        table.push(axis, "d/tau", &column(&view.velocities, |v| v[k]))?;
    }
    for (k, axis) in ["wx", "wy", "wz"].into_iter().enumerate() {
        table.push(axis, "1/tau", &column(&view.spins, |w| w[k]))?;
    }
    table.push("contacts", "1", &column(&counted.contacts, |&count| f64::from(count)))?.push(
        "rattler",
        "1",
        &column(&counted.backbone, |&kept| f64::from(u8::from(!kept))),
    )?;
    Ok(table)
}

fn contacts(view: &View) -> Result<Table, TableError> {
    let rows = &view.contacts;
    let mut table = Table::new();
    table.push("i", "1", &column(rows, |c| real(c.i as u64)))?.push(
        "j",
        "1",
        &column(rows, |c| real(c.j as u64)),
    )?;
    for (k, axis) in ["nx", "ny", "nz"].into_iter().enumerate() {
        table.push(axis, "1", &column(rows, |c| c.normal[k]))?;
    }
    table.push("ov", "d", &column(rows, |c| c.overlap))?.push(
        "fn",
        "kn d",
        &column(rows, |c| c.normal_force),
    )?;
    for (k, axis) in ["ftx", "fty", "ftz"].into_iter().enumerate() {
        table.push(axis, "kn d", &column(rows, |c| c.tangential[k]))?;
    }
    table.push("ft", "kn d", &column(rows, |c| length(&c.tangential)))?.push(
        "sliding",
        "1",
        &column(rows, |c| f64::from(u8::from(c.sliding))),
    )?;
    Ok(table)
}

fn wall_contacts(view: &View) -> Result<Table, TableError> {
    let rows = &view.wall_contacts;
    let mut table = Table::new();
    table
        .push("particle", "1", &column(rows, |c| real(c.particle as u64)))?
        .push("wall", "1", &column(rows, |c| real(c.wall as u64)))?
        .push("ov", "d", &column(rows, |c| c.overlap))?
        .push("fn", "kn d", &column(rows, |c| c.normal_force))?
        .push("ft", "kn d", &column(rows, |c| length(&c.tangential)))?;
    Ok(table)
}

fn walls(view: &View) -> Result<Table, TableError> {
    let rows = &view.walls;
    let mut table = Table::new();
    table
        .push("axis", "1", &column(rows, |w| real(w.axis as u64)))?
        .push("position", "d", &column(rows, |w| w.position))?
        .push("velocity", "d/tau", &column(rows, |w| w.velocity))?
        .push("force", "kn d", &column(rows, |w| w.force))?
        .push("load", "kn d", &column(rows, |w| w.load))?
        .push("moving", "1", &column(rows, |w| f64::from(u8::from(w.moving))))?;
    Ok(table)
}

fn void_profile(view: &View) -> Result<Table, TableError> {
    let rows = profile::profile(&view.positions, &walls_of(view));
    let mut table = Table::new();
    table
        .push("r", "d", &column(&rows, |point| point.r))?
        .push("r_over_l", "1", &column(&rows, |point| point.r_over_l))?
        .push("e", "1", &column(&rows, |point| point.e))?;
    Ok(table)
}

/// Histogram of fn over f_c, or over the mean of |fn| without adhesion; nothing without contacts.
fn force_histogram(scene: &ReducedSpheres, view: &View) -> Result<Option<Table>, TableError> {
    let forces: Vec<f64> = view.contacts.iter().map(|contact| contact.normal_force).collect();
    let count = real(forces.len() as u64);
    let mean = forces.iter().map(|force| force.abs()).sum::<f64>() / count.max(1.0);
    let scale = if scene.adhesion > 0.0 { scene.adhesion } else { mean };
    if forces.is_empty() || scale <= 0.0 {
        return Ok(None);
    }
    let found = forces::histogram(&forces, scale);
    let left: Vec<f64> =
        (0..found.counts.len()).map(|bin| found.start + found.width * real(bin as u64)).collect();
    let counts: Vec<f64> = found.counts.iter().map(|&inside| real(inside)).collect();
    let density: Vec<f64> = counts.iter().map(|inside| inside / (count * found.width)).collect();
    let mut table = Table::new();
    table
        .push("x_low", "1", &left)?
        .push("x_high", "1", &left.iter().map(|x| x + found.width).collect::<Vec<f64>>())?
        .push("contacts", "1", &counts)?
        .push("density", "1", &density)?;
    Ok(Some(table))
}

fn length(v: &[f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
