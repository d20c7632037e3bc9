//! Accepted words for nonlinear iteration and linear solver.

use super::retired::PETSC_NAMES;

choice! {
    /// The non-linear iteration.
    pub enum Nonlinear {
        /// Quasi-Newton method with multiple secants. If it stalls, Newton's method follows.
        Auto = "auto",
        /// Broyden's method (rank-one update).
        Broyden = "broyden",
        /// Newton's method with the consistent tangent.
        Newton = "newton",
    }
}

choice! {
    /// The linear solver.
    pub enum LinearSolver {
        /// Direct solver: a Cholesky factorisation by nested dissection of the grid.
        Direct = "direct",
        /// Conjugate gradients with PETSc's algebraic multigrid.
        Multigrid = "multigrid",
        /// Approximate solution by an incomplete Cholesky factorisation of each rank's block, applied once.
        IncompleteCholesky = "incomplete-cholesky",
        /// Approximate solution by two cycles of PETSc's algebraic multigrid.
        MultigridCycles = "multigrid-cycles",
        /// Approximate solution by two cycles of geometric multigrid over the B-splines. Only in 3-D on one rank.
        SplineMultigrid = "spline-multigrid",
    }
    removed [PETSC_NAMES]
}

impl LinearSolver {
    /// Whether it applies a preconditioner a fixed number of times in place of a solution.
    pub fn is_rough(self) -> bool {
        matches!(
            self,
            Self::IncompleteCholesky | Self::MultigridCycles | Self::SplineMultigrid
        )
    }
}
