//! The quadratic forms of the background over a cell, exact: products of one-dimensional integrals.

use super::tensor::TensorForms;
use crate::grid::shape::with_width;
use crate::grid::{Grid, KnotVector};
use crate::lanes::{self, InLanes, LANES, Lanes, Simd};
use std::collections::BTreeMap;

/// A form within a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// int eps : eps dV, eps the symmetric gradient
    Strain,
    /// int sum_ij h_i h_j (d2u / dx_i dx_j)^2 dV
    Curvature,
}

/// The forms of cells, by number.
#[derive(Clone, Debug)]
pub(super) enum CellForms {
    /// one for all cells whose breakpoints lie alike
    Blocks(Vec<Block>),
    /// of each cell, of the strain in space
    ByAxes(TensorForms),
}

impl Default for CellForms {
    fn default() -> Self {
        Self::Blocks(Vec::new())
    }
}

impl CellForms {
    /// What up to eight forms make of the nodes of their cells, into `products`.
    pub(super) fn multiply<const D: usize>(
        &self,
        numbers: impl ExactSizeIterator<Item = usize>,
        u: &[[f64; D]],
        products: &mut [[f64; D]],
    ) {
        match self {
            Self::Blocks(blocks) => {
                let size = products.len() / numbers.len();
                for (number, (product, u)) in numbers.zip(products.chunks_mut(size).zip(u.chunks(size))) {
                    blocks[number].multiply(u, product);
                }
            }
            Self::ByAxes(forms) => forms.multiply(numbers, u.as_flattened(), products.as_flattened_mut()),
        }
    }

    /// Adds `factor` times a form to a patch's block of D unknowns a node.
    pub(super) fn add_to<const D: usize>(&self, number: usize, factor: f64, block: &mut [f64]) {
        match self {
            Self::Blocks(blocks) => blocks[number].add_to::<D>(factor, block),
            Self::ByAxes(forms) => forms.add_to(number, factor, block),
        }
    }
}

/// The block of a cell, m^(D-2), row-major and symmetric to the last bit.
#[derive(Clone, Debug)]
pub(super) enum Block {
    /// (q+1)^D square, equal for every component, which do not couple
    Scalar(Vec<f64>),
    /// D (q+1)^D square, and behind it seven zeros, so that vectors of eight may reach beyond the end
    Coupled(Vec<f64>),
}

impl Block {
    /// Adds `factor` times it to a patch's block of D unknowns a node.
    fn add_to<const D: usize>(&self, factor: f64, block: &mut [f64]) {
        match self {
            Self::Coupled(form) => block.iter_mut().zip(form).for_each(|(sum, value)| *sum += factor * value),
            Self::Scalar(form) => {
                let size = form.len().isqrt();
                for (entry, value) in form.iter().enumerate() {
                    let (a, b) = (entry / size, entry % size);
                    for i in 0..D {
                        block[(a * D + i) * size * D + b * D + i] += factor * value;
                    }
                }
            }
        }
    }

    /// What it makes of the nodes' `u`, into `product`.
    fn multiply<const D: usize>(&self, u: &[[f64; D]], product: &mut [[f64; D]]) {
        match self {
            Self::Scalar(form) => {
                for (sum, row) in product.iter_mut().zip(form.chunks_exact(u.len())) {
                    let along = |i: usize| row.iter().zip(u).map(|(entry, u)| entry * u[i]).sum();
                    *sum = std::array::from_fn(along);
                }
            }
            Self::Coupled(form) => {
                lanes::run(Product { form, u: u.as_flattened(), product: product.as_flattened_mut() });
            }
        }
    }
}

/// A symmetric block times what the nodes have: eight rows at a time, of which each entry of `u` has its column's.
struct Product<'a> {
    form: &'a [f64],
    u: &'a [f64],
    product: &'a mut [f64],
}

impl InLanes for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for (eight, rows) in self.product.chunks_mut(LANES).enumerate() {
            let mut sum = Lanes::splat(simd, 0.0);
            for (column, u) in self.u.iter().enumerate() {
                let entries = &self.form[column * self.u.len() + eight * LANES..];
                sum = sum + Lanes::first_of(simd, entries) * *u;
            }
            rows.copy_from_slice(&sum.numbers()[..rows.len()]);
        }
    }
}

