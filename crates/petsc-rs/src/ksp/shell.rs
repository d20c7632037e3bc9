//! Solves linear systems whose operator is given by its matrix-vector product, with a user-defined preconditioner.

use super::{Ksp, SolveInfo};
use crate::error::{Error, Result, c_string, check, same_length};
use crate::ffi;
use crate::shell::{Product, Shell, ShellPc, Slot, pc_apply, pc_set_up};
use crate::vector::Vector;

impl Ksp<'_> {
    /// Solves from now on with an operator that is known by its product only, of which this rank has `local_rows` rows;
    /// type, preconditioner and options stay, what was built is forgotten. Collective.
    pub fn set_shell_operator(&mut self, local_rows: usize) -> Result<()> {
        let shell = Shell::new(self.petsc, local_rows)?;
        let b = Vector::new(self.petsc, local_rows)?;
        let x = Vector::new(self.petsc, local_rows)?;
        // SAFETY: the handle is valid; it refers to no older operator any more.
        check(unsafe { ffi::KSPReset(self.raw) })?;
        // SAFETY: both handles are valid; PETSc takes references of its own.
        check(unsafe { ffi::KSPSetOperators(self.raw, shell.raw(), shell.raw()) })?;
        self.pc_slot.iter().for_each(|slot| slot.set_rows(local_rows));
        (self.local_rows, self.shell, self.is_ready) = (Some(local_rows), Some((shell, b, x)), false);
        // KSPReset forgets the viewers that options have asked for, and nothing else of what they say.
        if self.reads_options && self.petsc.views() {
            self.set_from_options()
        } else {
            Ok(())
        }
    }

    /// The shell operator is another one from now on: the preconditioner is built again. Collective.
    pub fn shell_operator_changed(&mut self) -> Result<()> {
        self.is_ready = false;
        self.shell()?.0.changed()
    }

    /// A shell preconditioner, which `-ksp_view` shows by `name`; what it does is handed over with
    /// [`Ksp::set_up_with_pc`] and [`Ksp::solve_with_pc`]. Collective.
    pub fn set_pc_shell(&mut self, name: &str) -> Result<()> {
        self.set_pc_type("shell")?;
        let name = c_string(name)?;
        let pc = self.pc()?;
        let slot = self
            .pc_slot
            .get_or_insert_with(|| Slot::new(self.local_rows.unwrap_or(0)));
        let place = std::ptr::from_ref::<Slot<dyn ShellPc>>(slot).cast_mut().cast();
        // SAFETY: the handle is valid; the slot lives as long as this solver, and the callbacks only share it.
        check(unsafe { ffi::PCShellSetContext(pc, place) })?;
        // SAFETY: the handle is valid; the callback lives for ever.
        check(unsafe { ffi::PCShellSetSetUp(pc, Some(pc_set_up)) })?;
        // SAFETY: as above.
        check(unsafe { ffi::PCShellSetApply(pc, Some(pc_apply)) })?;
        // SAFETY: the handle is valid; the text is copied.
        check(unsafe { ffi::PCShellSetName(pc, name.as_ptr()) })
    }

    /// [`Ksp::set_up`] with the shell preconditioner `pc`. Collective.
    pub fn set_up_with_pc(&mut self, pc: &mut dyn ShellPc) -> Result<()> {
        let outcome = self.lent_pc()?.lend_pc(pc, || self.build());
        self.is_ready = self.conclude(outcome).map(|()| true)?;
        Ok(())
    }

    /// [`Ksp::solve`] with the shell operator, `product` setting y = A x on this rank's part, and the shell
    /// preconditioner `pc`, which is set up first where that is still to be done; `fill` sets this rank's part of b.
    /// Collective.
    pub fn solve_with_pc(
        &mut self,
        product: &mut Product<'_>,
        pc: &mut dyn ShellPc,
        fill: impl FnOnce(&mut [f64]),
    ) -> Result<SolveInfo> {
        if !self.is_ready {
            self.set_up_with_pc(pc)?;
        }
        self.shell.as_mut().map_or(Ok(()), |(_, b, _)| b.write(fill))?;
        // Whatever happens below, only a solution says that the preconditioner is good.
        self.is_ready = false;
        let (shell, b, x) = self.shell()?;
        let slot = self.lent_pc()?;
        let outcome = shell.slot().lend_product(product, || {
            slot.lend_pc(pc, || {
                // SAFETY: the handles are valid; the vectors were made with the operator, and are distinct.
                check(unsafe { ffi::KSPSolve(self.raw, b.raw(), x.raw()) }).and_then(|()| self.verdict())
            })
        });
        let outcome = self.conclude(outcome);
        self.is_ready = outcome.is_ok();
        outcome
    }

    /// Gives the last solution of [`Ksp::solve_with_pc`], this rank's part, to `use_solution`.
    pub fn solution<R>(&self, use_solution: impl FnOnce(&[f64]) -> R) -> Result<R> {
        self.shell()?.2.read(use_solution)
    }

    /// Solves A x = b for an operator known by its product, `product` setting y = A x on this rank's part, with the
    /// preconditioner of the matrix of [`Ksp::set_operator`]; for Krylov methods. A solve that reaches its most
    /// iterations is `Ok` too: the caller looks at what is left. Collective.
    pub fn solve_with(&mut self, product: &mut Product<'_>, b: &Vector, x: &mut Vector) -> Result<SolveInfo> {
        let rows = self.operator_rows()?;
        let checked = same_length("right-hand side", b.local_len(), rows)
            .and_then(|()| same_length("solution", x.local_len(), rows));
        self.petsc.agree(checked)?;
        self.set_up()?;
        let mut matrix = std::ptr::null_mut();
        // SAFETY: the handle and the pointer are valid; the matrix stays PETSc's, and alive through the
        // preconditioner's reference to it.
        check(unsafe { ffi::KSPGetOperators(self.raw, std::ptr::null_mut(), &mut matrix) })?;
        let shell = Shell::new(self.petsc, rows)?;
        // SAFETY: all handles are valid; the preconditioner keeps its matrix and is not built again.
        check(unsafe { ffi::KSPSetOperators(self.raw, shell.raw(), matrix) })?;
        let outcome = shell.slot().lend_product(product, || {
            // SAFETY: the handles are valid; the vectors have the operator's layout and are distinct.
            check(unsafe { ffi::KSPSolve(self.raw, b.raw(), x.raw()) }).and_then(|()| self.verdict())
        });
        let outcome = match outcome {
            Err(Error::Diverged { reason, iterations, .. }) if reason == ffi::KSP_DIVERGED_ITS => {
                Ok(SolveInfo { reason, iterations })
            }
            other => other,
        };
        // SAFETY: as above; nothing refers to the shell any more when it ends.
        let restored = check(unsafe { ffi::KSPSetOperators(self.raw, matrix, matrix) });
        self.conclude(restored.and(outcome))
    }

    fn shell(&self) -> Result<&(Shell<'_>, Vector<'_>, Vector<'_>)> {
        self.shell
            .as_ref()
            .ok_or(Error::Unsupported("a shell operator before set_shell_operator"))
    }

    fn lent_pc(&self) -> Result<&Slot<dyn ShellPc>> {
        self.pc_slot
            .as_deref()
            .ok_or(Error::Unsupported("a shell preconditioner before set_pc_shell"))
    }
}
