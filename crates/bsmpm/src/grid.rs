//! The parametric grid and its tensor-product nodes (section 2.1), seen through the window of one slab.
//!
//! Positions are relative to the grid's lower corner: at 1e6 m an increment of 1e-9 m would lose 5 % of itself.

pub mod contributions;
pub mod shape;
pub mod spline;
pub mod transfer;

pub use contributions::Contributions;
pub use shape::Shape;
pub use spline::KnotVector;

use crate::error::GridError;
use crate::tensor::Vector;
use std::ops::Range;

/// A tensor product of open knot vectors, of which this rank sees the cells of some columns.
///
/// Axis 0 is the slowest in every numbering, so that the nodes of a slab of columns are one contiguous block.
/// Node and cell indices are local to the window unless said otherwise.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    axes: [KnotVector; D],
    columns: Range<usize>,
    beyond: usize, // further layers of nodes in a window
}

impl<const D: usize> Grid<D> {
    /// The whole grid as one window. Fails if the axes differ in order.
    pub fn new(axes: [KnotVector; D]) -> Result<Self, GridError> {
        let order = axes[0].order();
        if axes.iter().any(|axis| axis.order() != order) {
            return Err(GridError::MixedOrders);
        }
        let columns = 0..axes[0].cells();
        Ok(Self { axes, columns, beyond: 0 })
    }

    /// The same grid, whose windows hold `beyond` layers of nodes past those that their cells touch, as far as there are
    /// any: for what couples the cells of two windows.
    pub fn reaching(self, beyond: usize) -> Self {
        Self { beyond, ..self }
    }

    /// Layers of nodes that a window holds past those that its cells touch.
    pub fn beyond(&self) -> usize {
        self.beyond
    }

    /// The same grid seen through the cells `columns` along axis 0.
    pub fn window(&self, columns: Range<usize>) -> Self {
        debug_assert!(columns.start < columns.end && columns.end <= self.axes[0].cells());
        Self { axes: self.axes.clone(), columns, beyond: self.beyond }
    }

    /// Knot vectors, one per axis.
    pub fn axes(&self) -> &[KnotVector; D] {
        &self.axes
    }

    /// The window: cells along axis 0.
    pub fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// Polynomial order q.
    pub fn order(&self) -> usize {
        self.axes[0].order()
    }

    /// Layers of nodes along axis 0 that the window holds: those that its cells touch, of which the last q are shared with
    /// the next slab, and those beyond.
    pub fn layers(&self) -> Range<usize> {
        let end = self.columns.end + self.order() + self.beyond;
        self.columns.start..end.min(self.axes[0].functions())
    }

    /// Layers of nodes that a column of cells contributes to: those that it touches, and those beyond.
    pub fn column_layers(&self) -> usize {
        self.order() + 1 + self.beyond
    }

    /// Nodes of one layer across axis 0.
    pub fn layer_nodes(&self) -> usize {
        self.axes[1..].iter().map(KnotVector::functions).product()
    }

    /// Cells of one column across axis 0.
    pub fn column_cells(&self) -> usize {
        self.axes[1..].iter().map(KnotVector::cells).product()
    }

    /// Nodes in the window.
    pub fn nodes(&self) -> usize {
        self.layers().len() * self.layer_nodes()
    }

    /// Cells in the window.
    pub fn cells(&self) -> usize {
        self.columns.len() * self.column_cells()
    }

    /// Functions that are non-zero in a cell: (q + 1)^D.
    pub fn cell_nodes(&self) -> usize {
        (self.order() + 1).pow(D as u32)
    }

    /// Cell along each axis (global) that holds `x` (m, from the lower corner); `None` outside the grid.
    pub fn locate(&self, x: &Vector<D>) -> Option<[usize; D]> {
        let mut cell = [0; D];
        for (axis, found) in cell.iter_mut().enumerate() {
            *found = self.axes[axis].cell_of(x[axis])?;
        }
        Some(cell)
    }

    /// Local index of a cell given along each axis; its column must lie in the window.
    pub fn cell_index(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.columns.start;
        (1..D).fold(start, |index, axis| index * self.axes[axis].cells() + cell[axis])
    }

    /// Cell along each axis (global) of a local index.
    pub fn cell_at(&self, mut index: usize) -> [usize; D] {
        let mut cell = [0; D];
        for axis in (1..D).rev() {
            cell[axis] = index % self.axes[axis].cells();
            index /= self.axes[axis].cells();
        }
        cell[0] = index + self.columns.start;
        cell
    }

    /// Local index of the first of a cell's (q+1)^D nodes; the others stand at [`Grid::offsets`] from it.
    pub fn first_node(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.columns.start;
        (1..D).fold(start, |index, axis| index * self.axes[axis].functions() + cell[axis])
    }

    /// Offsets of a cell's nodes from its first one, axis 0 slowest: the paper's p2N, which is the same for all cells.
    pub fn offsets(&self) -> Vec<usize> {
        let width = self.order() + 1;
        (0..self.cell_nodes())
            .map(|k| {
                (0..D).fold(0, |offset, axis| {
                    let a = k / width.pow((D - 1 - axis) as u32) % width;
                    let functions = if axis == 0 { 1 } else { self.axes[axis].functions() };
                    offset * functions + a
                })
            })
            .collect()
    }

    /// Local nodes whose functions are non-zero on the lower (`false`) or upper (`true`) face of `axis`: there the
    /// open knot vector makes exactly one layer of nodes interpolate.
    pub fn face_nodes(&self, axis: usize, upper: bool) -> Vec<usize> {
        let wanted = if upper { self.axes[axis].functions() - 1 } else { 0 };
        (0..self.nodes()).filter(|&node| self.node_at(node)[axis] == wanted).collect()
    }

    /// Node along each axis (global) of a local index.
    pub fn node_at(&self, mut index: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = index % self.axes[axis].functions();
            index /= self.axes[axis].functions();
        }
        node[0] = index + self.columns.start;
        node
    }

    /// Lower corner and edge lengths of a cell, m.
    pub fn cell_box(&self, cell: &[usize; D]) -> (Vector<D>, Vector<D>) {
        let lower = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis]));
        let size = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis] + 1) - lower[axis]);
        (lower, size)
    }

    /// Integral of a node's function over the grid, m^D.
    pub fn node_volume(&self, node: usize) -> f64 {
        let node = self.node_at(node);
        (0..D).map(|axis| self.axes[axis].integral(node[axis])).product()
    }

    /// Smallest edge of any cell, m.
    pub fn smallest_edge(&self) -> f64 {
        self.axes.iter().map(KnotVector::smallest_cell).fold(f64::INFINITY, f64::min)
    }
}
