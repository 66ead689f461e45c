use super::*;
use crate::master::MasterCurve;
use crate::plateau::P0;
use crate::synthetic::{E_MIN, Study};

/// The whole chain on the paper's 220 points: e_min, plateau, collapse and master curve within their intervals in at
/// least 180 of 200 seeded studies, without replicates.
#[test]
fn recovers_the_papers_numbers_from_noisy_studies() {
    let mut hits = [0_u32; 9];
    for seed in 0..200 {
        let runs = Study::paper(seed).runs();
        let found = collapse(&runs, &CollapseOptions::default()).unwrap();
        let fitted = master::fit(&found).unwrap();
        let plateau = found.plateau_fit.value().unwrap();
        let truth = MasterCurve::PAPER;
        for (hit, (estimate, value)) in hits.iter_mut().zip([
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
        }
    }
    assert!(hits.iter().all(|hit| *hit >= 180), "{hits:?}");
}

/// Scatter as of single small runs (0.04 in e): many points then lie beyond e_r = 0 and 1, which bring knowledge too.
#[test]
fn much_noise_widens_the_intervals_and_refuses_nothing() {
    let mut hits = [0_u32; 2];
    let mut fits = 0;
    for seed in 0..100 {
        let found = default(&Study { noise: 0.04, ..Study::paper(seed) }.runs());
        let beyond = found.points.iter().filter(|point| !(0.0..=1.0).contains(&point.e_r)).count();
        assert!(beyond > 20, "{beyond}");
        let Ok(fitted) = master::fit(&found) else { continue };
        fits += 1;
        hits[0] += u32::from(fitted.alpha.covers(0.74));
        hits[1] += u32::from(fitted.beta.covers(2.3));
    }
    assert!(fits >= 95, "{fits} of 100 fits determined");
    assert!(hits.iter().all(|hit| *hit * 10 >= fits * 9), "{hits:?} of {fits}");
}

fn default(runs: &[Run]) -> Collapse {
    collapse(runs, &CollapseOptions::default()).unwrap()
}

/// With two replicates the weights come from the replicate scatter, which here differs by a factor of four between the
/// dense and the loose half.
#[test]
fn replicates_give_weights_and_honest_intervals() {
    let mut hits = [0_u32; 3];
    for seed in 0..200 {
        let mut runs = Study { replicates: 2, noise: 0.003, ..Study::paper(seed) }.runs();
        let loud = Study { replicates: 2, noise: 0.012, ..Study::paper(seed) }.runs();
        for (run, other) in runs.iter_mut().zip(loud) {
            if run.eta_star() > 0.03 {
                run.e = other.e;
            }
        }
        let found = default(&runs);
        assert!(found.points.iter().all(|point| point.replicates == 2 && point.e_sigma.is_some()));
        let fitted = master::fit(&found).unwrap();
        hits[0] += u32::from(found.e_min.estimate.covers(E_MIN));
        hits[1] += u32::from(fitted.alpha.covers(0.74));
        hits[2] += u32::from(fitted.beta.covers(2.3));
    }
    assert!(hits.iter().all(|hit| *hit >= 180), "{hits:?}");
}

#[test]
fn the_order_of_the_runs_does_not_matter() {
    let mut runs = Study { replicates: 2, ..Study::paper(4) }.runs();
    let first = default(&runs);
    runs.reverse();
    assert_eq!(default(&runs), first);
}

#[test]
fn runs_off_the_plateau_are_flagged_with_their_reason() {
    let mut runs = Study::paper(3).runs();
    for run in &mut runs {
        if run.p == 1e4 && run.eta_star() > 10.0 && !run.out_of_model {
            run.e += 0.2;
        }
        if run.p == 1e6 && run.eta_star() > 1.0 && run.sigma_c > 1e8 && !run.out_of_model {
            run.e -= 0.15;
        }
    }
    let found = default(&runs);
    let with =
        |reason: OutlierReason| found.outliers.iter().filter(|outlier| outlier.reason == reason).count();
    assert!(with(OutlierReason::BallisticAggregation) >= 1 && with(OutlierReason::DynamicJamming) >= 1);
    assert!(found.outliers.iter().all(|outlier| outlier.deviation.abs() > 0.1), "{:?}", found.outliers);
    let flagged = found.points.iter().filter(|point| point.role == Role::Outlier).count();
    assert_eq!(flagged, found.outliers.len());
    // and they do not pull the plateau
    for plateau in &found.plateaus {
        let truth = plateau::e_max(plateau.p, E_MIN, 1.0, 0.24, P0).unwrap();
        assert!((plateau.e_max.value - truth).abs() < 0.01, "{plateau:?}");
    }
}

/// e was made with e_max(p): that reading must win, and the other must refuse what it cannot reach.
#[test]
fn the_readings_of_e_max_are_compared() {
    let runs = Study::paper(6).runs();
    let found = default(&runs);
    let readings = found.readings.value().unwrap();
    assert_eq!(readings.better, Reading::PerPressure);
    assert!(readings.per_critical_pressure > 2.0 * readings.per_pressure, "{readings:?}");
    assert!(readings.refused > 0);
    let options = CollapseOptions { reading: Reading::PerCriticalPressure, ..CollapseOptions::default() };
    let other = collapse(&runs, &options).unwrap();
    assert!(other.excluded.iter().any(|run| run.reason.contains("outside the range")));
    assert!(other.points.iter().all(|point| point.e_r.is_finite()));
}

#[test]
fn a_pressure_without_plateau_runs_takes_e_max_from_the_fit() {
    let mut runs = Study::paper(7).runs();
    runs.retain(|run| run.p != 1e5 || run.eta_star() < 0.3);
    let found = default(&runs);
    let filled = found.plateaus.iter().find(|plateau| plateau.p == 1e5).unwrap();
    assert_eq!((filled.source, filled.points, filled.mean), (PlateauSource::Fit, 0, None));
    assert!((filled.e_max.value - 1.404).abs() < 0.02 && filled.e_max.se > 0.0);
    assert!(master::fit(&found).is_ok());
}

#[test]
fn a_sweep_that_is_still_running_answers_what_it_can() {
    let runs = Study::paper(8).runs();
    // nothing yet, one run, the dense limit alone
    assert!(matches!(collapse(&[], &CollapseOptions::default()), Err(FitError::TooFew { .. })));
    assert!(collapse(&runs[..1], &CollapseOptions::default()).is_err());
    let dense: Vec<Run> = runs.iter().filter(|run| run.eta_star() < 1e-3).cloned().collect();
    let error = collapse(&dense, &CollapseOptions::default()).unwrap_err();
    assert!(error.to_string().contains("e_max"), "{error}");
    // every third run: whatever is said is finite or a reason
    let third: Vec<Run> = runs.iter().step_by(3).cloned().collect();
    let found = default(&third);
    assert!(found.plateau_fit.value().is_some());
    assert!(master::fit(&found).is_ok());
    // one pressure: no (15), but a collapse and a master curve
    let one: Vec<Run> = runs.iter().filter(|run| run.p == 1e5).cloned().collect();
    let found = default(&one);
    assert!(found.plateau_fit.reason().unwrap().contains("at least 3"));
    assert!(master::fit(&found).is_ok());
    // a handful of points: levels, no curve
    let few: Vec<Run> =
        one.iter().filter(|run| run.eta_star() < 1e-3 || run.eta_star() > 1.0).cloned().collect();
    let found = default(&few);
    assert!(master::fit(&found).is_err());
}

#[test]
fn unsettled_and_out_of_model_runs_are_kept_apart() {
    let mut runs = Study::paper(9).runs();
    runs[5].status = "step_limit".to_owned();
    let found = default(&runs);
    assert_eq!(found.excluded.len(), 1);
    assert!(found.excluded[0].reason.contains("step_limit"));
    let soft = found.points.iter().filter(|point| point.role == Role::OutOfModel).count();
    assert_eq!(soft, runs.iter().filter(|run| run.out_of_model).count());
    let all =
        CollapseOptions { include_unsettled: true, include_out_of_model: true, ..CollapseOptions::default() };
    let found = collapse(&runs, &all).unwrap();
    assert!(found.excluded.is_empty() && found.points.iter().all(|point| point.role != Role::OutOfModel));
}

#[test]
fn a_given_e_min_is_kept() {
    let options = CollapseOptions { e_min: Some(0.75), ..CollapseOptions::default() };
    let found = collapse(&Study::paper(1).runs(), &options).unwrap();
    assert_eq!((found.e_min.estimate.value, found.e_min.estimate.se), (0.75, 0.0));
}

#[test]
fn answers_are_json_and_come_back() {
    let found = default(&Study::paper(2).runs());
    let fitted = master::fit(&found).unwrap();
    let text = serde_json::to_string(&found).unwrap();
    assert!(!text.contains("null,\"se\"") && text.contains("\"plateau_fit\":{\"value\":"));
    assert_eq!(serde_json::from_str::<Collapse>(&text).unwrap(), found);
    let text = serde_json::to_string(&fitted).unwrap();
    assert_eq!(serde_json::from_str::<crate::MasterFit>(&text).unwrap(), fitted);
}
