//! Interfaces to other ranks ([`Halo`]) and to the linear solver ([`LinearSolver`]).

use crate::error::SolveError;
use crate::exact::Exact;
use crate::grid::Contributions;
use crate::nodal::Nodal;
use std::ops::Range;

/// The nodes of a window that are its rank's own: as many at the start of each of its first layers. All of a layer
/// where ranks have slabs, a part of it where slabs are cut once more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwnedNodes {
    layers: usize,
    layer: usize, // nodes of the window's
    run: usize,   // own ones of it
}

impl OwnedNodes {
    /// The first `run` nodes of each of so many layers of `layer` nodes.
    pub fn new(layers: usize, layer: usize, run: usize) -> Self {
        debug_assert!(run <= layer);
        Self { layers, layer, run }
    }

    /// The first so many nodes, in one layer.
    pub fn first(nodes: usize) -> Self {
        Self::new(1, nodes, nodes)
    }

    /// Those of each layer, ascending.
    pub fn runs(self) -> impl Iterator<Item = Range<usize>> + Clone {
        (0..self.layers).map(move |layer| layer * self.layer..layer * self.layer + self.run)
    }

    /// Them all, ascending.
    pub fn nodes(self) -> impl Iterator<Item = usize> + Clone {
        self.runs().flatten()
    }

    /// Places of all their numbers in an array of `C` a node, ascending.
    pub fn places<const C: usize>(self) -> impl Iterator<Item = usize> + Clone {
        self.runs().flat_map(|run| Nodal::<C>::all(&run))
    }

    /// Whether a node of the window is one of them.
    #[inline]
    pub fn contains(self, node: usize) -> bool {
        node < self.layers * self.layer && (self.run == self.layer || node % self.layer < self.run)
    }
}

/// Exchange of nodal contributions between neighbours, and reductions over all ranks.
pub trait Halo {
    /// Local nodes that this rank owns: every node of the grid has exactly one owner. Sums over the layers of slabs do
    /// not depend on the cut.
    fn owned(&self) -> OwnedNodes;
    /// Nodal sums of what the columns of all ranks contribute, right at ghost nodes too: the same bits on any number of
    /// ranks.
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64>;
    /// Replaces the numbers of every node that ranks share by those of its owner.
    fn update_ghosts(&self, nodal: &mut [f64], width: usize);
    /// Replaces each number of the nodes that ranks share by the largest of theirs.
    fn ghost_max(&self, nodal: &mut [f64], width: usize);
    /// Replaces each number by its sum over the ranks. For counts and what one rank alone has, which are exact.
    fn all_reduce_sum(&self, numbers: &mut [f64]);
    /// The values of sums over all ranks: the same bits on any number of ranks.
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64>;
    /// Replaces each number by its largest over the ranks.
    fn all_reduce_max(&self, numbers: &mut [f64]);
    /// The numbers of all ranks, those of one rank behind those of the rank before it; ranks may have different counts.
    fn gather(&self, numbers: &[f64]) -> Vec<f64> {
        numbers.to_vec()
    }
    /// Whether a node of the window is this rank's own and in no other rank's window. On the ranks of one cut these
    /// nodes are those of a box.
    fn is_private(&self, _node: usize) -> bool {
        true
    }
    /// Whether somebody outside wants the step to be given up. Changes in [`all_reduce_sum`](Self::all_reduce_sum) and
    /// [`reproducible_sum`](Self::reproducible_sum) only, so that all ranks see it between the same two reductions.
    fn is_interrupted(&self) -> bool {
        false
    }
    /// Whether a step that has converged is to be given up all the same, on all ranks: what shows that an attempt
    /// leaves no trace.
    fn rejects(&self) -> bool {
        false
    }
}

/// Two nodal vectors of a dot product.
pub type VectorPair<'a> = (&'a [f64], &'a [f64]);

