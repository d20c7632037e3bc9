//! Multiplies nodal displacements by the artificial stiffness, in 3-D, for eight cells at a
//! time.

use super::integrals::{Integrals, KINDS};
use crate::grid::digit;
use crate::grid::shape::with_width;
use crate::lanes::{self, InLanes, Lanes, Simd};

/// Number of dimensions.
const D: usize = 3;
/// Largest number of functions of a cell along an axis, and of its nodes.
const MOST: [usize; 2] = [4, 64];
/// Values of eight cells per node, and per pair of functions along an axis.
type Eights<S> = [Lanes<S>; MOST[1]];
type AxisMatrix<S> = [Lanes<S>; MOST[0] * MOST[0]];

/// Returns the kind of integral along each axis for the product of two derivatives along `k`.
#[inline(always)]
fn across(k: usize) -> [usize; D] {
    std::array::from_fn(|axis| usize::from(axis == k))
}

/// Returns the kind of integral along each axis for the coupling of u_i with u_j: derivative of the row's function
/// along j, of the column's along i.
#[inline(always)]
fn mixed(i: usize, j: usize) -> [usize; D] {
    std::array::from_fn(|axis| if axis == j { 2 } else { 3 * usize::from(axis == i) })
}

#[inline(always)]
fn half_unless(whole: bool) -> f64 {
    if whole { 1.0 } else { 0.5 }
}

/// Returns the matrix of each axis for its kind.
#[inline(always)]
fn chosen<S: Simd>(matrices: &[[AxisMatrix<S>; KINDS]; D], kinds: [usize; D]) -> [&AxisMatrix<S>; D] {
    [0, 1, 2].map(|axis| &matrices[axis][kinds[axis]])
}

/// Returns the product over the axes of the values of these kinds.
#[inline]
fn term(values: &[[f64; KINDS]; D], kinds: [usize; D]) -> f64 {
    (0..D).map(|axis| values[axis][kinds[axis]]).product()
}

/// Blocks of 3-D cells as products of one-dimensional integrals, by index.
#[derive(Clone, Debug)]
pub(super) struct TensorForms {
    integrals: Integrals,
    cells: Vec<[usize; D]>,
}

impl TensorForms {
    pub(super) fn new(integrals: Integrals) -> Self {
        Self {
            integrals,
            cells: Vec::new(),
        }
    }

    /// Adds a cell and returns its index.
    pub(super) fn of(&mut self, cell: &[usize]) -> usize {
        self.cells.push(cell.try_into().expect("a cell in space"));
        self.cells.len() - 1
    }

    /// Adds `factor` times the bitwise symmetric block of a cell to `block`.
    pub(super) fn add_to(&self, number: usize, factor: f64, block: &mut [f64]) {
        let width = self.integrals.width;
        let cell = self.cells[number];
        let products: [_; D] = std::array::from_fn(|axis| &self.integrals.products[axis][cell[axis]]);
        let nodes = width.pow(D as u32);
        for (a, rows) in block.chunks_exact_mut(nodes * D * D).enumerate() {
            let row = [0, 1, 2].map(|axis| digit::<D>(a, axis, width));
            for b in 0..nodes {
                let column = [0, 1, 2].map(|axis| digit::<D>(b, axis, width));
                let values = [0, 1, 2].map(|axis| {
                    let entry = row[axis] * width + column[axis];
                    [0, 1, 2, 3].map(|kind| products[axis][kind][entry])
                });
                for (i, j) in (0..D * D).map(|k| (k / D, k % D)) {
                    let value: f64 = if i == j {
                        (0..D).map(|k| term(&values, across(k)) * half_unless(k == i)).sum()
                    } else {
                        0.5 * term(&values, mixed(i, j))
                    };
                    rows[i * nodes * D + b * D + j] += factor * value;
                }
            }
        }
    }

    /// Multiplies the blocks of up to eight cells with `u`; both arrays are ordered by cell, node and component.
    pub(super) fn multiply(&self, numbers: impl Iterator<Item = usize>, u: &[f64], products: &mut [f64]) {
        let cells: Vec<[usize; D]> = numbers.map(|number| self.cells[number]).collect();
        with_width!(self.integrals.width, W => {
            lanes::run(TensorProduct::<W> { integrals: &self.integrals, cells: &cells, u, products });
        });
    }
}

