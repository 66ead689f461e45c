use super::*;
use crate::master::MasterCurve;
use crate::synthetic::{E_MIN, Study};

/// The whole chain on the paper's 220 points: e_min, plateau, collapse and master curve within their intervals in at
/// least 180 of 200 seeded studies, without replicates.
#[test]
fn recovers_the_papers_numbers_from_noisy_studies() {
    let mut hits = [0_u32; 9];
    let mut pulls = [(0.0, 0.0); 9];
    for seed in 0..200 {
        let runs = Study::paper(seed).runs();
        let found = collapse(&runs, &CollapseOptions::default()).unwrap();
        let fitted = master::fit(&found).unwrap();
        let plateau = found.plateau_fit.value().unwrap();
        let truth = MasterCurve::PAPER;
        for ((hit, pull), (estimate, value)) in hits.iter_mut().zip(&mut pulls).zip([
            (found.e_min.estimate, E_MIN),
            (plateau.c, 0.24),
            (plateau.delta_e, 1.0),
            (fitted.alpha, truth.alpha),
            (fitted.beta, truth.beta),
            (fitted.a, truth.a),
            (fitted.b, truth.b),
            (fitted.at_paper.s_m, 1.55),
            (fitted.at_crossover.a, 0.475 * (0.475_f64 / MasterCurve::PAPER.b).powf(0.74 / 1.56)),
        ]) {
            *hit += u32::from(estimate.covers(value));
            let t = (estimate.value - value) / estimate.se;
            *pull = (pull.0 + t / 200.0, pull.1 + t * t / 200.0);
        }
    }
    println!("{pulls:.2?}");
    println!("e_min C delta_e alpha beta a b s_m a_x: {hits:?}");
    assert!(hits.iter().all(|hit| *hit >= 180), "{hits:?}");
}
