//! Pore pressure at a position, theory-manual equation (T8.14), for the effective normal force of friction (T7.2).

use crate::grid::{Shape, transfer};
use crate::parallel::Halo;
use crate::tensor::Vector;
use std::ops::Range;

/// Pore pressure at the nodes: linear along each axis, fitted to the points in the support of the node.
#[derive(Clone, Debug)]
pub struct PorePressure<const D: usize> {
    moments: Vec<f64>, // per node sum w, sum w p, and per axis sum w x, sum w x^2, sum w p x
}

impl<const D: usize> PorePressure<D> {
    const WIDTH: usize = 2 + 3 * D;

    /// Fits the pressures at all nodes to the points at `places` (m, from the lower corner of the grid) with `weights`
    /// (m^D) and `pressures` (Pa). One exchange with the neighbours.
    pub fn fitted(shape: &Shape<D>, places: &[Vector<D>], weights: &[f64], pressures: &[f64], halo: &dyn Halo) -> Self {
        let moments = match D {
            2 => transfer::to_nodes(shape, |p| moments_of::<D, 8>(weights[p], &places[p], pressures[p])),
            _ => transfer::to_nodes(shape, |p| moments_of::<D, 11>(weights[p], &places[p], pressures[p])),
        };
        Self {
            moments: halo.assemble_ghosts(&moments),
        }
    }

    /// Returns the pressure at `x` (m, from the lower corner of the grid) from the fit of a node, linear along the
    /// given axes and constant along the others (Pa).
    pub(super) fn of_node(&self, node: usize, axes: Range<usize>, x: &Vector<D>) -> f64 {
        let moments = &self.moments[Self::WIDTH * node..][..Self::WIDTH];
        let weight = moments[0];
        let value = moments[1];
        if weight <= 0.0 {
            return 0.0;
        }
        let rises = axes.map(|axis| {
            let [first, second, product] = [0, 1, 2].map(|k| moments[2 + 3 * axis + k] / weight);
            rise([first, second, value / weight, product], x[axis])
        });
        (value / weight + rises.sum::<f64>()).max(0.0)
    }

    /// Returns the weighted mean of the nodal fits at `x` (m, from the lower corner of the grid) (Pa).
    pub fn at(&self, weights: impl Iterator<Item = (usize, f64)>, x: &Vector<D>) -> f64 {
        let mut sum = 0.0;
        let mut whole = 0.0;
        for (node, weight) in weights.filter(|(node, _)| self.moments[Self::WIDTH * node] > 0.0) {
            sum += weight * self.of_node(node, 0..D, x);
            whole += weight;
        }
        if whole > 0.0 { (sum / whole).max(0.0) } else { 0.0 }
    }
}

/// Returns the contribution of a point to the N = 2 + 3 D moments of a node.
fn moments_of<const D: usize, const N: usize>(weight: f64, x: &Vector<D>, pressure: f64) -> [f64; N] {
    let mut moments = [0.0; N];
    moments[..2].copy_from_slice(&[weight, weight * pressure]);
    for (moments, x) in moments[2..].chunks_exact_mut(3).zip(x) {
        moments.copy_from_slice(&[weight * x, weight * x * x, weight * pressure * x]);
    }
    moments
}

/// Returns the regression line at `x` less the mean value, from the weighted means of x, x^2, y and x y (`moments`). It
/// is 0 if all points have the same position.
fn rise([middle, second, mean, product]: [f64; 4], x: f64) -> f64 {
    let variance = second - middle * middle;
    let covariance = product - middle * mean;
    let is_spread = variance > 1e-9 * (middle - x).powi(2);
    if is_spread {
        covariance / variance * (x - middle)
    } else {
        0.0
    }
}
