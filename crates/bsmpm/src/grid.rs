//! Grid of cells with tensor-product B-splines. Each rank stores a part of the grid (its window). Positions are
//! relative to the grid's lower corner, to reduce round-off.

pub mod contributions;
pub mod extension;
pub(crate) mod occupied;
mod paired;
pub mod room;
pub mod shape;
pub mod spline;
pub mod transfer;

pub use contributions::Contributions;
pub use shape::Shape;
pub use spline::KnotVector;

use crate::error::GridError;
use crate::kinematics::Kinematics;
use crate::tensor::Vector;
use std::ops::Range;

/// Points that have positions in a grid, as the grid needs them.
pub trait PointPositions<const D: usize> {
    /// Returns the positions of the points from the grid's lower corner (m).
    fn places(&self) -> &[Vector<D>];
    /// Returns the id by which an error message names point `p`.
    fn id(&self, p: usize) -> u64;
}

/// Tensor product of open knot vectors. All ranks together store the cells of the [active domain](room), a box around
/// the points. This rank stores its window, a box of cells in the active domain.
///
/// Axis 0 is the slowest in every numbering, so the nodes of consecutive layers are one contiguous block. Node and cell
/// indices are local to the window unless stated otherwise.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    axes: [KnotVector; D],
    room: [Range<usize>; D],
    window: [Range<usize>; D],
    beyond: usize, // additional node layers of a window
}

/// Extent of the nodal contributions of a column of cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColumnExtent {
    /// Number of node layers that the column contributes to.
    pub layers: usize,
    /// Number of nodes of a layer.
    pub layer_nodes: usize,
    /// Number of nodes in the window.
    pub nodes: usize,
}

impl<const D: usize> Grid<D> {
    /// Creates the whole grid as one window. Fails if the axes differ in degree.
    pub fn new(axes: [KnotVector; D]) -> Result<Self, GridError> {
        let order = axes[0].order();
        if axes.iter().any(|axis| axis.order() != order) {
            return Err(GridError::MixedOrders);
        }
        let room = axes.each_ref().map(|axis| 0..axis.cells());
        Ok(Self {
            window: room.clone(),
            axes,
            room,
            beyond: 0,
        })
    }

    /// Returns the same grid, whose windows have `beyond` more layers of nodes than their cells touch (fewer at the end
    /// of the active domain). Methods that couple the cells of two windows need them.
    pub fn reaching(self, beyond: usize) -> Self {
        Self { beyond, ..self }
    }

    /// Returns the number of node layers that a window has in addition to those that its cells touch.
    pub fn beyond(&self) -> usize {
        self.beyond
    }

    /// Returns the same grid with the active domain `room`, a range of cells along each axis. The window is the whole
    /// active domain.
    pub fn within(&self, room: [Range<usize>; D]) -> Self {
        debug_assert!((0..D).all(|axis| !room[axis].is_empty() && room[axis].end <= self.axes[axis].cells()));
        Self {
            axes: self.axes.clone(),
            window: room.clone(),
            room,
            beyond: self.beyond,
        }
    }

    /// Returns the same grid with the window of the cells `columns` along axis 0.
    pub fn window(&self, columns: Range<usize>) -> Self {
        let mut window = self.room.clone();
        window[0] = columns;
        self.window_of(window)
    }

    /// Returns the same grid with the given window, a range of cells along each axis.
    pub fn window_of(&self, window: [Range<usize>; D]) -> Self {
        debug_assert!((0..D).all(|axis| {
            let room = &self.room[axis];
            !window[axis].is_empty() && room.start <= window[axis].start && window[axis].end <= room.end
        }));
        Self { window, ..self.clone() }
    }

    /// Returns the knot vectors, one per axis.
    pub fn axes(&self) -> &[KnotVector; D] {
        &self.axes
    }

    /// Returns the active domain of all ranks together: the range of cells along each axis.
    pub fn room(&self) -> &[Range<usize>; D] {
        &self.room
    }

    /// Returns the window: the range of cells along each axis.
    pub fn cells_along(&self) -> &[Range<usize>; D] {
        &self.window
    }

    /// Returns the window's range of cells along axis 0.
    pub fn columns(&self) -> Range<usize> {
        self.window[0].clone()
    }

    /// Returns whether the window is shorter than the active domain along axis 1. The answer is the same on all ranks.
    pub fn is_parted(&self) -> bool {
        D > 1 && self.window[1] != self.room[1]
    }

    /// Returns the polynomial degree q.
    pub fn order(&self) -> usize {
        self.axes[0].order()
    }

    /// Returns the window's range of node layers along axis 0: the layers that its cells touch, the last q of which are
    /// shared with the next rank, and the additional ones.
    pub fn layers(&self) -> Range<usize> {
        let start = self.window[0].start;
        start..start + self.nodes_along(0)
    }

