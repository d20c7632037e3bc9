//! Pore pressure that material points store: ratio r_u, or excess pressure that strength reduction keeps constant. Its
//! nodal force is theory-manual equation (T8.4).

use crate::field::pore_water::flow::Motion;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Contributions, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::{MappedPoints, Points};
use crate::tensor::{Tensor, Vector};

/// Adds the forces of hydrostatic water and of stored pore pressures at time `t` to the external force `f_ext` (N).
/// `volume` (m^D) are the weights of the points in integrals of the stress. One exchange with the neighbours for each.
pub fn add_forces<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    volume: &[f64],
    t: f64,
    f_ext: &mut [f64],
    halo: &dyn Halo,
) {
    let MappedPoints { shape, points } = mapped;
    if let Some(water) = model.still_water(t) {
        let force = halo.assemble_ghosts(&transfer::to_nodes(shape, |p| {
            <[f64; D]>::from(water.force(points, p, model.span(points, p), model.follows_water(points, p)))
        }));
        f_ext.iter_mut().zip(force).for_each(|(all, force)| *all += force);
    }
    if let Some(force) = force(model, shape, points, volume, t) {
        let force = halo.assemble_ghosts(&force);
        f_ext.iter_mut().zip(force).for_each(|(all, force)| *all += force);
    }
}

/// Returns the nodal force of stored pore pressures at time `t`, sum_p V0 J p div N_Ip (N), with gradients at the start
/// of the step. `volume` (m^D) are the weights of the points in integrals of the stress. `None` if points store no
/// pressure.
pub fn force<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    volume: &[f64],
    t: f64,
) -> Option<Contributions> {
    let carried = pressures(model, points, t)?;
    Some(transfer::divergence::<K, D>(shape, &points.x, |p| {
        let pressed = volume[p] * points.F.at(p).determinant() * carried[p];
        K::working(&(Tensor::identity() * pressed))
    }))
}

/// Returns the work of the pressures at both times `t` on the displacements `u` (m, nodal), of every point (J).
pub fn work<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    volume: &[f64],
    u: &[f64],
    t: [f64; 2],
) -> Option<Vec<[f64; 2]>> {
    let [before, after] = t.map(|t| pressures(model, points, t));
    let before = before?;
    let after = after?;
    let x: &[Vector<D>] = &points.x;
    Some(transfer::gradients::<K, D, _>(shape, x, u, |p, gradient| {
        let dilates = volume[p] * points.F.at(p).determinant() * K::gradient::<f64>(&gradient).trace();
        [before[p] * dilates, after[p] * dilates]
    }))
}

/// Returns the pore pressure at the nodes at time `t` for the effective normal force of friction. `volume` (m^D) are
/// the weights of the points in integrals of the stress. `None` without friction, or without a stored or excess
/// pressure. One exchange with the neighbours.
pub fn pore_pressure<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    volume: &[f64],
    t: f64,
    halo: &dyn Halo,
) -> Option<PorePressure<D>> {
    // All ranks have the same boundary and water, but not all have points.
    if !model.boundary.has_friction() {
        return None;
    }
    let pressures = pressures(model, points, t).or_else(|| excess_pressures(model, points, t))?;
    let weights: Vec<f64> = (0..points.len()).map(|p| weight(points, volume, p)).collect();
    Some(PorePressure::fitted(shape, &points.x, &weights, &pressures, halo))
}

/// Returns the normal force of pore water on contact faces of the grid with friction, D numbers per node (N). It acts
/// on the area int N dA = |sum_p V div N| and belongs to the total stress, but causes no friction. One exchange with
/// the neighbours.
pub fn forces_on_faces<K: Kinematics<D>, const D: usize>(
    pores: &PorePressure<D>,
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    volume: &[f64],
    halo: &dyn Halo,
) -> Vec<f64> {
    let areas = halo.assemble_ghosts(&transfer::divergence::<K, D>(shape, &points.x, |p| {
        K::working(&(Tensor::identity() * weight(points, volume, p)))
    }));
    let mut forces = vec![0.0; areas.len()];
    let supports = model.boundary.supports.iter();
    for face in supports.filter(|support| support.contact.is_some_and(|law| law.friction > 0.0)) {
        let axis = face.axis;
        let place = if face.upper {
            model.grid.axes()[axis].length()
        } else {
            0.0
        };
        for node in model.grid.face_nodes(axis, face.upper) {
            let pressure = pores.of_node(node, axis..axis + 1, &Vector::repeat(place));
            forces[node * D + axis] = (pressure * areas[node * D + axis]).abs();
        }
    }
    forces
}

/// Returns the present volume of a point (m^D).
fn weight<const D: usize>(points: &Points<D>, volume: &[f64], p: usize) -> f64 {
    volume[p] * points.F.at(p).determinant()
}

/// Returns the stored pressures of all points at time `t` (Pa): r_u times the weight of the present gravity, or the
/// constant excess pressure. `None` if points store neither.
fn pressures<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, t: f64) -> Option<Vec<f64>> {
    let shares = points.carried_pressure.as_ref().zip(model.gravity.as_ref());
    if let Some((shares, gravity)) = shares {
        let grown = gravity.grown(t);
        return Some(shares.iter().map(|share| grown * share).collect());
    }
    model
        .water
        .as_ref()?
        .flow
        .as_ref()
        .filter(|flow| flow.motion == Motion::Held)?;
    excess_pressures(model, points, t)
}

/// Returns the difference of the pore pressure in the total stress from the hydrostatic pressure, of all points at the
/// start of the step (Pa). `None` without coupled flow.
fn excess_pressures<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    t: f64,
) -> Option<Vec<f64>> {
    let water = model.water.as_ref()?;
    let flow = water.flow.as_ref()?;
    let still = model.still_water(t).filter(|_| flow.retains());
    let mut pressures = vec![0.0; points.len()];
    for (p, pressure) in pressures.iter_mut().enumerate() {
        let x = &points.x[p];
        let Some(soil) = &flow.soils[usize::from(points.material[p])] else {
            continue;
        };
        let excess = points
            .pore_pressure
            .as_ref()
            .map_or_else(|| water.excess_at_start(x), |excess| excess[p]);
        let whole = if flow.retains() {
            excess + water.still_pressure(x, t)
        } else {
            excess
        };
        let borne = still.as_ref().map_or(0.0, |still| still.pressure(x));
        *pressure = soil.retained(whole, water.unit_weight).effective * whole - borne;
    }
    Some(pressures)
}
