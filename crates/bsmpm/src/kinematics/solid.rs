//! Three dimensions.

use super::{Kinematics, determinant, isotropic, pull_back, push_forward, scaled};
use crate::real::Real;
use crate::tensor::{Square, Symmetric, Tensor, Vector};

/// Three dimensions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Solid;

impl Kinematics<3> for Solid {
    type Gradient = Square<3>;

    #[inline(always)]
    fn slope<R: Real>(_N: impl FnOnce() -> R, grad: Vector<3, R>, _x: &Vector<3, R>) -> Vector<3, R> {
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

    #[inline(always)]
    fn jacobian<R: Real>(grad: &Tensor<R>) -> R {
        determinant(&Tensor::from_fn(|i, j| if i == j { grad[(i, j)] + 1.0 } else { grad[(i, j)] }))
    }

    #[inline(always)]
    fn gradient<R: Real>(grad: &Tensor<R>) -> Tensor<R> {
        *grad
    }

    #[inline]
    fn working(tensor: &Tensor) -> Square<3> {
        *tensor
    }

    fn dilation() -> Tensor {
        Tensor::identity() / 3.0
    }

    #[inline(always)]
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> Tensor<R> {
        pull_back(tau, dF)
    }

    #[inline(always)]
    fn push_forward<R: Real>(dF: &Tensor<R>, b_e: &Symmetric<R>) -> Symmetric<R> {
        push_forward(dF, b_e)
    }

    #[inline(always)]
    fn dilate<R: Real>(dF: &Tensor<R>, ratio: R) -> Tensor<R> {
        scaled(dF, ratio.cube_root())
    }
}