/// The blocks of a form, each made once: cells whose breakpoints lie alike have the same, up to round-off.
pub(super) struct Forms<'a, const D: usize> {
    grid: &'a Grid<D>,
    form: Form,
    integrals: Integrals,
    alike: [Vec<usize>; D], // per axis and cell: the first of the cells next to each other that are alike
    numbers: BTreeMap<[usize; D], usize>, // of what was found, by the first of the cells alike
    /// what was asked for
    pub found: CellForms,
}

/// int N_a N_b, int N_a' N_b', int N_a'' N_b'', int N_a' N_b and int N_a N_b' over a cell of one axis, row-major,
/// (q + 1) square; m, 1/m, 1/m^3, 1, 1.
pub(super) type FormProducts = [Vec<f64>; 5];
/// The last two of them.
pub(super) const MIXED: [usize; 2] = [3, 4];

impl<'a, const D: usize> Forms<'a, D> {
    pub(super) fn new(grid: &'a Grid<D>, form: Form) -> Self {
        let integrals = Integrals::of(grid);
        let alike = std::array::from_fn(|axis| first_alike(&integrals.products[axis]));
        // In space a block of the strain has 81² numbers, and in graded grids each cell its own.
        let found = match form {
            Form::Strain if D == 3 => CellForms::ByAxes(TensorForms::new(integrals.clone())),
            _ => CellForms::default(),
        };
        Self { grid, form, integrals, alike, numbers: BTreeMap::new(), found }
    }

    /// Number of a cell's form among those found.
    pub(super) fn of(&mut self, cell: &[usize; D]) -> usize {
        let cell = std::array::from_fn(|axis| self.alike[axis][cell[axis]]);
        let blocks = match &mut self.found {
            CellForms::ByAxes(forms) => return forms.of(&cell),
            CellForms::Blocks(blocks) => blocks,
        };
        *self.numbers.entry(cell).or_insert_with(|| {
            blocks.push(match self.form {
                Form::Strain => Block::Coupled(self.integrals.strain(&cell)),
                Form::Curvature => Block::Scalar(self.integrals.curvature(&cell, self.grid.cell_box(&cell).1.into())),
            });
            blocks.len() - 1
        })
    }
}

/// Integrals along the axes of all cells, whose products are those over cells.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// q + 1
    pub width: usize,
    /// per axis and cell
    pub products: Vec<Vec<FormProducts>>,
    /// per axis: where each entry (a, b) of a block finds the product of its functions along that axis
    entries: Vec<Vec<usize>>,
}

impl Integrals {
    pub(super) fn of<const D: usize>(grid: &Grid<D>) -> Self {
        let (width, nodes) = (grid.order() + 1, grid.cell_nodes());
        let of_axis = |axis: usize| {
            let along = |k: usize| k / width.pow((D - 1 - axis) as u32) % width;
            (0..nodes * nodes).map(|entry| along(entry / nodes) * width + along(entry % nodes)).collect()
        };
        Self { width, products: products(grid).into(), entries: (0..D).map(of_axis).collect() }
    }

    /// Row-major (q + 1)^D square, of a cell of that `size`.
    fn curvature<const D: usize>(&self, cell: &[usize; D], size: [f64; D]) -> Vec<f64> {
        let mut block = vec![0.0; self.entries[0].len()];
        for i in 0..D {
            for j in 0..D {
                let order = |axis| usize::from(axis == i) + usize::from(axis == j);
                self.add(cell, size[i] * size[j], order, &mut block);
            }
        }
        block
    }

