//! What came out, for a reader: the table of runs, the collapse, the fit.

use analysis::{Collapse, Estimate, MasterFit};
use protocol::api::SweepView;
use protocol::client::{Client, ClientError};
use record::Row;

use crate::failure::Failure;

/// Rows and analysis of a sweep.
pub struct Found {
    /// One row per point with a result.
    pub rows: Vec<Row>,
    /// The collapse, or why there is none.
    pub collapse: Result<Collapse, String>,
    /// The fit of the master curve, or why there is none.
    pub fit: Result<MasterFit, String>,
}

/// Asks the coordinator for everything.
pub async fn gather(client: &Client, view: &SweepView) -> Result<Found, Failure> {
    let base = format!("/v1/sweeps/{}", view.id);
    let text = client.get_bytes(&format!("{base}/results?format=ndjson")).await?;
    let rows = text
        .split(|byte| *byte == b'\n')
        .filter(|line| !line.is_empty())
        .map(serde_json::from_slice)
        .collect::<Result<Vec<Row>, _>>()
        .map_err(|error| Failure::Work(format!("a row of the results makes no sense: {error}")))?;
    let collapse = reason(client.get(&format!("{base}/collapse")).await)?;
    let fit = reason(client.get(&format!("{base}/fit")).await)?;
    Ok(Found { rows, collapse, fit })
}

/// An analysis that the data do not allow is no failure of the study.
fn reason<T>(answer: Result<T, ClientError>) -> Result<Result<T, String>, Failure> {
    match answer {
        Ok(value) => Ok(Ok(value)),
        Err(ClientError::FixInput(problem)) => Ok(Err(problem.detail.unwrap_or(problem.title))),
        Err(error) => Err(error.into()),
    }
}

/// Columns of the table: heading, and where the value comes from.
const COLUMNS: [(&str, Column); 11] = [
    ("σc [Pa]", Column::Scientific("sigma_c")),
    ("p [Pa]", Column::Scientific("p")),
    ("σe [Pa]", Column::Scientific("sigma_e")),
    ("η*", Column::Scientific("eta_star")),
    ("e", Column::Fixed("e")),
    ("e_r", Column::Relative),
    ("Z", Column::Fixed("z")),
    ("Z+", Column::Fixed("z_plus")),
    ("Z-", Column::Fixed("z_minus")),
    ("β+", Column::Fixed("beta_plus")),
    ("status", Column::Word("status")),
];

#[derive(Clone, Copy)]
enum Column {
    Scientific(&'static str),
    Fixed(&'static str),
    Relative,
    Word(&'static str),
}

/// Everything as text.
pub fn text(found: &Found) -> String {
    let mut rows: Vec<&Row> = found.rows.iter().collect();
    let order = |row: &Row| ["sigma_e", "p", "sigma_c", "seed"].map(|name| row.real(name).unwrap_or(0.0));
    rows.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal));
    let cells: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            COLUMNS.iter().map(|(_, column)| cell(row, *column, found.collapse.as_ref().ok())).collect()
        })
        .collect();
    let heads: Vec<String> = COLUMNS.iter().map(|(head, _)| (*head).to_owned()).collect();
    format!("{}\n{}", grid(&heads, &cells), analysis_text(found))
}

fn cell(row: &Row, column: Column, collapse: Option<&Collapse>) -> String {
    let shown = match column {
        Column::Scientific(name) => row.real(name).map(|value| format!("{value:.2e}")),
        Column::Fixed(name) => row.real(name).map(|value| format!("{value:.3}")),
        Column::Relative => collapse.and_then(|found| e_r(row, found)).map(|value| format!("{value:.3}")),
        Column::Word(name) => row.text(name).map(str::to_owned),
    };
    shown.unwrap_or_else(|| "-".to_owned())
}

/// e_r of the point that a run belongs to: replicates share it.
fn e_r(row: &Row, collapse: &Collapse) -> Option<f64> {
    let is_of = |name: &str, value: f64| {
        row.real(name).is_some_and(|found| (found - value).abs() <= 1e-9 * value.abs())
    };
    let point = collapse.points.iter().find(|point| {
        [
            ("p", point.p),
            ("sigma_c", point.sigma_c),
            ("sigma_e", point.sigma_e),
            ("alpha_n", point.alpha_n),
            ("mw", point.mw),
            ("ei", point.ei),
        ]
        .into_iter()
        .all(|(name, value)| is_of(name, value))
    })?;
    Some(point.e_r)
}

/// Right-aligned columns.
fn grid(heads: &[String], cells: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let all = cells.iter().map(|row| &row[column]).chain([&heads[column]]);
        all.map(|text| text.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let line = |row: &[String]| {
        let padded: Vec<String> =
            row.iter().zip(&widths).map(|(text, width)| format!("{text:>width$}")).collect();
        format!("{}\n", padded.join("  "))
    };
    let mut text = line(heads);
    for row in cells {
        text.push_str(&line(row));
    }
    text
}

fn analysis_text(found: &Found) -> String {
    let mut lines = Vec::new();
    match &found.collapse {
        Ok(collapse) => {
            lines.push(format!("e_min  {}", estimate(&collapse.e_min.estimate)));
            for plateau in &collapse.plateaus {
                lines.push(format!("e_max  {}  at p = {:.2e} Pa", estimate(&plateau.e_max), plateau.p));
            }
            if let Some(scatter) = collapse.scatter.value() {
                lines.push(format!(
                    "collapse: {} points, scatter of e_r {:.4}",
                    collapse.points.len(),
                    scatter.rms
                ));
            }
            if !collapse.outliers.is_empty() || !collapse.excluded.is_empty() {
                lines.push(format!(
                    "set aside: {} outliers, {} excluded",
                    collapse.outliers.len(),
                    collapse.excluded.len()
                ));
            }
        }
        Err(why) => lines.push(format!("no collapse: {why}")),
    }
    match &found.fit {
        Ok(fit) => {
            lines.push("master curve (30):".to_owned());
            for (name, value) in [
                ("A", &fit.at_paper.a),
                ("alpha", &fit.alpha),
                ("beta", &fit.beta),
                ("eta*_m", &fit.at_crossover.eta_star_m),
                ("s_m", &fit.at_paper.s_m),
            ] {
                lines.push(format!("  {name:<7} {}", estimate(value)));
            }
        }
        Err(why) => lines.push(format!("no fit: {why}")),
    }
    lines.push(String::new());
    lines.join("\n")
}

fn estimate(found: &Estimate) -> String {
    let [low, high] = found.ci95;
    format!("{:.4} ± {:.4}  (95 %: {low:.4} to {high:.4})", found.value, found.se)
}
