//! Splines for the average of `subgrid-f-bar`, theory-manual equation (T3.4), one degree below those of the grid. They
//! are defined on pairs of cells inside a body, and on single cells at its edges.

use super::{Patch, Shape};
use crate::grid::paired::CellPairs;
use crate::grid::{Contributions, Grid, digit};
use crate::parallel::Halo;
use crate::stabilisation::GroupedPoints;

/// Merged functions of every patch: functions on pairs, where these are inside a body, and functions on cells. Nodal
/// arrays have two numbers per node and group: first that of the function on cells, then that of the function on pairs.
#[derive(Clone, Debug)]
pub struct MergedFunctions<const D: usize> {
    axes: [CellPairs; D],
    functions: usize, // n: functions of a cell
    groups: usize,
    offsets: Vec<usize>, // per patch: nodes that store its n functions on pairs, from the patch's first node
    shares: Vec<f64>,    // per patch: r, n x n, a row for every function on pairs
    inside: Vec<bool>,   // per patch, group and function on pairs: whether it is used
}

impl<const D: usize> Shape<D> {
    /// Returns the same lowered functions, with those inside a body merged to functions on pairs of cells. Two
    /// exchanges with the neighbours.
    pub(crate) fn merged(mut self, grid: &Grid<D>, grouped: GroupedPoints<'_>, halo: &dyn Halo) -> Self {
        self.merged = Some(MergedFunctions::of(grid, &self, grouped, halo));
        self
    }

    /// Returns the merged functions, if lowered functions are merged.
    pub(crate) fn merger(&self) -> Option<&MergedFunctions<D>> {
        self.merged.as_ref()
    }

    /// Returns the count of numbers per node and group in sums: two if functions are merged, else one.
    pub(crate) fn levels(&self) -> usize {
        1 + usize::from(self.merged.is_some())
    }
}

impl<const D: usize> MergedFunctions<D> {
    /// Merges the splines `lower` of degree q - 1. The grid must have at least 2q - 1 additional layers. Two exchanges
    /// with the neighbours.
    pub(crate) fn of(grid: &Grid<D>, lower: &Shape<D>, grouped: GroupedPoints<'_>, halo: &dyn Halo) -> Self {
        debug_assert!(
            grid.beyond() + 1 >= 2 * grid.order(),
            "functions on pairs are kept beyond their cells"
        );
        let axes = grid.axes().each_ref().map(CellPairs::of);
        let width = lower.width();
        let n = lower.offsets().len();
        let groups = grouped.count();
        let mut offsets = Vec::new();
        let mut shares = Vec::new();
        for patch in lower.patches() {
            let cell = grid.cell_at(patch.cell);
            offsets.extend((0..n).map(|k| {
                offset(grid, |axis| {
                    let paired: &CellPairs = &axes[axis];
                    paired.slot(paired.function(cell[axis], digit::<D>(k, axis, width))) - cell[axis]
                })
            }));
            for (k, h) in (0..n).flat_map(|k| (0..n).map(move |h| (k, h))) {
                let along = (0..D).map(|axis| {
                    // Splines are products over the axes, and so is r.
                    let pair = digit::<D>(k, axis, width);
                    axes[axis].share(cell[axis], pair, digit::<D>(h, axis, width))
                });
                shares.push(along.product::<f64>());
            }
        }
        let mut merged = Self {
            axes,
            functions: n,
            groups,
            offsets,
            shares,
            inside: Vec::new(),
        };
        merged.inside = merged.inside(grid, lower, grouped, halo);
        merged
    }

    /// Returns per patch, group and function on pairs whether all cells of its support are inside the group's body. One
    /// exchange.
    fn inside(&self, grid: &Grid<D>, lower: &Shape<D>, grouped: GroupedPoints<'_>, halo: &dyn Halo) -> Vec<bool> {
        let deep = inner_cells(grid, lower, grouped, halo);
        let columns = lower.columns().iter().map(|column| column.column).collect();
        let mut counts = Contributions::none(grid, self.groups, columns);
        for (number, patch) in lower.patches().iter().enumerate() {
            let sums = counts.patch(patch.first_node);
            for group in (0..self.groups).filter(|group| deep[number * self.groups + group]) {
                self.offsets(number)
                    .iter()
                    .for_each(|offset| sums[offset * self.groups + group] += 1.0);
            }
        }
        let counts = halo.assemble_ghosts(&counts);
        let mut inside = Vec::with_capacity(self.offsets.len() * self.groups);
        for (number, patch) in lower.patches().iter().enumerate() {
            for group in 0..self.groups {
                for offset in self.offsets(number) {
                    let node = patch.first_node + offset;
                    let at = grid.node_at(node);
                    let cells = self
                        .axes
                        .iter()
                        .zip(at)
                        .map(|(axis, at)| axis.at_slot(at).map_or(0, |k| axis.cells_of(k)));
                    inside.push(counts[node * self.groups + group] == cells.product::<usize>() as f64);
                }
            }
        }
        inside
    }

    /// Returns the nodes that store a patch's functions on pairs, as offsets from the patch's first node.
    pub(crate) fn offsets(&self, patch: usize) -> &[usize] {
        &self.offsets[patch * self.functions..(patch + 1) * self.functions]
    }

