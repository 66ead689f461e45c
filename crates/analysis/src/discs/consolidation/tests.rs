use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

use super::*;

/// The programme of the paper: 0.01 to 13.3 by 10^(1/8).
fn pressures() -> Vec<f64> {
    (0..26).map(|i| 0.01 * 10.0_f64.powf(f64::from(i) / 8.0)).collect()
}

/// Table III for μ_R = 0.005, below the solid fraction of regime I.
fn truth(p_star: f64) -> f64 {
    PaperFit::of(0.005).unwrap().inverse_phi(p_star).min(1.0 / 0.524)
}

fn states(samples: u64, noise: f64, seed: u64) -> Vec<DiscState> {
    let normal = Normal::new(0.0, noise).unwrap();
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut states = Vec::new();
    for sample in 1..=samples {
        for p_star in pressures() {
            states.push(DiscState {
                seed: sample,
                assembly: "type2".to_owned(),
                mu_r: 0.005,
                branch: "compression".to_owned(),
                p_star,
                phi: 1.0 / (truth(p_star) + normal.sample(&mut rng)),
                z: Some(3.0),
                converged: true,
                ..DiscState::default()
            });
        }
    }
    states
}

fn fitted(states: &[DiscState]) -> ConsolidationFit {
    let found = consolidation(states, &ConsolidationOptions::default()).unwrap();
    found.curves[0].fit.value().unwrap().clone()
}

/// The relation with λ reproduces the printed Φmax, the printed relation does not.
#[test]
fn lambda_belongs_into_the_relation() {
    for mu_r in [0.0, 0.005] {
        let row = PaperFit::of(mu_r).unwrap();
        let reach = (row.p_star_1[0] / row.p_star_0).ln();
        let with = 1.0 / (1.0 / row.phi_0 - row.lambda[0] * reach);
        let without = 1.0 / (1.0 / row.phi_0 - reach);
        assert!((with - row.phi_max).abs() < 1e-3, "{with}");
        assert!(without < 0.0);
        // for large P* (9) goes over into (8) with A = λ P*1^α/(2α); next order x/12 relative
        let a = row.lambda[0] * row.p_star_1[0].powf(row.alpha[0]) / (2.0 * row.alpha[0]);
        let p = 1000.0;
        let found = (row.inverse_phi(p) - 1.0 / with) * p.powf(row.alpha[0]) / a;
        assert!((found - 1.0).abs() < 1e-3, "{found}");
    }
}

#[test]
fn exact_curves_give_exact_parameters() {
    let row = PaperFit::of(0.005).unwrap();
    let found = fitted(&states(1, 1e-9, 1));
    assert!((found.lambda.value - row.lambda[0]).abs() < 1e-4, "{:?}", found.lambda);
    assert!((found.alpha.value - row.alpha[0]).abs() < 1e-3, "{:?}", found.alpha);
    assert!((found.p_star_1.value - row.p_star_1[0]).abs() < 1e-3);
    assert!((found.phi_max.value - 0.7740).abs() < 2e-4);
    let expected = 1.0 / row.inverse_phi(found.p_star_0);
    // Φ0 is read on the line, without the bend
    assert!((found.phi_0.value - expected).abs() < 2e-3, "{:?} against {expected}", found.phi_0);
    let relation = found.relation.value().unwrap();
    assert!(relation.with_lambda && relation.phi_max_as_printed < 0.0);
    assert!((relation.phi_max_tail - 0.774).abs() < 1e-3);
    assert!((found.a.value - 0.194 * 0.9_f64.powf(1.08) / 2.16).abs() < 1e-3);
}

/// The choice of P*0 moves Φ0 along the line and nothing else.
#[test]
fn the_reference_pressure_is_a_free_choice() {
    let data = states(4, 0.003, 2);
    let first = fitted(&data);
    let options = ConsolidationOptions { p_star_0: Some(0.3), ..ConsolidationOptions::default() };
    let found = consolidation(&data, &options).unwrap();
    let other = found.curves[0].fit.value().unwrap();
    assert!((other.lambda.value - first.lambda.value).abs() < 1e-6);
    assert!((other.phi_max.value - first.phi_max.value).abs() < 1e-6);
    let moved = 1.0 / first.phi_0.value - first.lambda.value * (0.3 / first.p_star_0).ln();
    assert!((1.0 / other.phi_0.value - moved).abs() < 1e-6);
}

