//! Sizes of a case before anything is allocated.
//!
//! The bytes are counted from what the program holds and rounded to what runs took; `tests/shipped.rs` compares.

use bsmpm::stabilisation::Stabilisation;

use crate::case::Case;
use crate::grid::GridSpec;

/// Largest number of cells, unknowns and matrix rows: PETSc's and MPI's counts are 32-bit here.
pub(crate) const MOST_UNKNOWNS: u128 = i32::MAX as u128;
/// Largest number of points: they are sorted by 32-bit numbers.
pub(crate) const MOST_POINTS: u128 = u32::MAX as u128;

/// Bytes of a point: its state (about 270), shape functions (96), two trial states (160), response and buffers of its
/// migration. Measured: 820, from 28,800 and 115,200 points in the same cells.
const POINT: u128 = 820;
/// Bytes of a point's functions of the degree below, which `consistent-f-bar` averages with.
const LOWERED: u128 = 64;
/// Bytes of a node's vectors: about a dozen, and twenty secants of three, all of two doubles.
const VECTORS: u128 = (12 + 20 * 3) * 16;
/// Bytes of an entry of the stiffness while the system is built: value, row and column, its place in the matrix, and
/// what the factorisation copies. An assumption that fits the measured sums.
const ENTRY: u128 = 36;
/// The part of [`ENTRY`] that every rank has for itself where all factorise the whole system: matrix and copy of it.
const REPEATED: u128 = 20;
/// Bytes of the factor per unknown and level of a nested dissection: 10 doubles, and as many of workspace. Measured: 18
/// to 24 doubles on 3,444 and 13,284 nodes of quadratic functions.
const LEVEL: u128 = 20 * 8;
/// Bytes of a process that has next to nothing to solve: libraries and buffers of MPI and PETSc. Measured: 47.8e6.
const PROCESS: u64 = 48_000_000;

/// Unknowns of a rank below which it mostly waits for others, in two dimensions.
const FEWEST: u128 = 1000;

/// Sizes that follow from a case; unknowns are bounded from above, since empty cells have none. Empty cells do cost
/// memory: vectors and the stencils of the stiffness are held for every node of the grid.
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
    /// Ranks that have something to do: at least a thousand unknowns each, and a column of cells.
    pub useful_ranks: u64,
    /// Memory of the case, bytes, however many ranks share it: points, nodes, stiffness and its factor, where the bodies
    /// are at the start. Not what each rank adds, see [`Estimate::bytes_on`].
    pub bytes: u64,
    /// Bytes of this that every further rank holds again: the system, where each factorises the whole.
    pub repeated: u64,
}

impl Estimate {
    /// Memory of all of `ranks` ranks together, bytes, their libraries included. Within .85 to 1.1 of the peaks that
    /// were measured on one and two ranks; bodies that spread take more.
    pub fn bytes_on(&self, ranks: usize) -> u64 {
        let ranks = ranks as u64;
        let further = self.repeated.saturating_mul(ranks.saturating_sub(1));
        self.bytes.saturating_add(PROCESS.saturating_mul(ranks)).saturating_add(further)
    }
}

impl Case {
    /// Sizes of the case.
    pub fn estimate(&self) -> Estimate {
        let nodes = nodes(&self.grid);
        let places = (2 * self.grid.order as u128 + 1).pow(2);
        // The stencil of the stiffness: per place 2 x 2 doubles and an index of two bytes, and the list's head.
        let stencil = places * (4 * 8 + 2) + 24;
        let occupied = occupied_nodes(self).min(nodes);
        let entries = 2 * occupied * 2 * places;
        let levels = u128::from((2 * occupied).max(2).ilog2());
        let direct = self.solver.linear.factor.is_some();
        let factor = if direct { 2 * occupied * levels * LEVEL } else { entries * 12 };
        let lowered = if self.stabilisation == Stabilisation::ConsistentFBar { LOWERED } else { 0 };
        let bytes =
            u128::from(self.points()) * (POINT + lowered) + nodes * (stencil + VECTORS) + entries * ENTRY + factor;
        let repeated = if direct && self.solver.reproducible { factor + entries * REPEATED } else { 0 };
        let bounded = |number: u128| u64::try_from(number).unwrap_or(u64::MAX);
        Estimate {
            cells: bounded(cells(&self.grid)),
            nodes: bounded(nodes),
            unknowns: bounded(2 * nodes),
            points: self.points(),
            useful_ranks: bounded((2 * occupied / FEWEST).clamp(1, self.grid.axes[0].cells() as u128)),
            bytes: bounded(bytes),
            repeated: bounded(repeated),
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

/// Nodes that the bodies' cells touch at the start: exact for boxes, and for shapes without holes or bays.
fn occupied_nodes(case: &Case) -> u128 {
    let order = case.grid.order as u128;
    let of_body = |body: &crate::case::Body| -> u128 {
        let [columns, rows] = body.occupied(&case.grid).map(|cells| cells.len() as u128);
        body.cells(&case.grid) + order * (columns + rows + order)
    };
    case.bodies.iter().map(of_body).sum()
}
