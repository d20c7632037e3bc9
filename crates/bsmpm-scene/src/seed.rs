//! Fills the cells of a body with a regular lattice of material points.

use crate::case::{Body, Case};
use crate::grid::GridSpec;
use crate::grid::vector;
use crate::region::{AxisExtent, CellPlace, Lattice, Outline, Region, RegionPart, Volume, of_cell};
use bsmpm::kinematics::Kinematics;
use bsmpm::points::Seed;
use bsmpm::tensor::Vector;
use std::ops::Range;

impl Body {
    /// Cells that the body reaches into, per axis, if it is a box.
    fn extents<'a>(&self, grid: &'a GridSpec) -> Option<[AxisExtent<'a>; 2]> {
        let Region::Box { lower, upper } = &self.region else {
            return None;
        };
        Some([0, 1].map(|axis| AxisExtent::new(&grid.axes[axis], lower[axis], upper[axis])))
    }

    /// Cells between the first and the last one along each axis that hold its points.
    pub(crate) fn occupied(&self, grid: &GridSpec) -> Vec<Range<usize>> {
        match &self.region {
            Region::Outline(outline) => outline.tally().occupied.to_vec(),
            Region::Solid(volume) => volume.tally().occupied.to_vec(),
            Region::Box { .. } => self
                .extents(grid)
                .into_iter()
                .flatten()
                .map(|extent| extent.cells)
                .collect(),
        }
    }

    /// Number of cells that hold its points.
    pub(crate) fn cells(&self, grid: &GridSpec) -> u128 {
        match &self.region {
            Region::Outline(outline) => outline.tally().cells.into(),
            Region::Solid(volume) => volume.tally().cells.into(),
            Region::Box { .. } => self.occupied(grid).iter().map(|cells| cells.len() as u128).product(),
        }
    }

    /// Number of its points; cannot overflow.
    pub(crate) fn points(&self, grid: &GridSpec) -> u128 {
        match &self.region {
            Region::Outline(outline) => outline.tally().before.last().copied().unwrap_or(0).into(),
            Region::Solid(volume) => volume.tally().before.last().copied().unwrap_or(0).into(),
            Region::Box { .. } => self.cells(grid) * (self.points_per_cell as u128).pow(2),
        }
    }
}

impl Case {
    /// Number of material points, without making them.
    pub fn points(&self) -> u64 {
        self.bodies
            .iter()
            .map(|body| body.points(&self.grid))
            .sum::<u128>()
            .try_into()
            .unwrap_or(u64::MAX)
    }

    /// Number of material points in every column of knot spans along axis 0, without making them.
    pub fn points_by_column(&self) -> Vec<u64> {
        let of_cells = self.points_by_cells();
        let mut counts = vec![0; self.grid.spans(0)];
        of_cells
            .into_iter()
            .enumerate()
            .for_each(|(cell, count)| counts[self.grid.span(0, cell)] = count);
        counts
    }

    fn points_by_cells(&self) -> Vec<u64> {
        let mut counts = vec![0; self.grid.axes[0].cells()];
        for body in &self.bodies {
            let occupied = body.occupied(&self.grid);
            let before = match &body.region {
                Region::Box { .. } => {
                    let in_column = (occupied[1].len() * body.points_per_cell * body.points_per_cell) as u64;
                    counts[occupied[0].clone()]
                        .iter_mut()
                        .for_each(|count| *count += in_column);
                    continue;
                }
                Region::Outline(outline) => &outline.tally().before,
                Region::Solid(volume) => &volume.tally().before,
            };
            let in_columns = before.windows(2).map(|pair| pair[1] - pair[0]);
            counts[occupied[0].clone()]
                .iter_mut()
                .zip(in_columns)
                .for_each(|(count, more)| *count += more);
        }
        counts
    }
}

/// Points of all bodies in the cells `columns` along axis 0.
///
/// In every cell a box has `points_per_cell`² points at (i + ½)/n of the part that it covers, near an axis a little off
/// these places ([`Kinematics::spread`]), each with 1/n² of the part's area. Of any other shape only those places
/// (i + ½)/n of the whole cell are points that lie inside; each has what the shape covers of its n-th of the cell along
/// each axis, and the nearest point of the cell has what is covered around places outside. A cell without a place
/// inside has one point in the covered part. The areas add up to the body's; where an outline, but not a box, covers
/// less than 1e-9 of a cell, that is left out. In space there are `points_per_cell`³ of them, and volumes in the place
/// of areas.
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
    let bodies = case
        .bodies
        .iter()
        .zip(case.ids())
        .enumerate()
        .filter(move |(number, _)| wanted(*number));
    bodies.flat_map(move |(_, (body, ids))| {
        let first_id = ids.start;
        let of_box = body
            .extents(&case.grid)
            .map(|extents| of_box::<K, D>(case, body, first_id, extents, columns.clone()));
        let of_outline = match &body.region {
            Region::Outline(outline) => Some(of_outline::<K, D>(case, body, first_id, outline, columns.clone())),
            _ => None,
        };
        let of_volume = match &body.region {
            Region::Solid(volume) => Some(of_volume::<K, D>(case, body, first_id, volume, columns.clone())),
            _ => None,
        };
        of_box
            .into_iter()
            .flatten()
            .chain(of_outline.into_iter().flatten())
            .chain(of_volume.into_iter().flatten())
    })
}

