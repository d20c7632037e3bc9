//! History quantities at a place or a section.

use crate::gather::shown;
use bsmpm::error::StepError;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{self, Section, SectionForces, noise};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;
use bsmpm_scene::model::vector;
use bsmpm_scene::words::Measurement;
use bsmpm_scene::{GridSpec, Quantity};

/// The place of a history that follows the point nearest to it.
pub(super) fn followed_place(quantity: &Quantity) -> Option<[f64; 3]> {
    match *quantity {
        Quantity::Displacement { at } => Some(at),
        Quantity::Velocity { at, surface: false } | Quantity::Stress { at, surface: false } => Some(at),
        Quantity::PorePressure { at, surface: false } | Quantity::Pore { at, surface: false, .. } => Some(at),
        _ => None,
    }
}

/// Displacement (m) of the place that the point `id` is the nearest one to, since the start; `lower` is the grid's
/// corner. Zero where there is no such point.
pub(super) fn displacement<const D: usize>(
    at: [f64; 3],
    lower: Vector<D>,
    id: u64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> [f64; D] {
    let place = vector(at) - lower;
    observe::at_point(points, id, halo, |p| observe::displacement(points, p, &place).into())
}

/// The point that a history follows.
#[derive(Clone, Copy)]
pub(super) struct FollowedPoint<const D: usize> {
    /// its id
    pub(super) id: u64,
    /// m  the place that it is the nearest one to, from the grid's lower corner, where the value is that of the place;
    /// `None`: it is that of the point
    pub(super) place: Option<Vector<D>>,
}

impl<const D: usize> FollowedPoint<D> {
    /// Of a history at `at` (m, from the grid's lower corner), whose nearest point is `id`. In a grid whose cells
    /// differ in length points may lie far from the place.
    pub(super) fn of(id: Option<u64>, at: Vector<D>, grid: &GridSpec) -> Self {
        let is_graded = grid.axes.iter().any(|axis| axis.longest() > EQUAL * axis.shortest());
        Self {
            id: id.unwrap_or(u64::MAX),
            place: id.filter(|_| is_graded).map(|_| at),
        }
    }

    /// A field there: at the place, if it is in material, else of the point; zero where there is no such point.
    fn value<K: Kinematics<D>, const C: usize>(
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

/// Longest over shortest cell along an axis up to which cells count as equal.
const EQUAL: f64 = 1.0 + 1e-6;

/// A quantity of a followed point, zero where there is none; of other quantities there is none.
pub(super) fn at_followed<K: Kinematics<D>, const D: usize>(
    quantity: &Quantity,
    followed: FollowedPoint<D>,
    model: &Model<K, D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    match quantity {
        Quantity::Velocity { .. } => followed.value(model, points, |p| velocity(points, p), halo).to_vec(),
        Quantity::Stress { .. } => shown::<D>(&followed.value(model, points, |p| points.sigma.at(p).0, halo)),
        _ => Vec::new(),
    }
}

/// Velocity (m/s) of a point; zero where there is no motion.
pub(super) fn velocity<const D: usize>(points: &Points<D>, p: usize) -> [f64; D] {
    points.motion.as_ref().map_or([0.0; D], |motion| motion.v[p].into())
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

/// Where pore water is read.
#[derive(Clone, Copy)]
pub(super) enum PoreAt<const D: usize> {
    /// A point that is followed.
    Point(FollowedPoint<D>),
    /// m  the material place that was there, from the grid's lower corner, before anything moved
    Surface(Vector<D>),
}

impl<const D: usize> PoreAt<D> {
    fn value<K: Kinematics<D>, const C: usize>(
        self,
        model: &Model<K, D>,
        points: &Points<D>,
        field: impl Fn(usize) -> [f64; C],
        halo: &dyn Halo,
    ) -> Vec<f64> {
        match self {
            Self::Point(followed) => followed.value(model, points, field, halo).to_vec(),
            Self::Surface(at) => at_surface(model, points, at, field, halo),
        }
    }
}

/// A quantity of the pore water of a point or place; zero without it.
pub(super) fn pore<K: Kinematics<D>, const D: usize>(
    measured: Measurement,
    water: Option<PoreWater<'_, D>>,
    read: PoreAt<D>,
    model: &Model<K, D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Result<Vec<f64>, StepError> {
    if measured == Measurement::Flux {
        let fluxes = water.map(|water| water.fluxes::<K>(&model.grid, halo)).transpose()?;
        return Ok(read.value(
            model,
            points,
            |p| fluxes.as_ref().map_or([0.0; D], |fluxes| fluxes[p].into()),
            halo,
        ));
    }
    let number = match measured {
        Measurement::ExcessPressure => PoreWater::excess,
        Measurement::Porosity => PoreWater::porosity,
        _ => PoreWater::pressure,
    };
    Ok(read.value(model, points, |p| [water.map_or(0.0, |water| number(&water, p))], halo))
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

pub(super) fn both(noise: noise::Noise) -> Vec<f64> {
    vec![noise.about_average, noise.about_plane]
}
