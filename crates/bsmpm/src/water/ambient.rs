//! Still water: its pressure and what it does to the ground.

/// Still water, by its level.
#[derive(Clone, Debug, PartialEq)]
pub enum Ambient {
    /// none: the excess is the whole pore pressure
    None,
    /// m  rows of time (s or pseudo-time, increasing) and height above the grid's lower corner; constant after the last
    Level(Vec<(f64, f64)>),
    /// m  phreatic line: rows of x, increasing, and height, both from the grid's lower corner; constant beyond its ends
    Line(Vec<(f64, f64)>),
}
