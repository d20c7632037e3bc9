//! Stiffness matrices of single cells for the soft background (fictitious stiffness).

use super::integrals::{FormProducts, Integrals};
use super::tensor::TensorForms;
use crate::grid::Grid;
use crate::lanes::{self, InLanes, LANES, Lanes, Simd};
use std::collections::BTreeMap;

/// The forms of cells, by number.
#[derive(Clone, Debug)]
pub(super) enum CellForms {
    /// one for all cells whose breakpoints lie alike
    Blocks(Vec<CellBlock>),
    /// of each cell, in space
    ByAxes(TensorForms),
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
                    blocks[number].multiply(u.as_flattened(), product.as_flattened_mut());
                }
            }
            Self::ByAxes(forms) => forms.multiply(numbers, u.as_flattened(), products.as_flattened_mut()),
        }
    }

    /// Adds `factor` times a form to a patch's block of D unknowns a node.
    pub(super) fn add_to(&self, number: usize, factor: f64, block: &mut [f64]) {
        match self {
            Self::Blocks(blocks) => blocks[number].add_to(factor, block),
            Self::ByAxes(forms) => forms.add_to(number, factor, block),
        }
    }
}

/// The block of a cell, m^(D-2), row-major, D (q+1)^D square and symmetric to the last bit. Seven zeros follow it, so
/// that vectors of eight may reach beyond its end.
#[derive(Clone, Debug)]
pub(super) struct CellBlock(Vec<f64>);

impl CellBlock {
    /// Adds `factor` times the block to a patch's block of D unknowns a node.
    fn add_to(&self, factor: f64, block: &mut [f64]) {
        block
            .iter_mut()
            .zip(&self.0)
            .for_each(|(sum, value)| *sum += factor * value);
    }

    /// Writes the block times the nodes' `u` into `product`.
    fn multiply(&self, u: &[f64], product: &mut [f64]) {
        lanes::run(BlockProduct {
            form: &self.0,
            u,
            product,
        });
    }
}

/// A symmetric block times what the nodes have: eight rows at a time, of which each entry of `u` has its column's.
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

/// The blocks of the cells, each made once: cells whose breakpoints lie alike have the same, up to round-off.
pub(super) struct Forms<const D: usize> {
    integrals: Integrals,
    alike: [Vec<usize>; D], // per axis and cell: the first of the cells next to each other that are alike
    numbers: BTreeMap<[usize; D], usize>, // of what was found, by the first of the cells alike
    /// what was asked for
    pub found: CellForms,
}

impl<const D: usize> Forms<D> {
    pub(super) fn new(grid: &Grid<D>) -> Self {
        let integrals = Integrals::of(grid);
        let alike = std::array::from_fn(|axis| first_alike(&integrals.products[axis]));
        // In space a block has 81² numbers, and in graded grids each cell its own.
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

    /// Number of a cell's form among those found.
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

/// Departure from another cell's integrals, by the largest of each kind, up to which a cell counts as like it: what
/// breakpoints far from the origin lose of a cell's length.
const ALIKE: f64 = 1e-10;

/// For each cell of an axis the first one of the cells next to each other that it is like.
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

/// Whether two cells have the same integrals.
fn are_alike(one: &FormProducts, other: &FormProducts) -> bool {
    one.iter().zip(other).all(|(one, other)| {
        let largest = one.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        one.iter()
            .zip(other)
            .all(|(one, other)| (one - other).abs() <= ALIKE * largest)
    })
}
