//! Soft background: a fictitious elastic stiffness of all occupied cells, equation (T2.13) of the theory manual,
//! because some splines contain almost no material. It resists the displacement of a step or, in steady motion, the
//! change from the last step (T2.14).

mod form;
mod integrals;
mod tensor;

use crate::exact::Exact;
use crate::grid::shape::Shape;
use crate::grid::{Contributions, Grid};
use crate::kinematics::Kinematics;
use crate::lanes::LANES;
use crate::material::Material;
use crate::nodal::Nodal;
use crate::points::Points;
use form::{CellForms, Forms};

/// The soft background of all occupied cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// -  fraction c of the largest modulus in the cell
    pub coefficient: f64,
}

/// What the background resists of the displacement of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ResistedDisplacement {
    /// All of it.
    #[default]
    Displacement,
    /// Its change from the last step, scaled to the length of this one: steady flow meets no force.
    Change,
}

/// The background's blocks of one step, one of every occupied cell.
#[derive(Clone, Debug)]
pub struct Blocks {
    cells: Vec<SoftCell>, // by patch
    forms: CellForms,
}

/// A cell's background: `factor` times a form.
#[derive(Clone, Copy, Debug)]
struct SoftCell {
    form: usize,
    factor: f64, // Pa  c E, times a geometry's weight
}

impl Background {
    /// Blocks of the occupied cells, c E times the form; a geometry's weight is that of their middles.
    pub fn blocks<K: Kinematics<D>, const D: usize>(
        &self,
        grid: &Grid<D>,
        shape: &Shape<D>,
        points: &Points<D>,
        materials: &[Material],
    ) -> Blocks {
        let mut forms = Forms::new(grid);
        let mut cells = Vec::with_capacity(shape.patches().len());
        for patch in shape.patches() {
            let cell = grid.cell_at(patch.cell);
            let (lower, size) = grid.cell_box(&cell);
            let points = patch
                .points
                .clone()
                .map(|p| (usize::from(points.material[p]), points.height(p)));
            let young = points.map(|(material, height)| materials[material].young_at(height));
            let modulus = young.fold(0.0, f64::max);
            let factor = self.coefficient * modulus * K::weight(&(lower + size * 0.5));
            cells.push(SoftCell {
                form: forms.of(&cell),
                factor,
            });
        }
        Blocks {
            cells,
            forms: forms.found,
        }
    }
}

/// Largest number of nodes of a patch: (3 + 1)^3.
const MOST_NODES: usize = 64;

impl Blocks {
    /// f += B u (D numbers a node).
    pub fn multiply<const D: usize>(&self, shape: &Shape<D>, u: &[f64], f: &mut Contributions) {
        self.each_product::<D>(shape, u, |first, _, forces| {
            let f = f.patch(first);
            for (force, offset) in forces.iter().zip(shape.offsets()) {
                (0..D).for_each(|i| f[Nodal::<D>::at(*offset, i)] += force[i]);
            }
        });
    }

    /// u . B u of the cells of this rank: what the background takes.
    pub fn work<const D: usize>(&self, shape: &Shape<D>, u: &[f64]) -> Exact {
        let mut works: Vec<f64> = Vec::with_capacity(self.cells.len());
        self.each_product::<D>(shape, u, |_, u, forces| {
            let terms = u
                .iter()
                .zip(forces)
                .map(|(u, force)| (0..D).map(|i| u[i] * force[i]).sum::<f64>());
            works.push(terms.sum());
        });
        works.into_iter().collect()
    }

    /// Calls `product` for every cell with its first node, what its nodes have of `u` and what its block makes of it.
    fn each_product<const D: usize>(
        &self,
        shape: &Shape<D>,
        u: &[f64],
        mut product: impl FnMut(usize, &[[f64; D]], &[[f64; D]]),
    ) {
        let size = shape.offsets().len();
        let mut u_of = [[0.0; D]; LANES * MOST_NODES];
        let mut forces = [[0.0; D]; LANES * MOST_NODES];
        for (cells, patches) in self.cells.chunks(LANES).zip(shape.patches().chunks(LANES)) {
            for (patch, own) in patches.iter().zip(u_of.chunks_exact_mut(size)) {
                for (at_node, offset) in own.iter_mut().zip(shape.offsets()) {
                    at_node.copy_from_slice(&u[Nodal::<D>::of(patch.first_node + offset)]);
                }
            }
            let numbers = cells.iter().map(|soft| soft.form);
            self.forms.multiply(numbers, &u_of, &mut forces[..cells.len() * size]);
            let products = u_of.chunks(size).zip(forces.chunks_mut(size));
            for ((soft, patch), (own, forces)) in cells.iter().zip(patches).zip(products) {
                forces
                    .as_flattened_mut()
                    .iter_mut()
                    .for_each(|force| *force *= soft.factor);
                product(patch.first_node, own, forces);
            }
        }
    }

    /// Number of occupied cells of this rank.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// Adds that of the patch of this number to the patch's block.
    pub fn add_to(&self, patch: usize, block: &mut [f64]) {
        let soft = self.cells[patch];
        self.forms.add_to(soft.form, soft.factor, block);
    }
}
