//! The cells along an axis that a box covers.

use crate::grid::GridAxis;
use std::ops::Range;

/// Parts of a cell's edge below which a body is not taken to reach into it.
const SLIVER: f64 = 1e-9;

/// The part of one axis that a box covers.
#[derive(Clone, Debug)]
pub(crate) struct AxisExtent<'a> {
    axis: &'a GridAxis,
    /// m  ends of the box, from the grid's lower corner
    ends: [f64; 2],
    /// cells that it reaches into
    pub(crate) cells: Range<usize>,
}

impl<'a> AxisExtent<'a> {
    /// Of ends in the case's coordinates, m.
    pub(crate) fn new(axis: &'a GridAxis, lower: f64, upper: f64) -> Self {
        Self::between(axis, [lower - axis.lower(), upper - axis.lower()])
    }

    /// Of ends from the grid's lower corner, m.
    pub(super) fn between(axis: &'a GridAxis, [lower, upper]: [f64; 2]) -> Self {
        let ends = [lower.max(0.0), upper.min(axis.length())];
        let start = axis.first_cell(|i| axis.breakpoint(i + 1) > ends[0] + SLIVER * axis.cell(i));
        let end = axis.first_cell(|i| axis.breakpoint(i) >= ends[1] - SLIVER * axis.cell(i));
        Self {
            axis,
            ends,
            cells: start..end.max(start),
        }
    }

    /// Ends of the body's part of a cell, m; the outermost parts take up slivers, so that nothing is lost.
    pub(crate) fn part(&self, cell: usize) -> [f64; 2] {
        let lower = if cell == self.cells.start {
            self.ends[0]
        } else {
            self.axis.breakpoint(cell)
        };
        let upper = if cell + 1 == self.cells.end {
            self.ends[1]
        } else {
            self.axis.breakpoint(cell + 1)
        };
        [lower, upper]
    }
}
