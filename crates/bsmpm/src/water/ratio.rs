//! Pore pressure that points carry: a share r_u of the weight above them at the start.

use crate::grid::{Contributions, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};

/// N  what the pressure does to the nodes: sum_p V0 J p div N_Ip by the place at the start of the step, as far as
/// gravity has grown at time `t`; `volume` (m^D) is what points weigh in integrals of the stress.
pub fn force<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    (shape, points): (&Shape<D>, &Points<D>),
    volume: &[f64],
    t: f64,
) -> Option<Contributions> {
    let carried = points.carried_pressure.as_ref()?;
    let grown = model.gravity.as_ref()?.grown(t);
    let flux = |p: usize| {
        let pressed = grown * volume[p] * points.F.at(p).determinant() * carried[p];
        K::working(&(Tensor::identity() * pressed))
    };
    Some(transfer::divergence::<K, D>((shape, &points.x), flux))
}

/// J  work of the full pressure on the displacements `u` (m, nodal), of every point.
pub fn work<K: Kinematics<D>, const D: usize>(
    (shape, points): (&Shape<D>, &Points<D>),
    volume: &[f64],
    u: &[f64],
) -> Option<Vec<f64>> {
    let carried = points.carried_pressure.as_ref()?;
    let x: &[Vector<D>] = &points.x;
    Some(transfer::gradients::<K, D, _>((shape, x), u, |p, gradient| {
        volume[p] * points.F.at(p).determinant() * carried[p] * K::gradient::<f64>(&gradient).trace()
    }))
}
