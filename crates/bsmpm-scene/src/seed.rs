//! Bodies to material points: a regular lattice in the part of every cell that a box covers, or in the cells themselves
//! where another shape cuts them.

use crate::case::{Body, Case};
use crate::grid::{GridAxis, GridSpec};
use crate::model::vector;
use crate::region::{self, CellPlace, Outline, Region, RegionPart};
use bsmpm::kinematics::Kinematics;
use bsmpm::points::Seed;
use bsmpm::tensor::Vector;
use std::ops::Range;

/// Parts of a cell's edge below which a body is not taken to reach into it.
const SLIVER: f64 = 1e-9;

/// The part of one axis that a box covers.
#[derive(Clone, Debug)]
struct SeedExtent<'a> {
    axis: &'a GridAxis,
    /// m  ends of the box, from the grid's lower corner
    ends: [f64; 2],
    /// cells that it reaches into
    cells: Range<usize>,
}

impl<'a> SeedExtent<'a> {
    fn new(axis: &'a GridAxis, lower: f64, upper: f64) -> Self {
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
    /// Cells that the body reaches into, per axis, if it is a box.
    fn extents<'a>(&self, grid: &'a GridSpec) -> Option<[SeedExtent<'a>; 2]> {
        let Region::Box { lower, upper } = &self.region else { return None };
        Some([0, 1].map(|axis| SeedExtent::new(&grid.axes[axis], lower[axis], upper[axis])))
    }

    /// Cells between the first and the last one along each axis that hold its points.
    pub(crate) fn occupied(&self, grid: &GridSpec) -> [Range<usize>; 2] {
        match &self.region {
            Region::Outline(outline) => outline.tally().occupied.clone(),
            Region::Box { .. } => self.extents(grid).map_or([0..0, 0..0], |extents| extents.map(|extent| extent.cells)),
        }
    }

    /// Number of cells that hold its points.
    pub(crate) fn cells(&self, grid: &GridSpec) -> u128 {
        match &self.region {
            Region::Outline(outline) => outline.tally().cells.into(),
            Region::Box { .. } => self.occupied(grid).iter().map(|cells| cells.len() as u128).product(),
        }
    }

    /// Number of its points; cannot overflow.
    pub(crate) fn points(&self, grid: &GridSpec) -> u128 {
        match &self.region {
            Region::Outline(outline) => outline.tally().before.last().copied().unwrap_or(0).into(),
            Region::Box { .. } => self.cells(grid) * (self.points_per_cell as u128).pow(2),
        }
    }
}

impl Case {
    /// Number of material points, without making them.
    pub fn points(&self) -> u64 {
        self.bodies.iter().map(|body| body.points(&self.grid)).sum::<u128>().try_into().unwrap_or(u64::MAX)
    }

    /// Number of material points in every column of knot spans along axis 0, without making them.
    pub fn points_by_column(&self) -> Vec<u64> {
        let of_cells = self.points_by_cells();
        let mut counts = vec![0; self.grid.spans(0)];
        of_cells.into_iter().enumerate().for_each(|(cell, count)| counts[self.grid.span(0, cell)] = count);
        counts
    }

    fn points_by_cells(&self) -> Vec<u64> {
        let mut counts = vec![0; self.grid.axes[0].cells()];
        for body in &self.bodies {
            let [across, up] = body.occupied(&self.grid);
            match &body.region {
                Region::Box { .. } => {
                    let in_column = (up.len() * body.points_per_cell * body.points_per_cell) as u64;
                    counts[across].iter_mut().for_each(|count| *count += in_column);
                }
                Region::Outline(outline) => {
                    let before = outline.tally().before.windows(2);
                    counts[across].iter_mut().zip(before).for_each(|(count, pair)| *count += pair[1] - pair[0]);
                }
            }
        }
        counts
    }
}

/// Points of all bodies in the cells `columns` along axis 0.
///
/// In every cell a box has `points_per_cell`² points at (i + ½)/n of the part that it covers, each with 1/n² of the
/// part's area. Of any other shape only those places (i + ½)/n of the whole cell are points that lie inside; each has
/// what the shape covers of its n-th of the cell along each axis, and the nearest point of the cell has what is covered
/// around places outside. A cell without a place inside has one point in the covered part. The areas add up to the
/// body's; where an outline, but not a box, covers less than 1e-9 of a cell, that is left out.
///
/// Ids count body by body, cell by cell and point by point, axis 0 slowest; they and the points do not depend on
/// `columns`. Positions are relative to the grid's lower corner (m), volumes and masses what the geometry makes of an
/// area: of plane strain per metre of thickness (m²,
/// kg/m).
pub fn seed<K: Kinematics<D>, const D: usize>(
    case: &Case,
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<D>> + '_ {
    seed_bodies::<K, D>(case, columns, |_| true)
}

