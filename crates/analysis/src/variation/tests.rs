use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

use super::*;

/// Four blocks of three wall masses, `replicates` seeds each; `effect` per decade of m_w.
fn runs(seed: u64, replicates: u64, effect: f64) -> Vec<Run> {
    let noise = Normal::new(0.0, 0.01).unwrap();
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut runs = Vec::new();
    for (p, sigma_c) in [(1e4, 1e6), (1e4, 1e8), (1e6, 1e6), (1e6, 1e8)] {
        for mw in [24.0, 96.0, 384.0_f64] {
            for seed in 1..=replicates {
                runs.push(Run {
                    p,
                    sigma_c,
                    sigma_e: 1e10,
                    mw,
                    alpha_n: 0.25,
                    ei: 1.704,
                    seed,
                    e: 1.0 + 0.1 * (sigma_c / p).log10() + effect * mw.log10() + noise.sample(&mut rng),
                    status: "equilibrium".to_owned(),
                    ..Run::default()
                });
            }
        }
    }
    runs
}

fn significant(seed: u64, replicates: u64, effect: f64) -> bool {
    variation(&runs(seed, replicates, effect), Varied::Mw).unwrap().significance.value().unwrap().significant
}

/// At a level of 1 % some 2 of 200 studies without effect are called significant; a real effect is.
#[test]
fn the_level_of_the_test_is_kept_and_effects_are_seen() {
    for replicates in [1, 2] {
        let false_alarms = (0..200).filter(|&seed| significant(seed, replicates, 0.0)).count();
        assert!(false_alarms <= 8, "{replicates} replicates: {false_alarms} false alarms of 200");
        let seen = (0..200).filter(|&seed| significant(seed, replicates, 0.05)).count();
        assert!(seen >= 190, "{replicates} replicates: {seen} of 200");
    }
}

#[test]
fn the_statement_names_key_and_numbers() {
    let found = variation(&runs(1, 2, 0.0), Varied::Mw).unwrap();
    assert_eq!((found.blocks.len(), found.blocks[0].levels.len()), (4, 3));
    let significance = found.significance.value().unwrap();
    assert_eq!(significance.degrees_of_freedom, [8, 12]);
    assert!(significance.from_replicates);
    assert!(significance.statement.starts_with("m_w/m does not significantly change e: largest spread 0.0"));
}

#[test]
fn without_variation_or_scatter_there_is_no_test() {
    let runs = runs(1, 1, 0.0);
    assert!(matches!(variation(&runs, Varied::Ei), Err(FitError::TooFew { .. })));
    let one = variation(&runs[..3], Varied::Mw).unwrap();
    assert!(one.significance.reason().unwrap().contains("replicates"));
}
