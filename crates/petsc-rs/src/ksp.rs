//! Linear solvers: a Krylov method with a preconditioner, or a factorisation (method `preonly`).

mod shell;
mod verdict;

use std::ptr;

use crate::error::{Error, Result, c_string, check, int, same_length, text};
use crate::ffi;
use crate::matrix::Matrix;
use crate::petsc::Petsc;
use crate::shell::{Shell, ShellPc, Slot};
use crate::vector::Vector;

/// When an iteration ends: |r| <= max(relative |b|, absolute), or too many iterations (an `Err`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// of the norm of the right-hand side
    pub relative: f64,
    /// of the residual itself
    pub absolute: f64,
    /// most iterations
    pub max_iterations: usize,
}

/// The norm of the residual r that the convergence test sees, with preconditioner B.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NormType {
    /// none: a fixed number of iterations
    None,
    /// |B r|, which may be far from the true residual
    Preconditioned,
    /// |r|
    Unpreconditioned,
    /// sqrt(r . B r), of conjugate gradients
    Natural,
}

/// How a solve ended well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SolveInfo {
    /// KSPConvergedReason; > 0, or of a solve with too many iterations
    pub reason: i32,
    /// iterations done, 1 for a factorisation
    pub iterations: usize,
}

/// A linear solver.
pub struct Ksp<'p> {
    petsc: &'p Petsc<'p>,
    raw: ffi::KSP,
    /// of the operator, None before there is one
    local_rows: Option<usize>,
    /// the operator, if it is one, with a right-hand side and a solution
    shell: Option<(Shell<'p>, Vector<'p>, Vector<'p>)>,
    /// where the shell preconditioner finds what is lent to it, if there is one; never moved while PETSc knows it
    pc_slot: Option<Box<Slot<dyn ShellPc>>>,
    /// the shell preconditioner is that of the operator
    is_ready: bool,
    reads_options: bool,
}

impl<'p> Ksp<'p> {
    /// A solver without an operator, of PETSc's default method. Collective.
    pub fn new(petsc: &'p Petsc) -> Result<Self> {
        let mut raw = ptr::null_mut();
        // SAFETY: PETSc runs; the pointer is valid.
        check(unsafe { ffi::KSPCreate(petsc.comm(), &mut raw) })?;
        Ok(Self {
            petsc,
            raw,
            local_rows: None,
            shell: None,
            pc_slot: None,
            is_ready: false,
            reads_options: false,
        })
    }

    /// Solves with `matrix` from now on, and builds the preconditioner from it. PETSc shares the
    /// matrix: new values in it are seen by the next solve. Collective.
    pub fn set_operator(&mut self, matrix: &Matrix<'p>) -> Result<()> {
        // SAFETY: both handles are valid; PETSc takes a reference of its own.
        check(unsafe { ffi::KSPSetOperators(self.raw, matrix.raw(), matrix.raw()) })?;
        self.local_rows = Some(matrix.local_rows());
        Ok(())
    }

    /// The method, e.g. `cg`, or `preonly` for a factorisation. Collective.
    pub fn set_type(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        // SAFETY: the handle is valid; the text is copied.
        check(unsafe { ffi::KSPSetType(self.raw, name.as_ptr()) })
    }

    /// The preconditioner, e.g. `cholesky`, `icc`, `gamg`. Collective.
    pub fn set_pc_type(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        // SAFETY: the handle is valid; the text is copied.
        check(unsafe { ffi::PCSetType(self.pc()?, name.as_ptr()) })
    }

    /// The package that factorises, e.g. `mumps`, `petsc`, `cholmod`; after [`Ksp::set_pc_type`] has
    /// chosen a factorisation, else `Unsupported`. Whether PETSc has the package shows in
    /// [`Ksp::set_up`]. Collective.
    pub fn set_factor_solver(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        let pc = self.pc()?;
        let mut taken = ptr::null();
        // SAFETY: the handle is valid; the text is copied.
        check(unsafe { ffi::PCFactorSetMatSolverType(pc, name.as_ptr()) })?;
        // SAFETY: the handle and the pointer are valid.
        check(unsafe { ffi::PCFactorGetMatSolverType(pc, &mut taken) })?;
        // SAFETY: null or a text of PETSc.
        if unsafe { text(taken) }.as_bytes() != name.as_bytes() {
            return Err(Error::Unsupported("the preconditioner is no factorisation"));
        }
        Ok(())
    }

    /// The method's name, `None` before there is one.
    pub fn type_name(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        // SAFETY: the handle and the pointer are valid.
        check(unsafe { ffi::KSPGetType(self.raw, &mut name) })?;
        // SAFETY: null or a text of PETSc.
        Ok(Some(unsafe { text(name) }).filter(|name| !name.is_empty()))
    }

    /// The preconditioner's name, `None` before there is one.
    pub fn pc_type_name(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        let pc = self.pc()?;
        // SAFETY: the handle and the pointer are valid.
        check(unsafe { ffi::PCGetType(pc, &mut name) })?;
        // SAFETY: null or a text of PETSc.
        Ok(Some(unsafe { text(name) }).filter(|name| !name.is_empty()))
    }

