//! Weights of material points in stress integrals, computed at the start of a step: the volumes of the points, or
//! fitted weights. Inside a body, fitted weights integrate splines of one degree below the grid's exactly,
//! theory-manual equation (T2.9).

use crate::boundary::Boundary;
use crate::grid::occupied::OccupiedCells;
use crate::grid::{Grid, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;

/// What points weigh in the internal force, its derivative and its work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Their own volumes.
    #[default]
    Points,
    /// Inside a body, volumes that integrate the splines of degree q - 1 exactly.
    Fitted,
}

/// Passes of the iteration: 0.001 of what is missing is left. With 10 it is 0.02, which dominates the error in fine
/// grids.
const PASSES: usize = 16;
/// Least and largest factor of a volume: a function that few points see might ask for others.
const FACTORS: [f64; 2] = [0.1, 10.0];

/// Weight of every point, m^D of the reference volume; the same bits on any number of ranks. An exchange with the
/// neighbours for every pass of the iteration, and three more.
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

/// Which functions reach into cells that have empty neighbours.
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

/// Chebyshev's iteration for a symmetric system, in terms of its lumped form: needs no sums over all nodes, so that a
/// fixed number of passes costs little and repeats to the bit (Saad, 2003, Iterative Methods for Sparse Linear
/// Systems).
struct Chebyshev {
    way: Vec<f64>,
    rho: f64, // 0 before the first pass
}

impl Chebyshev {
    /// Eigenvalues of the lumped form's inverse times the matrix, none of which is above 1. With exact integrals those
    /// of linear functions begin at 3^-D; what changes from node to node so fast comes slowly. Constants of cells have
    /// ones only.
    const EIGENVALUES: [f64; 2] = [0.05, 1.0];

    fn new(nodes: usize) -> Self {
        Self {
            way: vec![0.0; nodes],
            rho: 0.0,
        }
    }

    /// The next pass, `rest` being what is left of the right-hand side over the lumped form.
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
