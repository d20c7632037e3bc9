//! Pore pressure that points carry: a share r_u of the weight above them at the start; and the excess of water that
//! flowed, held as it is while strength is divided.

use crate::boundary::Support;
use crate::grid::{Contributions, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};
use crate::water::flow::Motion;

/// N  what the pressure does to the nodes: sum_p V0 J p div N_Ip by the place at the start of the step, at time `t`;
/// `volume` (m^D) is what points weigh in integrals of the stress.
pub fn force<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    (shape, points): (&Shape<D>, &Points<D>),
    volume: &[f64],
    t: f64,
) -> Option<Contributions> {
    let carried = pressures(model, points, t)?;
    let flux = |p: usize| {
        let pressed = volume[p] * points.F.at(p).determinant() * carried[p];
        K::working(&(Tensor::identity() * pressed))
    };
    Some(transfer::divergence::<K, D>((shape, &points.x), flux))
}

/// J  work of the pressures of the times `t` on the displacements `u` (m, nodal), of every point.
pub fn work<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    (shape, points): (&Shape<D>, &Points<D>),
    volume: &[f64],
    u: &[f64],
    t: [f64; 2],
) -> Option<Vec<[f64; 2]>> {
    let [before, after] = t.map(|t| pressures(model, points, t));
    let (before, after) = (before?, after?);
    let x: &[Vector<D>] = &points.x;
    Some(transfer::gradients::<K, D, _>((shape, x), u, |p, gradient| {
        let dilates = volume[p] * points.F.at(p).determinant() * K::gradient::<f64>(&gradient).trace();
        [before[p] * dilates, after[p] * dilates]
    }))
}

/// N  normal force of pore water on the contact faces of the grid at time `t`, D numbers a node: what a face carries of
/// the total stress without friction. The pressure at a node of a face is that of a linear function along the face's
/// normal, fitted to the points that the node sees, and acts on the area int N dA = |sum_p V div N|. `None` without a
/// face with friction, and without such pressures. Two sums over the ranks for each axis.
pub fn forces_on_faces<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    (shape, points): (&Shape<D>, &Points<D>),
    volume: &[f64],
    t: f64,
    halo: &dyn Halo,
) -> Option<Vec<f64>> {
    let with_friction = |support: &&Support<D>| support.contact.is_some_and(|law| law.friction > 0.0);
    let faces: Vec<&Support<D>> = model.boundary.supports.iter().filter(with_friction).collect();
    let pressures = pressures(model, points, t).or_else(|| excess_pressures(model, points, t));
    // All ranks have the same boundary and water, but not all have points.
    let pressures = pressures.filter(|_| !faces.is_empty())?;
    let weight = |p: usize| volume[p] * points.F.at(p).determinant();
    let areas = |p: usize| K::working(&(Tensor::identity() * weight(p)));
    let areas = halo.sum(&transfer::divergence::<K, D>((shape, &points.x), areas));
    let mut forces = vec![0.0; areas.len()];
    for face in faces {
        let axis = face.axis;
        let moments = |p: usize| {
            let (weight, x, pressure) = (weight(p), points.x[p][axis], pressures[p]);
            [weight, weight * x, weight * x * x, weight * pressure, weight * pressure * x]
        };
        let moments = halo.sum(&transfer::to_nodes(shape, moments));
        let place = if face.upper { model.grid.axes()[axis].length() } else { 0.0 };
        for node in model.grid.face_nodes(axis, face.upper) {
            let pressure = linear_fit(&moments[5 * node..5 * node + 5], place);
            forces[node * D + axis] = (pressure * areas[node * D + axis]).abs();
        }
    }
    Some(forces)
}

/// Value at `x` of the line through weighted points of which `moments` are sum w, w x, w x^2, w y, w x y: their mean
/// where all have one place, 0 without points.
fn linear_fit(moments: &[f64], x: f64) -> f64 {
    let [weight, first, second, value, product] = [0, 1, 2, 3, 4].map(|k| moments[k]);
    if weight <= 0.0 {
        return 0.0;
    }
    let (middle, mean) = (first / weight, value / weight);
    let variance = second / weight - middle * middle;
    let covariance = product / weight - middle * mean;
    let is_spread = variance > 1e-9 * (middle - x).powi(2);
    let slope = if is_spread { covariance / variance } else { 0.0 };
    (mean + slope * (x - middle)).max(0.0)
}

/// Pa  of every point, at time `t`: the share of the weight, as far as gravity has grown; or what the excess that is
/// held presses with. `None` where points carry neither.
fn pressures<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, t: f64) -> Option<Vec<f64>> {
    let shares = points.carried_pressure.as_ref().zip(model.gravity.as_ref());
    if let Some((shares, gravity)) = shares {
        let grown = gravity.grown(t);
        return Some(shares.iter().map(|share| grown * share).collect());
    }
    model.water.as_ref()?.flow.as_ref().filter(|flow| flow.motion == Motion::Held)?;
    excess_pressures(model, points, t)
}

/// Pa  by which pore pressure in the total stress exceeds that of still water, of every point: of water that flows at
/// the start of the step. `None` where none flows.
fn excess_pressures<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    t: f64,
) -> Option<Vec<f64>> {
    let water = model.water.as_ref()?;
    let flow = water.flow.as_ref()?;
    let still = model.still_water(t).filter(|_| flow.retains());
    let of = |p: usize| {
        let x = &points.x[p];
        let Some(soil) = &flow.soils[usize::from(points.material[p])] else { return 0.0 };
        let excess = points.pore_pressure.as_ref().map_or_else(|| water.excess_at_start(x), |excess| excess[p]);
        let whole = if flow.retains() { excess + water.still_pressure(x, t) } else { excess };
        let borne = still.as_ref().map_or(0.0, |still| still.pressure(x));
        soil.retained(whole, water.unit_weight).effective * whole - borne
    };
    Some((0..points.len()).map(of).collect())
}
