//! Integrals of products of one-dimensional splines, for the matrix of the artificial stiffness.

use crate::gauss::GAUSS;
use crate::grid::shape::with_width;
use crate::grid::{Grid, KnotVector, digit};
use crate::lanes::LANES;

/// Integrals of N_a N_b (m), N_a' N_b' (1/m), N_a' N_b (-) and N_a N_b' (-) over a cell of one axis, each a row-major
/// square of size q + 1.
pub(super) type FormProducts = [Vec<f64>; KINDS];
/// Number of kinds of integrals along an axis, in the order of [`FormProducts`]: no derivative, both, of the row, of
/// the column.
pub(super) const KINDS: usize = 4;
/// Kinds with one derivative: of the row, of the column.
const MIXED: [usize; 2] = [2, 3];

/// One-dimensional integrals of all cells; their products over the axes are the integrals over cells.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// Functions per cell along an axis, q + 1.
    pub width: usize,
    /// Per axis and cell.
    pub products: Vec<Vec<FormProducts>>,
    /// Per axis: position, in that axis' square, of each entry (a, b) of a block.
    entries: Vec<Vec<usize>>,
}

impl Integrals {
    pub(super) fn of<const D: usize>(grid: &Grid<D>) -> Self {
        let width = grid.order() + 1;
        let nodes = grid.cell_nodes();
        let entries = (0..D).map(|axis| {
            let entries = (0..nodes * nodes).map(|entry| [entry / nodes, entry % nodes]);
            let along = entries.map(|pair| pair.map(|k| digit::<D>(k, axis, width)));
            along.map(|[a, b]| a * width + b).collect()
        });
        Self {
            width,
            products: products(grid).into(),
            entries: entries.collect(),
        }
    }

    /// Returns the block of eps : eps, row-major, D (q + 1)^D square, followed by the zeros that vectors of eight read:
    /// half of |grad u|^2, which does not couple the components, and half of sum_ij du_i/dx_j du_j/dx_i.
    pub(super) fn strain<const D: usize>(&self, cell: &[usize; D]) -> Vec<f64> {
        let nodes = self.entries[0].len().isqrt();
        let mut plain = vec![0.0; nodes * nodes];
        let mut coupled = vec![0.0; (nodes * D).pow(2)];
        for i in 0..D {
            self.add(cell, 0.5, |axis| usize::from(axis == i), &mut plain);
        }
        let mut mixed = vec![0.0; nodes * nodes];
        for (i, j) in (0..D * D).map(|k| (k / D, k % D)) {
            // Entry of u_i at node a and u_j at node b: the derivative of N_a along j times that of N_b along i.
            mixed.fill(0.0);
            self.add(cell, 0.5, |axis| kind(axis == j, axis == i), &mut mixed);
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

    /// Adds `factor` times the product over the axes of the integrals of kind `of(axis)` to every entry.
    fn add<const D: usize>(&self, cell: &[usize; D], factor: f64, of: impl Fn(usize) -> usize, block: &mut [f64]) {
        let products: [&[f64]; D] = std::array::from_fn(|axis| &self.products[axis][cell[axis]][of(axis)][..]);
        let entries: [&[usize]; D] = std::array::from_fn(|axis| &self.entries[axis][..block.len()]);
        for (entry, sum) in block.iter_mut().enumerate() {
            *sum += factor * (0..D).map(|axis| products[axis][entries[axis][entry]]).product::<f64>();
        }
    }
}

/// Returns the kind of integral for derivatives of the row's and of the column's function.
fn kind(is_row_derived: bool, is_column_derived: bool) -> usize {
    match (is_row_derived, is_column_derived) {
        (true, false) => MIXED[0],
        (false, true) => MIXED[1],
        (both, _) => usize::from(both),
    }
}

/// Computes the integrals of every cell of every axis.
fn products<const D: usize>(grid: &Grid<D>) -> [Vec<FormProducts>; D] {
    grid.axes().each_ref().map(|axis| {
        with_width!(axis.order() + 1, W => {
            (0..axis.cells()).map(|cell| of_cell::<W>(axis, cell)).collect()
        })
    })
}

/// Integrates the products of the functions of one cell; zero for a cell without length.
fn of_cell<const W: usize>(axis: &KnotVector, cell: usize) -> FormProducts {
    if !axis.has_length(cell) {
        return std::array::from_fn(|_| vec![0.0; W * W]);
    }
    let lower = axis.breakpoint(cell);
    let upper = axis.breakpoint(cell + 1);
    let middle = 0.5 * (lower + upper);
    let half = 0.5 * (upper - lower);
    let mut sums = [(); KINDS].map(|()| vec![0.0; W * W]);
    for (at, weight) in GAUSS {
        let shift = at * half;
        let weight = weight * half;
        let (N, dN) = axis.basis::<W>(middle + shift, cell);
        for (sum, (rows, columns)) in sums.iter_mut().zip([(N, N), (dN, dN), (dN, N), (N, dN)]) {
            for (entry, value) in sum.iter_mut().enumerate() {
                *value += weight * (rows[entry / W] * columns[entry % W]);
            }
        }
    }
    sums
}
