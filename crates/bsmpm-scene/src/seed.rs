//! Fills the cells of bodies with material points.

use crate::case::{Body, Case};
use crate::grid::GridSpec;
use crate::grid::vector;
use bsmpm::kinematics::Kinematics;
use bsmpm::points::Seed;
use bsmpm::tensor::Vector;
use bsmpm_shapes::{CellPlace, Region};
use std::ops::Range;

impl Body {
    /// Cells between the first and the last one along each axis that hold its points.
    pub(crate) fn occupied(&self, grid: &GridSpec) -> Vec<Range<usize>> {
        self.region.occupied(&grid.axes)
    }

    /// Number of cells that hold its points.
    pub(crate) fn cells(&self, grid: &GridSpec) -> u128 {
        self.region.cells(&grid.axes)
    }

    /// Number of its points; cannot overflow.
    pub(crate) fn points(&self, grid: &GridSpec) -> u128 {
        self.region.points(&grid.axes, self.points_per_cell)
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
            let in_columns = body.region.points_by_column(&self.grid.axes, body.points_per_cell);
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
        let axes = &case.grid.axes;
        let lattice = case.geometry.lattice(body.points_per_cell);
        let in_plane = body.region.places(axes, lattice, columns.clone());
        let of_plane = in_plane.map(move |(number, place)| body.seed::<K, D, 2>(case, ids.start + number, place));
        let volume = match &body.region {
            Region::Solid(volume) => Some(volume),
            Region::Box { .. } | Region::Outline(_) => None,
        };
        let columns = columns.clone();
        let in_space = volume
            .into_iter()
            .flat_map(move |volume| volume.places(axes, body.points_per_cell, columns.clone()));
        let of_space = in_space.map(move |(number, place)| body.seed::<K, D, 3>(case, ids.start + number, place));
        of_plane.chain(of_space)
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
