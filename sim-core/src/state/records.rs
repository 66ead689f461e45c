//! What every record of a body or force can do, whatever its layout.

/// Record of where a body is and how it moves.
pub trait Kinematics: Copy + Send + Sync + std::fmt::Debug + PartialEq + 'static {
    /// A body at `position` [d] with velocity [d/τ] and spin [1/τ], without a displacement budget.
    fn new(position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]) -> Self;
    /// Centre [d].
    fn position(&self) -> [f64; 3];
    /// Velocity and spin [d/τ, 1/τ].
    fn motion(&self) -> ([f64; 3], [f64; 3]);
    /// Puts it elsewhere [d].
    fn move_to(&mut self, position: [f64; 3]);
    /// At least the inverse of its displacement budget [1/d].
    fn inverse_budget(&self) -> f64;
    /// Gives it a displacement budget [d].
    fn set_budget(&mut self, budget: f64);
    /// The same body with the budget of another.
    #[must_use]
    fn with_budget_of(self, other: &Self) -> Self;
}

/// Record of a force that others add to.
pub trait Gain: Copy + Default + Send + Sync + std::fmt::Debug + 'static {
    /// Adds another one.
    fn gain(&mut self, other: &Self);
}
