//! Accepted words for nonlinear iteration and linear solver.

choice! {
    /// The non-linear iteration.
    pub enum Nonlinear {
        /// Quasi-Newton method with multiple secants, and Newton's method if it stalls.
        Auto = "auto",
        /// Broyden's rank-one update, as in the paper.
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
        /// One application of an incomplete Cholesky factorisation of each rank's block, as an approximate solution.
        IncompleteCholesky = "incomplete-cholesky",
        /// Two cycles of PETSc's algebraic multigrid, as an approximate solution.
        MultigridCycles = "multigrid-cycles",
        /// Two cycles of geometric multigrid over the B-splines, as an approximate solution. Only for 3-D on one rank.
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
        /// Geometric multigrid of bsmpm over the B-splines. Only for 3-D on one rank.
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
