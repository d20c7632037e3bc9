//! Chooses the linear solver and PETSc options.

use bsmpm::parallel::Symmetry;
use petsc_rs::{Ksp, Matrix, PcFailure, Petsc, ShellPc, Vector};

/// Defaults of the factorisation, given before the user's own options, which win. MUMPS: ordering by approximate
/// minimum fill, of all that were tried the cheapest for plane grids, and twice the workspace that it estimates, which
/// on several ranks is at times too little. Iterative methods: a tolerance whose solutions are trusted, unlike PETSc's
/// 1e-5.
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
/// Defaults of preconditioners that are applied in place of a solution: incomplete factors of the ranks' blocks, and
/// the same as the smoother of multigrid, which what pointwise smoothers leave of nearly empty cells needs.
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
/// The name of this program's own multigrid in the place of a PCType.
pub const SPLINE_MULTIGRID: &str = "spline-multigrid";
/// Prefix of the options of Newton's linear systems.
const NEWTON: &str = "newton_";

/// Method, preconditioner and factorising package by PETSc's names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// definite systems are preconditioned by nested dissection of the grid, whose matrix is not assembled
    pub dissection: bool,
    /// KSPType, e.g. `preonly`, `cg`
    pub ksp: String,
    /// PCType, e.g. `cholesky`, `gamg`
    pub pc: String,
    /// MatSolverType of a factorisation, e.g. `mumps`
    pub factor: Option<String>,
    /// every rank factorises the whole system by itself: a parallel factorisation need not repeat to the bit
    pub redundant: bool,
    /// so many times the preconditioner is applied in place of a solution; 0: there is a solution
    pub applications: usize,
}

impl Choice {
    /// Options that PETSc must start with, before the user's own.
    pub fn options(&self) -> Vec<&str> {
        let mut options = OPTIONS.to_vec();
        if self.is_rough() && !self.is_geometric() {
            options.extend(ROUGH);
        }
        if self.pc == "gamg" {
            // Of the present matrix alone: a run that goes on from a checkpoint has not seen the former ones.
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

    /// Whether directions are those of a preconditioner alone, see [`bsmpm::parallel::LinearSolver::is_rough`].
    pub fn is_rough(&self) -> bool {
        self.applications > 0
    }

    /// Whether nodes keep all their components, held ones too: multigrid wants blocks and the rigid-body modes.
    pub fn whole_nodes(&self) -> bool {
        ["gamg", "ml", "hypre"].contains(&self.pc.as_str())
    }

    /// Whether definite systems are preconditioned by multigrid over the grid's splines, see [`SPLINE_MULTIGRID`];
    /// their matrix is not assembled.
    pub fn is_geometric(&self) -> bool {
        self.pc == SPLINE_MULTIGRID
    }

    /// The program's own preconditioner of definite systems, if it is one.
    fn shell(&self) -> Option<&'static str> {
        if self.dissection {
            Some("dissection")
        } else {
            self.is_geometric().then_some("multigrid of splines")
        }
    }

    /// Sets a solver up; what the options say goes before. A general matrix preconditions a Krylov method.
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

/// Solves a system of one unknown a rank as `choice` and the options say: what PETSc does not know or have shows before
/// a run begins. Collective.
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

/// The preconditioner of the matrix that is solved before a run.
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
