//! Cells that contain material points, including those of neighbouring ranks.

use super::Grid;
use crate::parallel::Halo;

/// Cells along each axis of the neighbourhood that makes a cell interior: itself and one on either side.
const SIDE: usize = 3;

/// Which cells hold points, those beside this rank's columns included.
pub(crate) struct OccupiedCells<'a, const D: usize> {
    grid: &'a Grid<D>,
    width: [usize; 2],
    marks: Vec<f64>, // per node: whether the cell (k, l) before that of its number holds points, k and l from 0 to q
}

impl<'a, const D: usize> OccupiedCells<'a, D> {
    /// Of this rank's `cells`, by their index in the window; one exchange with the neighbours.
    ///
    /// Neighbouring slabs share layers of nodes, not of cells: a cell is noted at the node of its own number, which the
    /// rank before sees, and at the q next ones, which the rank behind sees; along axis 1, too, where slabs are cut.
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

    /// Whether all neighbours hold points, those that the grid does not have at its faces counted as ones that do where
    /// these are `closed` (per axis the lower and the upper one).
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

    /// The cell before (0), itself (1) or the one after (2) along an axis, of those that have a length; up to q away,
    /// as the copies of a breakpoint are q at most.
    fn beside(&self, axis: usize, cell: usize, side: usize) -> Option<usize> {
        let axis = &self.grid.axes()[axis];
        match side {
            0 => (0..cell).rev().find(|&at| axis.has_length(at)),
            1 => Some(cell),
            _ => (cell + 1..axis.cells()).find(|&at| axis.has_length(at)),
        }
    }
}
