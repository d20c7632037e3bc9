//! Splines for the average of `subgrid-f-bar`, theory-manual equation (T3.4), one degree below those of the grid. They
//! are defined on pairs of cells inside a body, and on single cells at its edges.

use super::{Patch, Shape};
use crate::grid::paired::CellPairs;
use crate::grid::{Contributions, Grid, digit};
use crate::parallel::Halo;
use crate::stabilisation::GroupedPoints;

/// What the functions of every patch are merged to; numbers of the functions on pairs stand beside those of the nodes.
#[derive(Clone, Debug)]
pub struct MergedFunctions<const D: usize> {
    axes: [CellPairs; D],
    functions: usize, // of a cell, n
    groups: usize,
    offsets: Vec<usize>, // per patch: where its n functions on pairs are kept, from the patch's first node
    shares: Vec<f64>,    // per patch: r, n x n, a row for every function on pairs
    inside: Vec<bool>,   // per patch, group and function on pairs: whether it takes part
}

impl<const D: usize> Shape<D> {
    /// The same lowered functions, those inside a body merged to the ones of pairs of cells.
    pub(crate) fn merged(mut self, grid: &Grid<D>, grouped: GroupedPoints<'_>, halo: &dyn Halo) -> Self {
        self.merged = Some(MergedFunctions::of(grid, &self, grouped, halo));
        self
    }

    /// What lowered functions are merged to, if they are.
    pub(crate) fn merger(&self) -> Option<&MergedFunctions<D>> {
        self.merged.as_ref()
    }

    /// Numbers that sums have per node and group: one, and one of the function on pairs that is kept there.
    pub(crate) fn levels(&self) -> usize {
        1 + usize::from(self.merged.is_some())
    }
}

impl<const D: usize> MergedFunctions<D> {
    /// Of the splines `lower` of degree q - 1 in a grid that reaches 2q - 1 layers; two exchanges with the neighbours.
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

    /// Which functions on pairs have all cells of their support inside the body of the group.
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

    /// Where the functions on pairs that a patch sees are kept, from its first node.
    pub(crate) fn offsets(&self, patch: usize) -> &[usize] {
        &self.offsets[patch * self.functions..(patch + 1) * self.functions]
    }

    /// r of the functions k on pairs that a patch sees and that take part, with k, and those on cells.
    pub(crate) fn rows(&self, patch: usize, group: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let n = self.functions;
        let inside = &self.inside[(patch * self.groups + group) * n..][..n];
        let rows = self.shares[patch * n * n..(patch + 1) * n * n].chunks_exact(n);
        rows.enumerate()
            .zip(inside)
            .filter(|(_, inside)| **inside)
            .map(|(row, _)| row)
    }

    /// rho of function `h` on the cells: what functions on pairs that do not take part would have of it.
    pub(crate) fn rest(&self, patch: usize, group: usize, h: usize) -> f64 {
        let n = self.functions;
        let inside = &self.inside[(patch * self.groups + group) * n..][..n];
        (0..n)
            .filter(|&k| !inside[k])
            .map(|k| self.shares[(patch * n + k) * n + h])
            .sum()
    }

    /// First cell along an axis of the function on pairs that is kept under the number of a node, if there is one.
    pub(crate) fn first_cell(&self, axis: usize, slot: usize) -> Option<usize> {
        self.axes[axis]
            .at_slot(slot)
            .map(|function| self.axes[axis].support(function).start)
    }

    /// Numbers of a patch's functions on the cells, as those of all functions that are merged: of cells, and of pairs.
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

    /// The transpose of [`MergedFunctions::spread`]: values of the functions on the cells that make up all.
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

/// Whether a patch holds points of the group.
fn holds(patch: &Patch, grouped: GroupedPoints<'_>, group: usize) -> bool {
    patch.points.clone().any(|p| grouped.of(p) == group)
}

/// Per patch and group: whether all cells about it hold points of the group, too. What lies behind a face of the grid
/// or a repeated breakpoint does not count: an edge that lies there cuts no cell.
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
                // The count of cell m is kept at node m + 1, that no column's reaches below itself.
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

/// Whether the neighbour `k` of a cell, of 3^D with itself, is a cell that has a length.
fn neighbour<const D: usize>(grid: &Grid<D>, cell: &[usize; D], k: usize) -> bool {
    (0..D).all(|axis| {
        let along = (cell[axis] + k / 3_usize.pow(axis as u32) % 3).checked_sub(1);
        along.is_some_and(|along| along < grid.axes()[axis].cells() && grid.axes()[axis].has_length(along))
    })
}

/// Distance in the numbering of local nodes of so many nodes along each axis.
fn offset<const D: usize>(grid: &Grid<D>, along: impl Fn(usize) -> usize) -> usize {
    (1..D).fold(along(0), |offset, axis| offset * grid.nodes_along(axis) + along(axis))
}