struct TensorProduct<'a, const W: usize> {
    integrals: &'a Integrals,
    cells: &'a [[usize; D]],
    u: &'a [f64],
    products: &'a mut [f64],
}

impl<const W: usize> InLanes for TensorProduct<'_, W> {
    type Output = ();

    /// Computes `f_i = sum_j int eps(N e_i) : eps(u_j e_j)`. With eps : eps = (u_i,k v_i,k + u_i,j v_j,i) / 2, the row
    /// of component i at node a is `sum_k c_k int N_a,k u_i,k + sum_(j != i) 1/2 int N_a,j u_j,i`. Here c_k = 1/2,
    /// except c_i = 1, which includes the term j = i of the second sum.
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let nodes = W.pow(D as u32);
        let last = self.cells.len() - 1;
        let none = [Lanes::splat(simd, 0.0); MOST[1]];
        let mut matrices = [[[Lanes::splat(simd, 0.0); MOST[0] * MOST[0]]; KINDS]; D];
        for (axis, kinds) in matrices.iter_mut().enumerate() {
            for (kind, matrix) in kinds.iter_mut().enumerate() {
                let products = &self.integrals.products[axis];
                for (entry, value) in matrix[..W * W].iter_mut().enumerate() {
                    *value = Lanes::from_fn(simd, |lane| products[self.cells[lane.min(last)][axis]][kind][entry]);
                }
            }
        }
        let mut u = [none; D];
        let mut f = [none; D];
        let mut scratch = [none; 2];
        for (j, own) in u.iter_mut().enumerate() {
            for (node, value) in own[..nodes].iter_mut().enumerate() {
                *value = Lanes::from_fn(simd, |lane| self.u[(lane.min(last) * nodes + node) * D + j]);
            }
        }
        for (i, f) in f.iter_mut().enumerate() {
            for j in 0..D {
                add::<W, S>(
                    chosen(&matrices, across(j)),
                    half_unless(j == i),
                    &u[i],
                    f,
                    &mut scratch,
                );
                if j != i {
                    add::<W, S>(chosen(&matrices, mixed(i, j)), 0.5, &u[j], f, &mut scratch);
                }
            }
        }
        for number in 0..nodes * D {
            let values = f[number % D][number / D].numbers();
            let at = self.products.iter_mut().skip(number).step_by(nodes * D);
            at.zip(values)
                .take(self.cells.len())
                .for_each(|(product, value)| *product = value);
        }
    }
}

/// Adds `factor` times the tensor product of three matrices with `u` to `f`. `one` and `two` are work arrays.
#[inline(always)]
fn add<const W: usize, S: Simd>(
    matrices: [&AxisMatrix<S>; D],
    factor: f64,
    u: &Eights<S>,
    f: &mut Eights<S>,
    [one, two]: &mut [Eights<S>; 2],
) {
    along::<W, S>(matrices[2], 1, u, one);
    along::<W, S>(matrices[1], W, one, two);
    along::<W, S>(matrices[0], W * W, two, one);
    for (sum, value) in f[..W.pow(3)].iter_mut().zip(one) {
        *sum = *sum + *value * factor;
    }
}

/// Applies a matrix along one axis, along which neighbouring nodes differ by `apart` in their index.
#[inline(always)]
fn along<const W: usize, S: Simd>(matrix: &AxisMatrix<S>, apart: usize, u: &Eights<S>, product: &mut Eights<S>) {
    // Node (i0, i1, i2) has the index (i0 W + i1) W + i2, so `apart` is W^2, W or 1 for the axes 0, 1, 2. With the axis
    // removed, `line` = h apart + l, with l < apart. The first node of a line is h apart W + l.
    for line in 0..W * W {
        let first = line / apart * apart * W + line % apart;
        for a in 0..W {
            let mut sum = matrix[a * W] * u[first];
            for b in 1..W {
                sum = sum + matrix[a * W + b] * u[first + b * apart];
            }
            product[first + a * apart] = sum;
        }
    }
}
