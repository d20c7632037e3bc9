//! Sizes of a case before anything is allocated.

use crate::case::Case;
use crate::grid::GridSpec;

/// Largest number of cells, unknowns and matrix rows: PETSc's and MPI's counts are 32-bit here.
pub(crate) const MOST_UNKNOWNS: u128 = i32::MAX as u128;
/// Largest number of points: they are sorted by 32-bit numbers.
pub(crate) const MOST_POINTS: u128 = u32::MAX as u128;

/// Bytes of a point: its state (about 310), shape functions (up to 130), trial state and responses (about 360), and its
/// copies while a frame is gathered (about 500).
const POINT: u128 = 1300;
/// Bytes of a node without its stencil: some vectors of two doubles, and those of the secants.
const NODE: u128 = 1200;
/// Bytes of a process before it has a point: libraries of MPI and PETSc. Measured, about.
const PROCESS: u64 = 45 << 20;
/// Bytes of an entry of the stiffness: value, column, and the place it is summed at.
const ENTRY: u128 = 20;

/// Sizes that follow from a case. Empty cells cost memory, too: every node of the grid has its vectors and its stencil.
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
    /// Memory for points, nodes, stiffness and its factor, bytes.
    pub bytes: u64,
}

impl Estimate {
    /// Memory of all processes of a run on so many ranks, bytes. Measured peaks, for comparison: the paper's collapse on
    /// 2 ranks 287e6, the short collapse on 1 rank 51e6.
    pub fn bytes_on(&self, ranks: usize) -> u64 {
        self.bytes.saturating_add((ranks as u64).saturating_mul(PROCESS))
    }
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
        let stencil = (2 * self.grid.order as u128 + 1).pow(2) * 34 + 24;
        let bytes = points * POINT + nodes * (NODE + stencil) + entries * ENTRY + factor;
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
