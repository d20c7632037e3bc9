//! Axisymmetry without torsion.

use super::{Kinematics, pull_back};
use crate::material::Moduli;
use crate::real::Real;
use crate::tensor::{Square, Symmetric, Tensor, Vector};
use nalgebra::{SMatrix, SVector};

/// Rotational symmetry about the axis r = 0, without torsion. Axis 0 of the grid is r, axis 1 is z. Volumes are those
/// of a sector of one radian. Tensors have the directions r, z and theta; the strain along theta is u_r / r.
#[derive(Clone, Copy, Debug, Default)]
pub struct Axisymmetric;

/// Distance from the axis, in cells, within which points are shifted from the middles of their shares of a cell.
const NEAR: f64 = 4.0;

/// Gradient with the columns r, z and theta, which belong to the slope (dN/dr, dN/dz, N/r). Its element (z, theta) has
/// no meaning and is never read.
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

    /// Returns the components r and z of sum B_a^T D B_b, with B the strains rr, zz, theta theta and rz of a node's
    /// displacement.
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

    /// Returns r, the volume of a sector of one radian per area.
    #[inline]
    fn weight(x: &Vector<2>) -> f64 {
        x[0]
    }

    /// Returns the factor that keeps a uniform stress near equilibrium at the axis.
    ///
    /// Equilibrium requires that the points integrate (r N)', of degree q, over the support of each function. Points in
    /// the middles of n equal shares of a cell of width w miss (w/n)^2/24 times the jump of its derivative over the
    /// cell. For equal cells away from the axis these errors cancel, and they still cancel if they grow linearly with
    /// the radius. The factor makes them do so over the first four cells. The second moment of the points is exact at
    /// the axis, and that of evenly spaced points beyond these cells. The shares of the volume remain r times the area.
    fn spread(axis: usize, [lower, upper]: [f64; 2], n: usize) -> f64 {
        if axis != 0 || n < 2 {
            return 1.0;
        }
        // Evenly spaced points have the second moment w^2/12 (1 - 1/n^2). The factor makes it w^2/12 (1 - missed/n^2),
        // with `missed` growing from 0 to 1.
        let missed = (0.5 * (lower + upper) / (NEAR * (upper - lower))).min(1.0);
        let lattice = (n * n) as f64;
        ((lattice - missed) / (lattice - 1.0)).sqrt()
    }
}
