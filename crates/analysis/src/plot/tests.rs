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
