//! Three dimensions.

use super::{Kinematics, determinant, isotropic, plus_identity, pull_back};
use crate::material::Moduli;
use crate::real::Real;
use crate::tensor::{Square, Symmetric, Tensor, Vector};

/// Three-dimensional geometry.
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
    fn stiffness(moment: &Square<3>, moduli: Moduli) -> Square<3> {
        isotropic(moment, moduli)
    }

    #[inline(always)]
    fn jacobian<R: Real>(grad: &Tensor<R>) -> R {
        determinant(&plus_identity(grad))
    }

    #[inline(always)]
    fn gradient<R: Real>(grad: &Tensor<R>) -> Tensor<R> {
        *grad
    }

    #[inline(always)]
    fn working<R: Real>(tensor: &Tensor<R>) -> Tensor<R> {
        *tensor
    }

    fn dilation() -> Tensor {
        Tensor::identity() / 3.0
    }

    #[inline(always)]
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> Tensor<R> {
        pull_back(tau, dF)
    }
}
