//! The only place where plane strain, axisymmetry and three dimensions differ: the numbers that a node's function has
//! in a gradient (G), how they become tensors and back (G, G^T), F-bar's exponent, and what a piece of the grid weighs.

mod axisymmetric;
mod plane_strain;
mod solid;

pub use axisymmetric::Axisymmetric;
pub use plane_strain::PlaneStrain;
pub use solid::Solid;

use crate::real::{Real, three};
use crate::tensor::{Square, Symmetric, Tensor, Vector};
use nalgebra::{ArrayStorage, SMatrix, SVector};
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, MulAssign, Sub, SubAssign};

/// How grid fields of dimension `D` become three-dimensional tensors, and back.
pub trait Kinematics<const D: usize>: Copy + Debug + Default + Send + Sync + 'static {
    /// Gradient of a displacement, 1/m of m: a row for each component, a column for each number of a node's function.
    type Gradient: Gradient<D, Of<f64> = Self::Gradient, SlopeOf<f64> = Slope<Self, D>>;

    /// The numbers of a node's function in a gradient, 1/m, of its value `N` and its gradient at `x`.
    fn slope<R: Real>(N: impl FnOnce() -> R, grad: Vector<D, R>, x: &Vector<D, R>) -> SlopeOf<Self, R, D>;

    /// dF = I + grad u, -.
    #[inline(always)]
    fn deformation<R: Real>(grad: &GradientOf<Self, R, D>) -> Tensor<R> {
        let gradient = Self::gradient::<R>(grad);
        Tensor::from_fn(|i, j| gradient[(i, j)] + if i == j { 1.0 } else { 0.0 })
    }

    /// Displacement gradient as a tensor.
    fn gradient<R: Real>(grad: &GradientOf<Self, R, D>) -> Tensor<R>;

    /// dJ = det(I + grad), -; where nothing stretches out of the grid's directions, without them.
    fn jacobian<R: Real>(grad: &GradientOf<Self, R, D>) -> R;

    /// What the grid sees of V0 tau dF^-T: times a node's numbers it is the internal force of a point there (step 5a).
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> GradientOf<Self, R, D>;

    /// dF-bar = (dJ-bar/dJ)^(1/dof) dF (Eq. 15), `ratio` = dJ-bar/dJ > 0; dof are the directions that the grid dilates.
    #[inline(always)]
    fn dilate<R: Real>(dF: &Tensor<R>, ratio: R) -> Tensor<R> {
        let root = ratio.cube_root();
        Tensor::from_fn(|i, j| dF[(i, j)] * root)
    }

    /// The part of a tensor that works on gradients: the adjoint of [`Kinematics::gradient`].
    fn working<R: Real>(tensor: &Tensor<R>) -> GradientOf<Self, R, D>;

    /// Spatial gradient of a unit of d ln(dJ-bar/dJ) under [`Kinematics::dilate`]: I / dof in the grid's directions.
    fn dilation() -> Tensor;

    /// What a unit displacement of a node dilates, 1/m: the trace of its gradient, by component.
    fn divergence(slope: &Slope<Self, D>) -> Vector<D>;

    /// Trial b^e = dF-bar b^e dF-bar^T (Eqs 7, 19).
    #[inline(always)]
    fn push_forward<R: Real>(dF: &Tensor<R>, b_e: &Symmetric<R>) -> Symmetric<R> {
        let [xx, yy, zz, xy, yz, xz] = b_e.0;
        let b = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let row = |i: usize| three(|k| dF[(i, 0)] * b[0][k] + dF[(i, 1)] * b[1][k] + dF[(i, 2)] * b[2][k]);
        let rows = [row(0), row(1), row(2)];
        let at = |i: usize, j: usize| rows[i][0] * dF[(j, 0)] + rows[i][1] * dF[(j, 1)] + rows[i][2] * dF[(j, 2)];
        Symmetric([at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(1, 2), at(0, 2)])
    }

    /// Elastic stiffness of a node pair from T = sum V0 g_a (x) g_b, g their numbers: where these are derivatives,
    /// lambda T + mu T^T + mu tr T I.
    fn stiffness(moment: &Moment<Self, D>, lame: (f64, f64)) -> Square<D>;

    /// Volume at `x` per m^D of the grid: what volumes and areas are multiplied with. Linear in x.
    fn weight(_x: &Vector<D>) -> f64 {
        1.0
    }
}

/// Gradients of a geometry, of one point or of several.
pub type GradientOf<K, R, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Of<R>;
/// The numbers of a node's function in the gradients of a geometry.
pub type Slope<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Slope;
/// The same of one point or of several.
pub type SlopeOf<K, R, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::SlopeOf<R>;
/// Sums over a node pair's numbers.
pub type Moment<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Moment;
/// A linear map of gradients.
pub type Moduli<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Moduli;

