//! Interfaces to linear systems: the assembly of the matrix ([`MatrixAssembly`]) and the solution ([`LinearSolver`]).

use crate::error::SolveError;

/// A distributed sparse matrix that is assembled from dense blocks.
pub trait MatrixAssembly {
    /// Clears the matrix. Its unknowns are the components marked `free` (D per local node, equal on all ranks that
    /// share the node).
    fn reinit(&mut self, free: &[bool]);
    /// Adds the dense row-major block of a patch (occupied cell): D unknowns for each of its (q+1)^D nodes, from
    /// `first_node` on.
    fn add_block(&mut self, first_node: usize, block: &[f64]);
    /// Adds a dense row-major block of D unknowns for each of `nodes`, the lowest first. It couples neighbouring
    /// patches of a grid with a wider pattern ([`Grid::reaching`](crate::grid::Grid::reaching)).
    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]);
    /// Adds to the diagonal, D numbers per local node; only those of owned nodes are used.
    fn add_diagonal(&mut self, diagonal: &[f64]);
}

/// Solver of a distributed sparse linear system.
pub trait LinearSolver {
    /// Returns the matrix, to be assembled before [`LinearSolver::factorise`].
    fn matrix(&mut self) -> &mut dyn MatrixAssembly;
    /// Completes and factorises the matrix.
    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError>;
    /// Solves for a nodal right-hand side. The solution is zero at components that are not free and valid at ghost
    /// nodes too.
    ///
    /// The solution is a search direction and may be inexact, but up to round-off it is the same linear, symmetric and
    /// positive function of every right-hand side. After [`LinearSolver::factorise`] the first residual is at most 1 %
    /// of the right-hand side, unless the solver [is rough](LinearSolver::is_rough).
    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError>;
    /// Returns whether [`LinearSolver::solve`] is a preconditioner that is applied a fixed number of times, which
    /// secants also correct. Newton directions then use it without a general matrix.
    fn is_rough(&self) -> bool {
        false
    }
    /// Solves as [`LinearSolver::solve`], to at most the residual `relative` to the right-hand side; a rough solver
    /// preconditions conjugate gradients.
    fn solve_to(&mut self, _relative: f64, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        self.solve(rhs, solution)
    }
    /// Solves for an operator that is given by its `product` (nodal arrays, zero where not free; collective). A Krylov
    /// method, preconditioned by the general matrix, iterates to the residual `relative` to the right-hand side, or as
    /// far as possible.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError>;
    /// Returns the solver of the pore pressures, if water flows. Its system has one unknown per node, at the node with
    /// the same number as the pressure's spline.
    fn second_field(&mut self) -> Option<&mut dyn LinearSolver> {
        None
    }
}

/// Properties of a matrix to be factorised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Symmetric and positive definite, for [`LinearSolver::solve`].
    Definite,
    /// Neither symmetric nor definite, for [`LinearSolver::solve_with`].
    General,
}

/// Cost and accuracy of a linear solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Iterations of the linear solver.
    pub iterations: usize,
    /// Additional factorisations because the existing one was insufficient.
    pub factorisations: usize,
    /// |b - A x| / |b|, if it was computed.
    pub residual: Option<f64>,
}

/// Result of a Krylov method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Krylov {
    /// Iterations, each with one product.
    pub iterations: usize,
    /// |b - A x| / |b|, recomputed.
    pub residual: f64,
}
