//! Quantities at a place: of the point that is followed, of the material there, of a section.

use crate::gather::shown;
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{self, SectionForces, noise};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;
use bsmpm::water::observed::PoreWater;
use bsmpm_scene::Quantity;
use bsmpm_scene::model::vector;
use bsmpm_scene::words::Measurement;
use std::any::Any;

/// The place of a history that follows the point nearest to it.
pub(super) fn followed_place(quantity: &Quantity) -> Option<[f64; 3]> {
    match *quantity {
        Quantity::Displacement { at } | Quantity::PorePressure { at } | Quantity::Pore { at, .. } => Some(at),
        Quantity::Velocity { at, surface: false } | Quantity::Stress { at, surface: false } => Some(at),
        _ => None,
    }
}

/// Displacement (m) of the place that the point `id` is the nearest one to, since the start; `lower` is the grid's
/// corner. Zero where there is no such point.
pub(super) fn displacement<const D: usize>(
    (at, lower): ([f64; 3], Vector<D>),
    id: u64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> [f64; D] {
    let place = vector(at) - lower;
    observe::at_point(points, id, halo, |p| observe::displacement(points, p, &place).into())
}

/// A quantity of the point `id`, zero where there is none; of other quantities there is none.
pub(super) fn at_followed<const D: usize>(
    quantity: &Quantity,
    id: u64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    let velocity = |p: usize| points.motion.as_ref().map_or([0.0; D], |motion| motion.v[p].into());
    match quantity {
        Quantity::Velocity { .. } => observe::at_point(points, id, halo, velocity).to_vec(),
        Quantity::Stress { .. } => shown::<D>(&observe::at_point(points, id, halo, |p| points.sigma.at(p).0)),
        _ => Vec::new(),
    }
}

/// A field at the material place that was at `at` (m, from the grid's lower corner) before anything moved; zero where
/// there is no material.
pub(super) fn at_surface<K: Kinematics<D>, const D: usize, const C: usize>(
    (model, points): (&Model<K, D>, &Points<D>),
    at: Vector<D>,
    field: impl Fn(usize) -> [f64; C],
    halo: &dyn Halo,
) -> Vec<f64> {
    let found = place::values::<K, D, _>(&model.grid, points, (&[at], Configuration::Initial), field, halo);
    found[0].map_or_else(|| vec![0.0; C], |values| values.to_vec())
}

/// A quantity of the pore water of the point of an id; zero without it.
pub(super) fn pore<const D: usize>(
    (measured, water): (Measurement, Option<PoreWater<'_, D>>),
    id: u64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    let number = |of: &dyn Fn(PoreWater<'_, D>, usize) -> f64| {
        observe::at_point(points, id, halo, |p| [water.map_or(0.0, |water| of(water, p))]).to_vec()
    };
    match measured {
        Measurement::Flux => {
            let flux = |p: usize| water.map_or([0.0; D], |water| water.flux(p).into());
            observe::at_point(points, id, halo, flux).to_vec()
        }
        Measurement::ExcessPressure => number(&|water, p| water.excess(p)),
        Measurement::Porosity => number(&|water, p| water.porosity(p)),
        _ => number(&|water, p| water.pressure(p)),
    }
}

/// Resultants of the stress in a section; none out of a plane.
pub(super) fn section<const D: usize>(
    (grid, points): (&Grid<D>, &Points<D>),
    ends: [Vector<D>; 2],
    fixed: bool,
    halo: &dyn Halo,
) -> SectionForces {
    let placed = |end: Vector<D>| if fixed { Some(end) } else { observe::moved(points, &end, halo) };
    let [from, to] = ends.map(placed);
    let plane = |end: Vector<D>| Vector::<2>::new(end[0], end[1]);
    let (grid, points): (&dyn Any, &dyn Any) = (grid, points);
    let (Some(grid), Some(points)) = (grid.downcast_ref(), points.downcast_ref()) else {
        return SectionForces::default();
    };
    let forces = from.zip(to).map(|(from, to)| observe::section_forces(grid, points, [from, to].map(plane), halo));
    forces.unwrap_or_default()
}

pub(super) fn both(noise: noise::Noise) -> Vec<f64> {
    vec![noise.about_average, noise.about_plane]
}