/// A matrix of D rows and G columns: gradients of grid fields, and what works on them.
pub trait Gradient<const D: usize>:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Index<(usize, usize), Output = f64>
    + IndexMut<(usize, usize)>
    + Add<Output = Self>
    + Sub<Output = Self>
    + AddAssign
    + SubAssign
    + Mul<f64, Output = Self>
    + MulAssign<f64>
{
    /// G
    const SLOPES: usize;
    /// Zeros of a node.
    const NO_SLOPE: Self::Slope;
    /// Zeros of a pair of nodes.
    const NO_MOMENT: Self::Moment;
    /// G numbers of a node's function.
    type Slope: Copy + Debug + Send + Sync + Index<usize, Output = f64> + Mul<f64, Output = Self::Slope>;
    /// G x G numbers of a pair of nodes.
    type Moment: Copy + Debug + Send + Sync + Index<(usize, usize), Output = f64> + IndexMut<(usize, usize)>;
    /// What every unit gradient makes: element (k, l) that of a unit at (k, l).
    type Moduli: Copy + Debug + Send + Sync + Index<(usize, usize), Output = Self> + IndexMut<(usize, usize)>;

    /// The same of other numbers.
    type Of<R: Real>: Copy + Index<(usize, usize), Output = R> + IndexMut<(usize, usize)>;
    /// A node's numbers of other numbers.
    type SlopeOf<R: Real>: Copy + Index<usize, Output = R>;

    /// Every element by its row and column, of any numbers.
    fn of<R: Real>(element: impl FnMut(usize, usize) -> R) -> Self::Of<R>;

    /// All elements the same.
    fn from_element(value: f64) -> Self;

    /// Every element by its row and column.
    fn from_fn(element: impl FnMut(usize, usize) -> f64) -> Self;

    /// The map that makes these of unit gradients.
    fn moduli(unit: impl FnMut(usize, usize) -> Self) -> Self::Moduli;

    /// Sum of the products of all elements.
    fn dot(&self, other: &Self) -> f64;

    /// The matrix times a node's numbers.
    fn times(&self, slope: &Self::Slope) -> Vector<D>;

    /// Zeros.
    #[inline]
    fn zeros() -> Self {
        Self::from_element(0.0)
    }

    /// 1 at one element, 0 elsewhere.
    #[inline]
    fn unit(row: usize, column: usize) -> Self {
        let mut unit = Self::zeros();
        unit[(row, column)] = 1.0;
        unit
    }
}

impl<const D: usize, const G: usize> Gradient<D> for SMatrix<f64, D, G> {
    const SLOPES: usize = G;
    const NO_SLOPE: Self::Slope = SVector::from_array_storage(ArrayStorage([[0.0; G]]));
    const NO_MOMENT: Self::Moment = SMatrix::from_array_storage(ArrayStorage([[0.0; G]; G]));
    type Slope = SVector<f64, G>;
    type Moment = SMatrix<f64, G, G>;
    type Moduli = SMatrix<Self, D, G>;
    type Of<R: Real> = SMatrix<R, D, G>;
    type SlopeOf<R: Real> = SVector<R, G>;

    #[inline(always)]
    fn of<R: Real>(element: impl FnMut(usize, usize) -> R) -> SMatrix<R, D, G> {
        SMatrix::from_fn(element)
    }

    #[inline]
    fn from_element(value: f64) -> Self {
        Self::from_element(value)
    }

    #[inline]
    fn from_fn(element: impl FnMut(usize, usize) -> f64) -> Self {
        Self::from_fn(element)
    }

    #[inline]
    fn moduli(unit: impl FnMut(usize, usize) -> Self) -> Self::Moduli {
        SMatrix::from_fn(unit)
    }

    #[inline]
    fn dot(&self, other: &Self) -> f64 {
        self.dot(other)
    }

    #[inline]
    fn times(&self, slope: &Self::Slope) -> Vector<D> {
        self * slope
    }
}

/// lambda T + mu T^T + mu tr T I, T = sum V0 grad N_a (x) grad N_b.
#[inline]
fn isotropic<const D: usize>(moment: &Square<D>, (lambda, mu): (f64, f64)) -> Square<D> {
    moment * lambda + moment.transpose() * mu + Square::<D>::identity() * (mu * moment.trace())
}

/// tau dF^-T.
#[inline(always)]
fn pull_back<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> Tensor<R> {
    let [xx, yy, zz, xy, yz, xz] = tau.0;
    let tau = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let at = |i: usize, j: usize| dF[(i % 3, j % 3)];
    // Cofactors of dF: its inverse is their transpose over the determinant.
    let cofactor = |i: usize, j: usize| at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1);
    let inverse = at(0, 0).like(1.0) / determinant(dF);
    let element =
        |i: usize, j: usize| tau[i][0] * cofactor(0, j) + tau[i][1] * cofactor(1, j) + tau[i][2] * cofactor(2, j);
    Tensor::from_fn(|i, j| element(i, j) * inverse)
}

/// det F.
#[inline(always)]
fn determinant<R: Real>(F: &Tensor<R>) -> R {
    let minor = |i: usize, j: usize| F[(1, i)] * F[(2, j)] - F[(2, i)] * F[(1, j)];
    F[(0, 0)] * minor(1, 2) - F[(0, 1)] * minor(0, 2) + F[(0, 2)] * minor(0, 1)
}