    /// Returns the number of nodes of the window along an axis.
    #[inline]
    pub fn nodes_along(&self, axis: usize) -> usize {
        let end = (self.window[axis].end + self.beyond).min(self.room[axis].end);
        end - self.window[axis].start + self.order()
    }

    /// Returns the number of node layers that a column of cells contributes to: the q + 1 that it touches, and the
    /// additional ones.
    pub fn column_layers(&self) -> usize {
        self.order() + 1 + self.beyond
    }

    /// Returns the extent of the contributions of a column of cells.
    pub(crate) fn column_extent(&self) -> ColumnExtent {
        ColumnExtent {
            layers: self.column_layers(),
            layer_nodes: self.layer_nodes(),
            nodes: self.nodes(),
        }
    }

    /// Returns the number of nodes of one layer across axis 0.
    pub fn layer_nodes(&self) -> usize {
        (1..D).map(|axis| self.nodes_along(axis)).product()
    }

    /// Returns the number of cells of one column across axis 0.
    pub fn column_cells(&self) -> usize {
        self.window[1..].iter().map(Range::len).product()
    }

    /// Returns the number of nodes in the window.
    pub fn nodes(&self) -> usize {
        self.layers().len() * self.layer_nodes()
    }

    /// Returns the number of cells in the window.
    pub fn cells(&self) -> usize {
        self.window[0].len() * self.column_cells()
    }

    /// Returns the number of functions that are non-zero in a cell: (q + 1)^D.
    pub fn cell_nodes(&self) -> usize {
        (self.order() + 1).pow(D as u32)
    }

    /// Returns the global index along each axis of the cell that contains the position `x` (m, from the lower corner);
    /// `None` outside the grid.
    pub fn locate(&self, x: &Vector<D>) -> Option<[usize; D]> {
        let mut cell = [0; D];
        for (axis, found) in cell.iter_mut().enumerate() {
            *found = self.axes[axis].cell_of(x[axis])?;
        }
        Some(cell)
    }

    /// Returns whether a cell (global index along each axis) is in the window.
    #[inline]
    pub fn holds(&self, cell: &[usize; D]) -> bool {
        (0..D).all(|axis| self.window[axis].contains(&cell[axis]))
    }

    /// Returns the local index of a cell of the window, given by its global index along each axis.
    #[inline]
    pub fn cell_index(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.window[0].start;
        (1..D).fold(start, |index, axis| {
            index * self.window[axis].len() + cell[axis] - self.window[axis].start
        })
    }

    /// Returns the global index along each axis of the cell with a local index.
    pub fn cell_at(&self, mut index: usize) -> [usize; D] {
        let mut cell = [0; D];
        for axis in (1..D).rev() {
            cell[axis] = self.window[axis].start + index % self.window[axis].len();
            index /= self.window[axis].len();
        }
        cell[0] = index + self.window[0].start;
        cell
    }

    /// Returns the local index of the first of a cell's (q + 1)^D nodes. [`Grid::offsets`] gives the offsets of all of
    /// them from the first.
    pub fn first_node(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.window[0].start;
        (1..D).fold(start, |index, axis| {
            index * self.nodes_along(axis) + cell[axis] - self.window[axis].start
        })
    }

    /// Iterates over the functions (index along each axis) that are non-zero in a cell (global), in the order of the
    /// cell's nodes, axis 0 slowest.
    pub fn functions_of(&self, cell: [usize; D]) -> impl Iterator<Item = [usize; D]> {
        let width = self.order() + 1;
        (0..self.cell_nodes()).map(move |k| std::array::from_fn(|axis| cell[axis] + digit::<D>(k, axis, width)))
    }

    /// Returns the offsets of a cell's nodes from its first node, axis 0 slowest. They are the same for all cells (p2N
    /// in the paper).
    pub fn offsets(&self) -> Vec<usize> {
        self.offsets_of(self.order() + 1)
    }

    /// Returns the same offsets for the functions of degree q - 1, which use the numbers of the nodes
    /// ([`Shape::lowered`]).
    pub fn lowered_offsets(&self) -> Vec<usize> {
        self.offsets_of(self.order())
    }

    /// Returns the offsets of the first `width` nodes of a cell along each axis.
    fn offsets_of(&self, width: usize) -> Vec<usize> {
        (0..width.pow(D as u32))
            .map(|k| {
                (0..D).fold(0, |offset, axis| {
                    let along = if axis == 0 { 1 } else { self.nodes_along(axis) };
                    offset * along + digit::<D>(k, axis, width)
                })
            })
            .collect()
    }

    /// Returns the local nodes whose functions are non-zero on the lower (`false`) or upper (`true`) face of `axis`.
    /// With an open knot vector, exactly one layer of nodes interpolates there.
    pub fn face_nodes(&self, axis: usize, upper: bool) -> Vec<usize> {
        let wanted = if upper { self.axes[axis].functions() - 1 } else { 0 };
        (0..self.nodes())
            .filter(|&node| self.node_at(node)[axis] == wanted)
            .collect()
    }

