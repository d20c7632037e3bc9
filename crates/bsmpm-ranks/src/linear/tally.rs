//! Counts KSP's convergence reasons.

use petsc_rs::{Error, Ksp, SolveInfo};
use std::collections::BTreeMap;

/// Solver of one kind of linear system, and the number of solves by KSP's converged reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// KSPType.
    pub ksp: String,
    /// PCType, with the name of a shell preconditioner.
    pub pc: String,
    /// Number of solves by KSPConvergedReason.
    pub reasons: BTreeMap<String, u64>,
}

impl Tally {
    /// Creates an empty tally with the names of a solver; `shell` is the name of a shell preconditioner.
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

    /// Counts a failed solve or set-up; success is not counted.
    pub(super) fn failure<T>(&mut self, outcome: &petsc_rs::Result<T>) {
        match outcome {
            Ok(_) => {}
            // The reason's name may be followed by that of the preconditioner's failure.
            Err(Error::Diverged { name, .. }) => self.enter(name.split(' ').next().unwrap_or(UNKNOWN).to_owned()),
            Err(_) => self.enter(UNKNOWN.into()),
        }
    }

    fn enter(&mut self, reason: String) {
        *self.reasons.entry(reason).or_default() += 1;
    }
}

/// Entry for a solve without a reason on this rank: another rank or PETSc itself failed.
const UNKNOWN: &str = "ERROR";

/// Outcomes of the solves, by kind of linear system.
#[derive(Clone, Debug, Default)]
pub struct Tallies {
    /// Stiffness that quasi-Newton secants correct.
    pub definite: Option<Tally>,
    /// Jacobian of Newton's method.
    pub general: Option<Tally>,
    /// Pore pressures.
    pub water: Option<Tally>,
}
