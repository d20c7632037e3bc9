//! The passes between points and nodes (Eqs 1, 2 and steps 4a, 5a), patch by patch.
//!
//! A patch gathers its (q+1)^D nodal values once, its points work on that small block, and what they scatter is summed
//! in a block before it is added to the nodes: sums over points have one order, whatever the number of ranks a cell has
//! as neighbours. Nodal arrays are flat; contributions of other ranks are not yet in what a scatter leaves.

use super::shape::{Shape, with_width};
use crate::tensor::{Square, Vector};

/// Largest number of nodes of a patch: (3 + 1)^3.
const MOST_NODES: usize = 64;

/// Scatter with shape functions: out_I += sum_p N_Ip value_p (Eq. 2), `C` numbers a point.
pub fn to_nodes<const D: usize, const C: usize>(
    shape: &Shape<D>,
    out: &mut [f64],
    mut value: impl FnMut(usize) -> [f64; C],
) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            let mut block = [[0.0; C]; MOST_NODES];
            for p in patch.points.clone() {
                let (support, value) = (shape.support::<W>(p), value(p));
                for (k, sums) in block[..const { W.pow(D as u32) }].iter_mut().enumerate() {
                    let N = support.value(k);
                    for c in 0..C {
                        sums[c] += N * value[c];
                    }
                }
            }
            add(out, shape.offsets(), patch.first_node, &block);
        }
    });
}

/// Largest value among the points that a node sees: out_I = max(out_I, value_p) over the points with N_Ip > 0.
pub fn largest_to_nodes<const D: usize>(shape: &Shape<D>, out: &mut [f64], value: impl Fn(usize) -> f64) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            for p in patch.points.clone() {
                let (support, value) = (shape.support::<W>(p), value(p));
                for (k, offset) in shape.offsets().iter().enumerate() {
                    if support.value(k) > 0.0 {
                        let at_node = &mut out[patch.first_node + offset];
                        *at_node = at_node.max(value);
                    }
                }
            }
        }
    });
}

/// Gather with shape functions: value_p = sum_I N_Ip nodal_I (Eq. 1), handed to `found`.
pub fn to_points<const D: usize, const C: usize>(
    shape: &Shape<D>,
    nodal: &[f64],
    mut found: impl FnMut(usize, [f64; C]),
) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            let block: [[f64; C]; MOST_NODES] = gather(nodal, shape.offsets(), patch.first_node);
            for p in patch.points.clone() {
                let support = shape.support::<W>(p);
                let mut value = [0.0; C];
                for (k, at_node) in block[..const { W.pow(D as u32) }].iter().enumerate() {
                    let N = support.value(k);
                    for c in 0..C {
                        value[c] += N * at_node[c];
                    }
                }
                found(p, value);
            }
        }
    });
}

/// Gather with gradients: (grad u)_p = sum_I u_I (x) grad N_Ip (step 4a), handed to `found`.
pub fn gradients<const D: usize>(shape: &Shape<D>, u: &[f64], mut found: impl FnMut(usize, Square<D>)) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            let block: [[f64; D]; MOST_NODES] = gather(u, shape.offsets(), patch.first_node);
            for p in patch.points.clone() {
                let support = shape.support::<W>(p);
                let mut gradient = Square::<D>::zeros();
                for (k, at_node) in block[..const { W.pow(D as u32) }].iter().enumerate() {
                    let grad = support.gradient(k);
                    for j in 0..D {
                        for i in 0..D {
                            gradient[(i, j)] += at_node[i] * grad[j];
                        }
                    }
                }
                found(p, gradient);
            }
        }
    });
}

/// Scatter with gradients, the adjoint of [`gradients`]: out_I += sum_p flux_p grad N_Ip (step 5a).
pub fn divergence<const D: usize>(shape: &Shape<D>, out: &mut [f64], mut flux: impl FnMut(usize) -> Square<D>) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            let mut block = [[0.0; D]; MOST_NODES];
            for p in patch.points.clone() {
                let (support, flux) = (shape.support::<W>(p), flux(p));
                for (k, sums) in block[..const { W.pow(D as u32) }].iter_mut().enumerate() {
                    let grad = support.gradient(k);
                    for j in 0..D {
                        for i in 0..D {
                            sums[i] += flux[(i, j)] * grad[j];
                        }
                    }
                }
            }
            add(out, shape.offsets(), patch.first_node, &block);
        }
    });
}

/// Scatter of squared gradients: out_I += sum_p weight_p |grad N_Ip|^2; tells nodes that have stiffness but no mass.
pub fn squared_gradients<const D: usize>(shape: &Shape<D>, out: &mut [f64], weight: impl Fn(usize) -> f64) {
    with_width!(shape.width(), W => {
        for patch in shape.patches() {
            let mut block = [[0.0; 1]; MOST_NODES];
            for p in patch.points.clone() {
                let (support, weight) = (shape.support::<W>(p), weight(p));
                for (k, sum) in block[..const { W.pow(D as u32) }].iter_mut().enumerate() {
                    sum[0] += weight * support.gradient(k).norm_squared();
                }
            }
            add(out, shape.offsets(), patch.first_node, &block);
        }
    });
}

/// Gradients of all nodes of point `p`, for pair sums over a patch.
#[inline]
pub(crate) fn gradients_of<const D: usize>(shape: &Shape<D>, p: usize, out: &mut [Vector<D>]) {
    with_width!(shape.width(), W => {
        let support = shape.support::<W>(p);
        for (k, grad) in out[..const { W.pow(D as u32) }].iter_mut().enumerate() {
            *grad = support.gradient(k);
        }
    });
}

fn gather<const C: usize>(nodal: &[f64], offsets: &[usize], first: usize) -> [[f64; C]; MOST_NODES] {
    let mut block = [[0.0; C]; MOST_NODES];
    for (at_node, offset) in block.iter_mut().zip(offsets) {
        at_node.copy_from_slice(&nodal[(first + offset) * C..(first + offset + 1) * C]);
    }
    block
}

fn add<const C: usize>(nodal: &mut [f64], offsets: &[usize], first: usize, block: &[[f64; C]; MOST_NODES]) {
    for (sums, offset) in block.iter().zip(offsets) {
        let at_node = &mut nodal[(first + offset) * C..(first + offset + 1) * C];
        for (total, sum) in at_node.iter_mut().zip(sums) {
            *total += sum;
        }
    }
}
