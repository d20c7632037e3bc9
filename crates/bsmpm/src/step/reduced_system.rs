//! Step (6): the matrix E^T K E of extended splines, for a solver that knows nothing of them.
//!
//! Blocks go on to the solver as they are. There the rows and columns of tied components are lost, as these are no
//! unknowns. Here the entries with a tied row or column are kept, and once all blocks are there they are added to the
//! rows and columns of the homes:
//!
//! ```text
//! (E^T K E)_im = K_im + sum_j e_ij K_jm + sum_k K_ik e_mk + sum_jk e_ij K_jk e_mk.
//! ```
//!
//! The pattern of the matrix stays as it is. An entry of two homes that lie farther apart than nodes couple in it is
//! replaced by its absolute value on both diagonals: what that adds is positive semidefinite, so that the matrix stays
//! definite, and the quasi-Newton secants (Newton's Krylov method) correct it like all that K_0 leaves out.
//!
//! An entry is summed by columns of cells, in their order, so that it has the same bits on any number of ranks.

use crate::error::SolveError;
use crate::grid::Grid;
use crate::nodal::Nodal;
use crate::parallel::{Halo, Krylov, LinearSolver, Solved, Symmetry};
use crate::step::extension::Extension;
use std::collections::BTreeMap;

/// Numbers of two nodes in the whole grid: row and column of a block.
type NodePair = [usize; 2];

/// A linear system behind which there is one of the inner functions alone.
pub struct ReducedSystem<'a, const D: usize> {
    solver: &'a mut dyn LinearSolver,
    extension: &'a Extension<D>,
    grid: &'a Grid<D>,
    halo: &'a dyn Halo,
    offsets: Vec<usize>,
    blocks: BTreeMap<NodePair, ColumnSums>,
}

/// D x D blocks by the column of cells that they come from, which is the layer of the lowest node of the sum.
type ColumnSums = BTreeMap<usize, Vec<f64>>;

impl<'a, const D: usize> ReducedSystem<'a, D> {
    /// In front of a `solver` for the window of a grid.
    pub fn new(
        solver: &'a mut dyn LinearSolver,
        extension: &'a Extension<D>,
        grid: &'a Grid<D>,
        halo: &'a dyn Halo,
    ) -> Self {
        Self { solver, extension, grid, halo, offsets: grid.offsets(), blocks: BTreeMap::new() }
    }

    /// Keeps the entries of a dense block that have a tied row or column.
    fn keep(&mut self, nodes: &[usize], block: &[f64]) {
        let ties = |node: usize| self.extension.tie_of(node).is_some();
        let is_tied: Vec<bool> = nodes.iter().map(|&node| ties(node)).collect();
        if !is_tied.contains(&true) {
            return;
        }
        let column = self.grid.node_at(nodes[0])[0];
        let order = nodes.len() * D;
        for (a, &row) in nodes.iter().enumerate() {
            for (b, &other) in nodes.iter().enumerate().filter(|(b, _)| is_tied[a] || is_tied[*b]) {
                let pair = [self.grid.number_of(row), self.grid.number_of(other)];
                let sums = self.blocks.entry(pair).or_default().entry(column).or_insert_with(|| vec![0.0; D * D]);
                for i in 0..D {
                    let entries = &block[(a * D + i) * order + b * D..][..D];
                    sums[i * D..(i + 1) * D].iter_mut().zip(entries).for_each(|(sum, entry)| *sum += entry);
                }
            }
        }
    }

    /// The kept blocks, each summed over the columns of cells of all ranks. One gathering where ties are published.
    fn complete_blocks(&mut self) -> BTreeMap<NodePair, Vec<f64>> {
        let mut kept = std::mem::take(&mut self.blocks);
        if self.extension.is_published() {
            let is_own = |number: usize| self.extension.tie_of_number(number).is_some_and(|tie| !tie.is_published);
            let (mut message, mut own) = (Vec::new(), BTreeMap::new());
            for (pair, sums) in kept {
                if pair.iter().any(|&number| is_own(number)) {
                    own.insert(pair, sums);
                    continue;
                }
                for (column, block) in sums {
                    message.extend([pair[0] as f64, pair[1] as f64, column as f64]);
                    message.extend_from_slice(&block);
                }
            }
            kept = own;
            for item in self.halo.gather(&message).chunks_exact(3 + D * D) {
                let (pair, column) = ([item[0] as usize, item[1] as usize], item[2] as usize);
                let sums = kept.entry(pair).or_default().entry(column).or_insert_with(|| vec![0.0; D * D]);
                sums.iter_mut().zip(&item[3..]).for_each(|(sum, entry)| *sum += entry);
            }
        }
        let total = |sums: ColumnSums| {
            let mut total = vec![0.0; D * D];
            for block in sums.into_values() {
                total.iter_mut().zip(block).for_each(|(sum, entry)| *sum += entry);
            }
            total
        };
        kept.into_iter().map(|(pair, sums)| (pair, total(sums))).collect()
    }