fn of_box<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    body: &'a Body,
    first_id: u64,
    [across, up]: [AxisExtent<'a>; 2],
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<D>> + 'a {
    let cells = across.cells.start.max(columns.start)..across.cells.end.min(columns.end);
    cells.flat_map(move |i| {
        let across = across.clone();
        let up = up.clone();
        let row = (i - across.cells.start) * up.cells.len();
        up.cells.clone().flat_map(move |j| {
            let cell = (row + (j - up.cells.start)) as u64;
            let count = (body.points_per_cell * body.points_per_cell) as u64;
            let first_id = first_id + cell * count;
            let lattice = Lattice {
                n: body.points_per_cell,
                geometry: case.geometry,
            };
            of_cell(lattice, [across.part(i), up.part(j)])
                .zip(first_id..)
                .map(move |(place, id)| body.seed::<K, D, 2>(case, id, place))
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
    let grid = &case.grid;
    let n = body.points_per_cell;
    (occupied.start.max(columns.start)..occupied.end.min(columns.end)).flat_map(move |i| {
        let first_id = first_id + tally.before[i - occupied.start];
        let x = [grid.axes[0].breakpoint(i), grid.axes[0].breakpoint(i + 1)];
        let places = outline.column(grid, n, i).parts.into_iter().flat_map(move |part| {
            let (whole, cut) = match part {
                RegionPart::Whole(rows) => (rows, Vec::new()),
                RegionPart::Cut(_, places) => (0..0, places),
            };
            let of_whole = whole.flat_map(move |j| {
                let y = [grid.axes[1].breakpoint(j), grid.axes[1].breakpoint(j + 1)];
                of_cell(outline.lattice(n), [x, y])
            });
            of_whole.chain(cut)
        });
        places
            .zip(first_id..)
            .map(move |(place, id)| body.seed::<K, D, 2>(case, id, place))
    })
}

fn of_volume<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    body: &'a Body,
    first_id: u64,
    volume: &'a Volume,
    columns: Range<usize>,
) -> impl Iterator<Item = Seed<D>> + 'a {
    let tally = volume.tally();
    let occupied = &tally.occupied[0];
    (occupied.start.max(columns.start)..occupied.end.min(columns.end)).flat_map(move |i| {
        let first_id = first_id + tally.before[i - occupied.start];
        let places = volume.slab(&case.grid.axes, body.points_per_cell, i);
        places
            .into_iter()
            .zip(first_id..)
            .map(move |(place, id)| body.seed::<K, D, 3>(case, id, place))
    })
}

impl Body {
    /// m/s  what its spin makes of a place, m from the grid's lower corner.
    fn spun<const D: usize, const N: usize>(&self, case: &Case, x: [f64; N]) -> Vector<D> {
        let Some([rate, about]) = self.spin else {
            return Vector::zeros();
        };
        let lower = case.grid.lower();
        let mut arm = [0.0; 3];
        for axis in 0..D {
            arm[axis] = x[axis] - (about[axis] - lower[axis]);
        }
        vector([[1, 2], [2, 0], [0, 1]].map(|[a, b]: [usize; 2]| rate[a] * arm[b] - rate[b] * arm[a]))
    }

    /// kg/m3  of a point, whose place is in m from the grid's lower corner.
    fn density<const N: usize>(&self, case: &Case, CellPlace { x, area }: CellPlace<N>) -> f64 {
        let lower = case.grid.lower();
        let at = std::array::from_fn(|axis| lower[axis] + x.get(axis).unwrap_or(&0.0));
        case.density_at(self, at, area)
    }

    fn seed<K: Kinematics<D>, const D: usize, const N: usize>(
        &self,
        case: &Case,
        id: u64,
        place: CellPlace<N>,
    ) -> Seed<D> {
        let x = vector(place.x);
        let volume = place.area * K::weight(&x);
        Seed {
            id,
            material: self.material as u16,
            x,
            volume,
            mass: self.density(case, place) * volume,
            v: self.velocity.map_or(Vector::zeros(), vector) + self.spun(case, place.x),
        }
    }
}
