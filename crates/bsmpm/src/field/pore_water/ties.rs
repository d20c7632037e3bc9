//! Couples excess pore pressures across C0 lines (repeated breakpoints), where splines of one degree below the grid's
//! are discontinuous.

use crate::grid::{Grid, KnotVector};
use crate::linear::MatrixAssembly;
use crate::parallel::Halo;

/// Conductance of a coupling relative to storage and flow of its functions; pressure jumps are then 1e-4 of the
/// pressure changes.
const STIFF: f64 = 1e4;

/// Couplings of functions of degree q - 1 that equal 1 on either side of a C0 line.
#[derive(Clone, Debug, Default)]
pub struct Ties {
    pairs: Vec<Tie>,
}

/// Coupling of two functions.
#[derive(Clone, Copy, Debug)]
struct Tie {
    /// Nodes before and behind the line.
    nodes: [usize; 2],
    /// Conductance times the length of the step (m3/Pa).
    flow: f64,
}

impl Ties {
    /// Creates the couplings of the functions that are `seen`; `takes` is the storage and flow of each function
    /// (m3/Pa). Both arrays are nodal, on the window of this rank.
    pub fn of<const D: usize>(grid: &Grid<D>, seen: &[bool], takes: &[f64]) -> Self {
        let torn = grid.axes().each_ref().map(torn);
        let mut pairs = Vec::new();
        for (axis, torn) in torn.iter().enumerate().filter(|(_, torn)| !torn.is_empty()) {
            for node in (0..grid.nodes()).filter(|&node| seen[node]) {
                let mut number = grid.node_at(node);
                if !torn.contains(&number[axis]) {
                    continue;
                }
                number[axis] += 1;
                if let Some(behind) = grid.node_index(&number).filter(|&behind| seen[behind]) {
                    pairs.push(Tie {
                        nodes: [node, behind],
                        flow: STIFF * (takes[node] + takes[behind]),
                    });
                }
            }
        }
        Self { pairs }
    }

    /// Adds the flow within each pair under the nodal pressures `p` (Pa) to `sums` (m3); `at` gives the index of a node
    /// in `sums`.
    pub fn add_to(&self, p: &[f64], sums: &mut [f64], at: impl Fn(usize) -> usize) {
        for Tie {
            nodes: [before, behind],
            flow,
        } in &self.pairs
        {
            let through = flow * (p[*before] - p[*behind]);
            sums[at(*before)] += through;
            sums[at(*behind)] -= through;
        }
    }

    /// Adds the derivative of the flow to the matrix. The rank that owns the first node of a pair adds it.
    pub fn assemble(&self, halo: &dyn Halo, matrix: &mut dyn MatrixAssembly) {
        for Tie { nodes, flow } in self.pairs.iter().filter(|tie| halo.owned().contains(tie.nodes[0])) {
            matrix.add_block_among(nodes, &[*flow, -flow, -flow, *flow]);
        }
    }
}

/// Returns the numbers of the functions of degree q - 1 of an axis that equal 1 on a C0 line, approached from below.
fn torn(axis: &KnotVector) -> Vec<usize> {
    let order = axis.order();
    let before = (0..axis.cells()).filter(|cell| {
        let is_closed = (1..order).all(|k| cell + k < axis.cells() && !axis.has_length(cell + k));
        axis.has_length(*cell) && is_closed && cell + order < axis.cells()
    });
    before.map(|cell| cell + order - 1).collect()
}
