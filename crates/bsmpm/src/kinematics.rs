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

/// Conversion of grid fields of dimension `D` to three-dimensional tensors and back.
pub trait Kinematics<const D: usize>: Copy + Debug + Default + Send + Sync + 'static {
    /// Displacement gradient: a row for each component, a column for each slope of a node's function.
    type Gradient: Gradient<D, Of<f64> = Self::Gradient, SlopeOf<f64> = Slope<Self, D>>;

    /// Returns the slopes of a node's function (1/m) from its value `N` and its gradient at `x`.
    fn slope<R: Real>(N: impl FnOnce() -> R, grad: Vector<D, R>, x: &Vector<D, R>) -> SlopeOf<Self, R, D>;

    /// Returns the deformation gradient of the step, dF = I + grad u (-).
    #[inline(always)]
    fn deformation<R: Real>(grad: &GradientOf<Self, R, D>) -> Tensor<R> {
        plus_identity(&Self::gradient::<R>(grad))
    }

    /// Returns the displacement gradient as a tensor.
    fn gradient<R: Real>(grad: &GradientOf<Self, R, D>) -> Tensor<R>;

    /// Returns dJ = det(I + grad) (-); in plane strain the determinant of the in-plane part.
    fn jacobian<R: Real>(grad: &GradientOf<Self, R, D>) -> R;

    /// Returns tau dF^-T, reduced to the components that act on gradients. Times V0 and the slopes of a node it is the
    /// internal force of a point at that node (step 5a of the paper).
    fn flux<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> GradientOf<Self, R, D>;

    /// Returns dF-bar = (dJ-bar/dJ)^(1/dof) dF (Eq. 15), with `ratio` = dJ-bar/dJ > 0 and dof the number of directions
    /// in which the geometry dilates.
    #[inline(always)]
    fn dilate<R: Real>(dF: &Tensor<R>, ratio: R) -> Tensor<R> {
        let root = ratio.cube_root();
        of_rows(
            scaled(row(dF, 0), root),
            scaled(row(dF, 1), root),
            scaled(row(dF, 2), root),
        )
    }

    /// Returns the components of a tensor that do work on gradients: the adjoint of [`Kinematics::gradient`].
    fn working<R: Real>(tensor: &Tensor<R>) -> GradientOf<Self, R, D>;

    /// Returns the spatial gradient for a unit change of ln(dJ-bar/dJ) in [`Kinematics::dilate`]: I/dof in the
    /// directions that dilate.
    fn dilation() -> Tensor;

    /// Returns the dilation by unit displacements of a node (1/m): the trace of the gradient, by component.
    fn divergence(slope: &Slope<Self, D>) -> Vector<D>;

    /// Returns the trial b^e = dF-bar b^e dF-bar^T (Eqs 7, 19).
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

    /// Returns the elastic stiffness of a node pair from T = sum V0 g_a (x) g_b, with the slopes g. For Cartesian
    /// geometries it is lambda T + mu T^T + mu tr T I.
    fn stiffness(moment: &Moment<Self, D>, moduli: Moduli) -> Square<D>;

    /// Returns the volume at `x` per m^D of the grid, the factor of volumes and areas; it is linear in x.
    fn weight(_x: &Vector<D>) -> f64 {
        1.0
    }

    /// Returns the factor by which `n` points of equal shares lie farther from the middle of a subcell than the middles
    /// of these shares. The subcell extends from `_part[0]` to `_part[1]` along an axis (m, from the lower corner of
    /// the grid).
    fn spread(_axis: usize, _part: [f64; 2], _n: usize) -> f64 {
        1.0
    }
}

/// Gradients of a geometry, of one point or of several.
pub type GradientOf<K, R, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Of<R>;
/// Slopes of a node's function in the gradients of a geometry.
pub type Slope<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Slope;
/// Slopes of one point or of several.
pub type SlopeOf<K, R, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::SlopeOf<R>;
/// Sums of products of the slopes of a node pair.
pub type Moment<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Moment;
/// Linear map of gradients.
pub type GradientModuli<K, const D: usize> = <<K as Kinematics<D>>::Gradient as Gradient<D>>::Moduli;