    /// Returns the nearest node of the window in the same layer across `axis` that is not on a face of the other axes.
    pub fn off_edges(&self, node: usize, axis: usize) -> usize {
        let place = self.node_at(node);
        let mut found = node;
        let mut stride = 1;
        for other in (0..D).rev() {
            match place[other] {
                _ if other == axis => {}
                0 => found += stride,
                last if last + 1 == self.axes[other].functions() => found -= stride,
                _ => {}
            }
            stride *= self.nodes_along(other);
        }
        found
    }

    /// Returns the global index along each axis of the node with a local index.
    pub fn node_at(&self, mut index: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = self.window[axis].start + index % self.nodes_along(axis);
            index /= self.nodes_along(axis);
        }
        node[0] = index + self.window[0].start;
        node
    }

    /// Returns the local index of a node, given by its global index along each axis; `None` outside the window.
    pub fn node_index(&self, node: &[usize; D]) -> Option<usize> {
        let first = self.node_at(0);
        (0..D).try_fold(0, |index, axis| {
            let along = node[axis]
                .checked_sub(first[axis])
                .filter(|&along| along < self.nodes_along(axis))?;
            Some(index * self.nodes_along(axis) + along)
        })
    }

    /// Returns the local nodes of a box, given by ranges of global node indices along the first two axes, as the
    /// smallest number of contiguous ranges. The box must be in the window.
    pub fn nodes_within(&self, [layers, rows]: &[Range<usize>; 2]) -> Vec<Range<usize>> {
        let layer = self.layer_nodes();
        let row = self.layer_nodes() / self.nodes_along(1);
        let first = self.window[0].start;
        let start = self.window[1].start;
        if layers.is_empty() || rows.is_empty() {
            return Vec::new();
        }
        // Whole layers are one contiguous range.
        let (runs, run) = if rows.len() == self.nodes_along(1) {
            (1, layers.len() * layer)
        } else {
            (layers.len(), rows.len() * row)
        };
        (0..runs)
            .map(|along| {
                let start = (layers.start + along - first) * layer + (rows.start - start) * row;
                start..start + run
            })
            .collect()
    }

    /// Returns the number of a local node among the nodes of the whole grid.
    pub fn number_of(&self, node: usize) -> usize {
        let node = self.node_at(node);
        (1..D).fold(node[0], |number, axis| {
            number * self.axes[axis].functions() + node[axis]
        })
    }

    /// Returns the local node that has `number` in the whole grid; `None` outside the window.
    pub fn node_of_number(&self, number: usize) -> Option<usize> {
        self.node_index(&self.place_of_number(number))
    }

    /// Returns the global index along each axis of the node that has `number` in the whole grid.
    pub fn place_of_number(&self, mut number: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = number % self.axes[axis].functions();
            number /= self.axes[axis].functions();
        }
        node[0] = number;
        node
    }

    /// Returns the lower corner and the edge lengths of a cell (m).
    pub fn cell_box(&self, cell: &[usize; D]) -> (Vector<D>, Vector<D>) {
        let lower = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis]));
        let size = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis] + 1) - lower[axis]);
        (lower, size)
    }

    /// Returns the volume of a cell, m^D of the grid times [`Kinematics::weight`] at the cell's centre, which is exact
    /// because the weight is linear.
    pub fn cell_volume<K: Kinematics<D>>(&self, cell: &[usize; D]) -> f64 {
        let (lower, size) = self.cell_box(cell);
        size.product() * K::weight(&(lower + size * 0.5))
    }

    /// Returns the integral over the grid of the function of degree q - 1 that has the number of a node
    /// ([`Shape::lowered`]). The weight of the volume is linear, so it is evaluated at the function's centroid.
    pub fn lowered_volume<K: Kinematics<D>>(&self, node: usize) -> f64 {
        let node = self.node_at(node);
        let along: [(f64, f64); D] = std::array::from_fn(|axis| self.axes[axis].lowered_integral(node[axis]));
        along.iter().map(|(length, _)| length).product::<f64>() * K::weight(&Vector::from_fn(|axis, _| along[axis].1))
    }

    /// Returns the smallest edge of all cells (m).
    pub fn smallest_edge(&self) -> f64 {
        self.axes
            .iter()
            .map(KnotVector::smallest_cell)
            .fold(f64::INFINITY, f64::min)
    }
}

/// Returns the digit that belongs to `axis` when `number` is written with `base`; the digit of axis 0 is the most
/// significant.
#[inline]
pub(crate) fn digit<const D: usize>(number: usize, axis: usize, base: usize) -> usize {
    number / base.pow((D - 1 - axis) as u32) % base
}
