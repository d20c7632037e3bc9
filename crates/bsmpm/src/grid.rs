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

/// What has places in a grid: the points, as the grid sees them.
pub trait PointPositions<const D: usize> {
    /// m  places from the grid's lower corner
    fn places(&self) -> &[Vector<D>];
    /// Number by which an error names the one at `p`.
    fn id(&self, p: usize) -> u64;
}

/// A tensor product of open knot vectors, of which the ranks together see the cells of a [`room`] around the points,
/// and this rank those of a box in it.
///
/// Axis 0 is the slowest in every numbering, so that the nodes of a slab of columns are one contiguous block.
/// Node and cell indices are local to the window unless said otherwise.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    axes: [KnotVector; D],
    room: [Range<usize>; D],
    window: [Range<usize>; D],
    beyond: usize, // further layers of nodes in a window
}

/// Extent of the nodal contributions of a column of cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColumnExtent {
    /// Layers of nodes that the column touches.
    pub layers: usize,
    /// Nodes of a layer.
    pub layer_nodes: usize,
    /// Nodes of the grid of this rank.
    pub nodes: usize,
}

impl<const D: usize> Grid<D> {
    /// The whole grid as one window. Fails if the axes differ in order.
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

    /// The same grid, whose windows hold `beyond` layers of nodes past those that their cells touch, as far as there
    /// are any: for what couples the cells of two windows.
    pub fn reaching(self, beyond: usize) -> Self {
        Self { beyond, ..self }
    }

    /// Layers of nodes that a window holds past those that its cells touch.
    pub fn beyond(&self) -> usize {
        self.beyond
    }

    /// The same grid of which only the cells of a box are seen (from and to, along each axis), by all ranks together;
    /// the window is all of it.
    pub fn within(&self, room: [Range<usize>; D]) -> Self {
        debug_assert!((0..D).all(|axis| !room[axis].is_empty() && room[axis].end <= self.axes[axis].cells()));
        Self {
            axes: self.axes.clone(),
            window: room.clone(),
            room,
            beyond: self.beyond,
        }
    }

    /// The same grid seen through the cells `columns` along axis 0.
    pub fn window(&self, columns: Range<usize>) -> Self {
        let mut window = self.room.clone();
        window[0] = columns;
        self.window_of(window)
    }

    /// The same grid seen through the cells of a box.
    pub fn window_of(&self, window: [Range<usize>; D]) -> Self {
        debug_assert!((0..D).all(|axis| {
            let room = &self.room[axis];
            !window[axis].is_empty() && room.start <= window[axis].start && window[axis].end <= room.end
        }));
        Self { window, ..self.clone() }
    }

    /// Knot vectors, one per axis.
    pub fn axes(&self) -> &[KnotVector; D] {
        &self.axes
    }

    /// What all ranks together see: cells along each axis.
    pub fn room(&self) -> &[Range<usize>; D] {
        &self.room
    }

    /// The window: cells along each axis.
    pub fn cells_along(&self) -> &[Range<usize>; D] {
        &self.window
    }

    /// The window: cells along axis 0.
    pub fn columns(&self) -> Range<usize> {
        self.window[0].clone()
    }

    /// Whether windows end along axis 1, too: on one rank they do if they do on any.
    pub fn is_parted(&self) -> bool {
        D > 1 && self.window[1] != self.room[1]
    }

    /// Polynomial order q.
    pub fn order(&self) -> usize {
        self.axes[0].order()
    }

    /// Layers of nodes along axis 0 that the window holds: those that its cells touch, of which the last q are shared
    /// with the next slab, and those beyond.
    pub fn layers(&self) -> Range<usize> {
        let start = self.window[0].start;
        start..start + self.nodes_along(0)
    }

    /// Nodes of the window along an axis.
    #[inline]
    pub fn nodes_along(&self, axis: usize) -> usize {
        let end = (self.window[axis].end + self.beyond).min(self.room[axis].end);
        end - self.window[axis].start + self.order()
    }

    /// Layers of nodes that a column of cells contributes to: those that it touches, and those beyond.
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

    /// Nodes of one layer across axis 0.
    pub fn layer_nodes(&self) -> usize {
        (1..D).map(|axis| self.nodes_along(axis)).product()
    }

    /// Cells of one column across axis 0.
    pub fn column_cells(&self) -> usize {
        self.window[1..].iter().map(Range::len).product()
    }

    /// Nodes in the window.
    pub fn nodes(&self) -> usize {
        self.layers().len() * self.layer_nodes()
    }

