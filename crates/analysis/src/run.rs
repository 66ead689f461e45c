//! One finished run of cohesive spheres as the analysis sees it.

use record::Row;
use serde::{Deserialize, Serialize};

/// Statuses of runs whose void ratio had not settled when they ended.
const UNSETTLED: [&str; 5] = ["step_limit", "not_converged", "unsettled", "failed", "running"];

/// Scene keys besides those of [`Run`] that make two runs different points (all but the seed).
const VARIANT_KEYS: [&str; 12] = [
    "n",
    "mu",
    "kt_over_kn",
    "mu_wall",
    "wall_adhesion",
    "moving_walls",
    "agitation",
    "damping_mass",
    "clamp_viscous",
    "scale_wall_mass",
    "approach",
    "precision",
];

/// One finished run: scene in SI units and what was observed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Run {
    /// Scene key or job id; empty when the row has none.
    pub id: String,
    /// Confining pressure p [Pa].
    pub p: f64,
    /// Cohesive stress σc [Pa].
    pub sigma_c: f64,
    /// Elastic stress σe [Pa].
    pub sigma_e: f64,
    /// Damping ratio α_n [1].
    pub alpha_n: f64,
    /// Wall mass over particle mass m_w/m [1].
    pub mw: f64,
    /// Initial void ratio e_i [1].
    pub ei: f64,
    /// Seed.
    pub seed: u64,
    /// The remaining scene keys, canonical; runs that differ only in the seed are replicates.
    pub variant: String,
    /// Void ratio e [1].
    pub e: f64,
    /// Its standard error within the run [1].
    pub e_se: Option<f64>,
    /// Coordination number Z [1].
    pub z: Option<f64>,
    /// Compressive coordination number Z+ [1].
    pub z_plus: Option<f64>,
    /// Tensile coordination number Z− [1].
    pub z_minus: Option<f64>,
    /// Exponent β+ of the compressive forces [1].
    pub beta_plus: Option<f64>,
    /// Standard error of β+ [1].
    pub beta_plus_se: Option<f64>,
    /// Exponent β− of the tensile forces [1].
    pub beta_minus: Option<f64>,
    /// Standard error of β− [1].
    pub beta_minus_se: Option<f64>,
    /// How the run ended.
    pub status: String,
    /// Whether the overlap at rest σc/σe leaves the range of the model (above 0.05).
    pub out_of_model: bool,
}

/// A row that is not a usable run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[error("column {column} is absent or not a positive number")]
pub struct NotARun {
    /// The offending column.
    pub column: String,
}

/// Largest σc/σe inside the model: equilibrium overlap of 5 % of d.
pub const LARGEST_OVERLAP: f64 = 0.05;

impl Run {
    /// Reads a record; keys at their documented default may be absent.
    ///
    /// # Errors
    /// [`NotARun`] when p, σe, σc or e is absent or not a number of the right sign.
    pub fn from_row(row: &Row) -> Result<Self, NotARun> {
        let refuse = |column: &str| NotARun { column: column.to_owned() };
        let positive =
            |column: &str| row.real(column).filter(|value| *value > 0.0).ok_or_else(|| refuse(column));
        let sigma_c = row.real("sigma_c").filter(|value| *value >= 0.0).ok_or_else(|| refuse("sigma_c"))?;
        let sigma_e = positive("sigma_e")?;
        let marked = match row.get("out_of_model") {
            Some(record::Cell::Flag(flag)) => *flag,
            _ => sigma_c / sigma_e > LARGEST_OVERLAP,
        };
        let variant: Vec<String> = VARIANT_KEYS
            .iter()
            .filter_map(|key| row.get(key).map(|cell| format!("{key}={}", cell.to_json())))
            .collect();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "seeds are small whole numbers"
        )]
        let seed = row.real("seed").unwrap_or(1.0) as u64;
        Ok(Self {
            id: ["scene_key", "key", "job", "id"]
                .iter()
                .find_map(|column| row.text(column))
                .unwrap_or_default()
                .to_owned(),
            p: positive("p")?,
            sigma_c,
            sigma_e,
            alpha_n: row.real("alpha_n").unwrap_or(0.25),
            mw: row.real("mw").unwrap_or(96.0),
            ei: row.real("ei").unwrap_or(1.704),
            seed,
            variant: variant.join(","),
            e: positive("e")?,
            e_se: row.real("e_se"),
            z: row.real("z"),
            z_plus: row.real("z_plus"),
            z_minus: row.real("z_minus"),
            beta_plus: row.real("beta_plus"),
            beta_plus_se: row.real("beta_plus_se"),
            beta_minus: row.real("beta_minus"),
            beta_minus_se: row.real("beta_minus_se"),
            status: row.text("status").unwrap_or("unknown").to_owned(),
            out_of_model: marked,
        })
    }

    /// Every row that is a run; the others with their position and reason.
    #[must_use]
    pub fn from_rows(rows: &[Row]) -> (Vec<Self>, Vec<(usize, NotARun)>) {
        let mut runs = Vec::new();
        let mut refused = Vec::new();
        for (position, row) in rows.iter().enumerate() {
            match Self::from_row(row) {
                Ok(run) => runs.push(run),
                Err(reason) => refused.push((position, reason)),
            }
        }
        (runs, refused)
    }

    /// Whether e had settled when the run ended.
    #[must_use]
    pub fn settled(&self) -> bool {
        !UNSETTLED.contains(&self.status.as_str())
    }

    /// Cohesion number η = σc/p (12).
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.sigma_c / self.p
    }

    /// Modified cohesion number η* = σc/√(p σe) (13).
    #[must_use]
    pub fn eta_star(&self) -> f64 {
        self.sigma_c / (self.p * self.sigma_e).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        let mut row = Row::new();
        for (name, value) in [("p", 1e5), ("sigma_c", 3e6), ("sigma_e", 1e10), ("e", 1.17), ("z", 4.05)] {
            row.number(name, value).unwrap();
        }
        row.put("status", "e_converged").put("n", 1000).put("seed", 3);
        row
    }

    #[test]
    fn reads_a_record_with_defaults() {
        let run = Run::from_row(&row()).unwrap();
        assert_eq!((run.alpha_n, run.mw, run.ei, run.seed), (0.25, 96.0, 1.704, 3));
        assert_eq!(run.variant, "n=1000");
        assert!((run.eta() - 30.0).abs() < 1e-12);
        assert!((run.eta_star() - 3e6 / 1e15_f64.sqrt()).abs() < 1e-12);
        assert!(run.settled() && !run.out_of_model);
    }

    #[test]
    fn refuses_what_is_no_run_and_marks_what_is_no_model() {
        let mut broken = row();
        broken.number("p", -1.0).unwrap();
        assert_eq!(Run::from_row(&broken).unwrap_err().column, "p");
        let (runs, refused) = Run::from_rows(&[row(), Row::new(), broken]);
        assert_eq!((runs.len(), refused.len(), refused[1].0), (1, 2, 2));
        let mut soft = row();
        soft.number("sigma_e", 5e7).unwrap().put("status", "step_limit");
        let run = Run::from_row(&soft).unwrap();
        assert!(run.out_of_model && !run.settled());
    }
}
