//! The quadratic forms of the background over a cell, exact: products of one-dimensional integrals.

use super::Block;
use crate::grid::shape::with_width;
use crate::grid::{Grid, KnotVector};
use crate::lanes::LANES;
use std::collections::BTreeMap;

/// A form within a cell.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// int eps : eps dV, eps the symmetric gradient
    Strain,
    /// int sum_ij h_i h_j (d2u / dx_i dx_j)^2 dV
    Curvature,
}

/// The blocks of a form, each made once: cells whose breakpoints lie alike have the same, up to round-off.
pub(super) struct Forms<'a, const D: usize> {
    grid: &'a Grid<D>,
    form: Form,
    products: [Vec<FormProducts>; D], // per axis and cell
    alike: [Vec<usize>; D],           // per axis and cell: the first of the cells next to each other that are alike
    /// per axis: where each entry (a, b) of a block finds the product of its functions along that axis
    entries: [Vec<usize>; D],
    numbers: BTreeMap<[usize; D], usize>, // of what was found, by the first of the cells alike
    /// what was asked for
    pub found: Vec<Block>,
}

/// int N_a N_b, int N_a' N_b', int N_a'' N_b'', int N_a' N_b and int N_a N_b' over a cell of one axis, row-major,
/// (q + 1) square; m, 1/m, 1/m^3, 1, 1.
pub(super) type FormProducts = [Vec<f64>; 5];
/// The last two of them.
const MIXED: [usize; 2] = [3, 4];

impl<'a, const D: usize> Forms<'a, D> {
    pub(super) fn new(grid: &'a Grid<D>, form: Form) -> Self {
        let (width, nodes) = (grid.order() + 1, grid.cell_nodes());
        let entries = std::array::from_fn(|axis| {
            let along = |k: usize| k / width.pow((D - 1 - axis) as u32) % width;
            (0..nodes * nodes).map(|entry| along(entry / nodes) * width + along(entry % nodes)).collect()
        });
        let products = products(grid);
        let alike = products.each_ref().map(|products| first_alike(products));
        Self { grid, form, products, alike, entries, numbers: BTreeMap::new(), found: Vec::new() }
    }

    /// Number of a cell's form among those found.
    pub(super) fn of(&mut self, cell: &[usize; D]) -> usize {
        let cell = std::array::from_fn(|axis| self.alike[axis][cell[axis]]);
        if let Some(&number) = self.numbers.get(&cell) {
            return number;
        }
        self.found.push(match self.form {
            Form::Strain => Block::Coupled(self.strain(&cell)),
            Form::Curvature => Block::Scalar(self.curvature(&cell)),
        });
        self.numbers.insert(cell, self.found.len() - 1);
        self.found.len() - 1
    }

    /// Row-major (q + 1)^D square.
    fn curvature(&self, cell: &[usize; D]) -> Vec<f64> {
        let mut block = vec![0.0; self.grid.cell_nodes().pow(2)];
        let size = self.grid.cell_box(cell).1;
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
    fn strain(&self, cell: &[usize; D]) -> Vec<f64> {
        let nodes = self.grid.cell_nodes();
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
    fn add(&self, cell: &[usize; D], factor: f64, of: impl Fn(usize) -> usize, block: &mut [f64]) {
        let products: [&[f64]; D] = std::array::from_fn(|axis| &self.products[axis][cell[axis]][of(axis)][..]);
        let entries = self.entries.each_ref().map(|entries| &entries[..block.len()]);
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