    /// Cells in the window.
    pub fn cells(&self) -> usize {
        self.window[0].len() * self.column_cells()
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

    /// Whether a cell (global, along each axis) lies in the window.
    #[inline]
    pub fn holds(&self, cell: &[usize; D]) -> bool {
        (0..D).all(|axis| self.window[axis].contains(&cell[axis]))
    }

    /// Local index of a cell given along each axis, which must lie in the window.
    #[inline]
    pub fn cell_index(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.window[0].start;
        (1..D).fold(start, |index, axis| {
            index * self.window[axis].len() + cell[axis] - self.window[axis].start
        })
    }

    /// Cell along each axis (global) of a local index.
    pub fn cell_at(&self, mut index: usize) -> [usize; D] {
        let mut cell = [0; D];
        for axis in (1..D).rev() {
            cell[axis] = self.window[axis].start + index % self.window[axis].len();
            index /= self.window[axis].len();
        }
        cell[0] = index + self.window[0].start;
        cell
    }

    /// Local index of the first of a cell's (q+1)^D nodes; the others stand at [`Grid::offsets`] from it.
    pub fn first_node(&self, cell: &[usize; D]) -> usize {
        let start = cell[0] - self.window[0].start;
        (1..D).fold(start, |index, axis| {
            index * self.nodes_along(axis) + cell[axis] - self.window[axis].start
        })
    }

    /// Functions (along each axis) of a cell (global), in the order of its nodes, axis 0 slowest.
    pub fn functions_of(&self, cell: [usize; D]) -> impl Iterator<Item = [usize; D]> {
        let width = self.order() + 1;
        (0..self.cell_nodes()).map(move |k| std::array::from_fn(|axis| cell[axis] + digit::<D>(k, axis, width)))
    }

    /// Offsets of a cell's nodes from its first one, axis 0 slowest: the paper's p2N, which is the same for all cells.
    pub fn offsets(&self) -> Vec<usize> {
        self.offsets_of(self.order() + 1)
    }

    /// The same of the functions of degree q - 1, which are numbered within the nodes ([`Shape::lowered`]).
    pub fn lowered_offsets(&self) -> Vec<usize> {
        self.offsets_of(self.order())
    }

    /// Offsets of the first `width` nodes of a cell along each axis.
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

    /// Local nodes whose functions are non-zero on the lower (`false`) or upper (`true`) face of `axis`: there the
    /// open knot vector makes exactly one layer of nodes interpolate.
    pub fn face_nodes(&self, axis: usize, upper: bool) -> Vec<usize> {
        let wanted = if upper { self.axes[axis].functions() - 1 } else { 0 };
        (0..self.nodes())
            .filter(|&node| self.node_at(node)[axis] == wanted)
            .collect()
    }

    /// The nearest node of the window in the same layer across `axis` that is on none of the other axes' faces.
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

    /// Node along each axis (global) of a local index.
    pub fn node_at(&self, mut index: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = self.window[axis].start + index % self.nodes_along(axis);
            index /= self.nodes_along(axis);
        }
        node[0] = index + self.window[0].start;
        node
    }

    /// Local index of a node given along each axis (global); `None` outside the window.
    pub fn node_index(&self, node: &[usize; D]) -> Option<usize> {
        let first = self.node_at(0);
        (0..D).try_fold(0, |index, axis| {
            let along = node[axis]
                .checked_sub(first[axis])
                .filter(|&along| along < self.nodes_along(axis))?;
            Some(index * self.nodes_along(axis) + along)
        })
    }

    /// Local nodes of the window within a box of nodes (global) along the first two axes: as few ranges as there can
    /// be.
    pub fn nodes_within(&self, [layers, rows]: &[Range<usize>; 2]) -> Vec<Range<usize>> {
        let layer = self.layer_nodes();
        let row = self.layer_nodes() / self.nodes_along(1);
        let first = self.window[0].start;
        let start = self.window[1].start;
        if layers.is_empty() || rows.is_empty() {
            return Vec::new();
        }
        // Whole layers are one range.
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

    /// Number of a node (local) among those of the whole grid.
    pub fn number_of(&self, node: usize) -> usize {
        let node = self.node_at(node);
        (1..D).fold(node[0], |number, axis| {
            number * self.axes[axis].functions() + node[axis]
        })
    }

    /// The node of the window that has a number among those of the whole grid; `None` outside the window.
    pub fn node_of_number(&self, number: usize) -> Option<usize> {
        self.node_index(&self.place_of_number(number))
    }

    /// Node along each axis (global) by its number among those of the whole grid.
    pub fn place_of_number(&self, mut number: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = number % self.axes[axis].functions();
            number /= self.axes[axis].functions();
        }
        node[0] = number;
        node
    }

    /// Lower corner and edge lengths of a cell, m.
    pub fn cell_box(&self, cell: &[usize; D]) -> (Vector<D>, Vector<D>) {
        let lower = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis]));
        let size = Vector::from_fn(|axis, _| self.axes[axis].breakpoint(cell[axis] + 1) - lower[axis]);
        (lower, size)
    }

    /// Volume of a cell.
    pub fn cell_volume<K: Kinematics<D>>(&self, cell: &[usize; D]) -> f64 {
        let (lower, size) = self.cell_box(cell);
        size.product() * K::weight(&(lower + size * 0.5))
    }

    /// Integral over the grid of the function of degree q - 1 that has a node's number ([`Shape::lowered`]): its weight
    /// is linear, so that the function's mean place decides.
    pub fn lowered_volume<K: Kinematics<D>>(&self, node: usize) -> f64 {
        let node = self.node_at(node);
        let along: [(f64, f64); D] = std::array::from_fn(|axis| self.axes[axis].lowered_integral(node[axis]));
        along.iter().map(|(length, _)| length).product::<f64>() * K::weight(&Vector::from_fn(|axis, _| along[axis].1))
    }

    /// Smallest edge of any cell, m.
    pub fn smallest_edge(&self) -> f64 {
        self.axes
            .iter()
            .map(KnotVector::smallest_cell)
            .fold(f64::INFINITY, f64::min)
    }
}

/// Digit of `number` in the system of the `base`, of which axis 0 is the slowest.
#[inline]
pub(crate) fn digit<const D: usize>(number: usize, axis: usize, base: usize) -> usize {
    number / base.pow((D - 1 - axis) as u32) % base
}
