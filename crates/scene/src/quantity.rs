//! Quantities derived from a scene.

/// A number that follows from a scene: for `where` in sweeps, as a column of results, as an axis of the analysis.
#[derive(Clone, Copy, Debug)]
pub struct Quantity<S> {
    /// Name; the paper's symbol in ASCII.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is, with its formula.
    pub meaning: &'static str,
    /// Paper and equation.
    pub source: &'static str,
    /// The formula.
    pub of: fn(&S) -> f64,
}

/// A [`Quantity`] without its formula, for documentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuantityInfo {
    /// Name; the paper's symbol in ASCII.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is, with its formula.
    pub meaning: &'static str,
    /// Paper and equation.
    pub source: &'static str,
}

impl<S> Quantity<S> {
    /// The quantity without its formula.
    #[must_use]
    pub const fn info(&self) -> QuantityInfo {
        QuantityInfo { name: self.name, unit: self.unit, meaning: self.meaning, source: self.source }
    }
}
