//! The answers of `/consolidation` and their pictures from a table of states: `consolidation_fits STATES.csv FOLDER`
//! takes the states of type 2 with 1400 discs (`docs/validation/cohesive-discs/states.csv`) and writes `fits.json`,
//! `consolidation*.svg`, `moduli*.svg` and `structure*.svg` (without suffix: μ_R = 0.005 a).
//! Moduli of physics version 1 without rolling resistance are left out: round-off spoilt them.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

use analysis::Determined;
use analysis::discs::{ConsolidationOptions, DiscState, consolidation, moduli, structure};
use analysis::plot::{consolidation_svg, moduli_svg, structure_svg};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [table, folder] = arguments.as_slice() else {
        return Err("usage: consolidation_fits STATES.csv FOLDER".into());
    };
    let folder = Path::new(folder);
    let text = std::fs::read_to_string(table)?;
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().ok_or("the table is empty")?.split(',').collect();
    let states: Vec<DiscState> = lines
        .map(|line| names.iter().copied().zip(line.split(',')).collect::<HashMap<_, _>>())
        .filter(|row| row["assembly"] == "type2" && row["n"] == "1400")
        .filter_map(|row| state(&row))
        .collect();
    let mut fits = Vec::new();
    for (mu_r, suffix) in [(0.0, "-0"), (0.005, ""), (0.5, "-0.5")] {
        let of_one: Vec<DiscState> = states.iter().filter(|state| state.mu_r == mu_r).cloned().collect();
        let consolidated = consolidation(&of_one, &ConsolidationOptions::default())?;
        let write = |name: &str, svg: String| std::fs::write(folder.join(format!("{name}{suffix}.svg")), svg);
        write("consolidation", consolidation_svg(&consolidated))?;
        write("moduli", moduli_svg(&moduli(&of_one)?))?;
        write("structure", structure_svg(&structure(&of_one)?))?;
        for curve in consolidated.curves {
            let Determined::Value(fit) = &curve.fit else {
                println!("mu_r {mu_r}: {}", serde_json::to_string(&curve.fit)?);
                continue;
            };
            let pair = |estimate: &analysis::Estimate| json!([estimate.value, estimate.se]);
            let mut answer = json!({
                "mu_r": mu_r, "samples": curve.samples, "rms_to_paper": curve.rms_to_paper,
                "p_star_0": fit.p_star_0, "straight": fit.straight, "method": fit.method, "errors": fit.errors,
            });
            for (name, estimate) in [
                ("phi_0", &fit.phi_0),
                ("lambda", &fit.lambda),
                ("phi_max", &fit.phi_max),
                ("alpha", &fit.alpha),
                ("p_star_1", &fit.p_star_1),
            ] {
                answer[name] = pair(estimate);
            }
            fits.push(answer);
        }
    }
    std::fs::write(folder.join("fits.json"), serde_json::to_string_pretty(&Value::Array(fits))? + "\n")?;
    Ok(())
}

fn state(row: &HashMap<&str, &str>) -> Option<DiscState> {
    let real = |name: &str| row.get(name).and_then(|text| text.parse::<f64>().ok());
    let mu_r = real("mu_r")?;
    let trusted = mu_r > 0.0 || row.get("physics_version") != Some(&"1");
    let modulus = |name: &str| real(name).filter(|_| trusted);
    Some(DiscState {
        seed: row.get("seed")?.parse().ok()?,
        assembly: (*row.get("assembly")?).to_owned(),
        mu_r,
        variant: "n=1400".to_owned(),
        branch: (*row.get("branch")?).to_owned(),
        leg: row.get("leg")?.parse().ok()?,
        p_star: real("p")?,
        phi: real("phi")?,
        z: real("z"),
        bulk: modulus("bulk"),
        shear: modulus("shear"),
        bulk_voigt: modulus("bulk_voigt"),
        shear_voigt: modulus("shear_voigt"),
        bulk_reuss: modulus("bulk_reuss"),
        stiffness_sign: modulus("stiffness_sign"),
        fractal_dimension: real("fractal_dimension"),
        correlation_length: real("correlation_length"),
        pore_radius: real("pore_radius"),
        converged: row.get("converged")?.eq_ignore_ascii_case("true"),
    })
}