    /// Iterates over the used functions k on pairs of a patch, each with its row of r over the functions on cells.
    pub(crate) fn rows(&self, patch: usize, group: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let n = self.functions;
        let inside = &self.inside[(patch * self.groups + group) * n..][..n];
        let rows = self.shares[patch * n * n..(patch + 1) * n * n].chunks_exact(n);
        rows.enumerate()
            .zip(inside)
            .filter(|(_, inside)| **inside)
            .map(|(row, _)| row)
    }

    /// Returns rho of function `h` on cells: the sum of r over the functions on pairs that are not used.
    pub(crate) fn rest(&self, patch: usize, group: usize, h: usize) -> f64 {
        let n = self.functions;
        let inside = &self.inside[(patch * self.groups + group) * n..][..n];
        (0..n)
            .filter(|&k| !inside[k])
            .map(|k| self.shares[(patch * n + k) * n + h])
            .sum()
    }

    /// Returns the first cell along an axis of the function on pairs that is stored under the number of a node, if
    /// there is one.
    pub(crate) fn first_cell(&self, axis: usize, slot: usize) -> Option<usize> {
        self.axes[axis]
            .at_slot(slot)
            .map(|function| self.axes[axis].support(function).start)
    }

    /// Distributes numbers of a patch's functions on cells to the merged functions: those on cells (times rho) and
    /// those on pairs (times r).
    pub(crate) fn spread<const C: usize, const N: usize>(
        &self,
        patch: usize,
        group: usize,
        block: &[[f64; C]; N],
    ) -> [[[f64; C]; N]; 2] {
        let mut cells = *block;
        let mut pairs = [[0.0; C]; N];
        for (h, numbers) in cells[..self.functions].iter_mut().enumerate() {
            let rest = self.rest(patch, group, h);
            numbers.iter_mut().for_each(|number| *number *= rest);
        }
        for (k, row) in self.rows(patch, group) {
            for (share, numbers) in row.iter().zip(block) {
                (0..C).for_each(|c| pairs[k][c] += share * numbers[c]);
            }
        }
        [cells, pairs]
    }

    /// Combines values of the merged functions to values of a patch's functions on cells: the transpose of
    /// [`MergedFunctions::spread`].
    pub(crate) fn combine<const C: usize, const N: usize>(
        &self,
        patch: usize,
        group: usize,
        [mut cells, pairs]: [[[f64; C]; N]; 2],
    ) -> [[f64; C]; N] {
        for (h, numbers) in cells[..self.functions].iter_mut().enumerate() {
            let rest = self.rest(patch, group, h);
            numbers.iter_mut().for_each(|number| *number *= rest);
        }
        for (k, row) in self.rows(patch, group) {
            for (share, numbers) in row.iter().zip(&mut cells) {
                (0..C).for_each(|c| numbers[c] += share * pairs[k][c]);
            }
        }
        cells
    }
}

/// Returns whether a patch contains points of the group.
fn holds(patch: &Patch, grouped: GroupedPoints<'_>, group: usize) -> bool {
    patch.points.clone().any(|p| grouped.of(p) == group)
}

/// Returns per patch and group whether the cell and all its neighbours contain points of the group. Cells behind a face
/// of the grid or a repeated breakpoint do not count, because a body's edge that lies there cuts no cell. One exchange.
fn inner_cells<const D: usize>(
    grid: &Grid<D>,
    lower: &Shape<D>,
    grouped: GroupedPoints<'_>,
    halo: &dyn Halo,
) -> Vec<bool> {
    let groups = grouped.count();
    let columns = lower.columns().iter().map(|column| column.column).collect();
    let mut around = Contributions::none(grid, groups, columns);
    for patch in lower.patches() {
        let cell = grid.cell_at(patch.cell);
        let sums = around.patch(patch.first_node);
        for group in (0..groups).filter(|&group| holds(patch, grouped, group)) {
            for k in (0..3_usize.pow(D as u32)).filter(|&k| neighbour(grid, &cell, k)) {
                // The count of cell m is stored at node m + 1, because a column contributes only to layers from its own
                // index on.
                let offset = offset(grid, |axis| k / 3_usize.pow(axis as u32) % 3);
                sums[offset * groups + group] += 1.0;
            }
        }
    }
    let around = halo.assemble_ghosts(&around);
    let own = offset(grid, |_| 1);
    let mut inner = Vec::with_capacity(lower.patches().len() * groups);
    for patch in lower.patches() {
        let cell = grid.cell_at(patch.cell);
        let all = (0..3_usize.pow(D as u32))
            .filter(|&k| neighbour(grid, &cell, k))
            .count() as f64;
        let counts = &around[(patch.first_node + own) * groups..][..groups];
        inner.extend((0..groups).map(|group| counts[group] == all && holds(patch, grouped, group)));
    }
    inner
}

/// Returns whether cell `k` of the 3^D cells around and including `cell` exists and has a length.
fn neighbour<const D: usize>(grid: &Grid<D>, cell: &[usize; D], k: usize) -> bool {
    (0..D).all(|axis| {
        let along = (cell[axis] + k / 3_usize.pow(axis as u32) % 3).checked_sub(1);
        along.is_some_and(|along| along < grid.axes()[axis].cells() && grid.axes()[axis].has_length(along))
    })
}

/// Returns the offset in the local numbering for a shift by `along` nodes along each axis.
fn offset<const D: usize>(grid: &Grid<D>, along: impl Fn(usize) -> usize) -> usize {
    (1..D).fold(along(0), |offset, axis| offset * grid.nodes_along(axis) + along(axis))
}
