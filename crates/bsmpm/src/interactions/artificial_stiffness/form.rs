//! Matrices of single cells for the artificial stiffness.

use super::integrals::{FormProducts, Integrals};
use super::tensor::TensorForms;
use crate::grid::Grid;
use crate::lanes::{self, InLanes, LANES, Lanes, Simd};
use std::collections::BTreeMap;

/// Geometric stiffness blocks of cells, by index.
#[derive(Clone, Debug)]
pub(super) enum CellForms {
    /// 2-D: one block for all cells with equal relative breakpoints.
    Blocks(Vec<CellBlock>),
    /// 3-D: products of one-dimensional integrals.
    ByAxes(TensorForms),
}

impl CellForms {
    /// Multiplies up to eight blocks with the nodal values of their cells, `u`, into `products`.
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
                    blocks[number].multiply(u.as_flattened(), product.as_flattened_mut());
                }
            }
            Self::ByAxes(forms) => forms.multiply(numbers, u.as_flattened(), products.as_flattened_mut()),
        }
    }

    /// Adds `factor` times a block to `block`, D unknowns per node.
    pub(super) fn add_to(&self, number: usize, factor: f64, block: &mut [f64]) {
        match self {
            Self::Blocks(blocks) => blocks[number].add_to(factor, block),
            Self::ByAxes(forms) => forms.add_to(number, factor, block),
        }
    }
}

/// Block of a cell (m^(D-2)), row-major, D (q+1)^D square and bitwise symmetric. Seven zeros follow, because vectors of
/// eight numbers may read beyond its end.
#[derive(Clone, Debug)]
pub(super) struct CellBlock(Vec<f64>);

impl CellBlock {
    /// Adds `factor` times the block to `block`, D unknowns per node.
    fn add_to(&self, factor: f64, block: &mut [f64]) {
        block
            .iter_mut()
            .zip(&self.0)
            .for_each(|(sum, value)| *sum += factor * value);
    }

    /// Writes the product of the block with the nodal values `u` into `product`.
    fn multiply(&self, u: &[f64], product: &mut [f64]) {
        lanes::run(BlockProduct {
            form: &self.0,
            u,
            product,
        });
    }
}

/// Product of a symmetric block with nodal values, eight rows at a time. Because of symmetry, eight entries of a column
/// are contiguous in the storage of the row with the same index.
struct BlockProduct<'a> {
    form: &'a [f64],
    u: &'a [f64],
    product: &'a mut [f64],
}

impl InLanes for BlockProduct<'_> {
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

/// Blocks of the cells, each computed once: cells with equal relative breakpoints share a block, up to round-off.
pub(super) struct Forms<const D: usize> {
    integrals: Integrals,
    alike: [Vec<usize>; D],               // per axis and cell: first cell of a run of equal cells
    numbers: BTreeMap<[usize; D], usize>, // index of a block, by the first cell of its run
    /// Blocks computed so far.
    pub found: CellForms,
}

impl<const D: usize> Forms<D> {
    pub(super) fn new(grid: &Grid<D>) -> Self {
        let integrals = Integrals::of(grid);
        let alike = std::array::from_fn(|axis| first_alike(&integrals.products[axis]));
        // In 3-D a block has 81² entries for degree 2, and in graded grids every cell needs its own.
        let found = match D {
            3 => CellForms::ByAxes(TensorForms::new(integrals.clone())),
            _ => CellForms::Blocks(Vec::new()),
        };
        Self {
            integrals,
            alike,
            numbers: BTreeMap::new(),
            found,
        }
    }

    /// Returns the index of a cell's block, which is computed if necessary.
    pub(super) fn of(&mut self, cell: &[usize; D]) -> usize {
        let cell = std::array::from_fn(|axis| self.alike[axis][cell[axis]]);
        let blocks = match &mut self.found {
            CellForms::ByAxes(forms) => return forms.of(&cell),
            CellForms::Blocks(blocks) => blocks,
        };
        *self.numbers.entry(cell).or_insert_with(|| {
            blocks.push(CellBlock(self.integrals.strain(&cell)));
            blocks.len() - 1
        })
    }
}

/// Difference of the integrals of two cells, relative to the largest of each kind, up to which the cells count as
/// equal: far from the origin, breakpoints lose that accuracy of a cell's length.
const ALIKE: f64 = 1e-10;

/// Returns, for each cell of an axis, the first cell of its run of equal cells.
fn first_alike(products: &[FormProducts]) -> Vec<usize> {
    let mut first = 0;
    let mut alike = Vec::with_capacity(products.len());
    for (cell, own) in products.iter().enumerate() {
        if !are_alike(&products[first], own) {
            first = cell;
        }
        alike.push(first);
    }
    alike
}

/// Returns whether two cells have the same integrals.
fn are_alike(one: &FormProducts, other: &FormProducts) -> bool {
    one.iter().zip(other).all(|(one, other)| {
        let largest = one.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        one.iter()
            .zip(other)
            .all(|(one, other)| (one - other).abs() <= ALIKE * largest)
    })
}
