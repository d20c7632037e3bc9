//! Interface to other ranks ([`Halo`]), and reductions.

use crate::exact::Exact;
use crate::grid::Contributions;
use crate::nodal::Nodal;
use std::ops::Range;

/// Nodes of a window that its rank owns: the first `run` nodes in each of the first layers. A rank owns complete layers
/// if the grid is partitioned into slabs, and parts of layers if slabs are partitioned once more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwnedNodes {
    layers: usize,
    layer: usize, // nodes per layer of the window
    run: usize,   // own nodes per layer
}

impl OwnedNodes {
    /// Creates the first `run` nodes of each of `layers` layers of `layer` nodes.
    pub fn new(layers: usize, layer: usize, run: usize) -> Self {
        debug_assert!(run <= layer);
        Self { layers, layer, run }
    }

    /// Creates the first `nodes` nodes, in one layer.
    pub fn first(nodes: usize) -> Self {
        Self::new(1, nodes, nodes)
    }

    /// Iterates over the own nodes of each layer, ascending.
    pub fn runs(self) -> impl Iterator<Item = Range<usize>> + Clone {
        (0..self.layers).map(move |layer| layer * self.layer..layer * self.layer + self.run)
    }

    /// Iterates over all own nodes, ascending.
    pub fn nodes(self) -> impl Iterator<Item = usize> + Clone {
        self.runs().flatten()
    }

    /// Iterates over the places of the own nodes' components in an array of `C` numbers per node, ascending.
    pub fn places<const C: usize>(self) -> impl Iterator<Item = usize> + Clone {
        self.runs().flat_map(|run| Nodal::<C>::all(&run))
    }

    /// Returns whether a node of the window is owned.
    #[inline]
    pub fn contains(self, node: usize) -> bool {
        node < self.layers * self.layer && (self.run == self.layer || node % self.layer < self.run)
    }
}

/// Communication between ranks: exchange with neighbours, and reductions.
pub trait Halo {
    /// Returns the local nodes that this rank owns; every node of the grid has exactly one owner. Sums over the layers
    /// do not depend on the partition.
    fn owned(&self) -> OwnedNodes;
    /// Sums nodal contributions over the columns of cells of all ranks; the result is valid at ghost nodes too. Bitwise
    /// identical on any number of ranks.
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64>;
    /// Replaces the numbers of every shared node by those of its owner; `width` numbers per node.
    fn update_ghosts(&self, nodal: &mut [f64], width: usize);
    /// Replaces each number of a shared node by the largest over the ranks; `width` numbers per node.
    fn ghost_max(&self, nodal: &mut [f64], width: usize);
    /// Replaces each number by its sum over the ranks. Only for counts, and numbers that are non-zero on one rank,
    /// whose sums are exact.
    fn all_reduce_sum(&self, numbers: &mut [f64]);
    /// Returns the rounded sums over all ranks; bitwise identical on any number of ranks.
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64>;
    /// Replaces each number by its largest over the ranks.
    fn all_reduce_max(&self, numbers: &mut [f64]);
    /// Concatenates the numbers of all ranks in the order of the ranks; their counts may differ.
    fn gather(&self, numbers: &[f64]) -> Vec<f64> {
        numbers.to_vec()
    }
    /// Returns whether a node of the window is owned by this rank and is in no other rank's window. In a partition
    /// these nodes form a box.
    fn is_private(&self, _node: usize) -> bool {
        true
    }
    /// Returns whether an interruption of the step was requested. Changes only in
    /// [`all_reduce_sum`](Self::all_reduce_sum) and [`reproducible_sum`](Self::reproducible_sum), so that all ranks see
    /// it between the same two reductions.
    fn is_interrupted(&self) -> bool {
        false
    }
    /// Returns, on all ranks, whether a converged step is rejected nevertheless. Tests use this to show that a rejected
    /// attempt changes nothing.
    fn rejects(&self) -> bool {
        false
    }
}

/// Computes the dot product of two nodal vectors (`width` numbers per node) over all nodes, each counted once. One
/// reduction.
pub fn dot(halo: &dyn Halo, width: usize, a: &[f64], b: &[f64]) -> f64 {
    halo.reproducible_sum(&[local_dot(halo, width, a, b)])[0]
}

/// Computes the part of a dot product over this rank's own nodes. [`Halo::reproducible_sum`] adds those of all ranks.
pub fn local_dot(halo: &dyn Halo, width: usize, a: &[f64], b: &[f64]) -> Exact {
    over_layers(halo, width, |c| a[c] * b[c])
}

/// Sums over the components of this rank's own nodes, `width` per node: rounded within a layer, exact over the layers.
pub fn over_layers(halo: &dyn Halo, width: usize, term: impl Fn(usize) -> f64) -> Exact {
    halo.owned()
        .runs()
        .map(|run| (run.start * width..run.end * width).map(&term).sum::<f64>())
        .collect()
}

/// Returns the result of this rank, or the error `other` if only another rank failed, so that all ranks continue or
/// none does. One reduction.
pub fn agreed<T, E>(halo: &dyn Halo, mine: Result<T, E>, other: E) -> Result<T, E> {
    let mut failed = [f64::from(u8::from(mine.is_err()))];
    halo.all_reduce_max(&mut failed);
    if failed[0] > 0.0 { mine.and(Err(other)) } else { mine }
}

/// Communication of a run on one rank without MPI, for unit tests and tools.
#[derive(Clone, Copy, Debug)]
pub struct Alone {
    /// Number of nodes of the grid.
    pub nodes: usize,
}

impl Halo for Alone {
    fn owned(&self) -> OwnedNodes {
        OwnedNodes::first(self.nodes)
    }
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        contributions.alone()
    }
    fn update_ghosts(&self, _nodal: &mut [f64], _width: usize) {}
    fn ghost_max(&self, _nodal: &mut [f64], _width: usize) {}
    fn all_reduce_sum(&self, _numbers: &mut [f64]) {}
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        sums.iter().map(Exact::value).collect()
    }
    fn all_reduce_max(&self, _numbers: &mut [f64]) {}
}
