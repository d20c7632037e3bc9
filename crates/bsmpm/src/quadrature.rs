//! Weights of material points in stress integrals, computed at the start of a step: the volumes of the points, or
//! fitted weights, theory-manual equation (T2.9).

use crate::boundary::Boundary;
use crate::grid::occupied::OccupiedCells;
use crate::grid::{Grid, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;

/// Weights of points in the internal force, its derivative and its work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Volumes of the points.
    #[default]
    Points,
    /// Fitted volumes that, inside a body, integrate splines of degree q - 1 exactly.
    Fitted,
}

/// Passes of the iteration, which reduce the defect to 0.001. With 10 passes 0.02 remains and dominates the error on
/// fine grids.
const PASSES: usize = 16;
/// Bounds of the ratio of a weight to the volume of the point; functions with few points might require other values.
const FACTORS: [f64; 2] = [0.1, 10.0];

/// Returns the weights of the points (m^D of the reference volume), bitwise identical on any number of ranks. One
/// exchange with the neighbours per pass, and three more.
pub fn fitted<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    boundary: &Boundary<D>,
    shape: &Shape<D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    let lower = shape.lowered(grid, points);
    let volume: Vec<f64> = (0..points.len())
        .map(|p| points.volume[p] * points.F.at(p).determinant())
        .collect();
    let own = halo.assemble_ghosts(&transfer::to_nodes(&lower, |p| [volume[p]]));
    let outside = outside(grid, boundary, &lower, halo);
    let missing: Vec<f64> = (0..own.len())
        .map(|node| grid.lowered_volume::<K>(node) - own[node])
        .collect();
    let mut chebyshev = Chebyshev::new(own.len());
    let mut found = vec![0.0; own.len()];
    for _ in 0..PASSES {
        let change: Vec<f64> = transfer::to_points::<D, 1, _>(&lower, &found, |_, [change]| change);
        let changed = halo.assemble_ghosts(&transfer::to_nodes(&lower, |p| [volume[p] * change[p]]));
        chebyshev.advance(&mut found, |node| {
            let is_inside = !outside[node] && own[node] > 0.0;
            if is_inside {
                (missing[node] - changed[node]) / own[node]
            } else {
                0.0
            }
        });
    }
    let [least, most] = FACTORS;
    transfer::to_points::<D, 1, _>(&lower, &found, |p, [change]| {
        points.volume[p] * (1.0 + change).clamp(least, most)
    })
}

/// Returns whether the function of each node extends into cells with empty neighbours.
fn outside<const D: usize>(grid: &Grid<D>, boundary: &Boundary<D>, lower: &Shape<D>, halo: &dyn Halo) -> Vec<bool> {
    let occupied = OccupiedCells::of(grid, lower.patches().iter().map(|patch| patch.cell), halo);
    let closed = boundary.closed();
    let mut marks = vec![0.0; grid.nodes()];
    for patch in lower.patches() {
        if !occupied.surround(&grid.cell_at(patch.cell), &closed) {
            lower
                .offsets()
                .iter()
                .for_each(|offset| marks[patch.first_node + offset] = 1.0);
        }
    }
    halo.ghost_max(&mut marks, 1);
    marks.iter().map(|&mark| mark > 0.0).collect()
}

/// Chebyshev iteration for a symmetric system, preconditioned by its lumped matrix (Saad, 2003, Iterative Methods for
/// Sparse Linear Systems). It needs no global sums, so that a fixed number of passes is cheap and bitwise reproducible.
struct Chebyshev {
    way: Vec<f64>,
    rho: f64, // 0 before the first pass
}

impl Chebyshev {
    /// Bounds of the eigenvalues of the lumped matrix's inverse times the matrix; the largest is 1. With exact
    /// integrals the smallest one is 3^-D for linear functions, but its mode oscillates from node to node and converges
    /// slowly. For functions that are constant in each cell all eigenvalues are 1.
    const EIGENVALUES: [f64; 2] = [0.05, 1.0];

    fn new(nodes: usize) -> Self {
        Self {
            way: vec![0.0; nodes],
            rho: 0.0,
        }
    }

    /// Performs a pass; `rest` returns the residual divided by the lumped matrix.
    fn advance(&mut self, found: &mut [f64], rest: impl Fn(usize) -> f64) {
        let [least, most] = Self::EIGENVALUES;
        let middle = 0.5 * (most + least);
        let half = 0.5 * (most - least);
        let (keep, take) = if self.rho == 0.0 {
            self.rho = half / middle;
            (0.0, 1.0 / middle)
        } else {
            let before = self.rho;
            self.rho = 1.0 / (2.0 * middle / half - before);
            (self.rho * before, 2.0 * self.rho / half)
        };
        for (node, (found, way)) in found.iter_mut().zip(&mut self.way).enumerate() {
            *way = keep * *way + take * rest(node);
            *found += *way;
        }
    }
}
