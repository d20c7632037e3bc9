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

/// Pore pressure that the soil carries, of every node: a function of the place, from which all friction takes the part
/// of normal forces that water carries. Along each axis it is linear, fitted to the points that the node sees.
#[derive(Clone, Debug)]
pub struct PorePressure<const D: usize> {
    moments: Vec<f64>, // per node sum w, sum w p, and for each axis sum w x, sum w x^2, sum w p x
}

impl<const D: usize> PorePressure<D> {
    const WIDTH: usize = 2 + 3 * D;

    /// Of all nodes at time `t`; `volume` (m^D) is what points weigh in integrals of the stress. `None` where nothing
    /// has friction, and where points carry no such pressure. A sum over the ranks.
    pub fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        (shape, points): (&Shape<D>, &Points<D>),
        volume: &[f64],
        t: f64,
        halo: &dyn Halo,
    ) -> Option<Self> {
        // All ranks have the same boundary and water, but not all have points.
        if !model.boundary.has_friction() {
            return None;
        }
        let pressures = pressures(model, points, t).or_else(|| excess_pressures(model, points, t))?;
        let moments = |p: usize| moments_of(weight(points, volume, p), &points.x[p], pressures[p]);
        let moments = match D {
            2 => halo.sum(&transfer::to_nodes(shape, |p| -> [f64; 8] { padded(&moments(p)) })),
            _ => halo.sum(&transfer::to_nodes(shape, |p| -> [f64; 11] { padded(&moments(p)) })),
        };
        Some(Self { moments })
    }

    /// Pa  at `x` (m, from the grid's lower corner), by the function of a node in the given axes; along the others it
    /// is that of the middle of what the node sees.
    fn of_node(&self, node: usize, axes: std::ops::Range<usize>, x: &Vector<D>) -> f64 {
        let moments = &self.moments[Self::WIDTH * node..][..Self::WIDTH];
        let (weight, value) = (moments[0], moments[1]);
        if weight <= 0.0 {
            return 0.0;
        }
        let along = |axis: usize| {
            let [first, second, product] = [0, 1, 2].map(|k| moments[2 + 3 * axis + k] / weight);
            rise([first, second, value / weight, product], x[axis])
        };
        (value / weight + axes.map(along).sum::<f64>()).max(0.0)
    }

    /// Pa  at `x` (m, from the grid's lower corner), the mean by `weights` of what nodes have there.
    pub fn at(&self, weights: impl Iterator<Item = (usize, f64)>, x: &Vector<D>) -> f64 {
        let (mut sum, mut whole) = (0.0, 0.0);
        for (node, weight) in weights.filter(|(node, _)| self.moments[Self::WIDTH * node] > 0.0) {
            sum += weight * self.of_node(node, 0..D, x);
            whole += weight;
        }
        if whole > 0.0 { (sum / whole).max(0.0) } else { 0.0 }
    }

    /// N  normal force of pore water on the contact faces of the grid, D numbers a node: what a face carries of the
    /// total stress without friction. It acts on the area int N dA = |sum_p V div N|. A sum over the ranks.
    pub fn forces_on_faces<K: Kinematics<D>>(
        &self,
        model: &Model<K, D>,
        (shape, points): (&Shape<D>, &Points<D>),
        volume: &[f64],
        halo: &dyn Halo,
    ) -> Vec<f64> {
        let areas = |p: usize| K::working(&(Tensor::identity() * weight(points, volume, p)));
        let areas = halo.sum(&transfer::divergence::<K, D>((shape, &points.x), areas));
        let mut forces = vec![0.0; areas.len()];
        let with_friction = |support: &&Support<D>| support.contact.is_some_and(|law| law.friction > 0.0);
        for face in model.boundary.supports.iter().filter(with_friction) {
            let axis = face.axis;
            let place = if face.upper { model.grid.axes()[axis].length() } else { 0.0 };
            for node in model.grid.face_nodes(axis, face.upper) {
                let pressure = self.of_node(node, axis..axis + 1, &Vector::repeat(place));
                forces[node * D + axis] = (pressure * areas[node * D + axis]).abs();
            }
        }
        forces
    }
}

/// m^D  volume of a point as it is deformed.
fn weight<const D: usize>(points: &Points<D>, volume: &[f64], p: usize) -> f64 {
    volume[p] * points.F.at(p).determinant()
}

/// What a point adds to the moments of a node.
fn moments_of<const D: usize>(weight: f64, x: &Vector<D>, pressure: f64) -> Vec<f64> {
    let along = x.iter().flat_map(|x| [weight * x, weight * x * x, weight * pressure * x]);
    [weight, weight * pressure].into_iter().chain(along).collect()
}

fn padded<const N: usize>(numbers: &[f64]) -> [f64; N] {
    std::array::from_fn(|k| numbers[k])
}

/// By how much the line through weighted points is higher at `x` than their mean: of `moments` per weight of x, x^2, y
/// and x y. 0 where all have one place.
fn rise([middle, second, mean, product]: [f64; 4], x: f64) -> f64 {
    let variance = second - middle * middle;
    let covariance = product - middle * mean;
    let is_spread = variance > 1e-9 * (middle - x).powi(2);
    if is_spread { covariance / variance * (x - middle) } else { 0.0 }
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
