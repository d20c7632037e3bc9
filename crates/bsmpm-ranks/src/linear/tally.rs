//! Counts KSP's convergence reasons.

use petsc_rs::{Error, Ksp, SolveInfo};
use std::collections::BTreeMap;

/// A kind of linear systems: what solves them, and how often KSP gave which reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// KSPType
    pub ksp: String,
    /// PCType, with the name of a shell
    pub pc: String,
    /// solves by KSPConvergedReason
    pub reasons: BTreeMap<String, u64>,
}

impl Tally {
    /// The names of a solver, of which nothing is counted yet; `shell` is that of a shell preconditioner.
    pub(super) fn of(ksp: &Ksp<'_>, shell: Option<&str>) -> Self {
        let [pc, ksp] = [ksp.pc_type_name(), ksp.type_name()].map(|name| name.ok().flatten().unwrap_or_default());
        let pc = shell.map_or_else(|| pc.clone(), |shell| format!("{pc} ({shell})"));
        Self {
            ksp,
            pc,
            reasons: BTreeMap::new(),
        }
    }

    /// Counts a solve.
    pub(super) fn count(&mut self, ksp: &Ksp<'_>, outcome: &petsc_rs::Result<SolveInfo>) {
        match outcome {
            Ok(_) => self.enter(ksp.converged_reason().map_or_else(|_| UNKNOWN.into(), |(_, name)| name)),
            Err(_) => self.failure(outcome),
        }
    }

    /// Counts what came to no solve, or to a failed one.
    pub(super) fn failure<T>(&mut self, outcome: &petsc_rs::Result<T>) {
        match outcome {
            Ok(_) => {}
            // The name of the reason may be followed by that of the preconditioner's.
            Err(Error::Diverged { name, .. }) => self.enter(name.split(' ').next().unwrap_or(UNKNOWN).to_owned()),
            Err(_) => self.enter(UNKNOWN.into()),
        }
    }

    fn enter(&mut self, reason: String) {
        *self.reasons.entry(reason).or_default() += 1;
    }
}

/// Of a solve without a reason on this rank: another one failed, or PETSc did.
const UNKNOWN: &str = "ERROR";
