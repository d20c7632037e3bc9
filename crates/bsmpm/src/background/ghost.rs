//! The ghost penalty: gamma E h^(2q-1) int_F [d^q u / dn^q] . [d^q v / dn^q] dA on faces between occupied cells.
//!
//! Splines of degree q join their cells with q - 1 continuous derivatives: the jump of the q-th along the normal is all
//! that tells the polynomials of two cells apart, so that a polynomial of degree q meets no resistance. A face has q +
//! 2 nodes along its normal and q + 1 along it, one more than a cell; its cells may be those of two ranks. Where a
//! repeated breakpoint lies between two cells there is no face: strains may jump there.

use super::integrals::{FormProducts, products};
use crate::grid::shape::{Patch, Shape};
use crate::grid::{Contributions, Grid, KnotVector};
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::parallel::{Halo, LinearSolver};

/// The faces of one step.
#[derive(Clone, Debug, Default)]
pub(super) struct GhostFaces {
    offsets: Vec<Vec<usize>>, // of a face's nodes from its first one, by its normal, which is the slowest
    faces: Vec<GhostFace>,
}

#[derive(Clone, Debug)]
struct GhostFace {
    first_node: usize,
    normal: usize,
    jump: Vec<f64>, // m^-q  of the q-th derivative, by node along the normal
    mass: Vec<f64>, // Pa m^(D+2q-2)  gamma E h^(2q-1) int N_a N_b dA, row-major square
}

/// Largest number of nodes along a face: (3 + 1)^2.
const MOST_ALONG: usize = 16;

impl GhostFaces {
    /// Faces with a cell of this rank below and a concerned cell on one side or on both; `modulus` in Pa, the largest
    /// of a patch; h is the mean of the two cells' lengths.
    pub(super) fn of<K: Kinematics<D>, const D: usize>(
        (grid, shape): (&Grid<D>, &Shape<D>),
        (coefficient, concerned): (f64, &[bool]),
        modulus: impl Fn(&Patch) -> f64,
        halo: &dyn Halo,
    ) -> Self {
        // A cell is told to the rank below at its first node.
        let mut cells = vec![0.0; 2 * grid.nodes()];
        for (patch, concerned) in shape.patches().iter().zip(concerned) {
            cells[2 * patch.first_node] = modulus(patch);
            cells[2 * patch.first_node + 1] = f64::from(u8::from(*concerned));
        }
        halo.max(&mut cells, 2);
        let products = products(grid);
        let offsets: Vec<Vec<usize>> = (0..D).map(|normal| offsets(grid, normal)).collect();
        let mut faces = Vec::new();
        for patch in shape.patches() {
            let cell = grid.cell_at(patch.cell);
            for (normal, axis) in grid.axes().iter().enumerate() {
                if cell[normal] + 1 == axis.cells() {
                    continue;
                }
                let next = patch.first_node + offsets[normal][along(grid)];
                let sides = [patch.first_node, next].map(|node| (cells[2 * node], cells[2 * node + 1] > 0.0));
                if sides[1].0 > 0.0 && (sides[0].1 || sides[1].1) {
                    let (lower, size) = grid.cell_box(&cell);
                    let middle =
                        lower + size.map_with_location(|along, _, h| if along == normal { h } else { 0.5 * h });
                    let factor = coefficient * sides[0].0.max(sides[1].0) * K::weight(&middle);
                    faces.push(GhostFace::new((grid, &products), (patch.first_node, &cell, normal), factor));
                }
            }
        }
        Self { offsets, faces }
    }

    /// Number of faces.
    pub(super) fn len(&self) -> usize {
        self.faces.len()
    }

    /// The nodes of all faces, those of several as often.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().flat_map(|face| self.offsets[face.normal].iter().map(move |offset| face.first_node + offset))
    }

    /// u . B u of every face.
    pub(super) fn work<const D: usize>(&self, u: &[f64]) -> impl Iterator<Item = f64> {
        self.faces.iter().map(|face| {
            let work = |component| {
                let jumps = self.jumps::<D>(face, u, component);
                let row = |(row, jump): (&[f64], &f64)| jump * row.iter().zip(&jumps).map(|(m, j)| m * j).sum::<f64>();
                face.mass.chunks_exact(face.width()).zip(&jumps).map(row).sum::<f64>()
            };
            (0..D).map(work).sum()
        })
    }

    /// Jumps of a component's derivative at the nodes along a face.
    fn jumps<const D: usize>(&self, face: &GhostFace, u: &[f64], component: usize) -> [f64; MOST_ALONG] {
        let (offsets, width) = (&self.offsets[face.normal], face.width());
        let mut jumps = [0.0; MOST_ALONG];
        for (layer, weight) in face.jump.iter().enumerate() {
            for (node, jump) in jumps[..width].iter_mut().enumerate() {
                *jump += weight * u[Nodal::<D>::at(face.first_node + offsets[layer * width + node], component)];
            }
        }
        jumps
    }

    /// f += B u (D numbers a node).
    pub(super) fn multiply<const D: usize>(&self, u: &[f64], f: &mut Contributions) {
        for face in &self.faces {
            let f = f.patch(face.first_node);
            let (offsets, width) = (&self.offsets[face.normal], face.width());
            for component in 0..D {
                let jumps = self.jumps::<D>(face, u, component);
                for (node, row) in face.mass.chunks_exact(width).enumerate() {
                    let force: f64 = row.iter().zip(&jumps).map(|(mass, jump)| mass * jump).sum();
                    for (layer, weight) in face.jump.iter().enumerate() {
                        f[Nodal::<D>::at(offsets[layer * width + node], component)] += weight * force;
                    }
                }
            }
        }
    }

    /// Adds B to a matrix.
    pub(super) fn assemble<const D: usize>(&self, solver: &mut dyn LinearSolver) {
        let (mut nodes, mut block) = (Vec::new(), Vec::new());
        for face in &self.faces {
            nodes.clear();
            nodes.extend(self.offsets[face.normal].iter().map(|offset| face.first_node + offset));
            face.fill::<D>(&mut block);
            solver.add_among(&nodes, &block);
        }
    }
}

