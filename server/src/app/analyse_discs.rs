//! The analysis of loading paths of discs; also while the sweep runs.

use analysis::discs::{ConsolidationOptions, DiscState, consolidation, moduli, structure};
use analysis::{FitError, plot};
use protocol::SweepId;
use serde::Serialize;
use serde_json::{Value, json};

use super::{App, Filters, ResultQuery};
use crate::error::{AppError, AppResult, blocking};

/// What is asked of the states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscAnalysis {
    /// Φ(P*) with the fits (7), (8) and (9).
    Consolidation,
    /// B and G with their Voigt and Reuss estimates.
    Moduli,
    /// d_F, ξ and the gyration radius of the pores.
    Structure,
}

impl App {
    /// An analysis of the states of a sweep as JSON, with its provenance under `provenance`.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::Analysis`] with the reason when the data do not determine it.
    pub async fn analyse_discs(&self, id: SweepId, what: DiscAnalysis, filters: Filters) -> AppResult<Value> {
        let (states, provenance) = self.disc_states(id, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || {
            let mut answer = computed(what, &states)?;
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
    /// As [`App::analyse_discs`].
    pub async fn picture_discs(
        &self,
        id: SweepId,
        what: DiscAnalysis,
        filters: Filters,
    ) -> AppResult<String> {
        let (states, _) = self.disc_states(id, filters).await?;
        let _turn = self.analyst().await?;
        blocking(move || drawn(what, &states)).await
    }

    /// Every state of every finished run.
    async fn disc_states(&self, id: SweepId, filters: Filters) -> AppResult<(Vec<DiscState>, Value)> {
        let sweep = self.sweep_row(id).await?;
        if sweep.model != scene::Model::CohesiveDiscs.name() {
            return Err(AppError::Analysis(format!(
                "this analysis is one of cohesive_discs; the sweep is of {}",
                sweep.model
            )));
        }
        let query = ResultQuery { filters, after: None, limit: None, states: true };
        let mut stream = self.result_stream(id, query).await?;
        let mut states = Vec::new();
        while let Some(row) = stream.next().await? {
            // A row carries the columns of its run.
            states.extend(DiscState::from_run(&row, std::slice::from_ref(&row)));
        }
        let provenance = json!({
            "sweep": id, "name": sweep.name, "state": sweep.state, "points": sweep.points,
            "finished_points": sweep.counts.done, "states": states.len(),
            "code_version": env!("CARGO_PKG_VERSION"), "at": self.now().rfc3339(),
        });
        Ok((states, provenance))
    }
}

fn computed(what: DiscAnalysis, states: &[DiscState]) -> AppResult<Value> {
    match what {
        DiscAnalysis::Consolidation => plain(&consolidated(states)?),
        DiscAnalysis::Moduli => plain(&moduli(states).map_err(refused)?),
        DiscAnalysis::Structure => plain(&structure(states).map_err(refused)?),
    }
}

fn drawn(what: DiscAnalysis, states: &[DiscState]) -> AppResult<String> {
    Ok(match what {
        DiscAnalysis::Consolidation => plot::consolidation_svg(&consolidated(states)?),
        DiscAnalysis::Moduli => plot::moduli_svg(&moduli(states).map_err(refused)?),
        DiscAnalysis::Structure => plot::structure_svg(&structure(states).map_err(refused)?),
    })
}

fn consolidated(states: &[DiscState]) -> AppResult<analysis::discs::Consolidation> {
    consolidation(states, &ConsolidationOptions::default()).map_err(refused)
}

fn plain(answer: &impl Serialize) -> AppResult<Value> {
    serde_json::to_value(answer).map_err(|error| AppError::Bug(format!("an analysis is no JSON: {error}")))
}

#[expect(clippy::needless_pass_by_value, reason = "shape of map_err")]
fn refused(error: FitError) -> AppError {
    AppError::Analysis(error.to_string())
}
