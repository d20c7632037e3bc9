//! Words of the solver: the non-linear iteration, and the linear solver by PETSc's own names.

choice! {
    /// The non-linear iteration.
    pub enum Nonlinear {
        /// The controller's choice: all recent secants on the stiffness at a step's first guess, Newton's method where
        /// they stall.
        Auto = "auto",
        /// The paper's rank-one update.
        Broyden = "broyden",
        /// Newton's method with the complete derivative.
        Newton = "newton",
    }
}

choice! {
    /// The linear solver in a word.
    pub enum LinearSolver {
        /// A factor of the stiffness by nested dissection of the grid.
        Direct = "direct",
        /// Conjugate gradients with PETSc's algebraic multigrid.
        Multigrid = "multigrid",
        /// An incomplete Cholesky factor of every rank's block, applied once in place of a solution.
        IncompleteCholesky = "incomplete-cholesky",
        /// Two cycles of PETSc's algebraic multigrid in place of a solution.
        MultigridCycles = "multigrid-cycles",
        /// Two cycles of multigrid over the grid's own splines, with boxes of nodes as its smoother, in place of a
        /// solution: for solids on one rank.
        SplineMultigrid = "spline-multigrid",
    }
}

choice! {
    /// Krylov method, by PETSc's name.
    pub enum Ksp {
        /// The preconditioner alone, which solves by itself.
        Preonly = "preonly",
        /// Conjugate gradients.
        Cg = "cg",
        /// Minimal residuals.
        Minres = "minres",
        /// Generalised minimal residuals.
        Gmres = "gmres",
        /// The same with a preconditioner that may vary.
        Fgmres = "fgmres",
        /// Stabilised biconjugate gradients.
        Bcgs = "bcgs",
    }
}

choice! {
    /// Preconditioner or direct solver, by PETSc's name but for the last.
    pub enum Pc {
        /// Cholesky's factorisation.
        Cholesky = "cholesky",
        /// Factorisation without symmetry.
        Lu = "lu",
        /// The whole system on every rank.
        Redundant = "redundant",
        /// No preconditioner.
        None = "none",
        /// The diagonal.
        Jacobi = "jacobi",
        /// The diagonal blocks of nodes.
        Pbjacobi = "pbjacobi",
        /// The diagonal blocks of ranks.
        Bjacobi = "bjacobi",
        /// Successive over-relaxation.
        Sor = "sor",
        /// Additive Schwarz method.
        Asm = "asm",
        /// Incomplete Cholesky factorisation.
        Icc = "icc",
        /// Incomplete factorisation without symmetry.
        Ilu = "ilu",
        /// PETSc's algebraic multigrid.
        Gamg = "gamg",
        /// Trilinos' algebraic multigrid.
        Ml = "ml",
        /// Preconditioners of hypre.
        Hypre = "hypre",
        /// This program's own: multigrid over the grid's splines, for solids on one rank.
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
        /// This program's own: nested dissection of the grid.
        Dissection = "dissection",
        /// MUMPS.
        Mumps = "mumps",
        /// PETSc's own.
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
