//! Coordination numbers Z, Z+, Z− and the tensile share Z−/Z against η and η*.

use serde::{Deserialize, Serialize};

use crate::compare::{Comparison, compare};
use crate::cost::Shape;
use crate::estimate::mean_of;
use crate::{Determined, Estimate, FitError, Run};

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct BondPoint {
    /// Id of the run.
    pub id: String,
    /// Confining pressure [Pa].
    pub p: f64,
    /// Elastic stress [Pa].
    pub sigma_e: f64,
    /// η = σc/p [1].
    pub eta: f64,
    /// η* = σc/√(p σe) [1].
    pub eta_star: f64,
    /// Coordination number Z [1].
    pub z: f64,
    /// Compressive part Z+ [1].
    pub z_plus: f64,
    /// Tensile part Z− [1].
    pub z_minus: f64,
    /// Tensile share Z−/Z [1].
    pub tensile_share: f64,
    /// How the run ended: Z and its parts still rise long after e has settled.
    pub status: String,
    /// Whether σc/σe exceeds 0.05; shown, left out of the comparison.
    pub out_of_model: bool,
}

/// Coordination numbers of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Bonds {
    /// The runs that have Z, Z+ and Z−.
    pub points: Vec<BondPoint>,
    /// Runs without coordination numbers, not settled, or without adhesion.
    pub left_out: usize,
    /// Smallest and largest Z; the paper finds 4 … 4.2 [1].
    pub z_range: [f64; 2],
    /// Mean Z [1].
    pub z: Estimate,
    /// Mean Z+ of the runs with η ≥ 10; the paper's limit is 2 [1].
    pub z_plus_limit: Determined<Estimate>,
    /// Mean Z− of the runs with η ≥ 10; the paper's limit is 2 [1].
    pub z_minus_limit: Determined<Estimate>,
    /// Z+, Z− and Z−/Z: which of η and η* collapses them better.
    pub comparisons: Vec<Determined<Comparison>>,
}

/// Above this η the limit Z± → 2 is read.
const LIMIT_ETA: f64 = 10.0;

/// Coordination numbers against η and η*.
///
/// # Errors
/// [`FitError::TooFew`] when no run has them.
pub fn bonds(runs: &[Run]) -> Result<Bonds, FitError> {
    let points: Vec<BondPoint> =
        runs.iter().filter(|run| run.settled() && run.sigma_c > 0.0).filter_map(point).collect();
    if points.is_empty() {
        return Err(FitError::too_few("bonds", "runs with z, z_plus and z_minus", 1, 0));
    }
    let z: Vec<f64> = points.iter().map(|point| point.z).collect();
    let inside: Vec<&BondPoint> = points.iter().filter(|point| !point.out_of_model).collect();
    let limit = |get: fn(&BondPoint) -> f64, name: &str| {
        let values: Vec<f64> =
            inside.iter().filter(|point| point.eta >= LIMIT_ETA).map(|point| get(point)).collect();
        if values.len() < 2 {
            return Err(FitError::too_few(name, "runs with η ≥ 10", 2, values.len()));
        }
        Ok(mean_of(&values).expect("two or more values"))
    };
    let against = |name: &str, get: fn(&BondPoint) -> f64, shape: Shape| {
        let column = |f: fn(&BondPoint) -> f64| inside.iter().map(|point| f(point)).collect::<Vec<f64>>();
        let weights = vec![1.0; inside.len()];
        compare(name, &column(|p| p.eta), &column(|p| p.eta_star), &column(get), &weights, shape).into()
    };
    Ok(Bonds {
        left_out: runs.len() - points.len(),
        z_range: [z.iter().copied().fold(f64::INFINITY, f64::min), z.iter().copied().fold(0.0, f64::max)],
        z: mean_of(&z).expect("not empty"),
        z_plus_limit: limit(|point| point.z_plus, "Z+ at large η").into(),
        z_minus_limit: limit(|point| point.z_minus, "Z− at large η").into(),
        comparisons: vec![
            against("z_plus", |point| point.z_plus, Shape::Decreasing),
            against("z_minus", |point| point.z_minus, Shape::Increasing),
            against("tensile_share", |point| point.tensile_share, Shape::Increasing),
        ],
        points,
    })
}

fn point(run: &Run) -> Option<BondPoint> {
    let (z, z_plus, z_minus) = (run.z?, run.z_plus?, run.z_minus?);
    (z > 0.0).then(|| BondPoint {
        id: run.id.clone(),
        p: run.p,
        sigma_e: run.sigma_e,
        eta: run.eta(),
        eta_star: run.eta_star(),
        z,
        z_plus,
        z_minus,
        tensile_share: z_minus / z,
        status: run.status.clone(),
        out_of_model: run.out_of_model,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Variable;
    use crate::synthetic::Study;

    #[test]
    fn bonds_that_follow_eta_collapse_on_eta() {
        let runs = Study::paper(1).runs();
        let found = bonds(&runs).unwrap();
        assert_eq!(found.points.len() + found.left_out, runs.len());
        assert_eq!(found.comparisons.len(), 3);
        for comparison in &found.comparisons {
            let comparison = comparison.value().unwrap();
            assert_eq!(comparison.better, Variable::Eta);
            assert!(comparison.ratio > 3.0 && comparison.confidence > 0.99, "{comparison:?}");
        }
        // Z− = 2η/(1 + η) + noise
        let limit = found.z_minus_limit.value().unwrap();
        assert!((limit.value - 2.0).abs() < 0.05, "{limit:?}");
    }

    #[test]
    fn runs_without_coordination_are_an_error_and_few_runs_no_comparison() {
        let mut runs = Study::paper(1).runs();
        let few = bonds(&runs[..5]).unwrap();
        assert!(few.comparisons.iter().all(|comparison| comparison.reason().is_some()));
        runs.iter_mut().for_each(|run| run.z = None);
        assert!(matches!(bonds(&runs), Err(FitError::TooFew { .. })));
    }
}
