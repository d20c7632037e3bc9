//! Decides whether a solve succeeded. PETSc's functions return success even without convergence, so KSP's convergence
//! reason is checked here.

use std::ptr;

use super::{Ksp, SolveInfo};
use crate::error::{Error, Result, check, text};
use crate::ffi;

/// A solver whose preconditioner cannot be used any more.
const BROKEN: i32 = 2;

impl Ksp<'_> {
    /// How the solve that has just returned ended.
    pub(super) fn verdict(&self) -> Result<SolveInfo> {
        let mut reason = 0;
        let mut count = 0;
        // SAFETY: the handle and the pointers are valid.
        check(unsafe { ffi::KSPGetConvergedReason(self.raw, &mut reason) })?;
        // SAFETY: as above.
        check(unsafe { ffi::KSPGetIterationNumber(self.raw, &mut count) })?;
        let iterations = usize::try_from(count).unwrap_or(0);
        match self.factor_failure()? {
            Some(failure) => Err(self.diverged(ffi::KSP_DIVERGED_PC_FAILED, failure, iterations)),
            None if reason > 0 => Ok(SolveInfo { reason, iterations }),
            None => Err(self.diverged(reason, "", iterations)),
        }
    }

    /// The outcome of this rank, agreed with the others in one reduction; a preconditioner that failed is dropped.
    pub(super) fn conclude<T>(&mut self, outcome: Result<T>) -> Result<T> {
        let severity = match &outcome {
            Ok(_) => 0,
            Err(Error::Diverged { reason, .. }) if *reason != ffi::KSP_DIVERGED_PC_FAILED => 1,
            Err(_) => BROKEN,
        };
        let worst = self.petsc.most(severity);
        if worst == BROKEN {
            // The error that led here says more than one of the cleaning up would.
            let _ = self.forget_factor();
        }
        if worst > 0 {
            outcome.and(Err(Error::OtherRank))
        } else {
            outcome
        }
    }

    /// Why the last solve ended, KSPConvergedReason and its name.
    pub fn converged_reason(&self) -> Result<(i32, String)> {
        let mut reason = 0;
        // SAFETY: the handle and the pointer are valid.
        check(unsafe { ffi::KSPGetConvergedReason(self.raw, &mut reason) })?;
        Ok((reason, self.reason_name()?))
    }

    fn reason_name(&self) -> Result<String> {
        let mut name = ptr::null();
        // SAFETY: the handle and the pointer are valid; PETSc's text is constant.
        check(unsafe { ffi::KSPGetConvergedReasonString(self.raw, &mut name) })?;
        // SAFETY: null or a text of PETSc.
        Ok(unsafe { text(name) })
    }

    pub(super) fn diverged(&self, reason: i32, failure: &str, iterations: usize) -> Error {
        if reason == ffi::KSP_DIVERGED_PC_FAILED {
            return Error::Diverged {
                reason,
                name: format!("DIVERGED_PC_FAILED {failure}").trim_end().to_owned(),
                iterations,
            };
        }
        Error::Diverged {
            reason,
            name: self.reason_name().unwrap_or_default(),
            iterations,
        }
    }

    /// Why the preconditioner or factor cannot be used, if it cannot.
    pub(super) fn factor_failure(&self) -> Result<Option<&'static str>> {
        let mut failure = ffi::PC_NOERROR;
        // SAFETY: the handle and the pointer are valid.
        check(unsafe { ffi::PCGetFailedReason(self.pc()?, &mut failure) })?;
        Ok(match failure {
            ffi::PC_NOERROR => None,
            ffi::PC_FACTOR_STRUCT_ZEROPIVOT => Some("(structurally zero pivot)"),
            ffi::PC_FACTOR_NUMERIC_ZEROPIVOT => Some("(zero pivot)"),
            ffi::PC_FACTOR_OUTMEMORY => Some("(factor out of memory)"),
            _ => Some("(factor or preconditioner failed)"),
        })
    }

    /// Drops a factor that failed: PETSc would keep it, failed, for later values of the matrix.
    fn forget_factor(&mut self) -> Result<()> {
        let pc = self.pc()?;
        let mut matrix = ptr::null_mut();
        // SAFETY: the handle and the pointer are valid; the matrix stays PETSc's.
        check(unsafe { ffi::KSPGetOperators(self.raw, ptr::null_mut(), &mut matrix) })?;
        // SAFETY: a matrix is a PetscObject; this reference outlives the PC's, which ends next.
        check(unsafe { ffi::PetscObjectReference(matrix.cast()) })?;
        // SAFETY: the handles are valid; the reference taken above is given back at the end.
        check(unsafe { ffi::PCReset(pc) })
            .and_then(|()| check(unsafe { ffi::PCSetFailedReason(pc, ffi::PC_NOERROR) }))
            .and_then(|()| check(unsafe { ffi::KSPSetOperators(self.raw, matrix, matrix) }))
            .and(check(unsafe { ffi::MatDestroy(&mut matrix) }))
    }

    pub(super) fn pc(&self) -> Result<ffi::PC> {
        let mut pc = ptr::null_mut();
        // SAFETY: the handle and the pointer are valid; the PC is the KSP's own.
        check(unsafe { ffi::KSPGetPC(self.raw, &mut pc) })?;
        Ok(pc)
    }
}
