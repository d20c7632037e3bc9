//! Finds the equilibrium of one step by nonlinear iteration (chapter 5 of the theory manual).

pub mod bordered;
pub mod broyden;
pub mod contact;
pub mod convergence;
pub mod fgmres;
pub mod found;
pub mod linearised;
pub mod multisecant;
pub mod newton;
pub mod quasi_newton;
pub mod round_off;
pub mod stability;
pub mod unknowns;

use crate::error::StepError;
use crate::field::Field;
use crate::field::solution::FieldSolution;
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::method::{Nonlinear, QuasiNewton};
use crate::parallel::Halo;
use crate::solve::quasi_newton::SecantMethod;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::report::Counts;
use crate::step::residual::Residual;
use crate::step::stiffness;
use convergence::{Convergence, inverted};
use found::StepSolution;
use quasi_newton::FailedIteration;

/// Communication between the ranks, the solver of the linear systems, and the work done.
pub struct Backend<'a> {
    /// Communication with the other ranks.
    pub halo: &'a dyn Halo,
    /// Solver of the linear systems.
    pub solver: &'a mut dyn LinearSolver,
    /// Work done, failed attempts included.
    pub counts: &'a mut Counts,
}

/// Finds equilibrium from the previous displacement `guess` (m, step 3b). If this fails, the iteration restarts from
/// zero. `first_energy` is the reference of the energy criterion, if an iteration of the step has set it already (N m).
pub fn find<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    guess: &[f64],
    first_energy: Option<f64>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<StepSolution<K, D>, StepError> {
    let last = admissible::<K, D>(problem.nodes, guess);
    let zero = admissible::<K, D>(problem.nodes, &vec![0.0; guess.len()]);
    let mut differs = [f64::from(u8::from(last != zero))];
    problem.halo.all_reduce_max(&mut differs);
    let is_coupled = problem.nodes.field.is_some();
    let method = match problem.model.nonlinear {
        // A rank-one update ignores a second field, and a Newton iteration costs as much as 6 to 23 secant iterations.
        Nonlinear::QuasiNewton(_) | Nonlinear::Auto if is_coupled => Nonlinear::QuasiNewton(QuasiNewton::Multisecant),
        method => method,
    };
    let by_newton = (is_coupled && problem.model.nonlinear == Nonlinear::Auto).then(|| last.clone());
    let mut found = search(problem, method, last, first_energy, solver, counts);
    // With a second field, Newton's method is tried before another guess: it converges in more of the steps in which
    // secants fail, and a failure of both costs the same.
    if let Some(last) = by_newton.filter(|_| goes_on(&found)) {
        found = search(problem, Nonlinear::Newton, last, first_energy, solver, counts);
    }
    if goes_on(&found) && differs[0] > 0.0 {
        let method = if method == Nonlinear::Auto {
            Nonlinear::Newton
        } else {
            method
        };
        found = search(problem, method, zero, first_energy, solver, counts).map(|found| StepSolution {
            first_guess: false,
            ..found
        });
    }
    if let Ok(found) = &mut found {
        problem
            .nodes
            .constraints
            .extend(&problem.model.grid, &mut found.u, problem.halo);
    }
    found
}

/// Returns whether another method or guess may succeed.
fn goes_on<T>(found: &Result<T, StepError>) -> bool {
    found.as_ref().is_err_and(StepError::another_method_may_help)
}

/// Searches for equilibrium from one guess.
fn search<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    method: Nonlinear,
    u: Vec<f64>,
    first_energy: Option<f64>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<StepSolution<K, D>, StepError> {
    let mut convergence = Convergence::new(problem, first_energy);
    let update = match method {
        Nonlinear::Newton => {
            let found = newton::iterate(problem, u, solver, counts, &mut convergence);
            return found
                .or_else(|failure| settled(problem, failure, counts, &convergence))
                .map_err(|failure| *failure.error);
        }
        Nonlinear::QuasiNewton(update) => update,
        Nonlinear::Auto => QuasiNewton::Multisecant,
    };
    let is_patient = method != Nonlinear::Auto;
    let secants = SecantMethod { update, is_patient };
    let mut failure = match by_secants(problem, secants, u, solver, counts, &mut convergence) {
        Ok(found) => return Ok(found),
        Err(failure) => failure,
    };
    if !is_patient && let Some(best) = failure.best.take() {
        let found = newton::iterate(problem, best, solver, counts, &mut convergence);
        failure = match found.or_else(|failure| settled(problem, failure, counts, &convergence)) {
            Ok(found) => return Ok(found),
            Err(failure) => failure,
        };
        if let Some(best) = failure.best.take() {
            let patient = SecantMethod {
                is_patient: true,
                ..secants
            };
            failure = match by_secants(problem, patient, best, solver, counts, &mut convergence) {
                Ok(found) => return Ok(found),
                Err(failure) => failure,
            };
        }
    }
    // A secant method alone that reached its limit of iterations might still have converged.
    let found = if is_patient {
        Err(failure)
    } else {
        settled(problem, failure, counts, &convergence)
    };
    found.map_err(|failure| *failure.error)
}

/// Returns the first state whose forces balanced far below their tolerance, if the iteration made no further progress.
fn settled<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    failure: FailedIteration,
    counts: &mut Counts,
    convergence: &Convergence,
) -> Result<StepSolution<K, D>, FailedIteration> {
    if !failure.error.another_method_may_help() {
        return Err(failure);
    }
    let Some(u) = convergence.settled() else {
        return Err(failure);
    };
    let residual = evaluate(problem, u, counts);
    Ok(StepSolution {
        settled: true,
        ..StepSolution::new(u.clone(), residual, convergence)
    })
}

/// Iterates with secants around the stiffness at `u`.
fn by_secants<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    method: SecantMethod,
    u: Vec<f64>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
    convergence: &mut Convergence,
) -> Result<StepSolution<K, D>, FailedIteration> {
    let residual = evaluate(problem, &u, counts);
    if !residual.balance.is_sound() {
        return Err(inverted(problem, &residual, convergence.iterations()).into());
    }
    if problem.nodes.constraints.unknowns > 0 && !convergence.is_balanced(&residual.balance, problem) {
        stiffness::factorise(problem, Some(&residual.trial), solver)?;
        counts.factorisations += 1;
        if let Some(field) = &problem.nodes.field {
            field.factorise(problem, &u[problem.nodes.constraints.free.len()..], solver)?;
            counts.factorisations += 1;
        }
    }
    quasi_newton::iterate(problem, method, u, residual, solver, counts, convergence)
}

/// Combines `guess` at free components, prescribed values, and zero elsewhere. The values of a second field at
/// the start follow.
fn admissible<K: Kinematics<D>, const D: usize>(nodes: &GridState<D>, guess: &[f64]) -> Vec<f64> {
    let displacements = guess
        .iter()
        .enumerate()
        .map(|(c, &value)| match nodes.constraints.prescribed[c] {
            Some(prescribed) => prescribed,
            None if nodes.constraints.free[c] => value,
            None => 0.0,
        });
    let field = nodes.field.iter().flat_map(Field::<K, D>::start);
    displacements.chain(field.copied()).collect()
}

/// Evaluates the forces under `u` and counts the evaluation.
pub fn evaluate<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    u: &[f64],
    counts: &mut Counts,
) -> Residual<K, D> {
    counts.evaluations += 1;
    Residual::of(problem, u)
}
