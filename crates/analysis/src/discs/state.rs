//! One equilibrium state of a loading path.

use record::{Cell, Row};
use serde::{Deserialize, Serialize};

/// One equilibrium state. Forces in F0, lengths in a, moduli in K_N.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DiscState {
    /// Sample: seed of the run.
    pub seed: u64,
    /// Assembling procedure: `type1`, `type2`, `cohesionless`.
    pub assembly: String,
    /// Rolling friction μ_R/a [1].
    pub mu_r: f64,
    /// Remaining scene keys that make two runs different series.
    pub variant: String,
    /// Branch of the loading path: `compression`, `unloading`, `reloading`, `assembly`, ….
    pub branch: String,
    /// Number of the leg of the path.
    pub leg: u32,
    /// Reduced pressure P* = aP/F0 (1); P/K_N without cohesion [1].
    pub p_star: f64,
    /// Solid fraction Φ [1].
    pub phi: f64,
    /// Coordination number z [1].
    pub z: Option<f64>,
    /// Bulk modulus B [K_N].
    pub bulk: Option<f64>,
    /// Shear modulus G [K_N].
    pub shear: Option<f64>,
    /// Voigt estimate of B (12) [K_N].
    pub bulk_voigt: Option<f64>,
    /// Voigt estimate of G (12) [K_N].
    pub shear_voigt: Option<f64>,
    /// Reuss estimate of B (14) [K_N].
    pub bulk_reuss: Option<f64>,
    /// Sign of the smallest eigenvalue of the stiffness matrix: 1 stable, 0 floppy, −1 unstable.
    pub stiffness_sign: Option<f64>,
    /// Fractal dimension d_F [1].
    pub fractal_dimension: Option<f64>,
    /// Correlation length ξ [a].
    pub correlation_length: Option<f64>,
    /// Mass-averaged radius of gyration of the pores ξ' [a].
    pub pore_radius: Option<f64>,
    /// Whether all four equilibrium criteria were met.
    pub converged: bool,
}

const VARIANT_KEYS: [&str; 9] =
    ["n", "mu", "kr", "kappa", "kt_over_kn", "d0", "size_ratio", "phi_i", "cell_mass"];

/// Keys that older rows do not have, and the value that is as good as none: they count only when they differ.
const LATER_KEYS: [(&str, &str); 3] =
    [("final_drag", "0"), ("fluid_sweeps", "300"), ("precision", "\"double\"")];

impl DiscState {
    /// The states of one run: its scene and record in `run`, its rows in `states`. Rows without p or phi are left out.
    #[must_use]
    pub fn from_run(run: &Row, states: &[Row]) -> Vec<Self> {
        let told = |key: &str| run.get(key).map(|cell| cell.to_json().to_string());
        let early = VARIANT_KEYS.iter().filter_map(|key| told(key).map(|value| format!("{key}={value}")));
        let later = LATER_KEYS.iter().filter_map(|(key, usual)| {
            told(key)
                .filter(|value| value.trim_end_matches(".0") != *usual)
                .map(|value| format!("{key}={value}"))
        });
        let variant: Vec<String> = early.chain(later).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers")]
        let whole = |value: Option<f64>| value.unwrap_or(0.0) as u64;
        let state = |row: &Row| {
            Some(Self {
                seed: whole(run.real("seed")),
                assembly: run.text("assembly").unwrap_or("type2").to_owned(),
                mu_r: run.real("mu_r").unwrap_or(0.005),
                variant: variant.join(","),
                branch: row.text("branch").unwrap_or("compression").to_owned(),
                leg: u32::try_from(whole(row.real("leg"))).unwrap_or(u32::MAX),
                p_star: row.real("p")?,
                phi: row.real("phi").filter(|phi| *phi > 0.0)?,
                z: row.real("z"),
                bulk: row.real("bulk"),
                shear: row.real("shear"),
                bulk_voigt: row.real("bulk_voigt"),
                shear_voigt: row.real("shear_voigt"),
                bulk_reuss: row.real("bulk_reuss"),
                stiffness_sign: row.real("stiffness_sign"),
                fractal_dimension: row.real("fractal_dimension"),
                correlation_length: row.real("correlation_length"),
                pore_radius: row.real("pore_radius"),
                converged: !matches!(row.get("converged"), Some(Cell::Flag(false))),
            })
        };
        states.iter().filter_map(state).collect()
    }

    /// Whether the state is one of a pressure branch.
    #[must_use]
    pub fn is_loading(&self) -> bool {
        matches!(self.branch.as_str(), "compression" | "assembly") && self.p_star > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_rows_of_a_run() {
        let mut run = Row::new();
        run.put("seed", 3).put("assembly", "type1").number("mu_r", 0.5).unwrap();
        let mut good = Row::new();
        good.put("branch", "compression").put("converged", false).number("p", 0.1).unwrap();
        good.number("phi", 0.6).unwrap();
        let states = DiscState::from_run(&run, &[good, Row::new()]);
        assert_eq!(states.len(), 1);
        let state = &states[0];
        assert_eq!((state.seed, state.assembly.as_str(), state.mu_r), (3, "type1", 0.5));
        assert_eq!(state.variant, "");
        assert!(state.is_loading() && !state.converged && state.bulk.is_none());
    }
}
