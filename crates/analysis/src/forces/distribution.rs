//! The force distribution of one packing.

use record::Table;
use serde::{Deserialize, Serialize};

use super::truncated::{Truncated, truncated_exponential};
use crate::point::count;
use crate::{Determined, FitError};

/// One bin of the histogram.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Bin {
    /// Centre, x = fn/fc [1].
    pub x: f64,
    /// Probability density over all contacts that carry force [1].
    pub density: f64,
    /// Its standard error, √count/(n·width) [1].
    pub se: f64,
    /// Contacts in the bin.
    pub contacts: usize,
}

/// Distribution of fn/fc over the contacts between particles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ForceDistribution {
    /// Compressive exponent β+ on (0, 1.5].
    pub beta_plus: Determined<Truncated>,
    /// Tensile exponent β− on [−0.5, 0).
    pub beta_minus: Determined<Truncated>,
    /// Contacts with |fn| below the tolerance: the Dirac peak at zero, counted apart.
    pub zero_contacts: usize,
    /// All contacts.
    pub contacts: usize,
    /// Histogram for the eye; no fit is made to it.
    pub bins: Vec<Bin>,
}

/// End of the compressive range, fn/fc [1].
pub const COMPRESSIVE_END: f64 = 1.5;
/// End of the tensile range, −fn/fc [1].
pub const TENSILE_END: f64 = 0.5;

/// Distribution of the ratios x = fn/fc of one packing; |x| < `zero_tolerance` counts as zero force.
#[must_use]
pub fn distribution(ratios: &[f64], zero_tolerance: f64) -> ForceDistribution {
    let carries = |x: f64| x.abs() >= zero_tolerance;
    let plus: Vec<f64> =
        ratios.iter().copied().filter(|x| carries(*x) && *x > 0.0 && *x <= COMPRESSIVE_END).collect();
    let minus: Vec<f64> = ratios
        .iter()
        .copied()
        .filter(|x| carries(*x) && *x < 0.0 && *x >= -TENSILE_END)
        .map(|x| -x)
        .collect();
    let carrying: Vec<f64> = ratios.iter().copied().filter(|x| carries(*x)).collect();
    ForceDistribution {
        beta_plus: truncated_exponential(&plus, COMPRESSIVE_END).into(),
        beta_minus: truncated_exponential(&minus, TENSILE_END).into(),
        zero_contacts: ratios.len() - carrying.len(),
        contacts: ratios.len(),
        bins: histogram(&carrying),
    }
}

/// Distribution from a contact table with the column `fn` in units of k_n d; `adhesion` is f_c in the same units,
/// σc/σe. Contacts below 1e-6 f_c count as without force.
///
/// # Errors
/// [`FitError`] when the column is absent or there is no adhesion to scale with.
pub fn from_contacts(contacts: &Table, adhesion: f64) -> Result<ForceDistribution, FitError> {
    const WHAT: &str = "force distribution";
    if adhesion <= 0.0 {
        return Err(FitError::out_of_range(WHAT, format!("adhesion {adhesion}: fn/fc needs a positive one")));
    }
    let forces = contacts.column("fn").ok_or_else(|| FitError::too_few(WHAT, "columns named fn", 1, 0))?;
    let ratios: Vec<f64> = forces.iter().map(|force| force / adhesion).collect();
    Ok(distribution(&ratios, 1e-6))
}

/// Bins of 0.1 from −1 (no force is below −fc) to the largest of 3 and the 99 % quantile.
fn histogram(ratios: &[f64]) -> Vec<Bin> {
    const WIDTH: f64 = 0.1;
    if ratios.is_empty() {
        return Vec::new();
    }
    let mut sorted = ratios.to_vec();
    sorted.sort_by(f64::total_cmp);
    let top = crate::estimate::quantile_sorted(&sorted, 0.99).clamp(1.5, 10.0);
    let mut bins: Vec<Bin> = Vec::new();
    let mut low = -1.0;
    while low < top {
        let contacts = sorted.partition_point(|x| *x < low + WIDTH) - sorted.partition_point(|x| *x < low);
        let scale = 1.0 / (count(ratios.len()) * WIDTH);
        bins.push(Bin {
            x: low + 0.5 * WIDTH,
            density: count(contacts) * scale,
            se: count(contacts).sqrt() * scale,
            contacts,
        });
        low += WIDTH;
    }
    bins
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_forces_are_counted_apart() {
        let mut ratios: Vec<f64> = (1..=100).map(|i| -(1.0 - f64::from(i) / 101.0).ln()).collect();
        ratios.extend([0.0, 1e-9, -1e-9]);
        ratios.extend((1..=50).map(|i| -0.01 * f64::from(i)));
        let found = distribution(&ratios, 1e-6);
        assert_eq!((found.zero_contacts, found.contacts), (3, 153));
        assert!(found.beta_plus.value().unwrap().beta.covers(1.0));
        assert_eq!(found.beta_minus.value().unwrap().contacts, 50);
        let total: f64 = found.bins.iter().map(|bin| bin.density * 0.1).sum();
        assert!(total > 0.9 && total <= 1.0 + 1e-12, "{total}");
        let none = distribution(&[], 1e-6);
        assert!(none.beta_plus.reason().is_some() && none.bins.is_empty());
    }

    #[test]
    fn reads_a_contact_table() {
        let mut contacts = Table::new();
        let forces: Vec<f64> = (1..=100).map(|i| -1e-4 * (1.0 - f64::from(i) / 101.0).ln()).collect();
        contacts.push("fn", "kn d", &forces).unwrap();
        let found = from_contacts(&contacts, 1e-4).unwrap();
        assert!(found.beta_plus.value().unwrap().beta.covers(1.0));
        assert!(from_contacts(&contacts, 0.0).is_err() && from_contacts(&Table::new(), 1e-4).is_err());
    }
}
