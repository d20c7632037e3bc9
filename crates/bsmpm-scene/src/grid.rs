//! The grid of a case, cells described but not stored where they are equal.

/// The parametric grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpec {
    /// Cells along x and y.
    pub axes: [Axis; 2],
    /// Order of the B-splines, 1 to 3.
    pub order: usize,
}

/// Cells along one axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// Equal cells.
    Uniform {
        /// m  where the first cell starts, in the case's coordinates
        lower: f64,
        /// m  edge of a cell
        cell: f64,
        /// Number of cells.
        cells: usize,
    },
    /// m  increasing breakpoints, in the case's coordinates
    Graded(Vec<f64>),
}

impl GridSpec {
    /// Lower corner, m: positions of points are relative to it.
    pub fn lower(&self) -> [f64; 2] {
        [self.axes[0].lower(), self.axes[1].lower()]
    }

    /// Upper corner, m.
    pub fn upper(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.axes[axis].lower() + self.axes[axis].length())
    }

    /// A place of the case from the grid's lower corner, m: in the closed grid to the last bit. Validation lets a place
    /// miss the grid by rounding, and `(lower + n h) - lower` may be above `n h`, where there is no cell.
    pub fn local(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (at[axis] - self.axes[axis].lower()).clamp(0.0, self.axes[axis].length()))
    }
}

impl Axis {
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

    /// Shortest edge of a cell, m.
    pub fn shortest(&self) -> f64 {
        match self {
            Self::Uniform { cell, .. } => *cell,
            Self::Graded(_) => (0..self.cells()).map(|i| self.cell(i)).fold(f64::INFINITY, f64::min),
        }
    }

    /// First cell for which `past` holds, which must hold for all later ones too; the number of cells if there is none.
    pub(crate) fn first_cell(&self, past: impl Fn(usize) -> bool) -> usize {
        let (mut lower, mut upper) = (0, self.cells());
        while lower < upper {
            let middle = lower + (upper - lower) / 2;
            if past(middle) { upper = middle } else { lower = middle + 1 }
        }
        lower
    }
}
