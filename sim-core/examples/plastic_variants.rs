//! Compares the variants of the plastic discs with the finite-element reference and with each other.
//!
//! `plastic_variants table OUT.csv CELLS,… H,… VARIANT,…`: one disc between walls, one row per run, rows that are already
//! in the file are kept: error of force at three strains and of work at the end, CPU time, effort.
//! `plastic_variants gap OUT.csv`: two discs approaching, the distance at which force begins, in cells.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::fs::OpenOptions;
use std::io::Write;

use scene::Scene;
use serde_json::{Value, json};
use sim_core::mpm::constitutive::{Kinematics, Material};
use sim_core::mpm::contact::ContactKind;
use sim_core::mpm::element::Law;
use sim_core::mpm::implicit::Implicit;
use sim_core::mpm::updated;
use sim_core::mpm::world::World;
use sim_core::mpm::{body::Body, spline};
use sim_core::{Options, compile};

/// Name, scene keys.
const VARIANTS: &[(&str, &str)] = &[
    ("total_bilinear", r#"{}"#),
    ("total_bilinear_explicit", r#"{"method": "explicit", "wall_speed": 0.1}"#),
    ("total_cubic", r#"{"variant": "total_cubic"}"#),
    ("updated_cubic", r#"{"variant": "updated_cubic"}"#),
    ("total_cubic_1", r#"{"variant": "total_cubic", "points_across": 1}"#),
    ("total_cubic_9", r#"{"variant": "total_cubic", "points_across": 3}"#),
    ("total_cubic_16", r#"{"variant": "total_cubic", "points_across": 4}"#),
    ("updated_cubic_1", r#"{"variant": "updated_cubic", "points_across": 1}"#),
    ("updated_cubic_9", r#"{"variant": "updated_cubic", "points_across": 3}"#),
    ("updated_cubic_16", r#"{"variant": "updated_cubic", "points_across": 4}"#),
    ("updated_cubic_common_mesh", r#"{"variant": "updated_cubic", "contact": "common_mesh"}"#),
];

const HEAD: &str = "variant,cells,H,error_F_0.05[%],error_F_0.10[%],error_F_0.17[%],error_work_0.17[%],\
                    rms_error_F[%],energy_gap[%],cpu_time[s],steps,newton_per_step,sweeps_per_step,halved_steps,gap_bottom[cell],end";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: plastic_variants table OUT.csv CELLS,… H,… VARIANT,… | gap OUT.csv";
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["table", path, cells, hardening, variants] => {
            for name in variants.split(',') {
                for h in hardening.split(',') {
                    for cells in cells.split(',') {
                        let row = || row(name, cells.parse().expect("cells: a number"), h);
                        append(path, HEAD, &format!("{name},{cells},{h},"), row);
                    }
                }
            }
        }
        ["gap", path] => gaps(path),
        _ => println!("{usage}"),
    }
}

/// Appends a row unless the file has one with this beginning.
fn append(path: &str, head: &str, begins: &str, row: impl FnOnce() -> String) {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    if text.lines().any(|line| line.starts_with(begins)) {
        return;
    }
    let line = format!("{begins}{}", row());
    println!("{line}");
    let mut file = OpenOptions::new().create(true).append(true).open(path).expect("a writable file");
    if text.is_empty() {
        writeln!(file, "{head}").expect("written");
    }
    writeln!(file, "{line}").expect("written");
}

/// One disc between walls against the reference.
fn row(name: &str, cells: u64, hardening: &str) -> String {
    let (_, keys) = VARIANTS.iter().find(|(known, _)| *known == name).expect("a known variant");
    let mut scene =
        json!({"model": "plastic_discs", "setup": "diametrical", "cells": cells, "strain_step": 0.001});
    if hardening == "el" {
        scene["material"] = json!("elastic");
    } else {
        scene["h"] = json!(hardening.parse::<f64>().expect("H: el or a number [MPa]") * 1e6);
    }
    let keys: Value = serde_json::from_str(keys).expect("JSON");
    for (key, value) in keys.as_object().expect("an object") {
        scene[key] = value.clone();
    }
    let reduced = Scene::from_json(&scene).expect("a valid scene").reduce();
    let mut run = compile(&reduced, &Options { threads: 1, ..Options::default() }).expect("compiles");
    let begun = cpu_seconds();
    let end = loop {
        match run.advance(1) {
            Ok(progress) if progress.finished => break "done".to_owned(),
            Ok(_) => {}
            Err(error) => break error.to_string().replace(',', ";"),
        }
    };
    let seconds = cpu_seconds() - begun;
    let outcome = run.outcome().expect("an outcome");
    let of = |k: usize, name: &str| outcome.states[k].real(name).expect("a column");
    // stresses in E = 10 MPa; area of the disc π/4 in d²
    let deviation = |quantity: &str, value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        reference(quantity, hardening)
            .into_iter()
            .filter_map(|(strain, exact)| {
                let k = (0..outcome.states.len()).find(|&k| (of(k, "strain") - strain).abs() < 1e-9)?;
                Some((strain, 100.0 * (value(k) / exact - 1.0)))
            })
            .collect()
    };
    let force = deviation("F_over_D_MPa", &|k| 5.0 * (of(k, "sigma") + of(k, "sigma_top")));
    let work = deviation("work_over_A0_MPa", &|k| 10.0 * of(k, "work") / std::f64::consts::FRAC_PI_4);
    let at = |list: &[(f64, f64)], strain: f64| {
        let found = list.iter().find(|(x, _)| (x - strain).abs() < 1e-9);
        found.map_or_else(|| "-".to_owned(), |(_, y)| format!("{y:.2}"))
    };
    let late: Vec<f64> = force.iter().filter(|(x, _)| *x > 0.03).map(|(_, y)| y * y).collect();
    let rms = (late.iter().sum::<f64>() / late.len().max(1) as f64).sqrt();
    let record = |name: &str| outcome.record.real(name).unwrap_or(0.0);
    let [f05, f10, f17] = [0.05, 0.10, 0.17].map(|strain| at(&force, strain));
    // lowest place of the outline above the bottom wall, at the end
    let outlines = outcome.packing.0.get("outlines").and_then(|table| table.column("y"));
    let lowest = outlines.into_iter().flatten().fold(f64::INFINITY, f64::min);
    format!(
        "{f05},{f10},{f17},{},{rms:.2},{:.3},{seconds:.1},{},{:.2},{:.1},{},{:.3},{end}",
        at(&work, 0.17),
        100.0 * record("energy_gap"),
        run.progress().steps,
        record("newton_per_step"),
        record("sweeps_per_step"),
        record("halved_steps"),
        lowest * cells as f64,
    )
}

/// CPU time of this process, to 10 ms: what another load on the machine disturbs least (Linux).
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = text.rsplit(')').next().expect("a line");
    let ticks = after_name.split_whitespace().skip(11).take(2);
    ticks.map(|ticks| ticks.parse::<f64>().expect("a number")).sum::<f64>() / 100.0
}

/// (x, y) of the single disc.
fn reference(quantity: &str, hardening: &str) -> Vec<(f64, f64)> {
    let rows = include_str!("../tests/plastic/reference.csv").lines().filter_map(|line| {
        let cells: Vec<&str> = line.splitn(6, ',').collect();
        let meets = cells[..3] == ["diam_single_disc", hardening, quantity];
        meets.then(|| Some((cells[3].parse().ok()?, cells[4].parse().ok()?)))?
    });
    rows.collect()
}

/// Two elastic discs approach slowly, at different places of the grid; and one disc a wall.
fn gaps(path: &str) {
    let head = "contact,cells,offset[cell],gap_disc_disc[cell],gap_disc_disc[d],gap_disc_wall[cell]";
    for (name, kind) in [("markers", ContactKind::Markers), ("common_mesh", ContactKind::CommonMesh)] {
        for cells in [8_u32, 16] {
            for offset in [0.0, 0.125, 0.25, 0.375] {
                append(path, head, &format!("{name},{cells},{offset},"), || {
                    let h = 1.0 / f64::from(cells);
                    let [disc, wall] = [true, false].map(|pair| approach(kind, h, offset, pair));
                    format!("{:.3},{:.4},{:.3}", disc / h, disc, wall / h)
                });
            }
        }
    }
}

/// Distance of the surfaces at the first force, of two discs of diameter 1 or of a disc and a wall.
fn approach(kind: ContactKind, h: f64, offset: f64, pair: bool) -> f64 {
    let material = Material { young: 1.0, poisson: 0.45, density: 1.0, plasticity: None };
    let law = Law { material, kinematics: Kinematics::Jaumann, mean_dilatation: true };
    let speed = 1e-3;
    let disc = |x: f64, v: f64| -> Body {
        let centre = [x, 0.0];
        let (fill, markers) = (spline::disc(centre, 0.5, h, 2), spline::circle(centre, 0.5, h, 0.25));
        let mut body = updated::body(&fill, markers, h, 0.5, centre, &material);
        let cloud = body.cloud.as_mut().expect("an updated Lagrangian body");
        cloud.velocity.fill([v, 0.0]);
        body
    };
    let start = 4.5 * h;
    let first = disc(h * offset, speed);
    let edge = first.origin[0] + 0.5 + start;
    let mut world = if pair {
        World::new(vec![first, disc(edge + 0.5, 0.0)], Vec::new(), law)
    } else {
        let wall =
            sim_core::mpm::contact::Wall { point: [edge, 0.0], normal: [-1.0, 0.0], velocity: [0.0; 2] };
        World::new(vec![first], vec![wall], law)
    };
    world.contact = kind;
    updated::regrid(&mut world);
    let mut solver = Implicit::new(&world);
    // a hundredth of a cell per step
    let dt = 0.01 * h / speed;
    for step in 0..460 {
        solver.step(&mut world, dt).expect("free flight converges");
        if !world.impulses.is_empty() {
            return start - 0.01 * h * f64::from(step);
        }
    }
    0.0
}
