//! Assembles the matrix E^T K E of extended splines, theory-manual equation (T2.12). A tied component is not an
//! unknown. Its row and column are added to those of the functions to which it is tied, with weights e:
//!
//! ```text
//! (E^T K E)_im = K_im + sum_j e_ij K_jm + sum_k K_ik e_mk + sum_jk e_ij K_jk e_mk.
//! ```

use crate::grid::Grid;
use crate::linear::MatrixAssembly;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::step::extension::{Extension, InnerFunction, Tie};
use crate::step::problem::Problem;
use crate::tensor::{Square, Vector};
use std::collections::BTreeMap;

/// Assembles by `fill` into `matrix`. Where outer splines are extended, the matrix is reduced to the inner ones.
pub fn assemble<K, const D: usize>(
    problem: &Problem<'_, K, D>,
    matrix: &mut dyn MatrixAssembly,
    fill: impl FnOnce(&mut dyn MatrixAssembly),
) {
    let Some(extension) = &problem.nodes.constraints.extension else {
        return fill(matrix);
    };
    let mut reduced = ReducedMatrix::new(matrix, extension, &problem.model.grid, problem.halo);
    fill(&mut reduced);
    reduced.add_carried_blocks();
}

/// A matrix that is reduced to the inner splines while it is assembled.
struct ReducedMatrix<'a, const D: usize> {
    matrix: &'a mut dyn MatrixAssembly,
    extension: &'a Extension<D>,
    grid: &'a Grid<D>,
    halo: &'a dyn Halo,
    offsets: Vec<usize>,
    kept: Vec<KeptBlocks<D>>, // of every tie
}

/// Blocks between a tied node and other nodes.
#[derive(Clone, Debug, Default)]
struct KeptBlocks<const D: usize> {
    /// K_Jm of the tied node J and any node m.
    row: Blocks<D>,
    /// K_iJ of any node i that is not tied.
    column: Blocks<D>,
}

type Blocks<const D: usize> = BTreeMap<BlockOrigin, Square<D>>;

/// The other node of a block, and the column of cells that contributes the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct BlockOrigin {
    /// Number of the other node in the whole grid.
    other: usize,
    /// Column of cells: the layer of the lowest node of the contribution.
    cells: usize,
}

/// Numbers of two nodes in the whole grid: row and column of a block.
type NodePair = [usize; 2];

impl<'a, const D: usize> ReducedMatrix<'a, D> {
    /// Wraps a `matrix` for the window of a grid.
    fn new(
        matrix: &'a mut dyn MatrixAssembly,
        extension: &'a Extension<D>,
        grid: &'a Grid<D>,
        halo: &'a dyn Halo,
    ) -> Self {
        Self {
            matrix,
            extension,
            grid,
            halo,
            offsets: grid.offsets(),
            kept: Vec::new(),
        }
    }

    /// Keeps the blocks of a dense matrix that have a tied row or column.
    fn keep(&mut self, nodes: &[usize], block: &[f64]) {
        let ties: Vec<Option<usize>> = nodes.iter().map(|&node| self.extension.place_of(node)).collect();
        let cells = self.grid.node_at(nodes[0])[0];
        let origins: Vec<BlockOrigin> = nodes
            .iter()
            .map(|&node| BlockOrigin {
                other: self.grid.number_of(node),
                cells,
            })
            .collect();
        let order = nodes.len() * D;
        for (a, &row) in ties.iter().enumerate() {
            for (b, &column) in ties.iter().enumerate() {
                let sums = match (row, column) {
                    (Some(tie), _) => self.kept[tie].row.entry(origins[b]),
                    (None, Some(tie)) => self.kept[tie].column.entry(origins[a]),
                    (None, None) => continue,
                };
                *sums.or_insert_with(Square::zeros) += Square::from_fn(|i, j| block[(a * D + i) * order + b * D + j]);
            }
        }
    }