    /// Row-major D (q + 1)^D square, with the room behind it: eps : eps is half of |grad u|^2, which does not couple
    /// the components, and half of sum_ij du_i/dx_j du_j/dx_i.
    pub(super) fn strain<const D: usize>(&self, cell: &[usize; D]) -> Vec<f64> {
        let nodes = self.entries[0].len().isqrt();
        let (mut plain, mut coupled) = (vec![0.0; nodes * nodes], vec![0.0; (nodes * D).pow(2)]);
        for i in 0..D {
            self.add(cell, 0.5, |axis| usize::from(axis == i), &mut plain);
        }
        let mut mixed = vec![0.0; nodes * nodes];
        for (i, j) in (0..D * D).map(|k| (k / D, k % D)) {
            // Of u_i at a and u_j at b: the derivative of N_a along j times that of N_b along i.
            let of = |axis| match (axis == j, axis == i) {
                (true, false) => MIXED[0],
                (false, true) => MIXED[1],
                (both, _) => usize::from(both),
            };
            mixed.fill(0.0);
            self.add(cell, 0.5, of, &mut mixed);
            for (a, (mixed, plain)) in mixed.chunks_exact(nodes).zip(plain.chunks_exact(nodes)).enumerate() {
                let row = coupled[(a * D + i) * nodes * D..].iter_mut().skip(j).step_by(D);
                for (sum, (value, own)) in row.zip(mixed.iter().zip(plain)) {
                    *sum = if i == j { own + value } else { 0.0 + value };
                }
            }
        }
        coupled.resize(coupled.len() + LANES - 1, 0.0);
        coupled
    }

    /// Adds `factor` times the integral of the products of the functions' derivatives, `of(axis)` along each axis.
    fn add<const D: usize>(&self, cell: &[usize; D], factor: f64, of: impl Fn(usize) -> usize, block: &mut [f64]) {
        let products: [&[f64]; D] = std::array::from_fn(|axis| &self.products[axis][cell[axis]][of(axis)][..]);
        let entries: [&[usize]; D] = std::array::from_fn(|axis| &self.entries[axis][..block.len()]);
        for (entry, sum) in block.iter_mut().enumerate() {
            *sum += factor * (0..D).map(|axis| products[axis][entries[axis][entry]]).product::<f64>();
        }
    }
}

/// The integrals of every cell of every axis.
pub(super) fn products<const D: usize>(grid: &Grid<D>) -> [Vec<FormProducts>; D] {
    let of_axis = |axis: &KnotVector| {
        with_width!(axis.order() + 1, W => {
            (0..axis.cells()).map(|cell| of_cell::<W>(axis, cell)).collect()
        })
    };
    grid.axes().each_ref().map(of_axis)
}

/// Departure from another cell's integrals, by the largest of each kind, up to which a cell counts as like it: what
/// breakpoints far from the origin lose of a cell's length.
const ALIKE: f64 = 1e-10;

/// For each cell of an axis the first one of the cells next to each other that it is like.
fn first_alike(products: &[FormProducts]) -> Vec<usize> {
    let are_alike = |one: &FormProducts, other: &FormProducts| {
        one.iter().zip(other).all(|(one, other)| {
            let largest = one.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            one.iter().zip(other).all(|(one, other)| (one - other).abs() <= ALIKE * largest)
        })
    };
    let mut first = 0;
    let of_cell = |cell: usize| {
        if !are_alike(&products[first], &products[cell]) {
            first = cell;
        }
        first
    };
    (0..products.len()).map(of_cell).collect()
}

fn of_cell<const W: usize>(axis: &KnotVector, cell: usize) -> FormProducts {
    if !axis.has_length(cell) {
        return std::array::from_fn(|_| vec![0.0; W * W]);
    }
    let (lower, upper) = (axis.breakpoint(cell), axis.breakpoint(cell + 1));
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    // N' is at most quadratic in a cell: its central difference over any distance is N''.
    let (behind, ahead) = (middle - half, middle + half);
    let mut sums = [(); 5].map(|()| vec![0.0; W * W]);
    for (at, weight) in GAUSS {
        let (shift, weight) = (at * half, weight * half);
        let (N, dN) = axis.basis::<W>(middle + shift, cell);
        let slope = |x: f64| axis.basis::<W>(x + shift, cell).1;
        let (before, after) = (slope(behind), slope(ahead));
        let ddN = std::array::from_fn(|a| (after[a] - before[a]) / (2.0 * half));
        for (sum, (rows, columns)) in sums.iter_mut().zip([(N, N), (dN, dN), (ddN, ddN), (dN, N), (N, dN)]) {
            for (entry, value) in sum.iter_mut().enumerate() {
                *value += weight * (rows[entry / W] * columns[entry % W]);
            }
        }
    }
    sums
}

/// Gauss-Legendre rule of four points on [-1, 1]: exact for products of two cubics.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];
