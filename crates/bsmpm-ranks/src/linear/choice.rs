//! Chooses the linear solver and PETSc options.

use bsmpm::linear::Symmetry;
use petsc_rs::{Ksp, Matrix, PcFailure, Petsc, ShellPc, Vector};

/// Default options of the factorisation, which the user's options override. MUMPS: ordering by approximate minimum
/// fill, which was the cheapest for plane grids, and twice the estimated workspace, because the estimate is sometimes
/// too small on several ranks. Iterative methods: a tolerance that satisfies the residual check, unlike PETSc's 1e-5.
const OPTIONS: [&str; 18] = [
    "-ksp_rtol",
    "1e-10",
    "-mat_mumps_icntl_7",
    "2",
    "-mat_mumps_icntl_14",
    "100",
    "-redundant_mat_mumps_icntl_7",
    "2",
    "-redundant_mat_mumps_icntl_14",
    "100",
    "-newton_ksp_gmres_restart",
    "300",
    "-newton_mat_mumps_icntl_14",
    "100",
    "-newton_redundant_mat_mumps_icntl_14",
    "100",
    "-newton_ksp_pc_side",
    "right",
];
/// Default options of preconditioners that are applied in place of a solution: incomplete factors of the ranks' blocks.
/// Multigrid uses them as smoother, too, because pointwise smoothers fail for nearly empty cells.
const ROUGH: [&str; 10] = [
    "-sub_pc_type",
    "icc",
    "-mg_levels_ksp_type",
    "chebyshev",
    "-mg_levels_ksp_max_it",
    "2",
    "-mg_levels_pc_type",
    "bjacobi",
    "-mg_levels_sub_pc_type",
    "icc",
];
/// Name of this program's multigrid, used in place of a PCType.
pub const SPLINE_MULTIGRID: &str = "spline-multigrid";
/// Prefix of the options of Newton's linear systems.
const NEWTON: &str = "newton_";

/// Method, preconditioner and factorisation package, by PETSc's names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Whether definite systems are preconditioned by nested dissection of the grid. Their matrix is then not
    /// assembled.
    pub dissection: bool,
    /// KSPType, e.g. `preonly`, `cg`.
    pub ksp: String,
    /// PCType, e.g. `cholesky`, `gamg`.
    pub pc: String,
    /// MatSolverType of a factorisation, e.g. `mumps`.
    pub factor: Option<String>,
    /// Whether every rank factorises the whole system. A parallel factorisation may not be bitwise repeatable.
    pub redundant: bool,
    /// Number of applications of the preconditioner in place of a solution; 0 if systems are solved.
    pub applications: usize,
}

impl Choice {
    /// Returns the options with which PETSc must start, before the user's options.
    pub fn options(&self) -> Vec<&str> {
        let mut options = OPTIONS.to_vec();
        if self.is_rough() && !self.is_geometric() {
            options.extend(ROUGH);
        }
        if self.pc == "gamg" {
            // Interpolation must depend on the present matrix only: a restarted run does not know former matrices.
            options.extend(["-pc_gamg_reuse_interpolation", "false"]);
        }
        if self.redundant {
            options.extend(["-redundant_pc_type", &self.pc, "-newton_redundant_pc_type", "lu"]);
            if let Some(factor) = &self.factor {
                options.extend(["-redundant_pc_factor_mat_solver_type", factor]);
                options.extend(["-newton_redundant_pc_factor_mat_solver_type", factor]);
            }
        }
        options
    }

    /// Returns whether directions come from the preconditioner alone, see [`bsmpm::linear::LinearSolver::is_rough`].
    pub fn is_rough(&self) -> bool {
        self.applications > 0
    }

    /// Returns whether nodes keep all their components, including fixed ones: multigrid needs blocks and the rigid-body
    /// modes.
    pub fn whole_nodes(&self) -> bool {
        ["gamg", "ml", "hypre"].contains(&self.pc.as_str())
    }

    /// Returns whether definite systems are preconditioned by spline multigrid, see [`SPLINE_MULTIGRID`]. Their matrix
    /// is then not assembled.
    pub fn is_geometric(&self) -> bool {
        self.pc == SPLINE_MULTIGRID
    }

    /// Returns the name of the program's own preconditioner of definite systems, if one is used.
    pub(super) fn shell(&self) -> Option<&'static str> {
        if self.dissection {
            Some("dissection")
        } else {
            self.is_geometric().then_some("multigrid of splines")
        }
    }

    /// Sets up a solver; PETSc options take precedence. For a general matrix, the factor preconditions FGMRES.
    pub(super) fn apply(&self, ksp: &mut Ksp<'_>, symmetry: Symmetry) -> petsc_rs::Result<()> {
        if let (Some(shell), Symmetry::Definite) = (self.shell(), symmetry) {
            ksp.set_type(&self.ksp)?;
            ksp.set_pc_shell(shell)?;
            return ksp.set_from_options();
        }
        let pc = match (symmetry, self.pc.as_str()) {
            (Symmetry::General, "cholesky" | SPLINE_MULTIGRID) => "lu",
            (_, pc) => pc,
        };
        match symmetry {
            Symmetry::Definite => ksp.set_type(&self.ksp)?,
            Symmetry::General => {
                ksp.set_options_prefix(NEWTON)?;
                ksp.set_type("fgmres")?;
            }
        }
        if self.redundant {
            ksp.set_pc_type("redundant")?;
        } else {
            ksp.set_pc_type(pc)?;
            if let Some(factor) = &self.factor {
                ksp.set_factor_solver(factor)?;
            }
        }
        ksp.set_from_options()
    }
}

/// Solves a system of one unknown per rank as `choice` and the options define. Options that PETSc does not support thus
/// fail before a run begins. Collective.
pub fn probe<'p>(petsc: &'p Petsc<'p>, choice: &Choice) -> petsc_rs::Result<()> {
    let mut ksp = Ksp::new(petsc)?;
    if choice.shell().is_some() {
        choice.apply(&mut ksp, Symmetry::Definite)?;
        ksp.set_shell_operator(1)?;
        return ksp
            .solve_with_pc(&mut |x, y| y.copy_from_slice(x), &mut Identity, |b| b.fill(1.0))
            .map(|_| ());
    }
    let own = [petsc.rank()];
    let mut matrix = Matrix::from_coo(petsc, 1, 1, &own, &own)?;
    matrix.set_values(&[1.0])?;
    matrix.set_symmetry(petsc_rs::Symmetry::PositiveDefinite)?;
    ksp.set_operator(&matrix)?;
    choice.apply(&mut ksp, Symmetry::Definite)?;
    let mut b = Vector::new(petsc, 1)?;
    let mut x = Vector::new(petsc, 1)?;
    b.fill(1.0)?;
    ksp.set_up()?;
    ksp.solve(&b, &mut x).map(|_| ())
}

/// Preconditioner of the matrix in [`probe`].
struct Identity;

impl ShellPc for Identity {
    fn set_up(&mut self) -> Result<(), PcFailure> {
        Ok(())
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), PcFailure> {
        z.copy_from_slice(r);
        Ok(())
    }
}
