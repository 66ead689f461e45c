use super::*;
use crate::synthetic::{Study, log_range};
use crate::{CollapseOptions, collapse};

fn study(seed: u64) -> Study {
    Study {
        sigma_c: log_range(2e4, 1e8, 9),
        p: vec![1e4, 1e5, 1e6],
        sigma_e: log_range(1e9, 1e11, 3),
        noise: 0.008,
        ..Study::paper(seed)
    }
}

/// b within its bootstrap interval in at least 180 of 200 seeded studies.
#[test]
fn b_is_recovered_within_its_interval() {
    let options = ExponentOptions { resamples: 60, ..ExponentOptions::default() };
    let trial = |seed: u64| {
        let found = collapse(&study(seed).runs(), &CollapseOptions::default()).unwrap();
        let b = *exponents(&found, &options).unwrap().b.value().unwrap();
        (b.covers(0.5), b)
    };
    let halves: Vec<Vec<(bool, Estimate)>> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..2)
            .map(|half| scope.spawn(move || (half * 100..half * 100 + 100).map(trial).collect()))
            .collect();
        handles.into_iter().map(|handle| handle.join().unwrap()).collect()
    });
    let all: Vec<_> = halves.concat();
    let hits = all.iter().filter(|(hit, _)| *hit).count();
    let mean = all.iter().map(|(_, b)| b.value).sum::<f64>() / 200.0;
    println!("b: {hits} of 200, mean {mean:.4}, first {:?}", all[0].1);
    assert!(hits >= 180, "{hits}");
    assert!((mean - 0.5).abs() < 0.01, "biased: {mean}");
}

#[test]
fn another_exponent_than_the_papers_is_found_too() {
    let runs = Study { b: 0.35, ..study(5) }.runs();
    let found = collapse(&runs, &CollapseOptions::default()).unwrap();
    let result = exponents(&found, &ExponentOptions::default()).unwrap();
    let b = result.b.value().unwrap();
    assert!((b.value - 0.35).abs() < 0.05 && !b.covers(0.5), "{b:?}");
    assert!(result.best.rms < result.paper.rms && result.best.rms < result.eta.rms);
    assert!(result.c.reason().unwrap().contains("mw"));
    assert!(result.q.reason().unwrap().contains("alpha_n"));
}

#[test]
fn the_exponent_of_damping_is_found_where_damping_varies() {
    let runs = Study { q: 0.25, alpha_n: vec![0.05, 0.25, 0.9], ..study(2) }.runs();
    let found = collapse(&runs, &CollapseOptions::default()).unwrap();
    let result = exponents(&found, &ExponentOptions { resamples: 50, ..ExponentOptions::default() }).unwrap();
    let (b, q) = (result.b.value().unwrap(), result.q.value().unwrap());
    assert!((b.value - 0.5).abs() < 0.03, "{b:?}");
    assert!((q.value - 0.25).abs() < 0.05, "{q:?}");
    assert_eq!(result.q_by_regime.len(), 2);
    assert_eq!(result.scans.len(), 2);
}

/// q and c within their bootstrap intervals in at least 180 of 200 seeded studies.
#[test]
fn q_and_c_are_recovered_within_their_intervals() {
    let options = ExponentOptions { resamples: 60, ..ExponentOptions::default() };
    let trials = |as_wall_mass: bool| {
        (0..200)
            .filter(|&seed| {
                let study = Study {
                    q: 0.25,
                    alpha_n: vec![0.05, 0.25, 0.9],
                    p: vec![1e5],
                    sigma_e: vec![1e10],
                    sigma_c: log_range(2e4, 2e8, 14),
                    ..study(seed)
                };
                let mut runs = study.runs();
                if as_wall_mass {
                    for run in &mut runs {
                        (run.mw, run.alpha_n) = (96.0 * run.alpha_n / 0.25, 0.25);
                    }
                }
                let found = collapse(&runs, &CollapseOptions::default()).unwrap();
                let result = exponents(&found, &options).unwrap();
                let estimate = if as_wall_mass { &result.c } else { &result.q };
                assert!(result.b.reason().is_some());
                estimate.value().unwrap().covers(0.25)
            })
            .count()
    };
    let (q, c) = std::thread::scope(|scope| {
        let other = scope.spawn(|| trials(true));
        (trials(false), other.join().unwrap())
    });
    assert!(q >= 180 && c >= 180, "q {q}, c {c} of 200");
}