/// Dot products of nodal vectors (`width` numbers a node) over all nodes, each counted once, in one reduction.
pub fn dots(halo: &dyn Halo, width: usize, pairs: &[VectorPair<'_>]) -> Vec<f64> {
    let sums = pairs.iter().map(|(a, b)| over_layers(halo, width, |c| a[c] * b[c]));
    halo.reproducible_sum(&sums.collect::<Vec<_>>())
}

/// Sum over the components of this rank's own nodes, `width` a node: plainly within a layer, exactly over the layers.
pub fn over_layers(halo: &dyn Halo, width: usize, term: impl Fn(usize) -> f64) -> Exact {
    halo.owned()
        .runs()
        .map(|run| (run.start * width..run.end * width).map(&term).sum::<f64>())
        .collect()
}

/// The outcome of this rank, or `other` where only another rank failed: nobody goes on while another has returned.
pub fn agreed<T, E>(halo: &dyn Halo, mine: Result<T, E>, other: E) -> Result<T, E> {
    let mut failed = [f64::from(u8::from(mine.is_err()))];
    halo.all_reduce_max(&mut failed);
    if failed[0] > 0.0 { mine.and(Err(other)) } else { mine }
}

/// A distributed sparse system whose matrix is summed from dense patch blocks.
pub trait LinearSolver {
    /// Starts a matrix whose unknowns are the components marked `free` (D per local node, equal on all ranks that
    /// share the node).
    fn reinit(&mut self, free: &[bool]);
    /// Adds the dense row-major block of a patch: D unknowns for each of its (q+1)^D nodes, counted from `first_node`.
    fn add_block(&mut self, first_node: usize, block: &[f64]);
    /// Adds a dense row-major block of D unknowns for each of `nodes`, the lowest first: what couples neighbouring
    /// patches, of a grid that reaches so far ([`Grid::reaching`](crate::grid::Grid::reaching)).
    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]);
    /// Adds to the diagonal, D numbers per local node; those of owned nodes count.
    fn add_diagonal(&mut self, diagonal: &[f64]);
    /// Completes and factorises the matrix.
    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError>;
    /// Solves for a nodal right-hand side; the solution is zero at components that are not free, and right at ghost
    /// nodes too. It is a direction, the same linear, symmetric and positive function of all right-hand sides up to
    /// round-off, and no answer: what it leaves of the first one after [`LinearSolver::factorise`] is a hundredth of it
    /// at most, unless the solver [is rough](LinearSolver::is_rough).
    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError>;
    /// Whether [`LinearSolver::solve`] is a preconditioner, applied a fixed number of times: secants correct that, too.
    /// Newton's directions are then sought around it, without a general matrix.
    fn is_rough(&self) -> bool {
        false
    }
    /// As [`LinearSolver::solve`], to the residual `relative` to the right-hand side at most: by conjugate gradients
    /// around it where that is rough.
    fn solve_to(&mut self, _relative: f64, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        self.solve(rhs, solution)
    }
    /// Solves for an operator known by its product (nodal arrays, zero where not free; collective), by a Krylov method
    /// that the general matrix preconditions, to the residual `relative` to the right-hand side or as far as it gets.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError>;
    /// The system of the pore pressures beside this one of the displacements: one unknown a node, kept at the node
    /// whose number the pressure's function has; where water flows.
    fn water(&mut self) -> Option<&mut dyn LinearSolver> {
        None
    }
}

/// What a matrix is factorised for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// symmetric and positive definite, for [`LinearSolver::solve`]
    Definite,
    /// neither, for [`LinearSolver::solve_with`]
    General,
}

/// What a solution took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// iterations of the linear solver
    pub iterations: usize,
    /// further factorisations, as the first one did not do
    pub factorisations: usize,
    /// |b - A x| / |b|, where it was computed
    pub residual: Option<f64>,
}

/// How a Krylov method ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Krylov {
    /// iterations, of one product each
    pub iterations: usize,
    /// |b - A x| / |b|, recomputed
    pub residual: f64,
}

/// The halo of a run on one rank without MPI: unit tests and tools.
#[derive(Clone, Copy, Debug)]
pub struct Alone {
    /// Nodes of the grid.
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

/// Communication between the ranks, and the solver of the linear systems.
pub struct Backend<'a> {
    /// Exchange with other ranks.
    pub halo: &'a dyn Halo,
    /// Solver of the linear systems.
    pub solver: &'a mut dyn LinearSolver,
}
