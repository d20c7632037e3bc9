//! Solves a linear system by PETSc's KSP, with the direct solver as preconditioner.

use super::choice::Choice;
use super::direct::{DissectionFactor, DissectionPc, StiffnessOperator, gather};
use super::spread;
use super::system::{failed, trusted};
use super::tally::Tally;
use bsmpm::error::SolveError;
use bsmpm::linear::{SolveReport, Symmetry};
use petsc_rs::{Ksp, Petsc};

/// Linear system with its solver, which are kept when the unknowns change.
pub(super) struct ShellSystem<'p> {
    ksp: Ksp<'p>,
    is_preonly: bool,
    factor: DissectionFactor,
    unknowns: Vec<usize>,
}

impl<'p> ShellSystem<'p> {
    /// Creates a system without unknowns, solved as `choice` and the PETSc options define. Collective.
    pub fn new(petsc: &'p Petsc<'p>, choice: &Choice) -> petsc_rs::Result<Self> {
        let mut ksp = Ksp::new(petsc)?;
        choice.apply(&mut ksp, Symmetry::Definite)?;
        let is_preonly = ksp.type_name()?.as_deref() == Some("preonly");
        Ok(Self {
            ksp,
            is_preonly,
            factor: DissectionFactor::default(),
            unknowns: Vec::new(),
        })
    }

    /// Changes the unknown components of this rank. Collective.
    pub fn resize(&mut self, unknowns: Vec<usize>) -> petsc_rs::Result<()> {
        self.factor.replan();
        self.ksp.set_shell_operator(unknowns.len())?;
        self.unknowns = unknowns;
        Ok(())
    }

    /// Marks the factor as outdated, because the matrix will change.
    pub fn outdate(&mut self) {
        self.factor.outdate();
    }

    /// Returns whether the system is set up for the present matrix.
    pub fn is_ready(&self) -> bool {
        self.factor.is_there()
    }

    /// Creates a tally with the names of KSP and its preconditioner.
    pub fn tally(&self) -> Tally {
        Tally::of(&self.ksp, Some("dissection"))
    }

    /// Factorises a matrix, whose `unknowns` are set here. Collective.
    pub fn set_up<const D: usize, const C: usize>(
        &mut self,
        matrix: StiffnessOperator<'_, D, C>,
        tally: &mut Tally,
    ) -> Result<(), SolveError> {
        let Self {
            ksp, factor, unknowns, ..
        } = self;
        factor.cause = None;
        ksp.shell_operator_changed().map_err(failed)?;
        let mut pc = DissectionPc {
            factor,
            matrix: StiffnessOperator { unknowns, ..matrix },
        };
        let outcome = ksp.set_up_with_pc(&mut pc);
        tally.failure(&outcome);
        outcome.map_err(|error| pc.factor.cause.take().unwrap_or_else(|| failed(error)))
    }

    /// Solves for a nodal right-hand side. Fails if KSP has not converged or the residual is too large. Collective.
    pub fn solve<const D: usize, const C: usize>(
        &mut self,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError> {
        let Self {
            ksp, factor, unknowns, ..
        } = self;
        let matrix = StiffnessOperator { unknowns, ..matrix };
        (factor.cause, factor.further, factor.residual) = (None, 0, None);
        let mut pc = DissectionPc { factor, matrix };
        let outcome = ksp.solve_with_pc(&mut |x, y| matrix.multiply(x, y), &mut pc, |b| gather(unknowns, rhs, b));
        tally.count(ksp, &outcome);
        let info = outcome.map_err(|error| pc.factor.cause.take().unwrap_or_else(|| failed(error)))?;
        let mut residual = factor.residual;
        if self.is_preonly {
            // The preconditioner's result includes ghost nodes, so no exchange is needed.
            solution.copy_from_slice(&factor.solution);
        } else {
            ksp.solution(|x| spread::<C>(matrix.halo, unknowns, x, solution))
                .map_err(failed)?;
            let (left, right) = matrix.norms(rhs, solution);
            trusted(left, right)?;
            residual = (right > 0.0).then(|| left / right);
        }
        Ok(SolveReport {
            iterations: info.iterations,
            factorisations: factor.further,
            residual,
        })
    }
}
