//! How scenes approach their final state, for the studies of docs/accuracy.md:
//!
//! `cargo run --release -p sim-core --example approach -- SWEEP.json OUT [--cpu SECONDS] [--growth 1.1] [--threads 1]
//! [--save SECONDS] [--pause 1]`
//!
//! Runs every point of a sweep by its own stop rule and appends to `OUT.csv` the record on the way, whenever the number
//! of steps has grown by the given factor, and at the end (`mark` = `way`, `end`, or `cut` where a point has used its CPU
//! time, `failed` with the reason); with what still moves in it; to `OUT.series.csv` its samples, from which what any stop rule would have done
//! can be read off. A point that has its last row is skipped, so the command can be
//! repeated; with `--save` it goes on from a checkpoint that is written after so many CPU seconds, and with `--pause 1` a
//! point is left there (row with mark `settled` in its state) once e counts as settled, to go on without that flag. `cpu_s` counts the steps alone, on all threads of the process; what is looked at beside them is left out.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

mod motion;
mod state;

use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use record::{Cell, Outcome, Table};
use scene::Scene;
use scene::sweep::Sweep;
use sim_core::{KernelChoice, Options, SimError};

/// Keys of a scene and columns of a record that are written.
const KEYS: [&str; 14] = [
    "sigma_c",
    "p",
    "sigma_e",
    "alpha_n",
    "mw",
    "ei",
    "n",
    "seed",
    "mu_wall",
    "wall_adhesion",
    "approach",
    "dt",
    "max_steps",
    "stop.rule",
];
const COLUMNS: [&str; 34] = [
    "status",
    "criteria",
    "steps",
    "step_limit",
    "sim_time",
    "dt",
    "dt_reason",
    "e",
    "e_core",
    "e_se_scatter",
    "e_drift",
    "z",
    "z_plus",
    "z_minus",
    "z_backbone",
    "z_se",
    "z_plus_se",
    "z_minus_se",
    "rattler_share",
    "two_contact_particles",
    "beta_plus",
    "beta_plus_se",
    "beta_minus",
    "beta_minus_se",
    "z_drift",
    "wall_imbalance",
    "ke_over_eel",
    "ke_held_over_eel",
    "ke_contacts_over_eel",
    "z_rest",
    "z_plus_limit",
    "z_minus_limit",
    "unbalanced_force",
    "retries",
];

/// CPU time of the process, all threads [s]; NaN where the system does not tell.
fn cpu_seconds() -> f64 {
    let of = |task: PathBuf| -> Option<f64> {
        fs::read_to_string(task.join("schedstat")).ok()?.split(' ').next()?.parse::<f64>().ok()
    };
    fs::read_dir("/proc/self/task")
        .map_or(f64::NAN, |tasks| tasks.filter_map(|task| of(task.ok()?.path())).sum::<f64>() * 1e-9)
}

/// A CSV file that is appended to.
struct Sheet(File);

impl Sheet {
    fn open(path: &Path, header: &str) -> Self {
        let fresh = !path.exists();
        let mut file = OpenOptions::new().append(true).create(true).open(path).expect("a writable file");
        if fresh {
            writeln!(file, "{header}").expect("a writable file");
        }
        Self(file)
    }

    fn lines(&mut self, lines: &[String]) {
        for line in lines {
            writeln!(self.0, "{line}").expect("a writable file");
        }
    }
}

/// Seven significant digits: more than any of these is known to.
fn number(value: f64) -> String {
    if value == value.trunc() && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:.6e}").parse::<f64>().map_or_else(|_| value.to_string(), |short| short.to_string())
    }
}

fn cell(found: Option<&Cell>) -> String {
    match found {
        None => String::new(),
        Some(cell) => match (cell.number(), cell.text()) {
            (Some(value), _) => number(value),
            (_, Some(text)) => text.replace(',', ";"),
            _ => String::new(),
        },
    }
}

