//! Transfers and gradients for the material points of one cell, compiled for each SIMD instruction set.

use super::PatchBlock;
use crate::grid::shape::PointSupport;
use crate::kinematics::{Gradient, Kinematics};
use crate::lanes::{InLanes, Quad, Simd};
use crate::tensor::Vector;
use std::marker::PhantomData;
use std::ops::Range;

/// Largest number of rows of nodes along the last axis of a patch: 4 x 4 in three dimensions.
const MOST_ROWS: usize = 16;

/// Appends to `out` what `found` returns for the gradient at each point of a patch.
pub(super) struct Gradients<'a, K: Kinematics<D>, F, T, const D: usize, const W: usize> {
    pub rows: &'a [f64],
    pub x: &'a [Vector<D>],
    pub points: Range<usize>,
    pub block: &'a PatchBlock<D>,
    pub found: &'a F,
    pub out: &'a mut Vec<T>,
    pub kinematics: PhantomData<K>,
}

impl<K, F, T, const D: usize, const W: usize> InLanes for Gradients<'_, K, F, T, D, W>
where
    K: Kinematics<D>,
    F: Fn(usize, K::Gradient) -> T,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) {
        let size = 2 * D * W;
        for p in self.points {
            let support = PointSupport::<D, W> {
                rows: &self.rows[p * size..(p + 1) * size],
            };
            let mut gradient = K::Gradient::zeros();
            for (k, at_node) in self.block[..const { W.pow(D as u32) }].iter().enumerate() {
                let slope = K::slope::<f64>(|| support.value(k), support.gradient(k), &self.x[p]);
                for j in 0..K::Gradient::SLOPES {
                    for i in 0..D {
                        gradient[(i, j)] += at_node[i] * slope[j];
                    }
                }
            }
            self.out.push((self.found)(p, gradient));
        }
    }
}

/// Sums the fluxes of a patch's points to `block`, point by point.
pub(super) struct Divergence<'a, K: Kinematics<D>, const D: usize, const W: usize> {
    pub rows: &'a [f64],
    pub x: &'a [Vector<D>],
    pub points: Range<usize>,
    pub fluxes: &'a [K::Gradient],
    pub block: &'a mut PatchBlock<D>,
}

impl<K: Kinematics<D>, const D: usize, const W: usize> InLanes for Divergence<'_, K, D, W> {
    type Output = ();

    /// Each SIMD vector has the (up to four) nodes of one row along the last axis. With fewer than four nodes, the
    /// remaining lanes collect sums that are not used.
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let size = 2 * D * W;
        let mut sums = [[Quad::splat(simd, 0.0); D]; MOST_ROWS];
        let sums = &mut sums[..const { W.pow(D as u32 - 1) }];
        for (p, flux) in self.points.zip(self.fluxes) {
            let rows = &self.rows[p * size..];
            let x = Vector::from_fn(|i, _| Quad::splat(simd, self.x[p][i]));
            let last = [0, W].map(|derivative| Quad::first_of(simd, &rows[2 * W * (D - 1) + derivative..]));
            // Row k of nodes has the indices of the first D - 1 axes as its digits in base W, axis 0 first.
            // `along(axis, 1)` is the derivative of the factor of `axis`, so `product(i)` is component i of the
            // gradient, and `product(D)` the value.
            for (k, sums) in sums.iter_mut().enumerate() {
                let along = |axis: usize, derivative: usize| {
                    if axis == D - 1 {
                        return last[derivative];
                    }
                    let a = k / W.pow((D - 2 - axis) as u32) % W;
                    Quad::splat(simd, rows[2 * W * axis + W * derivative + a])
                };
                let product = |component: usize| {
                    let mut product = along(0, usize::from(component == 0));
                    for axis in 1..D {
                        product = product * along(axis, usize::from(component == axis));
                    }
                    product
                };
                let slope = K::slope(|| product(D), Vector::from_fn(|component, _| product(component)), &x);
                for j in 0..K::Gradient::SLOPES {
                    for i in 0..D {
                        sums[i] = sums[i] + slope[j] * flux[(i, j)];
                    }
                }
            }
        }
        spread::<S, D, W>(sums, self.block);
    }
}

/// Sums the values of a patch's points to `block`, point by point.
pub(super) struct PatchSums<'a, const D: usize, const C: usize, const W: usize> {
    pub rows: &'a [f64],
    pub stride: usize,
    pub points: Range<usize>,
    pub values: &'a [[f64; C]],
    pub block: &'a mut PatchBlock<C>,
}

impl<const D: usize, const C: usize, const W: usize> InLanes for PatchSums<'_, D, C, W> {
    type Output = ();

    /// Each SIMD vector has the nodes of one row along the last axis, as in [`Divergence`].
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut sums = [[Quad::splat(simd, 0.0); C]; MOST_ROWS];
        let sums = &mut sums[..const { W.pow(D as u32 - 1) }];
        for (p, value) in self.points.zip(self.values) {
            let rows = &self.rows[p * D * self.stride..];
            let last = Quad::first_of(simd, &rows[(D - 1) * self.stride..]);
            for (k, sums) in sums.iter_mut().enumerate() {
                let mut others = 1.0;
                for axis in 0..D - 1 {
                    others *= rows[axis * self.stride + k / W.pow((D - 2 - axis) as u32) % W];
                }
                let N = last * others;
                for c in 0..C {
                    sums[c] = sums[c] + N * value[c];
                }
            }
        }
        spread::<S, C, W>(sums, self.block);
    }
}

/// Writes rows of sums to the positions of their nodes in `block`.
#[inline(always)]
fn spread<S: Simd, const C: usize, const W: usize>(sums: &[[Quad<S>; C]], block: &mut PatchBlock<C>) {
    for (k, sums) in sums.iter().enumerate() {
        let numbers: [[f64; 4]; C] = std::array::from_fn(|i| sums[i].numbers());
        for (b, at_node) in block[W * k..W * (k + 1)].iter_mut().enumerate() {
            (0..C).for_each(|i| at_node[i] = numbers[i][b]);
        }
    }
}
