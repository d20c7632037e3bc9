//! The cells along one axis of a grid.

use std::ops::Range;

/// Cells along one axis.
#[derive(Clone, Debug, PartialEq)]
pub enum GridAxis {
    /// Equal cells.
    Uniform {
        /// Start of the first cell (m).
        lower: f64,
        /// Edge of a cell (m).
        cell: f64,
        /// Number of cells.
        cells: usize,
    },
    /// Increasing breakpoints (m), at least two.
    Graded(Vec<f64>),
}

impl GridAxis {
    /// Where the first cell starts, m.
    pub fn lower(&self) -> f64 {
        match self {
            Self::Uniform { lower, .. } => *lower,
            Self::Graded(breakpoints) => breakpoints[0],
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        match self {
            Self::Uniform { cells, .. } => *cells,
            Self::Graded(breakpoints) => breakpoints.len() - 1,
        }
    }

    /// Breakpoint `i` from 0 to the number of cells, in m from the first one, to the same bits as the grid's.
    pub fn breakpoint(&self, i: usize) -> f64 {
        match self {
            Self::Uniform { cell, .. } => i as f64 * cell,
            Self::Graded(breakpoints) => breakpoints[i] - breakpoints[0],
        }
    }

    /// Length of all cells, m.
    pub fn length(&self) -> f64 {
        self.breakpoint(self.cells())
    }

    /// Edge of cell `i`, m.
    pub fn cell(&self, i: usize) -> f64 {
        self.breakpoint(i + 1) - self.breakpoint(i)
    }

    /// Longest edge of a cell, m.
    pub fn longest(&self) -> f64 {
        (0..self.cells()).map(|i| self.cell(i)).fold(0.0, f64::max)
    }

    /// Shortest edge of a cell, m.
    pub fn shortest(&self) -> f64 {
        match self {
            Self::Uniform { cell, .. } => *cell,
            Self::Graded(_) => (0..self.cells()).map(|i| self.cell(i)).fold(f64::INFINITY, f64::min),
        }
    }

    /// Returns the first cell for which `past` is true, or the number of cells if there is none. If `past` is true for
    /// a cell, it must be true for all later cells.
    pub fn first_cell(&self, past: impl Fn(usize) -> bool) -> usize {
        let mut lower = 0;
        let mut upper = self.cells();
        while lower < upper {
            let middle = lower + (upper - lower) / 2;
            if past(middle) {
                upper = middle
            } else {
                lower = middle + 1
            }
        }
        lower
    }
}

/// Returns the lower corner of a grid in the plane of its first two axes (m).
pub(crate) fn corner(axes: &[GridAxis]) -> [f64; 2] {
    [0, 1].map(|axis| axes.get(axis).map_or(0.0, GridAxis::lower))
}

/// Returns the cells along an axis that an interval (m from the lower end of the grid) touches, including cells that
/// only end or begin at an end of the interval.
pub(crate) fn reached(axis: &GridAxis, [lower, upper]: [f64; 2]) -> Range<usize> {
    let start = axis.first_cell(|i| axis.breakpoint(i + 1) >= lower);
    start..axis.first_cell(|i| axis.breakpoint(i) > upper).max(start)
}
