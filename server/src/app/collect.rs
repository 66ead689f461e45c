//! Results: pages and streams of rows.

use std::collections::{BTreeSet, VecDeque};

use protocol::SweepId;
use protocol::api::ResultPage;
use record::Row;

use super::rows::flat;
use super::{App, Filters};
use crate::error::{AppError, AppResult, blocking};
use crate::store::{RunRow, SweepRow};

/// Rows read from the database at a time.
const CHUNK: u32 = 500;

/// Which results.
#[derive(Clone, Debug)]
pub struct ResultQuery {
    /// Conditions on the rows.
    pub filters: Filters,
    /// After this point.
    pub after: Option<u64>,
    /// At most so many rows; `None`: all.
    pub limit: Option<u32>,
    /// Rows of the loading paths instead of one row a run.
    pub states: bool,
}

/// Rows of a sweep, read chunk by chunk: memory does not grow with the sweep.
pub struct RowStream {
    app: App,
    sweep: i64,
    query: ResultQuery,
    ready: VecDeque<(u64, Row)>,
    given: u32,
    last: Option<u64>,
    end: bool,
}

impl RowStream {
    /// The next row; `None` at the end.
    ///
    /// # Errors
    /// When the database or a file fails.
    pub async fn next(&mut self) -> AppResult<Option<Row>> {
        if self.query.limit.is_some_and(|limit| self.given >= limit) {
            return Ok(None);
        }
        while self.ready.is_empty() && !self.end {
            self.fill().await?;
        }
        let Some((point, row)) = self.ready.pop_front() else { return Ok(None) };
        self.given += 1;
        self.last = Some(point);
        Ok(Some(row))
    }

    /// Where the next page begins, if there may be one; right after the last row of a limited stream.
    ///
    /// # Errors
    /// When the database or a file fails.
    pub async fn next_cursor(&mut self) -> AppResult<Option<u64>> {
        while self.ready.is_empty() && !self.end {
            self.fill().await?;
        }
        Ok(if self.ready.is_empty() { None } else { self.last })
    }

    async fn fill(&mut self) -> AppResult<()> {
        let runs = self.app.store().runs(self.sweep, self.query.after, CHUNK).await?;
        let Some(newest) = runs.last().map(|run| run.point) else {
            self.end = true;
            return Ok(());
        };
        self.query.after = Some(newest);
        let app = self.app.clone();
        let filters = self.query.filters.clone();
        let states = self.query.states;
        let rows = blocking(move || {
            let mut rows = VecDeque::new();
            for run in &runs {
                let point = run.point;
                let made = if states { app.path_of(run)? } else { vec![flat(run)?] };
                rows.extend(made.into_iter().filter(|row| filters.keep(row)).map(|row| (point, row)));
            }
            Ok(rows)
        })
        .await?;
        self.ready.extend(rows);
        Ok(())
    }
}

impl App {
    /// A stream of result rows.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::Invalid`] when a filter names no column.
    pub async fn result_stream(&self, id: SweepId, query: ResultQuery) -> AppResult<RowStream> {
        let sweep = self.sweep_row(id).await?;
        self.check_columns(&sweep, &query).await?;
        Ok(RowStream {
            app: self.clone(),
            sweep: sweep.seq,
            query,
            ready: VecDeque::new(),
            given: 0,
            last: None,
            end: false,
        })
    }

    /// A page of result rows. The states of one loading path are never torn apart between pages.
    ///
    /// # Errors
    /// As [`App::result_stream`].
    pub async fn results(&self, id: SweepId, query: ResultQuery, limit: u32) -> AppResult<ResultPage> {
        let states = query.states;
        let mut stream = self.result_stream(id, ResultQuery { limit: None, ..query }).await?;
        let mut items = Vec::new();
        while items.len() < limit as usize || (states && stream.same_path_follows()) {
            let Some(row) = stream.next().await? else { break };
            items.push(row);
        }
        let next = stream.next_cursor().await?.map(|point| point.to_string());
        Ok(ResultPage { items, next })
    }

    /// Every row of a sweep, for the analysis.
    ///
    /// # Errors
    /// As [`App::result_stream`].
    pub async fn all_rows(&self, id: SweepId, filters: Filters) -> AppResult<Vec<Row>> {
        let query = ResultQuery { filters, after: None, limit: None, states: false };
        let mut stream = self.result_stream(id, query).await?;
        let mut rows = Vec::new();
        while let Some(row) = stream.next().await? {
            rows.push(row);
        }
        Ok(rows)
    }

    /// Names of all columns that the rows of a query have, in order: the head of a CSV file.
    ///
    /// # Errors
    /// As [`App::result_stream`].
    pub async fn columns(&self, id: SweepId, query: ResultQuery) -> AppResult<Vec<String>> {
        let mut stream = self.result_stream(id, query).await?;
        let mut names = BTreeSet::new();
        while let Some(row) = stream.next().await? {
            for (name, _) in row.iter() {
                if !names.contains(name) {
                    names.insert(name.to_owned());
                }
            }
        }
        let first = ["point", "job", "scene_key"].map(str::to_owned);
        let rest = names.into_iter().filter(|name| !first.contains(name));
        Ok(first.iter().cloned().chain(rest).collect())
    }

    /// Refuses a filter on a column that no row can have. Which columns a record has is known from the first rows.
    async fn check_columns(&self, sweep: &SweepRow, query: &ResultQuery) -> AppResult<()> {
        if query.filters.0.is_empty() {
            return Ok(());
        }
        let runs = self.store().runs(sweep.seq, None, 20).await?;
        if runs.is_empty() {
            return Ok(());
        }
        let app = self.clone();
        let states = query.states;
        let known = blocking(move || {
            let mut known = BTreeSet::new();
            for run in &runs {
                let rows = if states { app.path_of(run)? } else { vec![flat(run)?] };
                for row in rows {
                    known.extend(row.iter().map(|(name, _)| name.to_owned()));
                }
            }
            Ok(known)
        })
        .await?;
        let model = scene::Model::named(&sweep.model);
        let mut known: BTreeSet<String> = known;
        if let Some(model) = model {
            known.extend(model.keys().iter().map(|key| key.name.to_owned()));
            known.extend(model.quantities().iter().map(|quantity| quantity.name.to_owned()));
        }
        let fields = query.filters.unknown(&known);
        if fields.is_empty() { Ok(()) } else { Err(AppError::Invalid { what: "query", fields }) }
    }

    /// The states of a run's loading path, each with the scene's columns; empty for a run without one.
    fn path_of(&self, run: &RunRow) -> AppResult<Vec<Row>> {
        let Some(hash) = &run.states else { return Ok(Vec::new()) };
        let bytes = self.blobs().get(hash)?;
        let states: Vec<Row> = super::table::unpack(&bytes)?;
        let base = flat(run)?;
        let mut rows = Vec::with_capacity(states.len());
        for (index, state) in states.into_iter().enumerate() {
            let mut row = base.clone();
            row.extend(state);
            row.put("state_index", i64::try_from(index).unwrap_or(i64::MAX));
            rows.push(row);
        }
        Ok(rows)
    }
}

impl RowStream {
    fn same_path_follows(&self) -> bool {
        self.last.is_some() && self.ready.front().map(|(point, _)| *point) == self.last
    }
}
