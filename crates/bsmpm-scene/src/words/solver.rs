//! Accepted words for nonlinear iteration and linear solver.

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
    /// The linear solver in a word.
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
}

choice! {
    /// Krylov method, by PETSc's name.
    pub enum Ksp {
        /// The preconditioner alone, for direct solvers.
        Preonly = "preonly",
        /// Conjugate gradients.
        Cg = "cg",
        /// Minimal residuals.
        Minres = "minres",
        /// Generalised minimal residuals.
        Gmres = "gmres",
        /// Flexible GMRES, for preconditioners that vary.
        Fgmres = "fgmres",
        /// Stabilised biconjugate gradients.
        Bcgs = "bcgs",
    }
}

choice! {
    /// Preconditioner or direct solver, by PETSc's name but for the last.
    pub enum Pc {
        /// Cholesky factorisation.
        Cholesky = "cholesky",
        /// LU factorisation.
        Lu = "lu",
        /// Direct solution of the whole system on every rank.
        Redundant = "redundant",
        /// No preconditioner.
        None = "none",
        /// Jacobi: the diagonal.
        Jacobi = "jacobi",
        /// Point-block Jacobi: the diagonal blocks of nodes.
        Pbjacobi = "pbjacobi",
        /// Block Jacobi: the diagonal blocks of ranks.
        Bjacobi = "bjacobi",
        /// Successive over-relaxation.
        Sor = "sor",
        /// Additive Schwarz method.
        Asm = "asm",
        /// Incomplete Cholesky factorisation.
        Icc = "icc",
        /// Incomplete LU factorisation.
        Ilu = "ilu",
        /// PETSc's algebraic multigrid.
        Gamg = "gamg",
        /// Algebraic multigrid of Trilinos.
        Ml = "ml",
        /// Preconditioners of hypre.
        Hypre = "hypre",
        /// Geometric multigrid over the B-splines, built into bsmpm. Only in 3-D on one rank.
        SplineMultigrid = "spline-multigrid",
    }
}

impl Pc {
    /// Whether it factorises with a package of its own choice.
    pub fn factorises(self) -> bool {
        matches!(self, Self::Cholesky | Self::Lu)
    }

    /// Whether it solves by itself.
    pub fn solves(self) -> bool {
        self.factorises() || self == Self::Redundant
    }
}

choice! {
    /// Package of a direct solver, by PETSc's name but for the first.
    pub enum Factor {
        /// Nested dissection of the grid, built into bsmpm.
        Dissection = "dissection",
        /// MUMPS.
        Mumps = "mumps",
        /// PETSc.
        Petsc = "petsc",
        /// SuperLU.
        Superlu = "superlu",
        /// SuperLU_DIST.
        SuperluDist = "superlu_dist",
        /// CHOLMOD.
        Cholmod = "cholmod",
        /// UMFPACK.
        Umfpack = "umfpack",
    }
}
