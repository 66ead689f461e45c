//! Does α_n, m_w/m or e_i change the void ratio? A statement with a number behind it.
//!
//! Runs that differ only in the variable form a block (same p, σc, σe, …). With replicates the spread inside the blocks
//! is compared with the replicate scatter by an F test of Σ_blocks Σ_levels n (ē_level − ē_block)². Without replicates
//! the test is the two-way table's: the effect of the levels common to all blocks against what is left over. Such a test
//! cannot tell an effect that changes sign from block to block from noise, and says so.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::point::{Point, count, group};
use crate::{Determined, FitError, Run};

/// A key that is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Varied {
    /// Damping ratio α_n.
    AlphaN,
    /// Wall mass m_w/m.
    Mw,
    /// Initial void ratio e_i.
    Ei,
}

impl Varied {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::AlphaN, Self::Mw, Self::Ei];

    fn get(self, run: &Run) -> f64 {
        match self {
            Self::AlphaN => run.alpha_n,
            Self::Mw => run.mw,
            Self::Ei => run.ei,
        }
    }

    fn without(self, run: &Run) -> Run {
        let mut other = run.clone();
        match self {
            Self::AlphaN => other.alpha_n = 0.0,
            Self::Mw => other.mw = 0.0,
            Self::Ei => other.ei = 0.0,
        }
        other
    }

    fn symbol(self) -> &'static str {
        match self {
            Self::AlphaN => "α_n",
            Self::Mw => "m_w/m",
            Self::Ei => "e_i",
        }
    }
}

/// One level of a block.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct LevelMean {
    /// Value of the varied key [1].
    pub value: f64,
    /// Mean void ratio [1].
    pub e: f64,
    /// Replicates behind it.
    pub replicates: usize,
}

/// Runs that differ only in the varied key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Block {
    /// Pressure [Pa].
    pub p: f64,
    /// Cohesive stress [Pa].
    pub sigma_c: f64,
    /// Elastic stress [Pa].
    pub sigma_e: f64,
    /// η* [1].
    pub eta_star: f64,
    /// Levels in rising order.
    pub levels: Vec<LevelMean>,
    /// Largest minus smallest mean void ratio [1].
    pub spread: f64,
}

/// The test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Significance {
    /// F statistic [1].
    pub f: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: [usize; 2],
    /// Probability of an F at least as large when the key has no effect [1].
    pub p_value: f64,
    /// p_value below 0.01.
    pub significant: bool,
    /// Whether the scatter is that of replicates; otherwise it is what the two-way table leaves over.
    pub from_replicates: bool,
    /// Standard deviation of one run [1].
    pub scatter: f64,
    /// The result as a sentence.
    pub statement: String,
}

/// Effect of one key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Variation {
    /// The key.
    pub varied: Varied,
    /// Blocks with at least two levels.
    pub blocks: Vec<Block>,
    /// Whether the key matters.
    pub significance: Determined<Significance>,
}

/// Effect of one key on e.
///
/// # Errors
/// [`FitError::TooFew`] when no two runs differ only in it.
pub fn variation(runs: &[Run], varied: Varied) -> Result<Variation, FitError> {
    let settled: Vec<Run> = runs.iter().filter(|run| run.settled()).cloned().collect();
    let points = group(&settled);
    let mut order: Vec<usize> = (0..points.len()).collect();
    let place = |point: &Point| {
        let run = varied.without(&point.scene);
        ([run.p, run.sigma_e, run.sigma_c, run.alpha_n, run.mw, run.ei], run.variant)
    };
    order.sort_by(|&a, &b| {
        place(&points[a]).partial_cmp(&place(&points[b])).expect("scenes hold finite numbers")
    });
    let members: Vec<Vec<&Point>> = order
        .chunk_by(|&a, &b| place(&points[a]) == place(&points[b]))
        .map(|chunk| {
            let mut block: Vec<&Point> = chunk.iter().map(|&i| &points[i]).collect();
            block.sort_by(|a, b| varied.get(&a.scene).total_cmp(&varied.get(&b.scene)));
            block
        })
        .filter(|block| block.len() > 1)
        .collect();
    if members.is_empty() {
        return Err(FitError::too_few(varied.symbol(), "runs that differ in it alone", 2, 0));
    }
    Ok(Variation {
        varied,
        significance: test(varied, &members, &points).into(),
        blocks: members.iter().map(|block| summary(varied, block)).collect(),
    })
}