/// A key of a scene as text; nested keys joined by a point.
fn key(scene: &Scene, name: &str) -> String {
    let json = scene.to_json();
    let found = name.split('.').try_fold(&json, |value, part| value.get(part));
    found.map_or_else(String::new, |value| value.as_str().map_or_else(|| value.to_string(), str::to_owned))
}

/// What one point is run with.
struct Limits {
    cpu: f64,
    growth: f64,
    options: Options,
    /// CPU seconds between checkpoints; infinite without.
    save: f64,
    /// Leave a point when e counts as settled, to go on another time.
    pause: bool,
}

/// What the rule `settled` asks for by default, whatever the rule of the scene.
fn settled(outcome: &Outcome) -> bool {
    let below = |name: &str, limit: f64| outcome.record.real(name).is_some_and(|value| value <= limit);
    let loaded = outcome.record.text("criteria").is_some_and(|found| found.contains("loaded"));
    below("e_drift", 1e-3) && below("wall_imbalance", 0.01) && loaded
}

/// The next step at which the record is written: 2500, then by the factor.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "steps"
)]
fn after(step: u64, growth: f64) -> u64 {
    (step + 250).max((step as f64 * growth) as u64).max(2500)
}

/// Runs a scene from where `place` has it; `line` makes a row. Returns the last mark, all rows and the series.
fn run(
    scene: &Scene,
    limits: &Limits,
    place: &Path,
    line: &dyn Fn(&str, f64, &Outcome) -> String,
) -> Result<(&'static str, Vec<String>, Table), SimError> {
    let (mut simulation, mut left) = state::open(place, scene, &limits.options)?;
    left.next = left.next.max(after(0, limits.growth));
    let mut calm = left.rows.iter().any(|row| row.contains(",settled,"));
    let mut saved = left.cpu;
    loop {
        let begun = cpu_seconds();
        let done = simulation.progress().steps;
        let slice = (left.next - done).min(2000);
        let progress = simulation.advance(slice)?;
        left.cpu += cpu_seconds() - begun;
        let cut = left.cpu > limits.cpu;
        if progress.finished || cut {
            let outcome = simulation.outcome()?;
            let mark = if progress.finished { "end" } else { "cut" };
            left.rows.push(line(mark, left.cpu, &outcome));
            return Ok((mark, left.rows, outcome.series));
        }
        if progress.steps >= left.next {
            let outcome = simulation.outcome()?;
            let here = !calm && settled(&outcome);
            left.rows.push(line(if here { "settled" } else { "way" }, left.cpu, &outcome));
            calm |= here;
            left.next = after(progress.steps, limits.growth);
            if here && limits.pause {
                state::write(place, &left, &simulation.save());
                return Ok(("settled", left.rows, outcome.series));
            }
        }
        if left.cpu > saved + limits.save {
            state::write(place, &left, &simulation.save());
            saved = left.cpu;
        }
    }
}

