//! Cells that contain material points, including those of neighbouring ranks.

use super::Grid;
use crate::parallel::Halo;

/// Number of cells along each axis in the neighbourhood of a cell: the cell and one on either side.
const SIDE: usize = 3;

/// Which cells contain material points, including cells of neighbouring ranks next to this rank's window.
pub(crate) struct OccupiedCells<'a, const D: usize> {
    grid: &'a Grid<D>,
    width: [usize; 2],
    marks: Vec<f64>, // per node i and (k, l), 0 to q: whether cell i - (k, l) is occupied
}

impl<'a, const D: usize> OccupiedCells<'a, D> {
    /// Marks this rank's occupied `cells`, given by their local index. One exchange with the neighbours.
    ///
    /// Neighbouring ranks share layers of nodes, not of cells. A cell is therefore marked at the node of its own
    /// number, which the rank before stores, and at the next q nodes, which the rank after stores. The same applies
    /// along axis 1 if slabs are divided.
    pub(crate) fn of(grid: &'a Grid<D>, cells: impl Iterator<Item = usize>, halo: &dyn Halo) -> Self {
        let width = [grid.order() + 1, if grid.is_parted() { grid.order() + 1 } else { 1 }];
        let marks = width[0] * width[1];
        let mut occupied = Self {
            grid,
            width,
            marks: vec![0.0; marks * grid.nodes()],
        };
        for index in cells {
            let cell = grid.cell_at(index);
            for mark in 0..marks {
                let place = occupied.place(&cell, [mark / width[1], mark % width[1]]);
                occupied.marks[place] = 1.0;
            }
        }
        halo.ghost_max(&mut occupied.marks, marks);
        occupied
    }

    fn place(&self, cell: &[usize; D], behind: [usize; 2]) -> usize {
        let mut node = *cell;
        node.iter_mut().zip(behind).for_each(|(node, behind)| *node += behind);
        (self.width[0] * self.grid.first_node(&node) + behind[0]) * self.width[1] + behind[1]
    }

    fn has(&self, cell: &[usize; D]) -> bool {
        let cells = self.grid.cells_along();
        let behind: [usize; D] = std::array::from_fn(|axis| cells[axis].start.saturating_sub(cell[axis]));
        let along = if self.grid.is_parted() { behind[1] } else { 0 };
        self.marks[self.place(cell, [behind[0], along])] > 0.0
    }

    /// Returns whether all neighbours of a cell contain points. Missing neighbours at a face of the grid count as
    /// occupied if `closed` (lower and upper face per axis) says so.
    pub(crate) fn surround(&self, cell: &[usize; D], closed: &[[bool; 2]; D]) -> bool {
        (0..SIDE.pow(D as u32)).all(|k| {
            let mut neighbour = *cell;
            for (axis, at) in neighbour.iter_mut().enumerate() {
                let side = k / SIDE.pow(axis as u32) % SIDE;
                match self.beside(axis, *at, side) {
                    Some(inside) => *at = inside,
                    None => return closed[axis][usize::from(side > 1)],
                }
            }
            self.has(&neighbour)
        })
    }

    /// Returns the previous cell (0), the cell itself (1) or the next one (2) along an axis, skipping cells of zero
    /// length. It is at most q away, because a breakpoint has at most q copies.
    fn beside(&self, axis: usize, cell: usize, side: usize) -> Option<usize> {
        let axis = &self.grid.axes()[axis];
        match side {
            0 => (0..cell).rev().find(|&at| axis.has_length(at)),
            1 => Some(cell),
            _ => (cell + 1..axis.cells()).find(|&at| axis.has_length(at)),
        }
    }
}
