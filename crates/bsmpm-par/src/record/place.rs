//! Quantities at a place: of the point that is followed, of the material there, of a section.

use crate::gather::shown;
use bsmpm::error::StepError;
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{self, Section, SectionForces, noise};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;
use bsmpm::water::observed::PoreWater;
use bsmpm_scene::Quantity;
use bsmpm_scene::model::vector;
use bsmpm_scene::words::Measurement;

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
    let found = place::values::<K, D, _>(&model.grid, points, (&[at], Configuration::Surface), field, halo);
    found[0].map_or_else(|| vec![0.0; C], |values| values.to_vec())
}

/// Where pore water is read.
#[derive(Clone, Copy)]
pub(super) enum PoreAt<const D: usize> {
    /// The point of an id.
    Point(u64),
    /// m  the material place that was there, from the grid's lower corner, before anything moved
    Surface(Vector<D>),
}

/// A quantity of the pore water of a point or place; zero without it.
pub(super) fn pore<K: Kinematics<D>, const D: usize>(
    (measured, water): (Measurement, Option<PoreWater<'_, D>>),
    read: PoreAt<D>,
    (model, points): (&Model<K, D>, &Points<D>),
    halo: &dyn Halo,
) -> Result<Vec<f64>, StepError> {
    let number = |of: &dyn Fn(PoreWater<'_, D>, usize) -> f64| {
        let field = |p: usize| [water.map_or(0.0, |water| of(water, p))];
        match read {
            PoreAt::Point(id) => observe::at_point(points, id, halo, field).to_vec(),
            PoreAt::Surface(at) => at_surface((model, points), at, field, halo),
        }
    };
    Ok(match measured {
        Measurement::Flux => {
            let fluxes = water.map(|water| water.fluxes::<K>(&model.grid, halo)).transpose()?;
            let flux = |p: usize| fluxes.as_ref().map_or([0.0; D], |fluxes| fluxes[p].into());
            match read {
                PoreAt::Point(id) => observe::at_point(points, id, halo, flux).to_vec(),
                PoreAt::Surface(at) => at_surface((model, points), at, flux, halo),
            }
        }
        Measurement::ExcessPressure => number(&|water, p| water.excess(p)),
        Measurement::Porosity => number(&|water, p| water.porosity(p)),
        _ => number(&|water, p| water.pressure(p)),
    })
}

/// Forces across a section, in the order of their columns; none across one that has lost its material.
pub(super) fn section<K: Kinematics<D>, const D: usize>(
    (grid, points): (&Grid<D>, &Points<D>),
    at_start: Section<D>,
    fixed: bool,
    halo: &dyn Halo,
) -> Vec<f64> {
    let placed = |end: &Vector<D>| if fixed { Some(*end) } else { observe::moved(points, end, halo) };
    let lines = at_start.lines.iter().map(|[from, to]| Some([placed(from)?, placed(to)?]));
    let present = lines.collect::<Option<_>>().map(|lines| Section { lines, ..at_start });
    let forces =
        present.map_or_else(SectionForces::default, |of| observe::section_forces::<K, D>(grid, points, &of, halo));
    let SectionForces { normal, shear, torsion, bending } = forces;
    let in_plane = [normal, shear[0], bending[0]];
    if D == 2 { in_plane.into() } else { vec![normal, shear[0], shear[1], torsion, bending[0], bending[1]] }
}

pub(super) fn both(noise: noise::Noise) -> Vec<f64> {
    vec![noise.about_average, noise.about_plane]
}
