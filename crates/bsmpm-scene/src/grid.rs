//! The grid of a case. A C0 line (repeated breakpoint) adds no cell here; the crate `bsmpm` represents it by a knot
//! span of zero length.

use bsmpm::tensor::Vector;
use bsmpm_shapes::GridAxis;
use std::ops::Range;

/// The parametric grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpec {
    /// Cells along x and y, and of a solid z.
    pub axes: Vec<GridAxis>,
    /// Order of the B-splines, 1 to 3.
    pub order: usize,
    /// Repeated inner breakpoints along x, y and z, in ascending order.
    pub lines: [Vec<Line>; 3],
}

/// A grid line across which the splines of order q are less smooth: with `multiplicity` m, q - m derivatives are
/// continuous.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Number of the breakpoint along its axis.
    pub breakpoint: usize,
    /// How often it stands in the knot vector, 2 to q.
    pub multiplicity: usize,
}

impl GridSpec {
    /// Number of axes; the last one is the vertical.
    pub fn dims(&self) -> usize {
        self.axes.len()
    }

    /// Shortest edge of all cells, m.
    pub fn shortest(&self) -> f64 {
        self.axes.iter().map(GridAxis::shortest).fold(f64::INFINITY, f64::min)
    }

    /// Lower corner, m: positions of points are relative to it; 0 along an axis that it does not have.
    pub fn lower(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.axes.get(axis).map_or(0.0, GridAxis::lower))
    }

    /// Lower corner in a plane, m.
    pub(crate) fn corner(&self) -> [f64; 2] {
        let [x, y, _] = self.lower();
        [x, y]
    }

    /// Upper corner, m.
    pub fn upper(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.axes.get(axis).map_or(0.0, |axis| axis.lower() + axis.length()))
    }

    /// Knot spans along an axis: its cells, and those without length between the copies of a breakpoint.
    pub fn spans(&self, axis: usize) -> usize {
        self.span(axis, self.axes[axis].cells())
    }

    /// Number of a cell's knot span along an axis.
    pub fn span(&self, axis: usize, cell: usize) -> usize {
        let before = self.lines[axis].iter().take_while(|line| line.breakpoint <= cell);
        cell + before.map(|line| line.multiplicity - 1).sum::<usize>()
    }

    /// Knot spans of some cells along an axis, and those between them.
    pub fn spans_of(&self, axis: usize, cells: &Range<usize>) -> Range<usize> {
        if cells.is_empty() {
            return self.span(axis, cells.start)..self.span(axis, cells.start);
        }
        self.span(axis, cells.start)..self.span(axis, cells.end - 1) + 1
    }

    /// Cells along an axis whose knot span lies in a range.
    pub(crate) fn cells_in(&self, axis: usize, spans: &Range<usize>) -> Range<usize> {
        let [first, end] =
            [spans.start, spans.end].map(|from| self.axes[axis].first_cell(|cell| self.span(axis, cell) >= from));
        first..end
    }

    /// Breakpoints along an axis, m from the first, each as often as it stands in the knot vector.
    pub(crate) fn repeated(&self, axis: usize) -> Vec<f64> {
        let breakpoints = (0..=self.axes[axis].cells()).flat_map(|i| {
            let line = self.lines[axis].iter().find(|line| line.breakpoint == i);
            let copies = line.map_or(1, |line| line.multiplicity);
            std::iter::repeat_n(self.axes[axis].breakpoint(i), copies)
        });
        breakpoints.collect()
    }

    /// A place of the case from the grid's lower corner, m: in the closed grid to the last bit. Validation lets a place
    /// miss the grid by rounding, and `(lower + n h) - lower` may be above `n h`, where there is no cell.
    pub fn local(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (at[axis] - self.axes[axis].lower()).clamp(0.0, self.axes[axis].length()))
    }
}

/// A vector of a case in the dimension of its geometry; what is described in a plane has no further component.
pub fn vector<const D: usize, const N: usize>(of: [f64; N]) -> Vector<D> {
    Vector::from_fn(|axis, _| of.get(axis).copied().unwrap_or(0.0))
}
