//! The quadratic forms of the background over a cell, exact: products of one-dimensional integrals.

use super::Block;
use crate::grid::shape::with_width;
use crate::grid::{Grid, KnotVector};

/// A form within a cell.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// int eps : eps dV, eps the symmetric gradient
    Strain,
    /// int sum_ij h_i h_j (d2u / dx_i dx_j)^2 dV
    Curvature,
}

/// What all blocks of a form need.
pub(super) struct Forms<'a, const D: usize> {
    grid: &'a Grid<D>,
    form: Form,
    products: [Vec<Products>; D], // per axis and cell
}

/// int N_a N_b, int N_a' N_b', int N_a'' N_b'' and int N_a' N_b over a cell of one axis, row-major (q + 1) square; m, 1/m,
/// 1/m^3, 1.
pub(super) type Products = [Vec<f64>; 4];
/// The last of them.
const MIXED: usize = 3;

impl<'a, const D: usize> Forms<'a, D> {
    pub(super) fn new(grid: &'a Grid<D>, form: Form) -> Self {
        Self { grid, form, products: products(grid) }
    }

    /// `factor` times the form of a cell; m^(D-2) times the unit of the factor.
    pub(super) fn block(&self, cell: &[usize; D], factor: f64) -> Block {
        match self.form {
            Form::Strain => Block::Coupled(self.strain(cell, factor)),
            Form::Curvature => Block::Scalar(self.curvature(cell, factor)),
        }
    }

    /// Row-major (q + 1)^D square.
    fn curvature(&self, cell: &[usize; D], factor: f64) -> Vec<f64> {
        let mut block = vec![0.0; self.grid.cell_nodes().pow(2)];
        let size = self.grid.cell_box(cell).1;
        for i in 0..D {
            for j in 0..D {
                let order = |axis| usize::from(axis == i) + usize::from(axis == j);
                self.add(cell, factor * size[i] * size[j], order, &mut block);
            }
        }
        block
    }

    /// Row-major D (q + 1)^D square: eps : eps is half of |grad u|^2, which does not couple the components, and half of
    /// sum_ij du_i/dx_j du_j/dx_i.
    fn strain(&self, cell: &[usize; D], factor: f64) -> Vec<f64> {
        let nodes = self.grid.cell_nodes();
        let (mut plain, mut coupled) = (vec![0.0; nodes * nodes], vec![0.0; (nodes * D).pow(2)]);
        for i in 0..D {
            self.add(cell, 0.5 * factor, |axis| usize::from(axis == i), &mut plain);
        }
        for (i, j) in (0..D * D).map(|k| (k / D, k % D)) {
            // Of u_i at a and u_j at b: the derivative of N_a along j times that of N_b along i.
            let mut mixed = vec![0.0; nodes * nodes];
            let derivatives = |axis| (usize::from(axis == j), usize::from(axis == i));
            self.add_mixed(cell, 0.5 * factor, derivatives, &mut mixed);
            for (entry, value) in mixed.iter().enumerate() {
                let (a, b) = (entry / nodes, entry % nodes);
                let own = if i == j { plain[entry] } else { 0.0 };
                coupled[(a * D + i) * nodes * D + b * D + j] = own + value;
            }
        }
        coupled
    }

    /// Adds `factor` times the integral of the products of the functions' derivatives of at most first order, of N_a and of
    /// N_b along each axis.
    fn add_mixed(
        &self,
        cell: &[usize; D],
        factor: f64,
        derivatives: impl Fn(usize) -> (usize, usize),
        block: &mut [f64],
    ) {
        let (width, nodes) = (self.grid.order() + 1, self.grid.cell_nodes());
        let along = |k: usize, axis: usize| k / width.pow((D - 1 - axis) as u32) % width;
        for (entry, sum) in block.iter_mut().enumerate() {
            let (a, b) = (entry / nodes, entry % nodes);
            let integral = |axis: usize| {
                let (a, b, products) = (along(a, axis), along(b, axis), &self.products[axis][cell[axis]]);
                match derivatives(axis) {
                    (1, 0) => products[MIXED][a * width + b],
                    (0, 1) => products[MIXED][b * width + a],
                    (order, _) => products[order][a * width + b],
                }
            };
            *sum += factor * (0..D).map(integral).product::<f64>();
        }
    }

    /// Adds `factor` times the integral of the products of the functions' derivatives of `order(axis)` along each axis.
    fn add(&self, cell: &[usize; D], factor: f64, order: impl Fn(usize) -> usize, block: &mut [f64]) {
        let (width, nodes) = (self.grid.order() + 1, self.grid.cell_nodes());
        let along = |k: usize, axis: usize| k / width.pow((D - 1 - axis) as u32) % width;
        for (entry, sum) in block.iter_mut().enumerate() {
            let (a, b) = (entry / nodes, entry % nodes);
            let integral =
                |axis: usize| self.products[axis][cell[axis]][order(axis)][along(a, axis) * width + along(b, axis)];
            *sum += factor * (0..D).map(integral).product::<f64>();
        }
    }
}

/// The integrals of every cell of every axis.
pub(super) fn products<const D: usize>(grid: &Grid<D>) -> [Vec<Products>; D] {
    let of_axis = |axis: &KnotVector| {
        with_width!(axis.order() + 1, W => {
            (0..axis.cells()).map(|cell| of_cell::<W>(axis, cell)).collect()
        })
    };
    grid.axes().each_ref().map(of_axis)
}

fn of_cell<const W: usize>(axis: &KnotVector, cell: usize) -> Products {
    if !axis.has_length(cell) {
        return std::array::from_fn(|_| vec![0.0; W * W]);
    }
    let (lower, upper) = (axis.breakpoint(cell), axis.breakpoint(cell + 1));
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    // N' is at most quadratic in a cell: its central difference over any distance is N''.
    let (behind, ahead) = (middle - half, middle + half);
    let mut sums = [(); 4].map(|()| vec![0.0; W * W]);
    for (at, weight) in GAUSS {
        let (shift, weight) = (at * half, weight * half);
        let (N, dN) = axis.basis::<W>(middle + shift, cell);
        let slope = |x: f64| axis.basis::<W>(x + shift, cell).1;
        let (before, after) = (slope(behind), slope(ahead));
        let ddN = std::array::from_fn(|a| (after[a] - before[a]) / (2.0 * half));
        for (sum, (rows, columns)) in sums.iter_mut().zip([(N, N), (dN, dN), (ddN, ddN), (dN, N)]) {
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
