//! The analysis of a sweep's finished runs; also while it runs.

use analysis::collapse::CollapseOptions;
use analysis::exponents::ExponentOptions;
use analysis::plot;
use analysis::variation::Varied;
use analysis::{FitError, MasterFit, Run};
use protocol::SweepId;
use serde::Serialize;
use serde_json::{Value, json};

use super::{App, Filters};
use crate::error::{AppError, AppResult, blocking};

/// What is asked of the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    /// Plateau, relative void ratio e_r against η*.
    Collapse,
    /// The master curve through it.
    Fit,
    /// Exponents b and c found by the data.
    Exponents,
    /// Coordination against η and η*.
    Bonds,
    /// Force exponents β± against η and η*.
    Forces,
    /// Whether a key beside the groups of the collapse changes the void ratio.
    Variation(Varied),
}

impl App {
    /// An analysis as JSON, with its provenance under `provenance`.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::Analysis`] with the reason when the data do not determine it.
    pub async fn analyse(&self, id: SweepId, what: Analysis, filters: Filters) -> AppResult<Value> {
        let (runs, provenance) = self.runs(id, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || {
            let mut answer = computed(what, &runs)?;
            match &mut answer {
                Value::Object(members) => {
                    members.insert("provenance".to_owned(), provenance);
                    Ok(answer)
                }
                _ => Ok(json!({ "answer": answer, "provenance": provenance })),
            }
        })
        .await
    }

    /// The picture of an analysis, as SVG text.
    ///
    /// # Errors
    /// As [`App::analyse`].
    pub async fn picture(&self, id: SweepId, what: Analysis, filters: Filters) -> AppResult<String> {
        let (runs, _) = self.runs(id, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || drawn(what, &runs)).await
    }

    pub(super) async fn analyst(&self) -> AppResult<tokio::sync::SemaphorePermit<'_>> {
        let closed = |_| AppError::Unavailable("the service is stopping".to_owned());
        self.0.analysts.acquire().await.map_err(closed)
    }

    async fn runs(&self, id: SweepId, filters: Filters) -> AppResult<(Vec<Run>, Value)> {
        let sweep = self.sweep_row(id).await?;
        if sweep.model != scene::Model::CohesiveSpheres.name() {
            return Err(AppError::Analysis(format!(
                "this analysis is one of cohesive_spheres; the sweep is of {}: take the rows of /results and /states",
                sweep.model
            )));
        }
        let rows = self.all_rows(id, filters).await?;
        let (runs, unusable) = Run::from_rows(&rows);
        let unusable: Vec<Value> = unusable
            .iter()
            .take(100)
            .map(|(position, reason)| {
                let point = rows.get(*position).and_then(|row| row.real("point"));
                json!({ "point": point, "reason": reason.to_string() })
            })
            .collect();
        let provenance = json!({
            "sweep": id, "name": sweep.name, "state": sweep.state, "points": sweep.points,
            "finished_points": sweep.counts.done, "rows": rows.len(), "runs": runs.len(), "unusable": unusable,
            "code_version": env!("CARGO_PKG_VERSION"), "at": self.now().rfc3339(),
        });
        Ok((runs, provenance))
    }
}

fn computed(what: Analysis, runs: &[Run]) -> AppResult<Value> {
    match what {
        Analysis::Collapse => plain(&collapsed(runs)?),
        Analysis::Fit => plain(&analysis::fit_master(&collapsed(runs)?).map_err(refused)?),
        Analysis::Exponents => plain(&exponents(runs)?),
        Analysis::Bonds => plain(&analysis::bonds(runs).map_err(refused)?),
        Analysis::Forces => plain(&analysis::forces(runs).map_err(refused)?),
        Analysis::Variation(varied) => plain(&analysis::variation(runs, varied).map_err(refused)?),
    }
}

fn drawn(what: Analysis, runs: &[Run]) -> AppResult<String> {
    Ok(match what {
        Analysis::Collapse => {
            let collapse = collapsed(runs)?;
            // The curve is drawn when the data have one; the points stand without it.
            let master: Option<MasterFit> = analysis::fit_master(&collapse).ok();
            plot::collapse_svg(&collapse, master.as_ref())
        }
        Analysis::Fit => {
            let collapse = collapsed(runs)?;
            let master = analysis::fit_master(&collapse).map_err(refused)?;
            plot::master_svg(&collapse, &master)
        }
        Analysis::Exponents => plot::exponents_svg(&exponents(runs)?),
        Analysis::Bonds => plot::bonds_svg(&analysis::bonds(runs).map_err(refused)?),
        Analysis::Forces => plot::forces_svg(&analysis::forces(runs).map_err(refused)?),
        Analysis::Variation(varied) => {
            plot::variation_svg(&analysis::variation(runs, varied).map_err(refused)?)
        }
    })
}

fn collapsed(runs: &[Run]) -> AppResult<analysis::Collapse> {
    analysis::collapse(runs, &CollapseOptions::default()).map_err(refused)
}

fn exponents(runs: &[Run]) -> AppResult<analysis::Exponents> {
    analysis::exponents(&collapsed(runs)?, &ExponentOptions::default()).map_err(refused)
}

fn plain(answer: &impl Serialize) -> AppResult<Value> {
    serde_json::to_value(answer).map_err(|error| AppError::Bug(format!("an analysis is no JSON: {error}")))
}

#[expect(clippy::needless_pass_by_value, reason = "shape of map_err")]
fn refused(error: FitError) -> AppError {
    AppError::Analysis(error.to_string())
}
