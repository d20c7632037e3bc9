//! Couples excess pore pressures across C0 lines (repeated breakpoints), where splines of one degree below the grid's
//! are discontinuous.

use crate::grid::{Grid, KnotVector};
use crate::parallel::{Halo, LinearSolver};

/// Conductance of the skin, of what a function stores and lets flow: jumps are such parts of the pressures' changes.
const STIFF: f64 = 1e4;

/// Pairs of functions of degree q - 1 that are one on a line.
#[derive(Clone, Debug, Default)]
pub struct Ties {
    pairs: Vec<Tie>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
struct Tie {
    /// before the line and behind it
    nodes: [usize; 2],
    /// m3/Pa  conductance times the step
    flow: f64,
}

impl Ties {
    /// Of the functions that are `seen`, each of which stores and lets flow `takes`, m3/Pa; nodal arrays of the window.
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

    /// Adds what flows from each of a pair to the other under the nodal pressures `p`, Pa: m3, with the sums that a
    /// node has at `at`.
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

    /// Adds its derivative, each pair on the rank that owns the first of them.
    pub fn assemble(&self, halo: &dyn Halo, solver: &mut dyn LinearSolver) {
        for Tie { nodes, flow } in self.pairs.iter().filter(|tie| halo.owned().contains(tie.nodes[0])) {
            solver.add_block_among(nodes, &[*flow, -flow, -flow, *flow]);
        }
    }
}

/// Numbers of the functions of degree q - 1 of an axis that are 1 on a line from below.
fn torn(axis: &KnotVector) -> Vec<usize> {
    let order = axis.order();
    let before = (0..axis.cells()).filter(|cell| {
        let is_closed = (1..order).all(|k| cell + k < axis.cells() && !axis.has_length(cell + k));
        axis.has_length(*cell) && is_closed && cell + order < axis.cells()
    });
    before.map(|cell| cell + order - 1).collect()
}
