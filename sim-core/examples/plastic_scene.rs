//! Runs one scene of plastic discs and writes the states of its loading path as CSV, also of a run that fails:
//! `plastic_scene '{"model": "plastic_discs", …}' states.csv [threads]`. A checkpoint beside the states lets a run that
//! was stopped go on.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::io::Write;
use std::time::Instant;

use scene::Scene;
use sim_core::{Options, compile, restore};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let text = arguments.next().expect("usage: plastic_scene '{\"model\": …}' states.csv [threads]");
    let path = arguments.next().expect("a file for the states");
    let threads = arguments.next().map_or(2, |threads| threads.parse().expect("a number of threads"));
    let scene = Scene::from_json(&serde_json::from_str(&text).expect("JSON")).expect("a valid scene");
    let options = Options { threads, ..Options::default() };
    let kept = format!("{path}.checkpoint");
    let mut run = match std::fs::read(&kept) {
        Ok(bytes) => restore(&scene.reduce(), &options, &bytes).expect("a checkpoint of this scene"),
        Err(_) => compile(&scene.reduce(), &options).expect("compiles"),
    };
    let begun = Instant::now();
    let mut next = 0.0;
    loop {
        match run.advance(1) {
            Ok(progress) => {
                if progress.fraction >= next || progress.finished {
                    next = progress.fraction + 0.02;
                    let seconds = begun.elapsed().as_secs_f64();
                    println!("{seconds:7.1} s, step {}: {:?}", progress.steps, progress.live);
                    write(run.as_ref(), &path);
                    std::fs::write(&kept, run.save()).expect("a writable file");
                }
                if progress.finished {
                    break;
                }
            }
            Err(error) => {
                println!("{error}");
                break;
            }
        }
    }
    write(run.as_ref(), &path);
    let _ = std::fs::remove_file(&kept);
    let outcome = run.outcome().expect("an outcome");
    println!("{}", serde_json::to_string_pretty(&outcome.record).expect("plain"));
    println!("{:.1} s with {threads} threads, {}", begun.elapsed().as_secs_f64(), run.kernel());
}

fn write(run: &dyn sim_core::Simulation, path: &str) {
    let series = run.outcome().expect("an outcome").series;
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).expect("a writable file"));
    let names: Vec<String> =
        series.columns().iter().map(|column| format!("{}[{}]", column.name, column.unit)).collect();
    writeln!(file, "{}", names.join(",")).expect("written");
    for row in 0..series.rows() {
        let cells: Vec<String> =
            series.columns().iter().map(|column| format!("{:.8e}", column.values[row].get())).collect();
        writeln!(file, "{}", cells.join(",")).expect("written");
    }
}
