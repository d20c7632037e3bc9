//! Values at a place or a section.

use crate::grid::GridSpec;
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{self, Section, SectionForces};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;

/// Longest over shortest cell along an axis up to which cells count as equal.
const EQUAL: f64 = 1.0 + 1e-6;

/// The point that a history follows.
#[derive(Clone, Copy)]
pub(super) struct FollowedPoint<const D: usize> {
    id: u64,
    place: Option<Vector<D>>, // m, the place that it is nearest to, where the value is that of the place
}

impl<const D: usize> FollowedPoint<D> {
    /// Of a history at `at` (m, from the grid's lower corner), whose nearest point is `id`. In a grid whose cells
    /// differ in length points may lie far from the place, and the value is that of the place.
    pub(super) fn of(id: Option<u64>, at: Vector<D>, grid: &GridSpec) -> Self {
        let is_graded = grid.axes.iter().any(|axis| axis.longest() > EQUAL * axis.shortest());
        Self {
            id: id.unwrap_or(u64::MAX),
            place: id.filter(|_| is_graded).map(|_| at),
        }
    }

    /// A field there: at the place, if it is in material, else of the point; zero where there is no such point.
    pub(super) fn value<K: Kinematics<D>, const C: usize>(
        self,
        model: &Model<K, D>,
        points: &Points<D>,
        field: impl Fn(usize) -> [f64; C],
        halo: &dyn Halo,
    ) -> [f64; C] {
        // A stage may have removed the body of the point, and another one be there.
        let place = self
            .place
            .filter(|_| observe::at_point(points, self.id, halo, |_| [1.0]) == [1.0]);
        let found = place.and_then(|at| {
            place::values::<K, D, _>(&model.grid, points, &[at], Configuration::Initial, &field, halo)[0]
        });
        found.unwrap_or_else(|| observe::at_point(points, self.id, halo, &field))
    }
}

/// A field at the material place that was at `at` (m, from the grid's lower corner) before anything moved; zero where
/// there is no material.
pub(super) fn at_surface<K: Kinematics<D>, const D: usize, const C: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    at: Vector<D>,
    field: impl Fn(usize) -> [f64; C],
    halo: &dyn Halo,
) -> Vec<f64> {
    let found = place::values::<K, D, _>(&model.grid, points, &[at], Configuration::Surface, field, halo);
    found[0].map_or_else(|| vec![0.0; C], |values| values.to_vec())
}

/// Forces across a section, in the order of their columns; none across one that has lost its material.
pub(super) fn section<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    at_start: Section<D>,
    fixed: bool,
    halo: &dyn Halo,
) -> Vec<f64> {
    let present = if fixed {
        Some(at_start)
    } else {
        let lines = at_start
            .lines
            .iter()
            .map(|[from, to]| Some([observe::moved(points, from, halo)?, observe::moved(points, to, halo)?]));
        lines.collect::<Option<_>>().map(|lines| Section { lines, ..at_start })
    };
    let forces = present.map_or_else(SectionForces::default, |of| {
        observe::section_forces::<K, D>(grid, points, &of, halo)
    });
    let SectionForces {
        normal,
        shear,
        torsion,
        bending,
    } = forces;
    let in_plane = [normal, shear[0], bending[0]];
    if D == 2 {
        in_plane.into()
    } else {
        vec![normal, shear[0], shear[1], torsion, bending[0], bending[1]]
    }
}
