//! A soft elastic background in occupied cells, against nodes that hold next to no material.
//!
//! A point that enters an empty cell gives its farthest node a stiffness that vanishes faster than its force. The
//! background adds eps E x (grid Laplacian) over occupied cells; it acts on the step's increment u, in residual and
//! stiffness alike, so that it never accumulates stress. It is no part of the paper.

use crate::grid::shape::{Patch, Shape};
use crate::grid::{Grid, KnotVector};
use crate::material::Material;
use crate::points::Points;

/// Which occupied cells get the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All occupied cells.
    Occupied,
    /// Cells whose points fill less than .75 of them.
    PartlyFilled,
}

/// Coefficient and extent of the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// -  fraction eps of the largest modulus in the cell
    pub coefficient: f64,
    /// the cells concerned
    pub extent: Extent,
}

/// The background's blocks of one step: a scalar matrix per cell, equal for every component.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    cells: Vec<(usize, Vec<f64>)>, // patch number; Pa m^(D-2), row-major (q+1)^D square
}

/// Fill below which a cell counts as partly filled.
const FILLED: f64 = 0.75;

impl Background {
    /// Blocks eps E int_cell grad N_a . grad N_b dV of the cells concerned.
    pub fn blocks<const D: usize>(
        &self,
        grid: &Grid<D>,
        shape: &Shape<D>,
        points: &Points<D>,
        materials: &[Material],
    ) -> Blocks {
        let tables: Vec<AxisTable> = grid.axes().iter().map(AxisTable::new).collect();
        let modulus = |patch: &Patch| {
            let young = |p: usize| {
                let material = &materials[usize::from(points.material[p])];
                material.elastic().young * material.relative_stiffness(points.height(p))
            };
            patch.points.clone().map(young).fold(0.0, f64::max)
        };
        let concerned = |patch: &Patch| match self.extent {
            Extent::Occupied => true,
            Extent::PartlyFilled => {
                let (_, size) = grid.cell_box(&grid.cell_at(patch.cell));
                let held = patch.points.clone().map(|p| points.volume[p] * points.F[p].determinant());
                held.sum::<f64>() < FILLED * size.product()
            }
        };
        let cells = shape.patches().iter().enumerate().filter(|(_, patch)| concerned(patch));
        let block = |(number, patch): (usize, &Patch)| {
            let laplacian = laplacian(&tables, &grid.cell_at(patch.cell), shape.width());
            let factor = self.coefficient * modulus(patch);
            (number, laplacian.into_iter().map(|entry| factor * entry).collect())
        };
        Blocks { cells: cells.map(block).collect() }
    }
}

impl Blocks {
    /// f += B u on the nodal arrays (D numbers a node).
    pub fn multiply<const D: usize>(&self, shape: &Shape<D>, u: &[f64], f: &mut [f64]) {
        for (number, block) in &self.cells {
            let first = shape.patches()[*number].first_node;
            for (row, a) in block.chunks_exact(shape.offsets().len()).zip(shape.offsets()) {
                for (entry, b) in row.iter().zip(shape.offsets()) {
                    for component in 0..D {
                        f[(first + a) * D + component] += entry * u[(first + b) * D + component];
                    }
                }
            }
        }
    }

    /// Block of a patch by its number, if it has one.
    pub fn of(&self, patch: usize) -> Option<&[f64]> {
        let found = self.cells.binary_search_by_key(&patch, |(number, _)| *number).ok()?;
        Some(&self.cells[found].1)
    }
}

/// int N_a N_b and int N_a' N_b' over every cell of one axis.
struct AxisTable {
    mass: Vec<Vec<f64>>,
    stiffness: Vec<Vec<f64>>,
}

impl AxisTable {
    fn new(axis: &KnotVector) -> Self {
        crate::grid::shape::with_width!(axis.order() + 1, W => Self::with::<W>(axis))
    }

    fn with<const W: usize>(axis: &KnotVector) -> Self {
        let (mut mass, mut stiffness) = (Vec::new(), Vec::new());
        for cell in 0..axis.cells() {
            let (lower, upper) = (axis.breakpoint(cell), axis.breakpoint(cell + 1));
            let (mut m, mut s) = (vec![0.0; W * W], vec![0.0; W * W]);
            for (at, weight) in GAUSS {
                let length = 0.5 * (upper - lower);
                let (N, dN) = axis.basis::<W>(0.5 * (lower + upper) + at * length, cell);
                for a in 0..W {
                    for b in 0..W {
                        m[a * W + b] += weight * length * N[a] * N[b];
                        s[a * W + b] += weight * length * dN[a] * dN[b];
                    }
                }
            }
            mass.push(m);
            stiffness.push(s);
        }
        Self { mass, stiffness }
    }
}

/// Gauss-Legendre rule of four points on [-1, 1]: exact for products of two cubics.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// int grad N_a . grad N_b over a cell: stiffness along one axis times mass along the others, summed over the axes.
fn laplacian<const D: usize>(tables: &[AxisTable], cell: &[usize; D], width: usize) -> Vec<f64> {
    let nodes = width.pow(D as u32);
    let along = |k: usize, axis: usize| k / width.pow((D - 1 - axis) as u32) % width;
    let mut block = vec![0.0; nodes * nodes];
    for (entry, sum) in block.iter_mut().enumerate() {
        let (a, b) = (entry / nodes, entry % nodes);
        for derived in 0..D {
            *sum += (0..D)
                .map(|axis| {
                    let table = if axis == derived { &tables[axis].stiffness } else { &tables[axis].mass };
                    table[cell[axis]][along(a, axis) * width + along(b, axis)]
                })
                .product::<f64>();
        }
    }
    block
}
