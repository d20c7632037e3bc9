//! Shape functions and cells of all material points at the start of a step, stored per axis to save memory.

pub mod merged;
mod support;

use super::{Grid, PointPositions};
use crate::error::StepError;
use crate::grid::ColumnExtent;
use crate::tensor::Vector;
use crate::threads;
use merged::MergedFunctions;
use std::ops::Range;
use std::sync::Mutex;
pub(crate) use support::{PointSupport, Values};

/// Occupied cell with its material points: the patch of section 2.1 of the paper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Local index of the cell.
    pub cell: usize,
    /// Local index of the cell's first node.
    pub first_node: usize,
    /// Points in the cell.
    pub points: Range<usize>,
}

/// Occupied column of cells with its patches. One thread works on one column, and each column has its own sum of every
/// node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PatchColumn {
    /// Index of the column in the window.
    pub column: usize,
    /// Patches of the column.
    pub patches: Range<usize>,
    /// Points of the column.
    pub points: Range<usize>,
}

/// Shape functions of all material points at the start of a step.
#[derive(Clone, Debug)]
pub struct Shape<const D: usize> {
    width: usize,
    offsets: Vec<usize>,
    patches: Vec<Patch>,
    columns: Vec<PatchColumn>,
    extent: ColumnExtent,
    rows: Vec<f64>, // per point and axis: q + 1 values, q + 1 derivatives (1/m, optional if lowered); padding
    stride: usize,  // numbers of a row
    pub(super) merged: Option<MergedFunctions<D>>, // splines on pairs of cells, of lowered functions only
}

/// Zeros after the last row: four numbers are read at once from any position.
const BEHIND: usize = 3;

/// Runs `$body` with the constant `W` = q + 1, so the compiler unrolls the loops over a patch's nodes. With `lowered`,
/// W may be 1: functions that are constant in a cell.
macro_rules! with_width {
    (lowered $width:expr, $W:ident => $body:expr) => {
        match $width {
            1 => {
                const $W: usize = 1;
                $body
            }
            width => with_width!(width, $W => $body),
        }
    };
    ($width:expr, $W:ident => $body:expr) => {
        match $width {
            2 => {
                const $W: usize = 2;
                $body
            }
            3 => {
                const $W: usize = 3;
                $body
            }
            4 => {
                const $W: usize = 4;
                $body
            }
            width => unreachable!("{width} functions per axis"),
        }
    };
}
pub(crate) use with_width;

impl<const D: usize> Shape<D> {
    /// Evaluates the shape functions at all points, which must be sorted by cell. Fails if a point is outside the
    /// window.
    pub fn at(grid: &Grid<D>, points: &impl PointPositions<D>) -> Result<Self, StepError> {
        let width = grid.order() + 1;
        let mut shape = Self {
            width,
            offsets: grid.offsets(),
            patches: Vec::new(),
            columns: Vec::new(),
            extent: grid.column_extent(),
            rows: vec![0.0; points.places().len() * 2 * D * width + BEHIND],
            stride: 2 * width,
            merged: None,
        };
        with_width!(width, W => shape.evaluate::<W>(grid, points))?;
        shape.columns = columns(&shape.patches, grid.column_cells());
        Ok(shape)
    }

    fn evaluate<const W: usize>(&mut self, grid: &Grid<D>, points: &impl PointPositions<D>) -> Result<(), StepError> {
        let x = points.places();
        let cells = threads::each(x.len(), |p| grid.locate(&x[p]).filter(|cell| grid.holds(cell)));
        for (p, located) in cells.iter().enumerate() {
            let Some(located) = located else {
                return Err(StepError::Outside {
                    id: points.id(p),
                    x: x[p].as_slice().to_vec(),
                });
            };
            let cell = grid.cell_index(located);
            match self.patches.last_mut() {
                Some(patch) if patch.cell == cell => patch.points.end = p + 1,
                _ => self.patches.push(Patch {
                    cell,
                    first_node: grid.first_node(located),
                    points: p..p + 1,
                }),
            }
        }
        debug_assert!(
            self.patches.is_sorted_by(|a, b| a.cell < b.cell),
            "points must be sorted by cell"
        );
        threads::change(&mut self.rows[..x.len() * 2 * D * W], 2 * D * W, |p, row| {
            let Some(cell) = &cells[p] else { return };
            for (axis, row) in row.chunks_exact_mut(2 * W).enumerate() {
                let (N, dN) = grid.axes()[axis].basis::<W>(x[p][axis], cell[axis]);
                row[..W].copy_from_slice(&N);
                row[W..].copy_from_slice(&dN);
            }
        });
        Ok(())
    }

    /// Returns the values of the splines of degree q - 1 on the same cells, at the same points.
    ///
    /// Function `a` of cell `c` has the number `c + a` for either degree. The lower splines are therefore numbered as
    /// the first q + (cells - 1) nodes along an axis, and nodal arrays and their exchange serve both degrees.
    pub fn lowered(&self, grid: &Grid<D>, points: &impl PointPositions<D>) -> Self {
        self.lower(grid, points, false)
    }

    /// Returns the values and derivatives of the splines of degree q - 1 ([`Shape::lowered`]).
    pub fn lowered_with_derivatives(&self, grid: &Grid<D>, points: &impl PointPositions<D>) -> Self {
        self.lower(grid, points, true)
    }