    /// Functions that carry a node's function, with their weights by component: its home's, or itself.
    fn carriers(&self, number: usize) -> Vec<(usize, [f64; D])> {
        let Some(tie) = self.extension.tie_of_number(number) else { return vec![(number, [1.0; D])] };
        let weights = |weight: f64| std::array::from_fn(|i| if tie.tied[i] { weight } else { 0.0 });
        tie.inner.iter().map(|inner| (inner.number, weights(inner.weight))).collect()
    }

    /// The blocks that the kept ones add between carriers.
    fn carried_blocks(&mut self) -> BTreeMap<NodePair, Vec<f64>> {
        let mut carried: BTreeMap<NodePair, Vec<f64>> = BTreeMap::new();
        for ([row, column], block) in self.complete_blocks() {
            let columns = self.carriers(column);
            for (row, row_weights) in self.carriers(row) {
                for (column, column_weights) in &columns {
                    let sums = carried.entry([row, *column]).or_insert_with(|| vec![0.0; D * D]);
                    for (at, sum) in sums.iter_mut().enumerate() {
                        *sum += row_weights[at / D] * block[at] * column_weights[at % D];
                    }
                }
            }
        }
        carried
    }

    /// Adds E^T K E - K_II to the solver's matrix, every entry on one rank.
    fn add_carried_blocks(&mut self) {
        let mut diagonal = vec![0.0; self.grid.nodes() * D];
        for ([row, column], block) in self.carried_blocks() {
            let nodes = [row, column].map(|number| self.grid.node_of_number(number));
            if !self.couples(row, column) {
                let lumped: [f64; D] =
                    std::array::from_fn(|i| 0.5 * (0..D).map(|j| block[i * D + j].abs()).sum::<f64>());
                let across: [f64; D] =
                    std::array::from_fn(|j| 0.5 * (0..D).map(|i| block[i * D + j].abs()).sum::<f64>());
                for (node, lumped) in nodes.into_iter().zip([lumped, across]) {
                    let Some(node) = node else { continue };
                    diagonal[Nodal::<D>::of(node)].iter_mut().zip(lumped).for_each(|(sum, part)| *sum += part);
                }
                continue;
            }
            if let ([Some(row), Some(column)], true) = (nodes, self.owns_lowest(row, column)) {
                self.add_block(row, column, &block);
            }
        }
        self.solver.add_diagonal(&diagonal);
    }

    /// Whether the pattern of the matrix has the block of two nodes.
    fn couples(&self, row: usize, column: usize) -> bool {
        let [row, column] = [row, column].map(|number| self.grid.place_of_number(number));
        let reach = self.grid.order() + self.grid.beyond();
        (0..D).all(|axis| row[axis].abs_diff(column[axis]) <= reach)
    }

    /// Whether the lowest node of the box around two nodes is this rank's own: its window has both.
    fn owns_lowest(&self, row: usize, column: usize) -> bool {
        let [row, column] = [row, column].map(|number| self.grid.place_of_number(number));
        let lowest = std::array::from_fn(|axis| row[axis].min(column[axis]));
        self.grid.node_index(&lowest).is_some_and(|node| self.halo.owned().contains(node))
    }

    fn add_block(&mut self, row: usize, column: usize, block: &[f64]) {
        if row == column {
            self.solver.add_among(&[row], block);
            return;
        }
        let mut nodes = [row, column];
        nodes.sort_unstable();
        let [from, to] = [row, column].map(|node| usize::from(node == nodes[1]));
        let mut pair = vec![0.0; 4 * D * D];
        for i in 0..D {
            let start = (from * D + i) * 2 * D + to * D;
            pair[start..start + D].copy_from_slice(&block[i * D..(i + 1) * D]);
        }
        self.solver.add_among(&nodes, &pair);
    }
}

impl<const D: usize> LinearSolver for ReducedSystem<'_, D> {
    fn begin(&mut self, free: &[bool]) {
        self.blocks.clear();
        self.solver.begin(free);
    }

    fn add(&mut self, first_node: usize, block: &[f64]) {
        let nodes: Vec<usize> = self.offsets.iter().map(|offset| first_node + offset).collect();
        self.keep(&nodes, block);
        self.solver.add(first_node, block);
    }

    fn add_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.keep(nodes, block);
        self.solver.add_among(nodes, block);
    }

    /// Of nodes that are not tied: without inertia no others have any.
    fn add_diagonal(&mut self, diagonal: &[f64]) {
        self.solver.add_diagonal(diagonal);
    }

    fn finish(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        self.add_carried_blocks();
        self.solver.finish(symmetry)
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<Solved, SolveError> {
        self.solver.solve(rhs, solution)
    }

    fn is_rough(&self) -> bool {
        self.solver.is_rough()
    }

    fn solve_to(&mut self, relative: f64, rhs: &[f64], solution: &mut [f64]) -> Result<Solved, SolveError> {
        self.solver.solve_to(relative, rhs, solution)
    }

    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        self.solver.solve_with(product, relative, rhs, solution)
    }

    fn water(&mut self) -> Option<&mut dyn LinearSolver> {
        self.solver.water()
    }
}
