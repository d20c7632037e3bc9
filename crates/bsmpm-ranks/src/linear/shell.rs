//! Solves a linear system by PETSc's KSP without an assembled matrix: the preconditioner is this program's own.

use super::choice::Choice;
use super::direct::{DissectionFactor, DissectionPc, StiffnessOperator, gather};
use super::system::{failed, trusted};
use super::tally::Tally;
use super::{missing, spread};
use bsmpm::error::SolveError;
use bsmpm::linear::{SolveReport, Symmetry};
use petsc_rs::{Ksp, Petsc};

/// Linear system whose matrix is known by its products, with its solver. Both are kept when the unknowns change.
pub(super) trait ShellSystem<const D: usize, const C: usize> {
    /// Changes the unknown components of this rank. Collective.
    fn resize(&mut self, unknowns: Vec<usize>) -> petsc_rs::Result<()>;

    /// Marks the preconditioner as outdated, because the matrix will change.
    fn outdate(&mut self) {}

    /// Creates a tally with the names of KSP and its preconditioner.
    fn tally(&self) -> Tally;

    /// Sets up the preconditioner for a matrix, whose `unknowns` are set here. Collective.
    fn set_up(&mut self, matrix: StiffnessOperator<'_, D, C>, tally: &mut Tally) -> Result<(), SolveError>;

    /// Solves for a nodal right-hand side, see [`LinearSolver::solve`](bsmpm::linear::LinearSolver::solve). Fails if
    /// KSP has not converged or the residual is too large. Collective.
    fn solve(
        &mut self,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError>;

    /// Solves to the relative residual `_relative`. Collective.
    fn solve_to(
        &mut self,
        _relative: f64,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError> {
        self.solve(matrix, rhs, solution, tally)
    }
}

/// System with the direct solver, nested dissection, as preconditioner.
pub(super) struct DissectionSystem<'p> {
    ksp: Ksp<'p>,
    is_preonly: bool,
    factor: DissectionFactor,
    unknowns: Vec<usize>,
}

impl<'p> DissectionSystem<'p> {
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
}

impl<const D: usize, const C: usize> ShellSystem<D, C> for DissectionSystem<'_> {
    fn resize(&mut self, unknowns: Vec<usize>) -> petsc_rs::Result<()> {
        self.factor.replan();
        self.ksp.set_shell_operator(unknowns.len())?;
        self.unknowns = unknowns;
        Ok(())
    }

    fn outdate(&mut self) {
        self.factor.outdate();
    }

    fn tally(&self) -> Tally {
        Tally::of(&self.ksp, Some("dissection"))
    }

    fn set_up(&mut self, matrix: StiffnessOperator<'_, D, C>, tally: &mut Tally) -> Result<(), SolveError> {
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

    fn solve(
        &mut self,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError> {
        let Self {
            ksp, factor, unknowns, ..
        } = self;
        if !factor.is_there() {
            return Err(missing());
        }
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
