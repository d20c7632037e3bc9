//! Sizes of a case before anything is allocated.

use crate::case::Case;
use crate::grid::GridSpec;

/// Largest number of cells, unknowns and matrix rows: PETSc's and MPI's counts are 32-bit here.
pub(crate) const MOST_UNKNOWNS: u128 = i32::MAX as u128;
/// Largest number of points: they are sorted by 32-bit numbers.
pub(crate) const MOST_POINTS: u128 = u32::MAX as u128;

/// Bytes of a point, assumed: its state (about 270), its trial state and its shape functions.
const POINT: u128 = 800;
/// Bytes of a node, assumed: about a dozen vectors of two doubles.
const NODE: u128 = 200;
/// Bytes of an entry of the stiffness: value, column, and the place it is summed at.
const ENTRY: u128 = 20;

/// Sizes that follow from a case; those of the grid are upper bounds, since empty cells cost next to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Cells of the grid.
    pub cells: u64,
    /// Nodes of the grid: functions of the tensor product.
    pub nodes: u64,
    /// Nodal components, supported ones included.
    pub unknowns: u64,
    /// Material points.
    pub points: u64,
    /// Memory of all ranks together, bytes: points, nodes, stiffness and its factor. A rough figure from
    /// assumed sizes, not yet compared with a run.
    pub bytes: u64,
}

impl Case {
    /// Sizes of the case.
    pub fn estimate(&self) -> Estimate {
        let nodes = nodes(&self.grid);
        let points = u128::from(self.points());
        let support = 2 * (2 * self.grid.order as u128 + 1).pow(2);
        let occupied = occupied_nodes(self).min(nodes);
        let entries = 2 * occupied * support;
        // Nested dissection in two dimensions: entries of the factor grow as n log n; the 5 is an assumption.
        let levels = u128::from((2 * occupied).max(2).ilog2());
        let factor = if self.solver.linear.factor.is_some() { 2 * occupied * 8 * 5 * levels } else { entries * 12 };
        let bytes = points * POINT + nodes * NODE + entries * ENTRY + factor;
        let bounded = |number: u128| u64::try_from(number).unwrap_or(u64::MAX);
        Estimate {
            cells: bounded(cells(&self.grid)),
            nodes: bounded(nodes),
            unknowns: bounded(2 * nodes),
            points: bounded(points),
            bytes: bounded(bytes),
        }
    }
}

/// Cells of the grid.
pub(crate) fn cells(grid: &GridSpec) -> u128 {
    grid.axes.iter().map(|axis| axis.cells() as u128).product()
}

/// Nodes of the grid.
pub(crate) fn nodes(grid: &GridSpec) -> u128 {
    grid.axes.iter().map(|axis| (axis.cells() + grid.order) as u128).product()
}

/// Nodes that the bodies' cells touch at the start.
fn occupied_nodes(case: &Case) -> u128 {
    let of_body = |body: &crate::case::Body| -> u128 {
        body.extents(&case.grid).iter().map(|extent| (extent.cells.len() + case.grid.order) as u128).product()
    };
    case.bodies.iter().map(of_body).sum()
}