    /// Returns whether a block couples with a tie that belongs to this rank alone.
    fn is_own(&self, origin: &BlockOrigin) -> bool {
        let place = self.extension.place_of_number(origin.other);
        place.is_some_and(|place| !self.extension.ties()[place].is_published)
    }

    /// Completes the blocks of published ties by those of other ranks. One gather.
    fn exchange(&self, kept: &mut [KeptBlocks<D>]) {
        let extension = self.extension;
        let mut message = Vec::new();
        for (tie, blocks) in extension
            .ties()
            .iter()
            .zip(&mut *kept)
            .filter(|(tie, _)| tie.is_published)
        {
            for (part, blocks) in [&mut blocks.row, &mut blocks.column].into_iter().enumerate() {
                for (origin, block) in blocks.iter().filter(|(origin, _)| !self.is_own(origin)) {
                    message.extend([tie.number, part, origin.other, origin.cells].map(|number| number as f64));
                    message.extend_from_slice(block.as_slice());
                }
                blocks.retain(|origin, _| self.is_own(origin));
            }
        }
        for item in self.halo.gather(&message).chunks_exact(4 + D * D) {
            let [tie, part, other, cells] = [0, 1, 2, 3].map(|at| item[at] as usize);
            let Some(place) = extension.place_of_number(tie) else {
                continue;
            };
            let blocks = if part == 0 {
                &mut kept[place].row
            } else {
                &mut kept[place].column
            };
            *blocks.entry(BlockOrigin { other, cells }).or_insert_with(Square::zeros) +=
                Square::from_column_slice(&item[4..]);
        }
    }

    /// Returns the contributions of the kept blocks between inner splines: E^T K_Jm E_m of every tied row J, and K_iJ
    /// E_J of every tied column.
    fn carried_blocks(&mut self) -> BTreeMap<NodePair, Square<D>> {
        let mut kept = std::mem::take(&mut self.kept);
        if self.extension.is_published() {
            self.exchange(&mut kept);
        }
        let mut carried: BTreeMap<NodePair, Square<D>> = BTreeMap::new();
        for (tie, blocks) in self.extension.ties().iter().zip(kept) {
            let mut row: BTreeMap<usize, Square<D>> = BTreeMap::new();
            for (other, block) in sums_over_cells(blocks.row) {
                let Some(place) = self.extension.place_of_number(other) else {
                    *row.entry(other).or_insert_with(Square::zeros) += block;
                    continue;
                };
                let other = &self.extension.ties()[place];
                for inner in &other.inner {
                    *row.entry(inner.number).or_insert_with(Square::zeros) += block * weights(other, inner);
                }
            }
            for (column, block) in row {
                for inner in &tie.inner {
                    *carried.entry([inner.number, column]).or_insert_with(Square::zeros) += weights(tie, inner) * block;
                }
            }
            for (row, block) in sums_over_cells(blocks.column) {
                for inner in &tie.inner {
                    *carried.entry([row, inner.number]).or_insert_with(Square::zeros) += block * weights(tie, inner);
                }
            }
        }
        carried
    }

    /// Adds E^T K E - K_II to the matrix, every entry on one rank. Blocks of patches are square, so each pair
    /// of nodes has both blocks.
    fn add_carried_blocks(&mut self) {
        let mut diagonal = vec![0.0; self.grid.nodes() * D];
        let carried = self.carried_blocks();
        for ([first, second], block) in carried.iter().filter(|([first, second], _)| first <= second) {
            let nodes = [*first, *second].map(|number| self.grid.node_of_number(number));
            let mirror = &carried[&[*second, *first]];
            if !self.couples(*first, *second) {
                for (block, nodes) in [(block, nodes), (mirror, [nodes[1], nodes[0]])] {
                    add_lumped(block, nodes, &mut diagonal);
                }
                continue;
            }
            let ([Some(row), Some(column)], true) = (nodes, self.owns_lowest(*first, *second)) else {
                continue;
            };
            if row == column {
                self.matrix.add_block_among(&[row], block.transpose().as_slice());
            } else {
                self.add_pair([row, column], [block, mirror]);
            }
        }
        self.matrix.add_diagonal(&diagonal);
    }