impl GhostFace {
    fn new<const D: usize>(
        (grid, products): (&Grid<D>, &[Vec<FormProducts>; D]),
        (first_node, cell, normal): (usize, &[usize; D], usize),
        factor: f64,
    ) -> Self {
        let axis = &grid.axes()[normal];
        let (below, q) = (cell[normal], grid.order());
        let h = 0.5 * (axis.breakpoint(below + 2) - axis.breakpoint(below));
        let mut mass = vec![factor * h.powi(2 * q as i32 - 1)];
        for other in (0..D).filter(|&other| other != normal) {
            mass = product(&mass, &products[other][cell[other]][0]);
        }
        Self { first_node, normal, jump: jump(axis, below), mass }
    }

    /// Nodes along the face.
    fn width(&self) -> usize {
        self.mass.len().isqrt()
    }

    /// The block of the face, row-major square: equal for every component, which do not couple.
    fn fill<const D: usize>(&self, block: &mut Vec<f64>) {
        let (width, layers) = (self.width(), self.jump.len());
        let order = layers * width * D;
        block.clear();
        block.resize(order * order, 0.0);
        for (a, row) in block.chunks_exact_mut(order * D).enumerate() {
            let (jump, mass) = (self.jump[a / width], &self.mass[a % width * width..][..width]);
            for b in 0..layers * width {
                let value = jump * self.jump[b / width] * mass[b % width];
                (0..D).for_each(|c| row[c * order + b * D + c] = value);
            }
        }
    }
}

/// Nodes along a face, (q + 1)^(D - 1).
fn along<const D: usize>(grid: &Grid<D>) -> usize {
    (grid.order() + 1).pow(D as u32 - 1)
}

/// Offsets of a face's nodes from its first one: the layers along the normal first, then the other axes in their order.
fn offsets<const D: usize>(grid: &Grid<D>, normal: usize) -> Vec<usize> {
    let stride = |axis: usize| (axis + 1..D).map(|axis| grid.nodes_along(axis)).product::<usize>();
    let mut offsets: Vec<usize> = (0..grid.order() + 2).map(|layer| layer * stride(normal)).collect();
    for axis in (0..D).filter(|&axis| axis != normal) {
        let further = |offset: usize| (0..=grid.order()).map(move |node| offset + node * stride(axis));
        offsets = offsets.into_iter().flat_map(further).collect();
    }
    offsets
}

/// Kronecker product of two row-major square matrices.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let (m, n) = (a.len().isqrt(), b.len().isqrt());
    let entry = |at: usize| {
        let (row, column) = (at / (m * n), at % (m * n));
        a[row / n * m + column / n] * b[row % n * n + column % n]
    };
    (0..m * n * m * n).map(entry).collect()
}

/// Jump of the q-th derivative at the upper end of `cell`, 1/m^q: of the q + 2 functions that begin with number `cell`.
fn jump(axis: &KnotVector, cell: usize) -> Vec<f64> {
    let mut jump = vec![0.0; axis.order() + 2];
    for (a, value) in highest(axis, cell).into_iter().enumerate() {
        jump[a] -= value;
    }
    for (a, value) in highest(axis, cell + 1).into_iter().enumerate() {
        jump[a + 1] += value;
    }
    jump
}

/// The q-th derivative of the q + 1 functions of `cell`, constant there, 1/m^q: every derivative of a spline of degree
/// p has the coefficients p (c_i - c_(i-1)) / (t_(i+p) - t_i) on the splines of degree p - 1.
fn highest(axis: &KnotVector, cell: usize) -> Vec<f64> {
    let q = axis.order();
    let of = |function: usize| {
        let mut c: Vec<f64> = (0..=q).map(|i| f64::from(u8::from(i == function))).collect();
        for degree in (1..=q).rev() {
            for i in (q - degree + 1..=q).rev() {
                let support = axis.knot(cell + i + degree) - axis.knot(cell + i);
                c[i] = degree as f64 * (c[i] - c[i - 1]) / support;
            }
        }
        c[q]
    };
    (0..=q).map(of).collect()
}
