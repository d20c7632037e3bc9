//! A soft elastic background, for cells in which nodes hold next to no material.
//!
//! A point that enters an empty cell gives its farthest node a stiffness that vanishes faster than its force. The
//! background ties such nodes to their neighbours; it acts on the step's increment u only, in residual and stiffness
//! alike, linear in u. So it never accumulates stress, however far a body moves or turns in many steps: it is a drag,
//! weaker in smaller steps. It is no part of the paper. The forms within a cell need neither a wider matrix nor more
//! exchange; the ghost penalty (Burman 2010) reaches over two cells, q + 2 layers of nodes, and leaves more motions
//! alone.

mod form;
mod ghost;
mod integrals;
mod tensor;

use crate::exact::Exact;
use crate::grid::shape::{Patch, Shape};
use crate::grid::{Contributions, Grid, transfer};
use crate::kinematics::Kinematics;
use crate::lanes::LANES;
use crate::material::Material;
use crate::nodal::Nodal;
use crate::parallel::{Halo, LinearSolver};
use crate::points::Points;
use form::{CellForms, Form, Forms};
use ghost::GhostFaces;

/// What the background resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// c E int eps : eps dV, eps the symmetric gradient of the step's displacement: every deformation, no
    /// small rotation; in axisymmetry those in the plane. In all occupied cells it slows down what fails: a slope
    /// far beyond its strength comes to rest in coarse steps, on half of its way.
    Strain,
    /// c E int sum_ij h_i h_j (d2u / dx_i dx_j)^2 dV: how far a cell departs from the linear extrapolation of its
    /// neighbours. An affine motion of the step meets no resistance: no strain, and no rotation as far as it is linear
    /// in space, so large ones too. On a linear grid only the mixed term is left, and holds next to nothing.
    Curvature,
    /// gamma E h^(2q-1) int_F [d^q u / dn^q]^2 dA on faces between cells: how far the polynomials of two cells differ.
    /// A polynomial of degree q meets no resistance. Better conditioned than the strain form with the same coefficient,
    /// and less of a drag on what has failed; in fine cells stiffer before failure where it is as robust. The matrix
    /// has nearly twice the entries in a plane. In partly filled cells only, it does not hold what has gone far.
    GhostPenalty,
}

impl Kind {
    /// Layers of nodes that it needs beyond those of the cells of a window, see [`Grid::reaching`].
    pub fn beyond(self) -> usize {
        usize::from(self == Self::GhostPenalty)
    }
}

/// Which occupied cells get the background; of the ghost penalty, the faces between occupied cells of which at least
/// one is such a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All occupied cells.
    Occupied,
    /// Cells at the body's edge whose points fill less than .75 of them.
    PartlyFilled,
}

/// Form, coefficient and extent of the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// the form
    pub kind: Kind,
    /// -  fraction c of the largest modulus in the cell
    pub coefficient: f64,
    /// the cells concerned
    pub extent: Extent,
}

/// The background's blocks of one step, of cells or faces.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    cells: Vec<SoftCell>, // ascending by patch
    forms: CellForms,
    faces: GhostFaces,
}

/// A cell with a background: `factor` times a form.
#[derive(Clone, Copy, Debug)]
struct SoftCell {
    patch: usize,
    form: usize,
    factor: f64, // Pa  c E, times a geometry's weight
}

/// Fill below which a cell counts as partly filled. Results hardly depend on it between .5 and .9.
const FILLED: f64 = 0.75;

/// Fill of a function's support below which the function lies at the body's edge. Points that stray between the cells
/// of a sheared or stretched body leave single cells two thirds full in its middle, but no function half empty.
const SUPPORTED: f64 = 0.5;

impl Background {
    /// Blocks of the cells or faces concerned, eps E times the form; a geometry's weight is that of their middles.
    pub fn blocks<K: Kinematics<D>, const D: usize>(
        &self,
        grid: &Grid<D>,
        shape: &Shape<D>,
        points: &Points<D>,
        materials: &[Material],
        halo: &dyn Halo,
    ) -> Blocks {
        let modulus = |patch: &Patch| {
            let young = |p: usize| materials[usize::from(points.material[p])].young_at(points.height(p));
            patch.points.clone().map(young).fold(0.0, f64::max)
        };
        let concerned: Vec<bool> = match self.extent {
            Extent::Occupied => vec![true; shape.patches().len()],
            Extent::PartlyFilled => partly_filled::<K, D>(grid, shape, points, halo),
        };
        let form = match self.kind {
            Kind::Strain => Form::Strain,
            Kind::Curvature => Form::Curvature,
            Kind::GhostPenalty => {
                let faces = GhostFaces::of::<K, D>((grid, shape), (self.coefficient, &concerned), modulus, halo);
                return Blocks { faces, ..Blocks::default() };
            }
        };
        let mut forms = Forms::new(grid, form);
        let cells = shape.patches().iter().enumerate().filter(|(number, _)| concerned[*number]);
        let soft = |(number, patch): (usize, &Patch)| {
            let cell = grid.cell_at(patch.cell);
            let (lower, size) = grid.cell_box(&cell);
            let factor = self.coefficient * modulus(patch) * K::weight(&(lower + size * 0.5));
            SoftCell { patch: number, form: forms.of(&cell), factor }
        };
        let cells = cells.map(soft).collect();
        Blocks { cells, forms: forms.found, ..Blocks::default() }
    }
}

