//! Bodies to material points: a regular lattice in the part of every cell that a body covers.

use crate::case::{Body, Case};
use crate::grid::{Axis, GridSpec};
use bsmpm::points::Seed;
use bsmpm::tensor::Vector;
use std::ops::Range;

/// Parts of a cell's edge below which a body is not taken to reach into it.
const SLIVER: f64 = 1e-9;

/// The part of one axis that a body covers.
#[derive(Clone, Debug)]
pub(crate) struct Extent<'a> {
    axis: &'a Axis,
    /// m  ends of the body, from the grid's lower corner
    ends: [f64; 2],
    /// cells that it reaches into
    pub(crate) cells: Range<usize>,
}

impl<'a> Extent<'a> {
    fn new(axis: &'a Axis, lower: f64, upper: f64) -> Self {
        let ends = [(lower - axis.lower()).max(0.0), (upper - axis.lower()).min(axis.length())];
        let start = axis.first_cell(|i| axis.breakpoint(i + 1) > ends[0] + SLIVER * axis.cell(i));
        let end = axis.first_cell(|i| axis.breakpoint(i) >= ends[1] - SLIVER * axis.cell(i));
        Self { axis, ends, cells: start..end.max(start) }
    }

    /// Ends of the body's part of a cell, m; the outermost parts take up slivers, so that nothing is lost.
    fn part(&self, cell: usize) -> [f64; 2] {
        let lower = if cell == self.cells.start { self.ends[0] } else { self.axis.breakpoint(cell) };
        let upper = if cell + 1 == self.cells.end { self.ends[1] } else { self.axis.breakpoint(cell + 1) };
        [lower, upper]
    }
}

impl Body {
    /// Cells that the body reaches into, per axis.
    pub(crate) fn extents<'a>(&self, grid: &'a GridSpec) -> [Extent<'a>; 2] {
        [0, 1].map(|axis| Extent::new(&grid.axes[axis], self.lower[axis], self.upper[axis]))
    }

    /// Number of its points; cannot overflow.
    pub(crate) fn points(&self, grid: &GridSpec) -> u128 {
        let cells = self.extents(grid).map(|extent| extent.cells.len() as u128);
        cells[0] * cells[1] * (self.points_per_cell as u128).pow(2)
    }
}

impl Case {
    /// Number of material points, without making them.
    pub fn points(&self) -> u64 {
        self.bodies.iter().map(|body| body.points(&self.grid)).sum::<u128>().try_into().unwrap_or(u64::MAX)
    }

    /// Number of material points in every column of cells along axis 0, without making them.
    pub fn points_by_column(&self) -> Vec<u64> {
        let mut counts = vec![0; self.grid.axes[0].cells()];
        for body in &self.bodies {
            let [across, up] = body.extents(&self.grid);
            let in_column = (up.cells.len() * body.points_per_cell * body.points_per_cell) as u64;
            counts[across.cells].iter_mut().for_each(|count| *count += in_column);
        }
        counts
    }
}

/// Points of all bodies in the cells `columns` along axis 0.
///
/// In every cell a body has `points_per_cell`² points at (i + ½)/n of the part that it covers, each with 1/n² of the
/// part's area; the areas add up to the body's. Ids count body by body, cell by cell and point by point, axis 0
/// slowest; they and the points do not depend on `columns`. Positions are relative to the grid's lower corner (m),
/// volumes and masses per metre of thickness (m², kg/m).
pub fn seed(case: &Case, columns: Range<usize>) -> impl Iterator<Item = Seed<2>> + '_ {
    let mut offset = 0;
    case.bodies.iter().flat_map(move |body| {
        let first_id = offset;
        offset += body.points(&case.grid) as u64;
        of_body(case, body, first_id, columns.clone())
    })
}

fn of_body<'a>(
    case: &'a Case,
    body: &'a Body,
    first_id: u64,
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<2>> + 'a {
    let [across, up] = body.extents(&case.grid);
    let cells = across.cells.start.max(columns.start)..across.cells.end.min(columns.end);
    cells.flat_map(move |i| {
        let (across, up) = (across.clone(), up.clone());
        let row = (i - across.cells.start) * up.cells.len();
        up.cells.clone().flat_map(move |j| {
            let cell = row + (j - up.cells.start);
            of_cell(case, body, [across.part(i), up.part(j)], (first_id, cell as u64))
        })
    })
}

/// Points of a body in one cell.
fn of_cell<'a>(
    case: &'a Case,
    body: &'a Body,
    [across, up]: [[f64; 2]; 2],
    (first_id, cell): (u64, u64),
) -> impl Iterator<Item = Seed<2>> + 'a {
    let n = body.points_per_cell;
    let count = n * n;
    let volume = (across[1] - across[0]) * (up[1] - up[0]) / count as f64;
    let mass = case.materials[body.material].density.unwrap_or(0.0) * volume;
    let place = move |[lower, upper]: [f64; 2], k: usize| lower + (upper - lower) * ((k as f64 + 0.5) / n as f64);
    (0..count).map(move |k| Seed {
        id: first_id + cell * count as u64 + k as u64,
        material: body.material as u16,
        x: Vector::<2>::new(place(across, k / n), place(up, k % n)),
        volume,
        mass,
        v: body.velocity.map_or(Vector::<2>::zeros(), |v| Vector::<2>::new(v[0], v[1])),
    })
}