/// The same of those bodies only whose number is `wanted`.
pub fn seed_bodies<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    columns: Range<usize>,
    wanted: impl Fn(usize) -> bool + 'a,
) -> impl Iterator<Item = Seed<D>> + 'a {
    let bodies = case.bodies.iter().zip(case.ids()).enumerate().filter(move |(number, _)| wanted(*number));
    bodies.flat_map(move |(_, (body, ids))| {
        let first_id = ids.start;
        let of_box =
            body.extents(&case.grid).map(|extents| of_box::<K, D>(case, body, first_id, extents, columns.clone()));
        let of_outline = match &body.region {
            Region::Outline(outline) => Some(of_outline::<K, D>(case, body, first_id, outline, columns.clone())),
            Region::Box { .. } => None,
        };
        of_box.into_iter().flatten().chain(of_outline.into_iter().flatten())
    })
}

fn of_box<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    body: &'a Body,
    first_id: u64,
    [across, up]: [SeedExtent<'a>; 2],
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<D>> + 'a {
    let cells = across.cells.start.max(columns.start)..across.cells.end.min(columns.end);
    cells.flat_map(move |i| {
        let (across, up) = (across.clone(), up.clone());
        let row = (i - across.cells.start) * up.cells.len();
        up.cells.clone().flat_map(move |j| {
            let cell = (row + (j - up.cells.start)) as u64;
            let count = (body.points_per_cell * body.points_per_cell) as u64;
            let first_id = first_id + cell * count;
            of_cell(body.points_per_cell, [across.part(i), up.part(j)])
                .zip(first_id..)
                .map(move |(place, id)| body.seed::<K, D>(case, id, place))
        })
    })
}

fn of_outline<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    body: &'a Body,
    first_id: u64,
    outline: &'a Outline,
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<D>> + 'a {
    let tally = outline.tally();
    let occupied = &tally.occupied[0];
    let (grid, n) = (&case.grid, body.points_per_cell);
    (occupied.start.max(columns.start)..occupied.end.min(columns.end)).flat_map(move |i| {
        let first_id = first_id + tally.before[i - occupied.start];
        let x = [grid.axes[0].breakpoint(i), grid.axes[0].breakpoint(i + 1)];
        let places = outline.column(grid, n, i).parts.into_iter().flat_map(move |part| {
            let (whole, cut) = match part {
                RegionPart::Whole(rows) => (rows, Vec::new()),
                RegionPart::Cut(_, places) => (0..0, places),
            };
            let y = move |j: usize| [grid.axes[1].breakpoint(j), grid.axes[1].breakpoint(j + 1)];
            whole.flat_map(move |j| of_cell(n, [x, y(j)])).chain(cut)
        });
        places.zip(first_id..).map(move |(place, id)| body.seed::<K, D>(case, id, place))
    })
}

/// Points of a rectangle that lies in one cell.
fn of_cell(n: usize, [across, up]: [[f64; 2]; 2]) -> impl Iterator<Item = CellPlace> {
    let count = n * n;
    let area = (across[1] - across[0]) * (up[1] - up[0]) / count as f64;
    (0..count).map(move |k| CellPlace { x: [region::place(across, k / n, n), region::place(up, k % n, n)], area })
}

impl Body {
    /// m/s  what its spin makes of a place, m from the grid's lower corner.
    fn spun<const D: usize>(&self, case: &Case, x: [f64; 2]) -> Vector<D> {
        let Some((rate, about)) = self.spin else { return Vector::zeros() };
        let about = case.grid.local(about);
        vector([-rate * (x[1] - about[1]), rate * (x[0] - about[0])])
    }

    /// kg/m3  at a place, m from the grid's lower corner.
    fn density(&self, case: &Case, x: [f64; 2]) -> f64 {
        let lower = case.grid.lower();
        case.density_at(self, [lower[0] + x[0], lower[1] + x[1]])
    }

    fn seed<K: Kinematics<D>, const D: usize>(&self, case: &Case, id: u64, place: CellPlace) -> Seed<D> {
        let x = vector(place.x);
        let volume = place.area * K::weight(&x);
        Seed {
            id,
            material: self.material as u16,
            x,
            volume,
            mass: self.density(case, place.x) * volume,
            v: self.velocity.map_or(Vector::zeros(), vector) + self.spun(case, place.x),
        }
    }
}