    fn lower(&self, grid: &Grid<D>, points: &impl PointPositions<D>, derivatives: bool) -> Self {
        let width = self.width - 1;
        let stride = if derivatives { 2 * width } else { width };
        let mut lower = Self {
            width,
            offsets: (0..self.offsets.len())
                .filter(|k| (0..D).all(|axis| k / self.width.pow(axis as u32) % self.width < width))
                .map(|k| self.offsets[k])
                .collect(),
            patches: self.patches.clone(),
            columns: self.columns.clone(),
            extent: self.extent,
            rows: vec![0.0; points.places().len() * D * stride + BEHIND],
            stride,
            merged: None,
        };
        with_width!(lowered width, W => lower.evaluate_lower::<W>(grid, points));
        lower
    }

    fn evaluate_lower<const W: usize>(&mut self, grid: &Grid<D>, points: &impl PointPositions<D>) {
        let x = points.places();
        let stride = self.stride;
        let patches = &self.patches;
        let mut rest = &mut self.rows[..];
        let mut rows = Vec::with_capacity(self.columns.len());
        for column in &self.columns {
            let (of_column, others) = std::mem::take(&mut rest).split_at_mut(column.points.len() * D * stride);
            rest = others;
            rows.push(Mutex::new(of_column));
        }
        threads::share(rows.len(), &|index| {
            let of_column = &mut **rows[index].lock().expect("the column's only thread");
            let mut rows = of_column.chunks_exact_mut(stride);
            for patch in &patches[self.columns[index].patches.clone()] {
                let cell = grid.cell_at(patch.cell);
                for x in &x[patch.points.clone()] {
                    for (axis, row) in rows.by_ref().take(D).enumerate() {
                        let (N, dN) = grid.axes()[axis].basis::<W>(x[axis], cell[axis]);
                        row[..W].copy_from_slice(&N);
                        row[W..].copy_from_slice(&dN[..stride - W]);
                    }
                }
            }
        });
    }

    /// Returns the number of functions per axis: q + 1, or q if lowered.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the occupied cells in ascending order.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Returns the occupied columns of cells in ascending order.
    pub(crate) fn columns(&self) -> &[PatchColumn] {
        &self.columns
    }

    /// Returns the extent of the contributions of a column.
    pub(crate) fn extent(&self) -> ColumnExtent {
        self.extent
    }

    /// Returns the offsets of a patch's nodes from its first node.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Returns the rows of values, with or without derivatives, and their stride. The order is point by point and axis
    /// by axis. Zeros after the last row let four numbers be read from any position.
    pub(super) fn rows(&self) -> (&[f64], usize) {
        (&self.rows, self.stride)
    }

    /// Returns the rows of values and derivatives.
    pub(super) fn rows_with_derivatives(&self) -> &[f64] {
        assert_eq!(self.stride, 2 * self.width, "lowered functions have values only");
        &self.rows
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.patches.last().map_or(0, |patch| patch.points.end)
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the values and derivatives of point `p`, for a width `W` that is a constant.
    #[inline(always)]
    pub(crate) fn support<const W: usize>(&self, p: usize) -> PointSupport<'_, D, W> {
        let size = 2 * D * W;
        debug_assert_eq!(self.stride, 2 * W, "lowered functions have values only");
        PointSupport {
            rows: &self.rows[p * size..(p + 1) * size],
        }
    }

    /// Returns the values of point `p`: W numbers per axis, at multiples of the stride.
    #[inline(always)]
    pub(crate) fn values<const W: usize>(&self, p: usize) -> Values<'_, D, W> {
        let size = D * self.stride;
        Values {
            rows: &self.rows[p * size..(p + 1) * size],
            stride: self.stride,
        }
    }

    /// Writes N_Ip of every node of point `p` to `out`, axis 0 slowest.
    #[inline]
    pub(crate) fn values_into(&self, p: usize, out: &mut [f64]) {
        with_width!(lowered self.width, W => {
            let support = self.values::<W>(p);
            out.iter_mut().enumerate().for_each(|(k, value)| *value = support.value(k));
        });
    }

    /// Returns N_Ip of every node of point `p`, axis 0 slowest; for tests.
    pub fn values_of(&self, p: usize) -> Vec<f64> {
        with_width!(lowered self.width, W => {
            let support = self.values::<W>(p);
            (0..W.pow(D as u32)).map(|k| support.value(k)).collect()
        })
    }

    /// Returns N_Ip and grad N_Ip (1/m) of every node of point `p`, axis 0 slowest; for tests and output, not for hot
    /// loops.
    pub fn of(&self, p: usize) -> Vec<(f64, Vector<D>)> {
        with_width!(self.width, W => {
            let support = self.support::<W>(p);
            (0..W.pow(D as u32)).map(|k| (support.value(k), support.gradient(k))).collect()
        })
    }
}

/// Groups patches by columns of `cells` cells.
fn columns(patches: &[Patch], cells: usize) -> Vec<PatchColumn> {
    let mut columns: Vec<PatchColumn> = Vec::new();
    for (number, patch) in patches.iter().enumerate() {
        let of_patch = patch.cell / cells;
        match columns.last_mut() {
            Some(last) if last.column == of_patch => {
                (last.patches.end, last.points.end) = (number + 1, patch.points.end);
            }
            _ => columns.push(PatchColumn {
                column: of_patch,
                patches: number..number + 1,
                points: patch.points.clone(),
            }),
        }
    }
    columns
}
