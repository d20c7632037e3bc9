//! Shape functions of one material point at the nodes of its cell, as products over the axes.

use crate::tensor::Vector;

/// Shape function values of one point: D rows of W numbers.
#[derive(Clone, Copy)]
pub(crate) struct Values<'a, const D: usize, const W: usize> {
    pub(super) rows: &'a [f64],
    pub(super) stride: usize,
}

impl<const D: usize, const W: usize> Values<'_, D, W> {
    /// Returns N_Ip of local node `k`, the product of one value per axis.
    #[inline(always)]
    pub fn value(&self, k: usize) -> f64 {
        let mut product = 1.0;
        for axis in 0..D {
            product *= self.rows[self.stride * axis + k / W.pow((D - 1 - axis) as u32) % W];
        }
        product
    }
}

/// Shape functions of one point: D rows of W values and W derivatives (1/m).
#[derive(Clone, Copy)]
pub(crate) struct PointSupport<'a, const D: usize, const W: usize> {
    pub rows: &'a [f64],
}

impl<const D: usize, const W: usize> PointSupport<'_, D, W> {
    /// Returns the index of local node `k` along `axis`.
    #[inline(always)]
    fn along(k: usize, axis: usize) -> usize {
        k / W.pow((D - 1 - axis) as u32) % W
    }

    /// Returns N_Ip of local node `k`.
    #[inline(always)]
    pub fn value(&self, k: usize) -> f64 {
        let mut product = self.rows[Self::along(k, 0)];
        for axis in 1..D {
            product *= self.rows[2 * W * axis + Self::along(k, axis)];
        }
        product
    }

    /// Returns grad N_Ip of local node `k` (1/m).
    #[inline(always)]
    pub fn gradient(&self, k: usize) -> Vector<D> {
        Vector::from_fn(|component, _| {
            let mut product = self.factor(k, 0, component);
            for axis in 1..D {
                product *= self.factor(k, axis, component);
            }
            product
        })
    }

    /// Returns the factor along `axis` in a component of the gradient: the derivative if `axis` is the component, else
    /// the value.
    #[inline(always)]
    fn factor(&self, k: usize, axis: usize, component: usize) -> f64 {
        let a = 2 * W * axis + Self::along(k, axis);
        self.rows[if component == axis { a + W } else { a }]
    }
}
