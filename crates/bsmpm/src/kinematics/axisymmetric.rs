//! Axisymmetry without torsion.

use super::{Kinematics, pull_back};
use crate::material::Moduli;
use crate::real::Real;
use crate::tensor::{Square, Symmetric, Tensor, Vector};
use nalgebra::{SMatrix, SVector};

/// Rotational symmetry about the axis r = 0, without torsion: axis 0 of the grid is r, axis 1 is z; of every body a
/// sector of one radian. Tensors have the directions r, z and theta, in which u_r / r stretches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Axisymmetric;

/// Cells from the axis at which points are not in the middles of their shares of a cell.
const NEAR: f64 = 4.0;

/// dN/dr, dN/dz and N/r of a node: columns r, z and theta of a gradient, whose element (z, theta) has no meaning and is
/// nowhere read.
type Strains = SMatrix<f64, 2, 3>;

impl Kinematics<2> for Axisymmetric {
    type Gradient = Strains;

    #[inline(always)]
    fn slope<R: Real>(N: impl FnOnce() -> R, grad: Vector<2, R>, x: &Vector<2, R>) -> SVector<R, 3> {
        SVector::<R, 3>::new(grad[0], grad[1], N() / x[0])
    }

    #[inline]
    fn divergence(slope: &SVector<f64, 3>) -> Vector<2> {
        Vector::<2>::new(slope[0] + slope[2], slope[1])
    }

    /// The rows and columns r, z of sum B_a^T D B_b, B the strains rr, zz, theta theta and rz of a node's displacement.
    #[inline]
    fn stiffness(moment: &SMatrix<f64, 3, 3>, moduli: Moduli) -> Square<2> {
        let Moduli { lambda, mu } = moduli;
        let T = moment;
        Square::<2>::new(
            lambda * (T[(0, 0)] + T[(0, 2)] + T[(2, 0)] + T[(2, 2)])
                + mu * (2.0 * T[(0, 0)] + T[(1, 1)] + 2.0 * T[(2, 2)]),
            lambda * (T[(0, 1)] + T[(2, 1)]) + mu * T[(1, 0)],
            lambda * (T[(1, 0)] + T[(1, 2)]) + mu * T[(0, 1)],
            lambda * T[(1, 1)] + mu * (2.0 * T[(1, 1)] + T[(0, 0)]),
        )
    }

    #[inline(always)]
    fn jacobian<R: Real>(grad: &SMatrix<R, 2, 3>) -> R {
        let in_plane = (grad[(0, 0)] + 1.0) * (grad[(1, 1)] + 1.0) - grad[(0, 1)] * grad[(1, 0)];
        in_plane * (grad[(0, 2)] + 1.0)
    }

    #[inline(always)]
    fn gradient<R: Real>(grad: &SMatrix<R, 2, 3>) -> Tensor<R> {
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
            grad[(0, 2)],
        )
    }

    #[inline(always)]
    fn working<R: Real>(t: &Tensor<R>) -> SMatrix<R, 2, 3> {
        let zero = t[(0, 0)].like(0.0);
        SMatrix::<R, 2, 3>::new(t[(0, 0)], t[(0, 1)], t[(2, 2)], t[(1, 0)], t[(1, 1)], zero)
    }

    fn dilation() -> Tensor {
        Tensor::identity() / 3.0
    }

    #[inline(always)]
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> SMatrix<R, 2, 3> {
        Self::working(&pull_back(tau, dF))
    }

    /// r: the volume of a sector of one radian.
    #[inline]
    fn weight(x: &Vector<2>) -> f64 {
        x[0]
    }

    /// A uniform stress is in equilibrium where the points integrate (r N)', of degree q, over all that a function
    /// reaches. In the middles of equal shares they miss (w/n)^2/24 times the change of its derivative in every cell, w
    /// wide; of even cells off the axis that adds up to nothing, and does so too if it grows in proportion to the
    /// radius. So it does here, from the axis on over four cells, beyond which the points are evenly spaced: off the
    /// middle of a cell by what makes its second moment right, or nearly so. Shares of the volume stay r times the
    /// area.
    fn spread(axis: usize, [lower, upper]: [f64; 2], n: usize) -> f64 {
        if axis != 0 || n < 2 {
            return 1.0;
        }
        let missed = (0.5 * (lower + upper) / (NEAR * (upper - lower))).min(1.0);
        let lattice = (n * n) as f64;
        ((lattice - missed) / (lattice - 1.0)).sqrt()
    }
}
