//! Plane strain.

use super::{Kinematics, isotropic};
use crate::material::Moduli;
use crate::real::Real;
use crate::tensor::{Square, Symmetric, Tensor, Vector};
use nalgebra::SMatrix;

/// Plane strain: no displacement and no stretch out of the plane; thickness 1 m.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneStrain;

impl Kinematics<2> for PlaneStrain {
    type Gradient = Square<2>;

    #[inline(always)]
    fn slope<R: Real>(_N: impl FnOnce() -> R, grad: Vector<2, R>, _x: &Vector<2, R>) -> Vector<2, R> {
        grad
    }

    #[inline]
    fn divergence(slope: &Vector<2>) -> Vector<2> {
        *slope
    }

    #[inline]
    fn stiffness(moment: &Square<2>, moduli: Moduli) -> Square<2> {
        isotropic(moment, moduli)
    }

    #[inline(always)]
    fn jacobian<R: Real>(grad: &SMatrix<R, 2, 2>) -> R {
        (grad[(0, 0)] + 1.0) * (grad[(1, 1)] + 1.0) - grad[(1, 0)] * grad[(0, 1)]
    }

    #[inline(always)]
    fn gradient<R: Real>(grad: &SMatrix<R, 2, 2>) -> Tensor<R> {
        let zero = grad[(0, 0)].like(0.0);
        Tensor::new(
            grad[(0, 0)],
            grad[(0, 1)],
            zero,
            grad[(1, 0)],
            grad[(1, 1)],
            zero,
            zero,
            zero,
            zero,
        )
    }

    #[inline(always)]
    fn working<R: Real>(tensor: &Tensor<R>) -> SMatrix<R, 2, 2> {
        SMatrix::<R, 2, 2>::from_fn(|i, j| tensor[(i, j)])
    }

    fn dilation() -> Tensor {
        Tensor::from_diagonal(&[0.5, 0.5, 0.0].into())
    }

    #[inline(always)]
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> SMatrix<R, 2, 2> {
        let [xx, yy, _, xy, ..] = tau.0;
        let a = dF[(0, 0)];
        let b = dF[(0, 1)];
        let c = dF[(1, 0)];
        let d = dF[(1, 1)];
        let inverse = a.like(1.0) / (a * d - b * c);
        SMatrix::<R, 2, 2>::new(
            (xx * d - xy * b) * inverse,
            (xy * a - xx * c) * inverse,
            (xy * d - yy * b) * inverse,
            (yy * a - xy * c) * inverse,
        )
    }

    #[inline(always)]
    fn push_forward<R: Real>(dF: &Tensor<R>, b_e: &Symmetric<R>) -> Symmetric<R> {
        let [xx, yy, zz, xy, ..] = b_e.0;
        let a = dF[(0, 0)];
        let b = dF[(0, 1)];
        let c = dF[(1, 0)];
        let d = dF[(1, 1)];
        let row_x = (a * xx + b * xy, a * xy + b * yy);
        let row_y = (c * xx + d * xy, c * xy + d * yy);
        let normal = dF[(2, 2)] * dF[(2, 2)] * zz;
        let zero = a.like(0.0);
        let along = [row_x.0 * a + row_x.1 * b, row_y.0 * c + row_y.1 * d];
        let across = row_x.0 * c + row_x.1 * d;
        Symmetric([along[0], along[1], normal, across, zero, zero])
    }

    #[inline(always)]
    fn dilate<R: Real>(dF: &Tensor<R>, ratio: R) -> Tensor<R> {
        let root = ratio.root();
        let mut dF_bar = *dF;
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            dF_bar[(i, j)] = dF[(i, j)] * root;
        }
        dF_bar
    }
}
