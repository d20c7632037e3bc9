//! Solves a linear system by PETSc's KSP with spline multigrid as preconditioner.

use super::choice::Choice;
use super::direct::{StiffnessOperator, gather};
use super::multigrid::{Multigrid, Operator};
use super::shell::ShellSystem;
use super::spread;
use super::system::{MOST_ITERATIONS, failed, trusted};
use super::tally::Tally;
use bsmpm::error::SolveError;
use bsmpm::linear::{SolveReport, Symmetry};
use petsc_rs::{Ksp, NormType, PcFailure, Petsc, ShellPc, Tolerances};

/// System with spline multigrid as preconditioner.
pub(super) struct CycleSystem<'p, const D: usize, const C: usize> {
    ksp: Ksp<'p>,
    ksp_type: String,
    cycles: usize, // per application
    multigrid: Option<Multigrid<D, C>>,
    unknowns: Vec<usize>,
}

impl<'p, const D: usize, const C: usize> CycleSystem<'p, D, C> {
    /// Creates a system without unknowns, solved as `choice` and the PETSc options define. Collective.
    pub fn new(petsc: &'p Petsc<'p>, choice: &Choice) -> petsc_rs::Result<Self> {
        let mut ksp = Ksp::new(petsc)?;
        choice.apply(&mut ksp, Symmetry::Definite)?;
        let cycles = choice.applications.max(1);
        Ok(Self {
            ksp,
            ksp_type: choice.ksp.clone(),
            cycles,
            multigrid: None,
            unknowns: Vec::new(),
        })
    }
}

impl<const D: usize, const C: usize> ShellSystem<D, C> for CycleSystem<'_, D, C> {
    fn resize(&mut self, unknowns: Vec<usize>) -> petsc_rs::Result<()> {
        self.multigrid = None;
        self.ksp.set_shell_operator(unknowns.len())?;
        self.unknowns = unknowns;
        Ok(())
    }

    fn tally(&self) -> Tally {
        Tally::of(&self.ksp, Some("multigrid of splines"))
    }

    fn set_up(&mut self, matrix: StiffnessOperator<'_, D, C>, tally: &mut Tally) -> Result<(), SolveError> {
        let Self {
            ksp,
            multigrid,
            unknowns,
            cycles,
            ..
        } = self;
        *multigrid = None;
        ksp.shell_operator_changed().map_err(failed)?;
        let mut pc = Cycles {
            multigrid,
            cycles: *cycles,
            matrix: StiffnessOperator { unknowns, ..matrix },
        };
        let outcome = ksp.set_up_with_pc(&mut pc);
        tally.failure(&outcome);
        outcome.map_err(|error| {
            if multigrid.is_none() {
                SolveError::Failed("a part of the stiffness is not positive definite".to_owned())
            } else {
                failed(error)
            }
        })
    }

    /// Only applies the preconditioner if the KSP type is `preonly`.
    fn solve(
        &mut self,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError> {
        let Self {
            ksp,
            multigrid,
            unknowns,
            cycles,
            ksp_type,
        } = self;
        let matrix = StiffnessOperator { unknowns, ..matrix };
        let mut pc = Cycles {
            multigrid,
            cycles: *cycles,
            matrix,
        };
        let outcome = ksp.solve_with_pc(&mut |x, y| matrix.multiply(x, y), &mut pc, |b| gather(unknowns, rhs, b));
        tally.count(ksp, &outcome);
        let info = outcome.map_err(failed)?;
        ksp.solution(|x| spread::<C>(matrix.halo, unknowns, x, solution))
            .map_err(failed)?;
        if ksp_type == PREONLY {
            let finite = solution.iter().all(|x| x.is_finite());
            return if finite {
                Ok(SolveReport::default())
            } else {
                Err(SolveError::NotFinite)
            };
        }
        let (left, right) = matrix.norms(rhs, solution);
        trusted(left, right)?;
        let residual = (right > 0.0).then(|| left / right);
        Ok(SolveReport {
            iterations: info.iterations,
            factorisations: 0,
            residual,
        })
    }

    /// Solves by conjugate gradients with the multigrid cycles as preconditioner.
    fn solve_to(
        &mut self,
        relative: f64,
        matrix: StiffnessOperator<'_, D, C>,
        rhs: &[f64],
        solution: &mut [f64],
        tally: &mut Tally,
    ) -> Result<SolveReport, SolveError> {
        let tolerances = Tolerances {
            relative: 0.1 * relative,
            absolute: 0.0,
            max_iterations: MOST_ITERATIONS,
        };
        let usual = std::mem::replace(&mut self.ksp_type, "cg".into());
        self.ksp.set_tolerances(tolerances).map_err(failed)?;
        self.ksp
            .set_type("cg")
            .and_then(|()| self.ksp.set_norm(NormType::Unpreconditioned))
            .map_err(failed)?;
        let found = self.solve(matrix, rhs, solution, tally);
        self.ksp_type = usual;
        self.ksp
            .set_type(&self.ksp_type)
            .and_then(|()| self.ksp.set_norm(NormType::None))
            .map_err(failed)?;
        found
    }
}

/// KSP type that only applies the preconditioner.
const PREONLY: &str = "preonly";

/// Multigrid levels with their finest matrix, as KSP's preconditioner.
struct Cycles<'a, const D: usize, const C: usize> {
    multigrid: &'a mut Option<Multigrid<D, C>>,
    cycles: usize,
    matrix: StiffnessOperator<'a, D, C>,
}

impl<const D: usize, const C: usize> ShellPc for Cycles<'_, D, C> {
    fn set_up(&mut self) -> Result<(), PcFailure> {
        let StiffnessOperator {
            grid,
            stencil,
            free,
            timers,
            ..
        } = self.matrix;
        let _timed = timers.time("factorisation");
        *self.multigrid = Multigrid::new(grid, Operator { stencil, free });
        if self.multigrid.is_some() {
            Ok(())
        } else {
            Err(PcFailure::ZeroPivot)
        }
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), PcFailure> {
        let StiffnessOperator {
            stencil,
            free,
            unknowns,
            timers,
            ..
        } = self.matrix;
        let _timed = timers.time("linear solve");
        let multigrid = self.multigrid.as_ref().ok_or(PcFailure::Other)?;
        let mut rhs = vec![0.0; free.len()];
        let mut solution = vec![0.0; free.len()];
        unknowns
            .iter()
            .zip(r)
            .for_each(|(&component, value)| rhs[component] = *value);
        multigrid.apply(Operator { stencil, free }, self.cycles, &rhs, &mut solution);
        gather(unknowns, &solution, z);
        Ok(())
    }
}
