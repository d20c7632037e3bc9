//! The cells along an axis that a box covers.

use crate::axis::GridAxis;
use std::ops::Range;

/// Parts of a cell's edge below which a body is not taken to reach into it.
const SLIVER: f64 = 1e-9;

/// The part of one axis that a box covers.
#[derive(Clone, Debug)]
pub struct AxisExtent<'a> {
    axis: &'a GridAxis,
    /// m  ends of the box, from the grid's lower corner
    ends: [f64; 2],
    /// Cells that the box reaches into.
    pub cells: Range<usize>,
}

impl<'a> AxisExtent<'a> {
    /// Returns the extent of a box between two ends (m).
    pub fn new(axis: &'a GridAxis, lower: f64, upper: f64) -> Self {
        Self::between(axis, [lower - axis.lower(), upper - axis.lower()])
    }

    /// Returns the extent of a box between two ends (m from the lower end of the grid).
    pub(crate) fn between(axis: &'a GridAxis, [lower, upper]: [f64; 2]) -> Self {
        let ends = [lower.max(0.0), upper.min(axis.length())];
        let start = axis.first_cell(|i| axis.breakpoint(i + 1) > ends[0] + SLIVER * axis.cell(i));
        let end = axis.first_cell(|i| axis.breakpoint(i) >= ends[1] - SLIVER * axis.cell(i));
        Self {
            axis,
            ends,
            cells: start..end.max(start),
        }
    }

    /// Returns the ends of the part of a cell that the box covers (m from the lower end of the grid). The outermost
    /// parts include what the box covers of cells that it barely reaches, so that nothing is lost.
    pub fn part(&self, cell: usize) -> [f64; 2] {
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

/// Returns the lower and upper corner of what is left of a box where other boxes cut off whole sides of it.
pub fn left_of_box<const D: usize>([mut lower, mut upper]: [[f64; D]; 2], cut: &[[[f64; D]; 2]]) -> [[f64; D]; 2] {
    for _ in cut {
        for [from, to] in cut {
            for axis in 0..D {
                let mut others = (0..D).filter(|other| *other != axis);
                if !others.all(|other| from[other] <= lower[other] && upper[other] <= to[other]) {
                    continue;
                }
                if from[axis] <= lower[axis] && lower[axis] < to[axis] {
                    lower[axis] = to[axis].min(upper[axis]);
                }
                if to[axis] >= upper[axis] && upper[axis] > from[axis] {
                    upper[axis] = from[axis].max(lower[axis]);
                }
            }
        }
    }
    [lower, upper]
}