    /// Text put before the names of this solver's options: `flow_` makes it read `-flow_ksp_type`.
    pub fn set_options_prefix(&mut self, prefix: &str) -> Result<()> {
        let prefix = c_string(prefix)?;
        // SAFETY: the handle is valid; the text is copied.
        check(unsafe { ffi::KSPSetOptionsPrefix(self.raw, prefix.as_ptr()) })
    }

    /// Reads the options database; it overrules what was set before. After
    /// [`Ksp::set_operator`], or once method and preconditioner have a type. Collective.
    pub fn set_from_options(&mut self) -> Result<()> {
        self.reads_options = true;
        // SAFETY: the handle is valid.
        check(unsafe { ffi::KSPSetFromOptions(self.raw) })
    }

    /// When an iteration ends. Collective.
    pub fn set_tolerances(&mut self, tolerances: Tolerances) -> Result<()> {
        let most = int("max_iterations", tolerances.max_iterations)?;
        let relative = tolerances.relative;
        let absolute = tolerances.absolute;
        let mut divergence = 0.0;
        let none = ptr::null_mut();
        // SAFETY: the handle is valid; null pointers are not filled.
        check(unsafe { ffi::KSPGetTolerances(self.raw, none, none, &mut divergence, ptr::null_mut()) })?;
        // SAFETY: the handle is valid; PETSc checks the numbers.
        check(unsafe { ffi::KSPSetTolerances(self.raw, relative, absolute, divergence, most) })
    }

    /// The norm of the convergence test; not every method has all of them. Collective.
    pub fn set_norm(&mut self, norm: NormType) -> Result<()> {
        let norm = match norm {
            NormType::None => ffi::KSP_NORM_NONE,
            NormType::Preconditioned => ffi::KSP_NORM_PRECONDITIONED,
            NormType::Unpreconditioned => ffi::KSP_NORM_UNPRECONDITIONED,
            NormType::Natural => ffi::KSP_NORM_NATURAL,
        };
        // SAFETY: the handle is valid.
        check(unsafe { ffi::KSPSetNormType(self.raw, norm) })
    }

    /// Whether `x` enters [`Ksp::solve`] as the first guess, instead of zero. Collective.
    pub fn set_initial_guess_nonzero(&mut self, nonzero: bool) -> Result<()> {
        // SAFETY: the handle is valid.
        check(unsafe { ffi::KSPSetInitialGuessNonzero(self.raw, ffi::PetscBool::from(nonzero)) })
    }

    /// Whether the preconditioner or factor is kept when the matrix gets new values. Collective.
    pub fn set_reuse_preconditioner(&mut self, reuse: bool) -> Result<()> {
        // SAFETY: the handle is valid.
        check(unsafe { ffi::KSPSetReusePreconditioner(self.raw, ffi::PetscBool::from(reuse)) })
    }

    /// Builds the preconditioner or factor now, instead of in the next solve; a factor that fails,
    /// for instance at a zero pivot, is [`Error::Diverged`]. Collective.
    pub fn set_up(&mut self) -> Result<()> {
        self.operator_rows()?;
        let outcome = self.build();
        self.conclude(outcome)
    }

    /// Builds on this rank.
    fn build(&self) -> Result<()> {
        let pc = self.pc()?;
        // SAFETY: the handle is valid and has an operator.
        check(unsafe { ffi::KSPSetUp(self.raw) })?;
        // The KSP, after its first time, would leave new values of the matrix to the solve.
        // SAFETY: the handle is valid and has an operator.
        check(unsafe { ffi::PCSetUp(pc) })?;
        // SAFETY: as above.
        check(unsafe { ffi::KSPSetUpOnBlocks(self.raw) })?;
        match self.factor_failure()? {
            Some(failure) => Err(self.diverged(ffi::KSP_DIVERGED_PC_FAILED, failure, 0)),
            None => Ok(()),
        }
    }

    /// Solves A x = b, with [`Ksp::set_up`] before it. Collective.
    ///
    /// `Ok` is PETSc's word only: a factorisation reports success also for a right-hand side with
    /// NaN and for a singular matrix whose pivots rounding has hidden. The caller checks that `x` is
    /// finite and [`Matrix::residual`] small.
    pub fn solve(&mut self, b: &Vector, x: &mut Vector) -> Result<SolveInfo> {
        let rows = self.operator_rows()?;
        let checked = same_length("right-hand side", b.local_len(), rows)
            .and_then(|()| same_length("solution", x.local_len(), rows));
        self.petsc.agree(checked)?;
        // A failed factor must not be applied: PETSc would try.
        self.set_up()?;
        // SAFETY: the handles are valid; the vectors have the operator's layout and are distinct.
        let outcome = check(unsafe { ffi::KSPSolve(self.raw, b.raw(), x.raw()) }).and_then(|()| self.verdict());
        self.conclude(outcome)
    }

    fn operator_rows(&self) -> Result<usize> {
        let missing = Error::Unsupported("a solve before set_operator");
        self.local_rows.ok_or(missing)
    }
}

impl Drop for Ksp<'_> {
    fn drop(&mut self) {
        // SAFETY: PETSc runs (borrowed); the handle is valid, and not used again.
        let _ = check(unsafe { ffi::KSPDestroy(&mut self.raw) });
    }
}
