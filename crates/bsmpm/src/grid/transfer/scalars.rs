//! Transfers of pore pressure and its gradient on splines of one degree below the grid's.

use super::{MOST_NODES, PatchBlock, at_points, gather, scatter};
use crate::grid::shape::with_width;
use crate::grid::{Contributions, Shape};
use crate::stabilisation::GroupedPoints;
use crate::tensor::Vector;

/// Largest number of functions at a point: quadratic splines in three dimensions.
pub const MOST_FUNCTIONS: usize = 27;

/// Computes p_p = sum_h A_hp p_h and grad p_p = sum_h p_h grad A_hp at every point, and returns `found(p, p_p, grad
/// p_p)`.
pub fn scalars<const D: usize, T: Clone + Send>(
    shape: &Shape<D>,
    nodal: &[f64],
    found: impl Fn(usize, f64, Vector<D>) -> T + Sync,
) -> Vec<T> {
    let scratch = [[0.0; 1]; MOST_NODES];
    type Block = PatchBlock<1>;
    with_width!(shape.width(), W => at_points(shape, scratch, |number, block: &mut Block, out: &mut Vec<T>| {
        let patch = &shape.patches()[number];
        gather(nodal, shape.offsets(), patch.first_node, 0, 1, block);
        for p in patch.points.clone() {
            let support = shape.support::<W>(p);
            let mut value = 0.0;
            let mut gradient = Vector::zeros();
            for (k, [at_node]) in block[..const { W.pow(D as u32) }].iter().enumerate() {
                value += support.value(k) * at_node;
                gradient += support.gradient(k) * *at_node;
            }
            out.push(found(p, value, gradient));
        }
    }))
}

/// Computes sum_p A_hp value_p + grad A_hp . flux_p at the nodes, the adjoint of [`scalars`], `C` such sums per node.
pub fn of_scalars<const D: usize, const C: usize>(
    shape: &Shape<D>,
    of_point: impl Fn(usize) -> [(f64, Vector<D>); C] + Sync,
) -> Contributions {
    with_width!(shape.width(), W => scatter(shape, GroupedPoints::ONE_GROUP, |points, block: &mut PatchBlock<C>| {
        for p in points {
            let support = shape.support::<W>(p);
            let of_point = of_point(p);
            for (k, sums) in block[..const { W.pow(D as u32) }].iter_mut().enumerate() {
                let value = support.value(k);
                let gradient = support.gradient(k);
                for (sum, (of_value, flux)) in sums.iter_mut().zip(&of_point) {
                    *sum += value * of_value + gradient.dot(flux);
                }
            }
        }
    }))
}

/// Function of degree q - 1 at a point.
#[derive(Clone, Copy)]
pub struct FunctionAtPoint<const D: usize> {
    /// Value A_hp (-).
    pub value: f64,
    /// Gradient grad A_hp (1/m).
    pub gradient: Vector<D>,
}

impl<const D: usize> FunctionAtPoint<D> {
    /// Returns a function that is zero at the point.
    pub fn zero() -> Self {
        Self {
            value: 0.0,
            gradient: Vector::zeros(),
        }
    }
}

/// Writes every function of point `p` to `out`, for sums over pairs of functions of a patch. Returns their number.
pub fn functions_of<const D: usize>(shape: &Shape<D>, p: usize, out: &mut [FunctionAtPoint<D>]) -> usize {
    with_width!(shape.width(), W => {
        let support = shape.support::<W>(p);
        let count = const { W.pow(D as u32) };
        for (k, function) in out[..count].iter_mut().enumerate() {
            *function = FunctionAtPoint { value: support.value(k), gradient: support.gradient(k) };
        }
        count
    })
}