/// The samples of a run from the hundredth of its time on.
fn write_series(sheet: &mut Sheet, label: &str, series: &Table) {
    let column = |name: &str| series.column(name).expect("in every series");
    let names = [
        "step",
        "t",
        "e",
        "z",
        "z_plus",
        "z_minus",
        "two_contact_particles",
        "ke",
        "ke_held",
        "ke_contacts",
        "eel",
        "unbalanced_force",
    ];
    let columns: Vec<Vec<f64>> = names.iter().map(|name| column(name)).collect();
    let walls: Vec<(Vec<f64>, Vec<f64>)> = ["x_low", "x_high", "y_low", "y_high", "z_low", "z_high"]
        .iter()
        .map(|wall| (column(&format!("force_{wall}")), column(&format!("load_{wall}"))))
        .collect();
    let last = columns[1].last().copied().unwrap_or(0.0);
    for k in 0..series.rows() {
        if columns[1][k] >= 0.01 * last {
            let mut cells = vec![label.to_owned()];
            cells.extend(columns.iter().map(|values| number(values[k])));
            cells.extend(walls.iter().map(|(force, load)| format!("{:.5}", force[k] / load[k])));
            sheet.lines(&[cells.join(",")]);
        }
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: approach SWEEP.json OUT [--cpu SECONDS] [--growth FACTOR] [--threads COUNT] [--save SECONDS] [--pause 1]";
    let sweep = fs::read_to_string(arguments.next().expect(usage)).expect("a readable file");
    let sweep = Sweep::from_text(&sweep).unwrap_or_else(|problems| panic!("{problems}"));
    let out = arguments.next().expect(usage);
    let mut limits = Limits {
        cpu: f64::INFINITY,
        growth: 1.1,
        options: Options::default(),
        save: f64::INFINITY,
        pause: false,
    };
    while let Some(flag) = arguments.next() {
        let value: f64 = arguments.next().and_then(|text| text.parse().ok()).expect(usage);
        match flag.as_str() {
            "--cpu" => limits.cpu = value,
            "--growth" => limits.growth = value,
            "--save" => limits.save = value,
            "--pause" => limits.pause = value > 0.0,
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
            "--threads" => limits.options = Options { threads: value as usize, kernel: KernelChoice::Auto },
            _ => panic!("{usage}"),
        }
    }
    let path = PathBuf::from(format!("{out}.csv"));
    let done: Vec<String> = fs::read_to_string(&path)
        .unwrap_or_default()
        .lines()
        .filter_map(|line| {
            let mut cells = line.split(',');
            let label = cells.next()?.to_owned();
            cells.next().filter(|mark| *mark != "way").map(|_| label)
        })
        .collect();
    let mut rows = Sheet::open(
        &path,
        &format!(
            "scene,mark,cpu_s,{},{},{}",
            KEYS.map(|name| if name == "dt" { "given_dt" } else { name }).join(","),
            COLUMNS.join(","),
            motion::COLUMNS.join(",")
        ),
    );
    let mut samples = Sheet::open(
        &PathBuf::from(format!("{out}.series.csv")),
        "scene,step,t,e,z,z_plus,z_minus,two_contact_particles,ke,ke_held,ke_contacts,eel,unbalanced_force,wall_1,wall_2,wall_3,wall_4,wall_5,wall_6",
    );
    for point in sweep.points() {
        let label = point.scene.reduce().key().to_string();
        let place = state::path(&out, &label);
        if done.contains(&label) || (limits.pause && state::settled(&place)) {
            continue;
        }
        let keys: Vec<String> = KEYS.iter().map(|name| key(&point.scene, name)).collect();
        let found = run(&point.scene, &limits, &place, &|mark, cpu, outcome| {
            let mut cells = vec![label.clone(), mark.to_owned(), number(cpu)];
            cells.extend(keys.iter().cloned());
            cells.extend(COLUMNS.iter().map(|name| cell(outcome.record.get(name))));
            cells.extend(motion::motion(&outcome.packing).map(number));
            cells.join(",")
        });
        // all rows of a point at once, at its end: an interrupted one leaves none, a paused one has them in its state
        match found {
            Ok((mark, held, series)) => {
                println!("{} {mark} {}", point.index, keys.join(" "));
                if mark != "settled" {
                    write_series(&mut samples, &label, &series);
                    rows.lines(&held);
                    // the file is there only after a pause or a checkpoint
                    drop(fs::remove_file(place));
                }
            }
            Err(error) => {
                let mut cells = vec![label.clone(), "failed".to_owned(), String::new()];
                cells.extend(keys.iter().cloned());
                cells.push(error.to_string().replace(',', ";"));
                cells.extend(std::iter::repeat_n(String::new(), COLUMNS.len() + motion::COLUMNS.len() - 1));
                rows.lines(&[cells.join(",")]);
                println!("{} failed: {error}", point.index);
            }
        }
    }
}
