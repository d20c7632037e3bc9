//! How volumetric locking and stress oscillation are treated (section 2.3).

/// The method of section 2.3 that a run uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilisation {
    /// The plain B-spline method.
    #[default]
    None,
    /// dJ averaged over the grid every iteration (Eqs 15-18).
    FBar,
    /// The paper's method: dJ averaged, and b^e averaged after every step (Eqs 15-20).
    ModifiedFBar,
}