fn summary(varied: Varied, block: &[&Point]) -> Block {
    let scene = &block[0].scene;
    let (low, high) = block.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p.e), h.max(p.e)));
    Block {
        p: scene.p,
        sigma_c: scene.sigma_c,
        sigma_e: scene.sigma_e,
        eta_star: scene.eta_star(),
        levels: block
            .iter()
            .map(|point| LevelMean {
                value: varied.get(&point.scene),
                e: point.e,
                replicates: point.replicates,
            })
            .collect(),
        spread: high - low,
    }
}

/// Degrees of freedom of the replicate scatter below which it is not used.
const FEWEST_REPLICATE_DOF: usize = 3;

fn test(varied: Varied, blocks: &[Vec<&Point>], points: &[Point]) -> Result<Significance, FitError> {
    let (mut within, mut within_dof) = (0.0, 0);
    for point in points {
        within += point.values.iter().map(|e| (e - point.e).powi(2)).sum::<f64>();
        within_dof += point.values.len() - 1;
    }
    if within_dof >= FEWEST_REPLICATE_DOF && within > 0.0 {
        let (mut between, mut dof) = (0.0, 0);
        for block in blocks {
            let n: f64 = block.iter().map(|point| count(point.replicates)).sum();
            let mean = block.iter().map(|point| count(point.replicates) * point.e).sum::<f64>() / n;
            between +=
                block.iter().map(|point| count(point.replicates) * (point.e - mean).powi(2)).sum::<f64>();
            dof += block.len() - 1;
        }
        return Ok(verdict(varied, blocks, [between, within], [dof, within_dof], true));
    }
    two_way(varied, blocks)
}

/// Blocks that hold the most common set of levels, as a complete two-way table.
fn two_way(varied: Varied, blocks: &[Vec<&Point>]) -> Result<Significance, FitError> {
    let levels =
        |block: &Vec<&Point>| block.iter().map(|p| varied.get(&p.scene).to_bits()).collect::<Vec<_>>();
    let most = blocks
        .iter()
        .max_by_key(|block| blocks.iter().filter(|other| levels(other) == levels(block)).count())
        .map(levels)
        .unwrap_or_default();
    let table: Vec<&Vec<&Point>> = blocks.iter().filter(|block| levels(block) == most).collect();
    let (rows, columns) = (table.len(), most.len());
    if rows < 2 {
        return Err(FitError::too_few(
            varied.symbol(),
            "blocks with the same levels, or replicates, to tell an effect from scatter",
            2,
            rows,
        ));
    }
    let row_mean = |row: &[&Point]| row.iter().map(|p| p.e).sum::<f64>() / count(columns);
    let grand = table.iter().map(|row| row_mean(row)).sum::<f64>() / count(rows);
    let column_mean = |j: usize| table.iter().map(|row| row[j].e).sum::<f64>() / count(rows);
    let effect: f64 = (0..columns).map(|j| count(rows) * (column_mean(j) - grand).powi(2)).sum();
    let left: f64 = table
        .iter()
        .map(|row| {
            let mean = row_mean(row);
            (0..columns).map(|j| (row[j].e - mean - column_mean(j) + grand).powi(2)).sum::<f64>()
        })
        .sum();
    if left <= 0.0 {
        return Err(FitError::underdetermined(varied.symbol(), "the runs leave no scatter to compare with"));
    }
    Ok(verdict(varied, blocks, [effect, left], [columns - 1, (columns - 1) * (rows - 1)], false))
}

fn verdict(
    varied: Varied,
    blocks: &[Vec<&Point>],
    squares: [f64; 2],
    dof: [usize; 2],
    from_replicates: bool,
) -> Significance {
    let variance = squares[1] / count(dof[1]);
    let f = squares[0] / count(dof[0]) / variance;
    let law = FisherSnedecor::new(count(dof[0]), count(dof[1])).expect("positive degrees of freedom");
    let p_value = law.sf(f).clamp(0.0, 1.0);
    let significant = p_value < 0.01;
    let spread = blocks
        .iter()
        .map(|block| {
            let (l, h) = block.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p.e), h.max(p.e)));
            h - l
        })
        .fold(0.0, f64::max);
    let basis = if from_replicates { "replicate scatter" } else { "scatter left over by the two-way table" };
    let verb = if significant { "changes" } else { "does not significantly change" };
    let statement = format!(
        "{} {verb} e: largest spread {spread:.4} in {} blocks against a {basis} of {:.4} (F = {f:.2}, p = {p_value:.2e})",
        varied.symbol(),
        blocks.len(),
        variance.sqrt()
    );
    Significance {
        f,
        degrees_of_freedom: dof,
        p_value,
        significant,
        from_replicates,
        scatter: variance.sqrt(),
        statement,
    }
}

#[cfg(test)]
mod tests;