/// 200 seeded trials of four samples and of one.
#[test]
fn parameters_lie_within_their_intervals() {
    let trials = |samples: u64, noise: f64| {
        let row = PaperFit::of(0.005).unwrap();
        let mut hits = [0_u32; 4];
        for seed in 0..200 {
            let found = fitted(&states(samples, noise, seed));
            for (hit, (estimate, value)) in hits.iter_mut().zip([
                (found.lambda, row.lambda[0]),
                (found.alpha, row.alpha[0]),
                (found.p_star_1, row.p_star_1[0]),
                (found.phi_max, 0.77399),
            ]) {
                *hit += u32::from(estimate.covers(value));
            }
        }
        hits
    };
    std::thread::scope(|scope| {
        let one = scope.spawn(|| trials(1, 0.003));
        let (four, one) = (trials(4, 0.006), one.join().unwrap());
        println!("λ α P*1 Φmax: four samples {four:?}, one sample {one:?}");
        assert!(four.iter().chain(&one).all(|hit| *hit >= 180), "{four:?} {one:?}");
    });
}

#[test]
fn short_and_flat_curves_are_errors_with_a_reason() {
    let all = states(1, 1e-4, 1);
    let short: Vec<DiscState> = all.iter().take(8).cloned().collect();
    let found = consolidation(&short, &ConsolidationOptions::default()).unwrap();
    assert!(found.curves[0].fit.reason().unwrap().contains("at least 10"));
    let half: Vec<DiscState> = all.iter().take(14).cloned().collect();
    let found = consolidation(&half, &ConsolidationOptions::default()).unwrap();
    assert!(found.curves[0].phi.len() == 14);
    let flat: Vec<DiscState> = all.iter().map(|state| DiscState { phi: 0.7, ..state.clone() }).collect();
    let found = consolidation(&flat, &ConsolidationOptions::default()).unwrap();
    assert!(found.curves[0].fit.reason().is_some());
    assert!(consolidation(&[], &ConsolidationOptions::default()).is_err());
}

#[test]
fn series_are_kept_apart_and_unconverged_states_left_out() {
    let mut all = states(2, 1e-3, 1);
    for state in all.iter_mut().filter(|state| state.seed == 2) {
        state.mu_r = 0.0;
    }
    all[3].converged = false;
    let found = consolidation(&all, &ConsolidationOptions::default()).unwrap();
    assert_eq!((found.curves.len(), found.unconverged), (2, 1));
    assert_eq!(found.curves[1].phi.len(), 25);
    assert!(found.curves[1].rms_to_paper.unwrap() < 0.01);
}

/// All three rows of Table III, with noise of the size that four samples leave: the stages settle and the truth lies
/// within three standard errors.
#[test]
fn every_row_of_table_iii_is_recovered() {
    for mu_r in [0.0, 0.005, 0.5] {
        let row = PaperFit::of(mu_r).unwrap();
        let normal = Normal::new(0.0, 0.01).unwrap();
        let mut rng = Pcg64::seed_from_u64(11);
        let mut states = states(4, 1e-3, 1);
        for state in &mut states {
            let exact = row.inverse_phi(state.p_star).min(row.inverse_phi(row.p_star_0 * 1.1));
            state.mu_r = mu_r;
            state.phi = 1.0 / (exact + normal.sample(&mut rng));
        }
        let found = fitted(&states);
        assert_eq!((found.method, found.errors), (Method::SelfConsistent, ErrorSource::Samples));
        for (estimate, truth) in
            [(found.lambda, row.lambda[0]), (found.alpha, row.alpha[0]), (found.p_star_1, row.p_star_1[0])]
        {
            assert!(
                (estimate.value - truth).abs() < 3.0 * estimate.se + 1e-3,
                "{mu_r}: {estimate:?} for {truth}"
            );
        }
        assert!(found.relation.value().unwrap().with_lambda);
    }
}

/// A single jumpy sample (measured with an independent code) has a wide interval, and no more.
#[test]
fn one_jumpy_sample_is_fitted_with_an_honest_interval() {
    let text = include_str!("one_sample.csv");
    let states: Vec<DiscState> = text
        .lines()
        .skip(1)
        .map(|line| line.split_once(',').unwrap())
        .map(|(p_star, phi)| DiscState {
            seed: 1,
            assembly: "type2".to_owned(),
            mu_r: 0.005,
            branch: "compression".to_owned(),
            p_star: p_star.parse().unwrap(),
            phi: phi.parse().unwrap(),
            converged: true,
            ..DiscState::default()
        })
        .collect();
    let found = fitted(&states);
    assert_eq!(found.errors, ErrorSource::Points);
    assert!(found.lambda.covers(0.194) && found.lambda.se > 0.05, "{:?}", found.lambda);
    assert!(found.phi_max.covers(0.774));
}
