//! Geometries: plane strain, axisymmetry and 3-D. Each geometry defines gradients, tensors, volume factors and the
//! exponent of F-bar, theory-manual equation (T3.2).

mod axisymmetric;
mod plane_strain;
mod solid;

use crate::material::Moduli;
pub use axisymmetric::Axisymmetric;
pub use plane_strain::PlaneStrain;
pub use solid::Solid;

use crate::real::Real;
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
        plus_identity(&Self::gradient::<R>(grad))
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
        of_rows(
            scaled(row(dF, 0), root),
            scaled(row(dF, 1), root),
            scaled(row(dF, 2), root),
        )
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
        let F = [row(dF, 0), row(dF, 1), row(dF, 2)];
        let [x, y, z] = [times(b, F[0]), times(b, F[1]), times(b, F[2])];
        Symmetric([
            dot(x, F[0]),
            dot(y, F[1]),
            dot(z, F[2]),
            dot(x, F[1]),
            dot(y, F[2]),
            dot(x, F[2]),
        ])
    }

    /// Elastic stiffness of a node pair from T = sum V0 g_a (x) g_b, g their numbers: where these are derivatives,
    /// lambda T + mu T^T + mu tr T I.
    fn stiffness(moment: &Moment<Self, D>, moduli: Moduli) -> Square<D>;

    /// Volume at `x` per m^D of the grid: what volumes and areas are multiplied with. Linear in x.
    fn weight(_x: &Vector<D>) -> f64 {
        1.0
    }

    /// By what factor `n` points with equal shares of a part of a cell, m from the grid's lower corner along an axis,
    /// are farther from its middle than the middles of these shares.
    fn spread(_axis: usize, _part: [f64; 2], _n: usize) -> f64 {
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
pub type GradientModuli<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Moduli;

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
fn isotropic<const D: usize>(moment: &Square<D>, moduli: Moduli) -> Square<D> {
    let Moduli { lambda, mu } = moduli;
    moment * lambda + moment.transpose() * mu + Square::<D>::identity() * (mu * moment.trace())
}

// Of lanes closures and nalgebra's `from_fn` may be left out of the function with the wide vectors, each operation in
// them a call: products of tensors are written out in functions that are always inlined.

/// Row `i`.
#[inline(always)]
fn row<R: Real>(F: &Tensor<R>, i: usize) -> [R; 3] {
    [F[(i, 0)], F[(i, 1)], F[(i, 2)]]
}

/// The tensor of its rows.
#[inline(always)]
fn of_rows<R: Real>(x: [R; 3], y: [R; 3], z: [R; 3]) -> Tensor<R> {
    Tensor::new(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2])
}

/// a . b
#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Products of a vector with three rows.
#[inline(always)]
fn times<R: Real>(rows: [[R; 3]; 3], vector: [R; 3]) -> [R; 3] {
    [dot(vector, rows[0]), dot(vector, rows[1]), dot(vector, rows[2])]
}

/// I + grad.
#[inline(always)]
fn plus_identity<R: Real>(grad: &Tensor<R>) -> Tensor<R> {
    let [x, y, z] = [row(grad, 0), row(grad, 1), row(grad, 2)];
    of_rows(
        [x[0] + 1.0, x[1] + 0.0, x[2] + 0.0],
        [y[0] + 0.0, y[1] + 1.0, y[2] + 0.0],
        [z[0] + 0.0, z[1] + 0.0, z[2] + 1.0],
    )
}

/// Cofactor of an element.
#[inline(always)]
fn cofactor<R: Real>(F: &Tensor<R>, i: usize, j: usize) -> R {
    let [i, next_i, j, next_j] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
    F[(i, j)] * F[(next_i, next_j)] - F[(i, next_j)] * F[(next_i, j)]
}

/// Cofactors of a column.
#[inline(always)]
fn cofactors<R: Real>(F: &Tensor<R>, j: usize) -> [R; 3] {
    [cofactor(F, 0, j), cofactor(F, 1, j), cofactor(F, 2, j)]
}

/// tau dF^-T.
#[inline(always)]
fn pull_back<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> Tensor<R> {
    let [xx, yy, zz, xy, yz, xz] = tau.0;
    // The inverse of dF is the transpose of its cofactors over the determinant.
    let columns = [cofactors(dF, 0), cofactors(dF, 1), cofactors(dF, 2)];
    let inverse = xx.like(1.0) / determinant(dF);
    let x = scaled(times(columns, [xx, xy, xz]), inverse);
    let y = scaled(times(columns, [xy, yy, yz]), inverse);
    let z = scaled(times(columns, [xz, yz, zz]), inverse);
    of_rows(x, y, z)
}

/// A vector times a number.
#[inline(always)]
fn scaled<R: Real>(vector: [R; 3], by: R) -> [R; 3] {
    [vector[0] * by, vector[1] * by, vector[2] * by]
}

/// det F.
#[inline(always)]
fn determinant<R: Real>(F: &Tensor<R>) -> R {
    F[(0, 0)] * minor(F, 1, 2) - F[(0, 1)] * minor(F, 0, 2) + F[(0, 2)] * minor(F, 0, 1)
}

/// Of the rows 1 and 2.
#[inline(always)]
fn minor<R: Real>(F: &Tensor<R>, i: usize, j: usize) -> R {
    F[(1, i)] * F[(2, j)] - F[(1, j)] * F[(2, i)]
}
