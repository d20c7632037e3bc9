//! Three dimensions.

use super::{Kinematics, isotropic};
use crate::tensor::{Square, Symmetric, Tensor, Vector};

/// Three dimensions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Solid;

impl Kinematics<3> for Solid {
    type Gradient = Square<3>;

    #[inline]
    fn slope(_N: impl FnOnce() -> f64, grad: Vector<3>, _x: &Vector<3>) -> Vector<3> {
        grad
    }

    #[inline]
    fn divergence(slope: &Vector<3>) -> Vector<3> {
        *slope
    }

    #[inline]
    fn stiffness(moment: &Square<3>, lame: (f64, f64)) -> Square<3> {
        isotropic(moment, lame)
    }

    #[inline]
    fn jacobian(grad: &Square<3>) -> f64 {
        (Square::<3>::identity() + grad).determinant()
    }

    #[inline]
    fn gradient(grad: &Square<3>) -> Tensor {
        *grad
    }

    #[inline]
    fn working(tensor: &Tensor) -> Square<3> {
        *tensor
    }

    fn dilation() -> Tensor {
        Tensor::identity() / 3.0
    }

    #[inline]
    fn flux(tau: &Symmetric, dF: &Tensor) -> Square<3> {
        let inverse = dF.try_inverse().unwrap_or_else(|| Tensor::from_element(f64::NAN));
        tau.full() * inverse.transpose()
    }

    #[inline]
    fn dilate(dF: &Tensor, ratio: f64) -> Tensor {
        dF * ratio.cbrt()
    }
}