    /// Returns whether the sparsity pattern contains the block of two nodes.
    fn couples(&self, row: usize, column: usize) -> bool {
        let [row, column] = [row, column].map(|number| self.grid.place_of_number(number));
        let reach = self.grid.order() + self.grid.beyond();
        (0..D).all(|axis| row[axis].abs_diff(column[axis]) <= reach)
    }

    /// Returns whether this rank owns the lowest node of the box around two nodes, so that its window contains both.
    fn owns_lowest(&self, row: usize, column: usize) -> bool {
        let [row, column] = [row, column].map(|number| self.grid.place_of_number(number));
        let lowest = std::array::from_fn(|axis| row[axis].min(column[axis]));
        self.grid
            .node_index(&lowest)
            .is_some_and(|node| self.halo.owned().contains(node))
    }

    /// Adds the two off-diagonal blocks of a pair of nodes: (first, second) and (second, first).
    fn add_pair(&mut self, nodes: [usize; 2], blocks: [&Square<D>; 2]) {
        let mut pair = vec![0.0; 4 * D * D];
        for i in 0..D {
            for j in 0..D {
                pair[i * 2 * D + D + j] = blocks[0][(i, j)];
                pair[(D + i) * 2 * D + j] = blocks[1][(i, j)];
            }
        }
        self.matrix.add_block_among(&nodes, &pair);
    }
}

/// Adds half the absolute values of a block to the diagonals of its row's and its column's node, if they are in the
/// window.
fn add_lumped<const D: usize>(block: &Square<D>, nodes: [Option<usize>; 2], diagonal: &mut [f64]) {
    let absolute = block.abs() * 0.5;
    let lumped = [absolute.column_sum(), absolute.row_sum().transpose()];
    for (node, lumped) in nodes.into_iter().zip(lumped) {
        let Some(node) = node else { continue };
        diagonal[Nodal::<D>::of(node)]
            .iter_mut()
            .zip(&lumped)
            .for_each(|(sum, part)| *sum += part);
    }
}

/// Sums the blocks of each other node over the columns of cells, in their order.
fn sums_over_cells<const D: usize>(blocks: Blocks<D>) -> Vec<(usize, Square<D>)> {
    let mut sums: Vec<(usize, Square<D>)> = Vec::new();
    for (origin, block) in blocks {
        match sums.last_mut().filter(|(other, _)| *other == origin.other) {
            Some((_, sum)) => *sum += block,
            None => sums.push((origin.other, block)),
        }
    }
    sums
}

/// Returns e_ij for tied components and 0 for others, as a diagonal matrix.
fn weights<const D: usize>(tie: &Tie<D>, inner: &InnerFunction) -> Square<D> {
    Square::from_diagonal(&Vector::from_fn(|i, _| if tie.tied[i] { inner.weight } else { 0.0 }))
}

impl<const D: usize> MatrixAssembly for ReducedMatrix<'_, D> {
    fn reinit(&mut self, free: &[bool]) {
        self.kept = vec![KeptBlocks::default(); self.extension.ties().len()];
        self.matrix.reinit(free);
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        let nodes = self.offsets.iter().map(|offset| first_node + offset);
        if nodes.clone().any(|node| self.extension.place_of(node).is_some()) {
            self.keep(&nodes.collect::<Vec<usize>>(), block);
        }
        self.matrix.add_block(first_node, block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        if nodes.iter().any(|&node| self.extension.place_of(node).is_some()) {
            self.keep(nodes, block);
        }
        self.matrix.add_block_among(nodes, block);
    }

    /// Adds the diagonal of nodes that are not tied; without inertia no other nodes have any.
    fn add_diagonal(&mut self, diagonal: &[f64]) {
        self.matrix.add_diagonal(diagonal);
    }
}
