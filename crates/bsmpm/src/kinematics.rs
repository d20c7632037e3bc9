//! The only place where plane strain, axisymmetry and three dimensions differ: G, G^T and F-bar's exponent.

use crate::tensor::{Square, Symmetric, Tensor};

/// How grid fields of dimension `D` become three-dimensional tensors, and back.
pub trait Kinematics<const D: usize>: Copy + Default + Send + Sync + 'static {
    /// Displacement gradient as a tensor, from the in-plane gradient du_i/dx_j.
    fn gradient(grad: &Square<D>) -> Tensor;

    /// dJ = det(I + grad), -; out of the grid's directions nothing stretches.
    fn jacobian(grad: &Square<D>) -> f64;

    /// In-plane part of V0 tau dF^-T: times grad N_I it is the internal force of a point at node I (step 5a).
    fn flux(tau: &Symmetric, dF: &Tensor) -> Square<D>;

    /// dF-bar = (dJ-bar/dJ)^(1/dof) dF (Eq. 15), `ratio` = dJ-bar/dJ > 0; dof are the directions that the grid dilates.
    fn dilate(dF: &Tensor, ratio: f64) -> Tensor;

    /// The part of a tensor that works on in-plane gradients: the adjoint of [`Kinematics::gradient`].
    fn in_plane(tensor: &Tensor) -> Square<D>;

    /// Spatial gradient of a unit of d ln(dJ-bar/dJ) under [`Kinematics::dilate`]: I / dof in the grid's directions.
    fn dilation() -> Tensor;

    /// Trial b^e = dF-bar b^e dF-bar^T (Eqs 7, 19).
    fn push_forward(dF: &Tensor, b_e: &Symmetric) -> Symmetric {
        Symmetric::of(&(dF * b_e.full() * dF.transpose()))
    }

    /// Elastic stiffness of a node pair from T = sum V0 grad N_a (x) grad N_b: lambda T + mu T^T + mu tr T I.
    fn stiffness(moment: &Square<D>, (lambda, mu): (f64, f64)) -> Square<D> {
        moment * lambda + moment.transpose() * mu + Square::<D>::identity() * (mu * moment.trace())
    }
}

/// Plane strain: no displacement and no stretch out of the plane; 1 m thick.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneStrain;

impl Kinematics<2> for PlaneStrain {
    #[inline]
    fn jacobian(grad: &Square<2>) -> f64 {
        (Square::<2>::identity() + grad).determinant()
    }

    #[inline]
    fn gradient(grad: &Square<2>) -> Tensor {
        Tensor::new(grad[(0, 0)], grad[(0, 1)], 0.0, grad[(1, 0)], grad[(1, 1)], 0.0, 0.0, 0.0, 0.0)
    }

    #[inline]
    fn in_plane(tensor: &Tensor) -> Square<2> {
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

/// Three dimensions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Solid;

impl Kinematics<3> for Solid {
    #[inline]
    fn jacobian(grad: &Square<3>) -> f64 {
        (Square::<3>::identity() + grad).determinant()
    }

    #[inline]
    fn gradient(grad: &Square<3>) -> Tensor {
        *grad
    }

    #[inline]
    fn in_plane(tensor: &Tensor) -> Square<3> {
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