/// Largest number of nodes of a patch: (3 + 1)^3.
const MOST_NODES: usize = 64;

/// Per patch: less than .75 of the cell is filled, and it holds a function at the body's edge.
fn partly_filled<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    shape: &Shape<D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<bool> {
    let volume = |p: usize| points.volume[p] * points.F.at(p).determinant();
    let held = halo.sum(&transfer::to_nodes(shape, |p| [volume(p)]));
    let at_the_edge = |node: usize| held[node] < SUPPORTED * grid.node_volume::<K>(node);
    let concerned = |patch: &Patch| {
        patch.points.clone().map(volume).sum::<f64>() < FILLED * grid.cell_volume::<K>(&grid.cell_at(patch.cell))
            && shape.offsets().iter().any(|offset| at_the_edge(patch.first_node + offset))
    };
    shape.patches().iter().map(concerned).collect()
}

impl Blocks {
    /// f += B u (D numbers a node).
    pub fn multiply<const D: usize>(&self, shape: &Shape<D>, u: &[f64], f: &mut Contributions) {
        self.each_product::<D>(shape, u, |first, _, forces| {
            let f = f.patch(first);
            for (force, offset) in forces.iter().zip(shape.offsets()) {
                (0..D).for_each(|i| f[Nodal::<D>::at(*offset, i)] += force[i]);
            }
        });
        self.faces.multiply::<D>(u, f);
    }

    /// u . B u of the cells and faces of this rank: what the background takes.
    pub fn work<const D: usize>(&self, shape: &Shape<D>, u: &[f64]) -> Exact {
        let mut works = Vec::with_capacity(self.cells.len());
        self.each_product::<D>(shape, u, |_, u, forces| {
            works.push(u.iter().zip(forces).map(|(u, force)| (0..D).map(|i| u[i] * force[i]).sum::<f64>()).sum());
        });
        works.into_iter().chain(self.faces.work::<D>(u)).collect()
    }

    /// Calls `product` for every cell with its first node, what its nodes have of `u` and what its block makes of it.
    fn each_product<const D: usize>(
        &self,
        shape: &Shape<D>,
        u: &[f64],
        mut product: impl FnMut(usize, &[[f64; D]], &[[f64; D]]),
    ) {
        let size = shape.offsets().len();
        let (mut u_of, mut forces) = ([[0.0; D]; LANES * MOST_NODES], [[0.0; D]; LANES * MOST_NODES]);
        for cells in self.cells.chunks(LANES) {
            let first = |cell: &SoftCell| shape.patches()[cell.patch].first_node;
            for (soft, own) in cells.iter().zip(u_of.chunks_exact_mut(size)) {
                for (at_node, offset) in own.iter_mut().zip(shape.offsets()) {
                    at_node.copy_from_slice(&u[Nodal::<D>::of(first(soft) + offset)]);
                }
            }
            let numbers = cells.iter().map(|soft| soft.form);
            self.forms.multiply(numbers, &u_of, &mut forces[..cells.len() * size]);
            for ((soft, own), forces) in cells.iter().zip(u_of.chunks(size)).zip(forces.chunks_mut(size)) {
                forces.as_flattened_mut().iter_mut().for_each(|force| *force *= soft.factor);
                product(first(soft), own, forces);
            }
        }
    }

    /// Number of cells or faces concerned, of this rank.
    pub fn count(&self) -> usize {
        self.cells.len() + self.faces.len()
    }

    /// Nodes of the faces, those of several as often.
    pub fn face_nodes(&self) -> impl Iterator<Item = usize> {
        self.faces.nodes()
    }

    /// Adds what is no part of a patch's block to a matrix.
    pub fn assemble<const D: usize>(&self, solver: &mut dyn LinearSolver) {
        self.faces.assemble::<D>(solver);
    }

    /// Whether the patch of this number has a background of its own.
    pub fn concerns(&self, patch: usize) -> bool {
        self.of(patch).is_some()
    }

    /// Adds that of the patch of this number, if it has one, to the patch's block.
    pub fn add_to<const D: usize>(&self, patch: usize, block: &mut [f64]) {
        if let Some(soft) = self.of(patch) {
            self.forms.add_to::<D>(soft.form, soft.factor, block);
        }
    }

    fn of(&self, patch: usize) -> Option<&SoftCell> {
        let found = self.cells.binary_search_by_key(&patch, |soft| soft.patch).ok()?;
        Some(&self.cells[found])
    }
}
