//! Vectors with the grid's dimension, and tensors, which are always three-dimensional.

use nalgebra::{Matrix3, SMatrix, SVector};

/// Vector of the grid's dimension.
pub type Vector<const D: usize, R = f64> = SVector<R, D>;
/// Square matrix of the grid's dimension, for gradients of grid fields.
pub type Square<const D: usize> = SMatrix<f64, D, D>;
/// Second-order tensor, three-dimensional in all geometries.
pub type Tensor<R = f64> = Matrix3<R>;

/// Symmetric tensor with the components XX, YY, ZZ, XY, YZ, XZ, in the order of ParaView.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Symmetric<R = f64>(pub [R; 6]);

impl Symmetric {
    /// Identity tensor.
    pub const IDENTITY: Self = Self([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);

    /// Returns the symmetric part of `t`.
    #[inline]
    pub fn of(t: &Tensor) -> Self {
        let [xy, yz, xz] = [(0, 1), (1, 2), (0, 2)].map(|(i, j)| 0.5 * (t[(i, j)] + t[(j, i)]));
        Self([t[(0, 0)], t[(1, 1)], t[(2, 2)], xy, yz, xz])
    }

    /// Returns the tensor as a full matrix.
    #[inline]
    pub fn full(&self) -> Tensor {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        Tensor::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// Returns the double contraction `a : b`.
    #[inline]
    pub fn double_dot(&self, other: &Self) -> f64 {
        let [xx, yy, zz, xy, yz, xz] = std::array::from_fn(|i| self.0[i] * other.0[i]);
        let normal = xx + yy + zz;
        let shear = xy + yz + xz;
        normal + 2.0 * shear
    }

    /// Returns the tensor multiplied by `factor`.
    #[inline]
    pub fn scaled(&self, factor: f64) -> Self {
        Self(self.0.map(|c| c * factor))
    }
}
