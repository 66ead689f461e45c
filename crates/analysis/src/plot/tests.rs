use super::*;
use crate::synthetic::Study;
use crate::{CollapseOptions, ExponentOptions, MasterFit};

/// Writes a picture for the eye when `TAMP_PICTURES` names a folder, and checks what a viewer would choke on.
fn check(name: &str, svg: &str) {
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    if let Some(folder) = std::env::var_os("TAMP_PICTURES") {
        std::fs::write(std::path::Path::new(&folder).join(format!("{name}.svg")), svg).unwrap();
    }
}

#[test]
fn pictures_of_a_study_are_drawn() {
    let study = Study { alpha_n: vec![0.05, 0.25, 0.9], q: 0.25, replicates: 2, ..Study::paper(1) };
    let runs = study.runs();
    let found = crate::collapse(&runs, &CollapseOptions::default()).unwrap();
    let fit: MasterFit = crate::fit_master(&found).unwrap();
    check("collapse", &collapse_svg(&found, Some(&fit)));
    check("collapse-without-fit", &collapse_svg(&found, None));
    check("master", &master_svg(&found, &fit));
    check("raw", &raw_svg(&found));
    check("plateau", &plateau_svg(&found));
    check("bonds", &bonds_svg(&crate::bonds(&runs).unwrap()));
    check("forces", &forces_svg(&crate::forces(&runs).unwrap()));
    let exponents =
        crate::exponents(&found, &ExponentOptions { resamples: 20, ..Default::default() }).unwrap();
    check("exponents", &exponents_svg(&exponents));
    let variation = crate::variation(&runs, crate::variation::Varied::AlphaN).unwrap();
    check(
        "variation",
        &variation_svg(&crate::variation::Variation {
            blocks: variation.blocks[40..52].to_vec(),
            ..variation
        }),
    );
    let cubes: Vec<crate::profile::ProfilePoint> = (1..50)
        .map(|i| f64::from(i) / 100.0)
        .map(|r| crate::profile::ProfilePoint {
            r_over_l: r,
            e: 1.1 + 0.2 * (30.0 * r).cos() * (-8.0 * r).exp() + 20.0 * (r - 0.3).max(0.0).powi(3),
        })
        .collect();
    let profile = crate::profile::profile(&cubes).unwrap();
    check("profile", &profile_svg(&[("η* = 0.05".to_owned(), &profile)]));
    let ratios: Vec<f64> =
        (1..2000)
            .map(|i| f64::from(i) / 2000.0)
            .map(|u| {
                if u < 0.6 {
                    -(1.0 - u / 0.6).ln() / 0.9
                } else {
                    (1.0 - (u - 0.6) / 0.4_f64).ln().max(-0.99)
                }
            })
            .collect();
    check("distribution", &distribution_svg(&crate::forces::distribution(&ratios, 1e-6)));
}

#[test]
fn pictures_of_discs_are_drawn() {
    use crate::discs::consolidation::PaperFit;
    use crate::discs::{ConsolidationOptions, DiscState, consolidation, moduli, structure};
    let mut states = Vec::new();
    for (mu_r, loosest) in [(0.0, 0.472), (0.005, 0.524)] {
        let paper = PaperFit::of(mu_r).unwrap();
        for seed in 1..=4_u64 {
            for i in 0..52 {
                let up = i < 26;
                let p_star = 0.01 * 10.0_f64.powf(f64::from(if up { i } else { 51 - i }) / 8.0);
                let wave = 0.01 * (f64::from(i) * 1.7 + seed as f64 * 2.1).sin();
                let loading = paper.inverse_phi(p_star).min(1.0 / loosest) + wave;
                let inverse = if up { loading } else { 1.29 + 0.004 * (13.3 / p_star).ln() + 0.3 * wave };
                let loose = up && p_star < 0.3;
                states.push(DiscState {
                    seed,
                    assembly: "type2".to_owned(),
                    mu_r,
                    branch: if up { "compression" } else { "unloading" }.to_owned(),
                    p_star,
                    phi: 1.0 / inverse,
                    z: Some(3.0),
                    bulk: Some(0.02 * p_star.powf(0.3) * (1.0 + 5.0 * wave)),
                    shear: Some(0.012 * p_star.powf(0.3)),
                    bulk_voigt: Some(0.4 / inverse),
                    shear_voigt: Some(0.25 / inverse),
                    bulk_reuss: Some(0.015 * p_star.powf(0.3)),
                    fractal_dimension: loose.then_some(1.52 + wave),
                    correlation_length: loose.then(|| 5.1 - 1.2 * (p_star / 0.01).log10()),
                    pore_radius: Some(2.0 * p_star.powf(-0.1)),
                    converged: true,
                    ..DiscState::default()
                });
            }
        }
    }
    check(
        "consolidation",
        &consolidation_svg(&consolidation(&states, &ConsolidationOptions::default()).unwrap()),
    );
    check("moduli", &moduli_svg(&moduli(&states).unwrap()));
    check("structure", &structure_svg(&structure(&states).unwrap()));
}

#[test]
fn pictures_of_plastic_discs_are_drawn() {
    use crate::plastic::model::{Constants, Material};
    use crate::plastic::{CompactionOptions, PlasticCurve, PlasticState, compaction, coordination};
    let run = |h: Option<f64>| {
        let material = Material { young: 10e6, nu: 0.45, sigma_y: 0.4e6, h };
        let states = (0..80)
            .map(|i| 0.77 + 0.0025 * f64::from(i))
            .map(|phi| {
                let wave = (500.0 * phi).sin();
                let z = if phi < 0.8 { 1.0 } else { 4.0 + 5.1 * (phi - 0.8_f64).sqrt() + 0.05 * wave };
                let sigma = Constants::PAPER.sigma(&material, phi, z) * (1.02 + 0.03 * wave);
                let sigma = if phi < 0.79999 { 0.0 } else { sigma.max(2e3) };
                let f_p = h.map(|_| Constants::PAPER.plastic_share(phi));
                PlasticState {
                    phi,
                    sigma,
                    strain: Some((phi / 0.74).ln()),
                    z: Some(z),
                    f_p,
                    kappa_d: Some(2.1 + 10.0 * (phi - 0.77)),
                    strain_nominal: Some(1.0 - 0.74 / phi),
                    sigma_contact: Some(2.0 * sigma),
                    sigma_volume: Some(1.1 * sigma),
                    sigma_centre: Some(1.5 * sigma),
                }
            })
            .collect();
        PlasticCurve { id: String::new(), setup: "assembly".to_owned(), material, seed: 1, states }
    };
    let curves: Vec<PlasticCurve> = [None, Some(0.0), Some(1e6), Some(3e6)].into_iter().map(run).collect();
    check("compaction", &compaction_svg(&compaction(&curves, &CompactionOptions::default()).unwrap()));
    check("coordination", &coordination_svg(&coordination(&curves).unwrap()));
    check("curvature", &curvature_svg(&compaction(&curves, &CompactionOptions::default()).unwrap()));
    check("stress-strain", &stress_strain_svg(&curves));
}
