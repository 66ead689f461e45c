//! The analysis of the loading paths of plastic discs; also while the sweep runs.

use analysis::plastic::{CompactionOptions, PlasticCurve, compaction, coordination};
use analysis::{FitError, plot};
use protocol::SweepId;
use record::Row;
use serde::Serialize;
use serde_json::{Value, json};

use super::{App, Filters, ResultQuery};
use crate::error::{AppError, AppResult, blocking};

/// What is asked of the loading paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlasticAnalysis {
    /// Stress against solid fraction and strain with the fits of (5) to (16).
    Compaction,
    /// Largest curvature and solid fraction against stress; a picture alone, its data are those of the compaction.
    Curvature,
    /// Four definitions of stress of single discs; a picture alone.
    StressStrain,
    /// Coordination number above jamming with the fit of (17).
    Coordination,
}

impl PlasticAnalysis {
    /// What the scenes it reads compress.
    fn setup(self) -> &'static str {
        match self {
            Self::StressStrain => "diametrical",
            _ => "assembly",
        }
    }
}

impl App {
    /// An analysis of the loading paths of a sweep as JSON, with its provenance under `provenance`.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::Analysis`] with the reason when the data do not determine it.
    pub async fn analyse_plastic(
        &self,
        id: SweepId,
        what: PlasticAnalysis,
        filters: Filters,
    ) -> AppResult<Value> {
        let (curves, provenance) = self.plastic_curves(id, what, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || {
            let mut answer = match what {
                PlasticAnalysis::Coordination => plain(&coordination(&curves).map_err(refused)?)?,
                _ => plain(&compacted(&curves)?)?,
            };
            if let Value::Object(members) = &mut answer {
                members.insert("provenance".to_owned(), provenance);
            }
            Ok(answer)
        })
        .await
    }

    /// The picture of such an analysis, as SVG text.
    ///
    /// # Errors
    /// As [`App::analyse_plastic`].
    pub async fn picture_plastic(
        &self,
        id: SweepId,
        what: PlasticAnalysis,
        filters: Filters,
    ) -> AppResult<String> {
        let (curves, _) = self.plastic_curves(id, what, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || {
            Ok(match what {
                PlasticAnalysis::Compaction => plot::compaction_svg(&compacted(&curves)?),
                PlasticAnalysis::Curvature => plot::curvature_svg(&compacted(&curves)?),
                PlasticAnalysis::StressStrain => {
                    compacted(&curves)?;
                    plot::stress_strain_svg(&curves)
                }
                PlasticAnalysis::Coordination => {
                    plot::coordination_svg(&coordination(&curves).map_err(refused)?)
                }
            })
        })
        .await
    }

    /// The loading path of every finished run of the setup that the analysis is about.
    async fn plastic_curves(
        &self,
        id: SweepId,
        what: PlasticAnalysis,
        filters: Filters,
    ) -> AppResult<(Vec<PlasticCurve>, Value)> {
        let sweep = self.sweep_row(id).await?;
        if sweep.model != scene::Model::PlasticDiscs.name() {
            return Err(AppError::Analysis(format!(
                "this analysis is one of plastic_discs; the sweep is of {}",
                sweep.model
            )));
        }
        let query = ResultQuery { filters, after: None, limit: None, states: true };
        let mut stream = self.result_stream(id, query).await?;
        let mut paths: Vec<Vec<Row>> = Vec::new();
        while let Some(row) = stream.next().await? {
            // the rows of a path follow each other; each carries the columns of its run
            let same = |path: &Vec<Row>| path[0].text("scene_key") == row.text("scene_key");
            match paths.last_mut().filter(|path| same(path)) {
                Some(path) => path.push(row),
                None => paths.push(vec![row]),
            }
        }
        let curves: Vec<PlasticCurve> = paths
            .iter()
            .map(|path| PlasticCurve::from_run(&path[0], path))
            .filter(|curve| curve.setup == what.setup())
            .collect();
        let provenance = json!({
            "sweep": id, "name": sweep.name, "state": sweep.state, "points": sweep.points,
            "finished_points": sweep.counts.done, "setup": what.setup(), "runs": curves.len(),
            "code_version": env!("CARGO_PKG_VERSION"), "at": self.now().rfc3339(),
        });
        Ok((curves, provenance))
    }
}

fn compacted(curves: &[PlasticCurve]) -> AppResult<analysis::plastic::Compaction> {
    compaction(curves, &CompactionOptions::default()).map_err(refused)
}

fn plain(answer: &impl Serialize) -> AppResult<Value> {
    serde_json::to_value(answer).map_err(|error| AppError::Bug(format!("an analysis is no JSON: {error}")))
}

#[expect(clippy::needless_pass_by_value, reason = "shape of map_err")]
fn refused(error: FitError) -> AppError {
    AppError::Analysis(error.to_string())
}