/// Matrix of D rows and G columns: gradients of grid fields, or the stresses that do work on them.
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
    /// Number of columns G.
    const SLOPES: usize;
    /// Zero slopes of a node.
    const NO_SLOPE: Self::Slope;
    /// Zero moment of a pair of nodes.
    const NO_MOMENT: Self::Moment;
    /// G slopes of a node's function.
    type Slope: Copy + Debug + Send + Sync + Index<usize, Output = f64> + Mul<f64, Output = Self::Slope>;
    /// G x G products of the slopes of a pair of nodes.
    type Moment: Copy + Debug + Send + Sync + Index<(usize, usize), Output = f64> + IndexMut<(usize, usize)>;
    /// Images of all unit gradients: element (k, l) is the image of a unit at (k, l).
    type Moduli: Copy + Debug + Send + Sync + Index<(usize, usize), Output = Self> + IndexMut<(usize, usize)>;

    /// Gradient with elements of another number type.
    type Of<R: Real>: Copy + Index<(usize, usize), Output = R> + IndexMut<(usize, usize)>;
    /// Slopes with elements of another number type.
    type SlopeOf<R: Real>: Copy + Index<usize, Output = R>;

    /// Creates a gradient of any number type from its elements by row and column.
    fn of<R: Real>(element: impl FnMut(usize, usize) -> R) -> Self::Of<R>;

    /// Creates a gradient of equal elements.
    fn from_element(value: f64) -> Self;

    /// Creates a gradient from its elements by row and column.
    fn from_fn(element: impl FnMut(usize, usize) -> f64) -> Self;

    /// Creates the linear map with these images of unit gradients.
    fn moduli(unit: impl FnMut(usize, usize) -> Self) -> Self::Moduli;

    /// Returns the sum of the products of all elements.
    fn dot(&self, other: &Self) -> f64;

    /// Returns the product of the matrix and the slopes of a node.
    fn times(&self, slope: &Self::Slope) -> Vector<D>;

    /// Returns the zero gradient.
    #[inline]
    fn zeros() -> Self {
        Self::from_element(0.0)
    }

    /// Returns a gradient with 1 at one element and 0 elsewhere.
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

/// Returns lambda T + mu T^T + mu tr T I, with T = sum V0 grad N_a (x) grad N_b.
#[inline]
fn isotropic<const D: usize>(moment: &Square<D>, moduli: Moduli) -> Square<D> {
    let Moduli { lambda, mu } = moduli;
    moment * lambda + moment.transpose() * mu + Square::<D>::identity() * (mu * moment.trace())
}

// For SIMD types, closures and nalgebra's `from_fn` may be compiled outside of the function with wide vectors, where
// each operation is a call. Tensor products are therefore written out in functions that are always inlined.

/// Returns row `i`.
#[inline(always)]
fn row<R: Real>(F: &Tensor<R>, i: usize) -> [R; 3] {
    [F[(i, 0)], F[(i, 1)], F[(i, 2)]]
}

/// Returns the tensor with these rows.
#[inline(always)]
fn of_rows<R: Real>(x: [R; 3], y: [R; 3], z: [R; 3]) -> Tensor<R> {
    Tensor::new(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2])
}

/// Returns a . b.
#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the products of a vector with three rows.
#[inline(always)]
fn times<R: Real>(rows: [[R; 3]; 3], vector: [R; 3]) -> [R; 3] {
    [dot(vector, rows[0]), dot(vector, rows[1]), dot(vector, rows[2])]
}

/// Returns I + grad.
#[inline(always)]
fn plus_identity<R: Real>(grad: &Tensor<R>) -> Tensor<R> {
    let [x, y, z] = [row(grad, 0), row(grad, 1), row(grad, 2)];
    of_rows(
        [x[0] + 1.0, x[1] + 0.0, x[2] + 0.0],
        [y[0] + 0.0, y[1] + 1.0, y[2] + 0.0],
        [z[0] + 0.0, z[1] + 0.0, z[2] + 1.0],
    )
}

/// Returns the cofactor of an element.
#[inline(always)]
fn cofactor<R: Real>(F: &Tensor<R>, i: usize, j: usize) -> R {
    let [i, next_i, j, next_j] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
    F[(i, j)] * F[(next_i, next_j)] - F[(i, next_j)] * F[(next_i, j)]
}

/// Returns the cofactors of a column.
#[inline(always)]
fn cofactors<R: Real>(F: &Tensor<R>, j: usize) -> [R; 3] {
    [cofactor(F, 0, j), cofactor(F, 1, j), cofactor(F, 2, j)]
}

/// Returns tau dF^-T.
#[inline(always)]
fn pull_back<R: Real>(tau: &Symmetric<R>, dF: &Tensor<R>) -> Tensor<R> {
    let [xx, yy, zz, xy, yz, xz] = tau.0;
    // The inverse of dF is the transpose of its cofactors divided by the determinant.
    let columns = [cofactors(dF, 0), cofactors(dF, 1), cofactors(dF, 2)];
    let inverse = xx.like(1.0) / determinant(dF);
    let x = scaled(times(columns, [xx, xy, xz]), inverse);
    let y = scaled(times(columns, [xy, yy, yz]), inverse);
    let z = scaled(times(columns, [xz, yz, zz]), inverse);
    of_rows(x, y, z)
}

/// Returns a vector times a number.
#[inline(always)]
fn scaled<R: Real>(vector: [R; 3], by: R) -> [R; 3] {
    [vector[0] * by, vector[1] * by, vector[2] * by]
}

/// Returns det F.
#[inline(always)]
fn determinant<R: Real>(F: &Tensor<R>) -> R {
    F[(0, 0)] * minor(F, 1, 2) - F[(0, 1)] * minor(F, 0, 2) + F[(0, 2)] * minor(F, 0, 1)
}

/// Returns a minor of the rows 1 and 2.
#[inline(always)]
fn minor<R: Real>(F: &Tensor<R>, i: usize, j: usize) -> R {
    F[(1, i)] * F[(2, j)] - F[(1, j)] * F[(2, i)]
}
