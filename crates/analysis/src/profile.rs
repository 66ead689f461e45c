//! Profile of the void ratio: e inside a centred cube of side 2r against r/L.
//!
//! The curve itself is measured where the particles are known, with exact sphere–cube intersection volumes; here it is
//! read from the packing of a run and summarised.

use record::Table;
use serde::{Deserialize, Serialize};

use crate::fit::{Datum, Sigma, least_squares};
use crate::{Determined, Estimate, FitError};

/// One cube.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ProfilePoint {
    /// Half side over box length r/L [1].
    pub r_over_l: f64,
    /// Void ratio inside the cube [1].
    pub e: f64,
}

/// The profile of one packing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Profile {
    /// Cubes from the centre outwards.
    pub points: Vec<ProfilePoint>,
    /// Slope de/d(r/L) between r/L = 0.15 and 0.4, away from the order at the centre and from the walls [1]. The
    /// paper sees a plateau or a small gradient in regular packings and a strong one in those off the plateau.
    pub gradient: Determined<Estimate>,
    /// e of the largest cube minus e at r/L = 0.25: what the layer at the walls adds [1].
    pub wall_excess: Determined<f64>,
}

/// Range of r/L in which the gradient is read.
const GRADIENT_RANGE: [f64; 2] = [0.15, 0.4];

/// Summarises a profile given as r/L and e.
///
/// # Errors
/// [`FitError::TooFew`] for an empty profile.
pub fn profile(points: &[ProfilePoint]) -> Result<Profile, FitError> {
    if points.is_empty() {
        return Err(FitError::too_few("profile", "cubes", 1, 0));
    }
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.r_over_l.total_cmp(&b.r_over_l));
    let [low, high] = GRADIENT_RANGE;
    let data: Vec<Datum> = sorted
        .iter()
        .filter(|point| (low..=high).contains(&point.r_over_l))
        .map(|point| Datum { x: point.r_over_l, y: point.e, sigma: 1.0 })
        .collect();
    let gradient = least_squares(
        "gradient of the profile",
        &data,
        &["e", "slope"],
        &[1.0, 0.0],
        Sigma::Relative,
        |x, t| t[0] + t[1] * (x - 0.25),
    );
    let wall_excess = gradient.as_ref().map_err(Clone::clone).map(|fit| {
        let last = sorted.last().expect("not empty").e;
        last - fit.values()[0]
    });
    Ok(Profile {
        points: sorted,
        gradient: gradient.map(|fit| fit.parameter("slope").expect("fitted")).into(),
        wall_excess: wall_excess.into(),
    })
}

/// Reads the columns `r_over_l` and `e` of a table.
///
/// # Errors
/// [`FitError::TooFew`] when a column is absent or empty.
pub fn from_table(table: &Table) -> Result<Profile, FitError> {
    let column = |name: &str| {
        table.column(name).ok_or_else(|| FitError::too_few("profile", &format!("columns named {name}"), 1, 0))
    };
    let points: Vec<ProfilePoint> = column("r_over_l")?
        .into_iter()
        .zip(column("e")?)
        .map(|(r_over_l, e)| ProfilePoint { r_over_l, e })
        .collect();
    profile(&points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_profile_has_its_slope() {
        let mut table = Table::new();
        let r: Vec<f64> = (1..=20).map(|i| 0.025 * f64::from(i)).collect();
        let e: Vec<f64> = r.iter().map(|r| 1.1 + 0.3 * (r - 0.25)).collect();
        table.push("r_over_l", "1", &r).unwrap().push("e", "1", &e).unwrap();
        let found = from_table(&table).unwrap();
        assert!((found.gradient.value().unwrap().value - 0.3).abs() < 1e-9);
        assert!((found.wall_excess.value().unwrap() - 0.075).abs() < 1e-9);
    }

    #[test]
    fn too_little_is_an_error() {
        assert!(from_table(&Table::new()).is_err());
        let one = profile(&[ProfilePoint { r_over_l: 0.2, e: 1.0 }]).unwrap();
        assert!(one.gradient.reason().is_some() && one.wall_excess.reason().is_some());
    }
}
