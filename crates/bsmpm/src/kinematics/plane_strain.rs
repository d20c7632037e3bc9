//! Plane strain.

use super::{Kinematics, isotropic};
use crate::tensor::{Square, Symmetric, Tensor, Vector};

/// Plane strain: no displacement and no stretch out of the plane; 1 m thick.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneStrain;

impl Kinematics<2> for PlaneStrain {
    type Gradient = Square<2>;

    #[inline]
    fn slope(_N: impl FnOnce() -> f64, grad: Vector<2>, _x: &Vector<2>) -> Vector<2> {
        grad
    }

    #[inline]
    fn divergence(slope: &Vector<2>) -> Vector<2> {
        *slope
    }

    #[inline]
    fn stiffness(moment: &Square<2>, lame: (f64, f64)) -> Square<2> {
        isotropic(moment, lame)
    }

    #[inline]
    fn jacobian(grad: &Square<2>) -> f64 {
        (Square::<2>::identity() + grad).determinant()
    }

    #[inline]
    fn gradient(grad: &Square<2>) -> Tensor {
        Tensor::new(grad[(0, 0)], grad[(0, 1)], 0.0, grad[(1, 0)], grad[(1, 1)], 0.0, 0.0, 0.0, 0.0)
    }

    #[inline]
    fn working(tensor: &Tensor) -> Square<2> {
        tensor.fixed_view::<2, 2>(0, 0).into_owned()
    }

    fn dilation() -> Tensor {
        Tensor::from_diagonal(&[0.5, 0.5, 0.0].into())
    }

    #[inline]
    fn flux(tau: &Symmetric, dF: &Tensor) -> Square<2> {
        let [xx, yy, _, xy, ..] = tau.0;
        let (a, b, c, d) = (dF[(0, 0)], dF[(0, 1)], dF[(1, 0)], dF[(1, 1)]);
        let inverse = 1.0 / (a * d - b * c);
        Square::<2>::new(
            (xx * d - xy * b) * inverse,
            (xy * a - xx * c) * inverse,
            (xy * d - yy * b) * inverse,
            (yy * a - xy * c) * inverse,
        )
    }

    #[inline]
    fn push_forward(dF: &Tensor, b_e: &Symmetric) -> Symmetric {
        let [xx, yy, zz, xy, ..] = b_e.0;
        let (a, b, c, d) = (dF[(0, 0)], dF[(0, 1)], dF[(1, 0)], dF[(1, 1)]);
        let (row_x, row_y) = ((a * xx + b * xy, a * xy + b * yy), (c * xx + d * xy, c * xy + d * yy));
        let normal = dF[(2, 2)] * dF[(2, 2)] * zz;
        Symmetric([row_x.0 * a + row_x.1 * b, row_y.0 * c + row_y.1 * d, normal, row_x.0 * c + row_x.1 * d, 0.0, 0.0])
    }

    #[inline]
    fn dilate(dF: &Tensor, ratio: f64) -> Tensor {
        let root = ratio.sqrt();
        let mut dF_bar = *dF;
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            dF_bar[(i, j)] *= root;
        }
        dF_bar
    }
}
