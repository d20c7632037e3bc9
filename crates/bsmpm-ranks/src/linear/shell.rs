//! Solves a linear system by PETSc's KSP, with the direct solver as preconditioner.

use super::choice::Choice;
use super::direct::{DissectionFactor, DissectionPc, StiffnessOperator, gather};
use super::spread;
use super::system::{failed, trusted};
use super::tally::Tally;
use bsmpm::error::SolveError;
use bsmpm::parallel::{SolveReport, Symmetry};
use petsc_rs::{Ksp, Petsc};

/// The system with its solver, which stay when the unknowns change.
pub(super) struct ShellSystem<'p> {
    ksp: Ksp<'p>,
    is_preonly: bool,
    factor: DissectionFactor,
    unknowns: Vec<usize>,
}

impl<'p> ShellSystem<'p> {
    /// A system without unknowns, to be solved as `choice` and the options say. Collective.
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

    /// Other components of this rank are unknown. Collective.
    pub fn resize(&mut self, unknowns: Vec<usize>) -> petsc_rs::Result<()> {
        self.factor.replan();
        self.ksp.set_shell_operator(unknowns.len())?;
        self.unknowns = unknowns;
        Ok(())
    }

    /// The matrix is about to be another one.
    pub fn outdate(&mut self) {
        self.factor.outdate();
    }

    /// Whether it was set up for the present matrix.
    pub fn is_ready(&self) -> bool {
        self.factor.is_there()
    }

    /// What KSP and its preconditioner are called.
    pub fn tally(&self) -> Tally {
        Tally::of(&self.ksp, Some("dissection"))
    }

    /// Factorises a matrix, of which the unknowns are filled in. Collective.
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

    /// The nodal solution for a nodal right-hand side; KSP's reason says whether it is one. Collective.
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
            // What the preconditioner gave, ghost nodes included: nothing need be exchanged.
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
