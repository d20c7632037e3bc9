//! Newton's method with the complete derivative, theory-manual equation (T5.14), a Krylov solver and a line search.
//! Used where quasi-Newton stalls.

use crate::error::{SolveError, StepError};
use crate::field::solution::FieldSolution;
use crate::field::{CoupledDirection, Scales};
use crate::kinematics::Kinematics;
use crate::linear::{Krylov, LinearSolver};
use crate::method::Method;
use crate::parallel::dot;
use crate::solve::convergence::{Convergence, first_energy, inverted};
use crate::solve::evaluate;
use crate::solve::fgmres;
use crate::solve::found::StepSolution;
use crate::solve::linearised::ForceTangent;
use crate::solve::quasi_newton::FailedIteration;
use crate::solve::stability;
use crate::solve::unknowns::Unknowns;
use crate::step::problem::Problem;
use crate::step::report::Counts;
use crate::step::residual::{Balance, Residual};
use crate::step::stiffness;

/// Iterations after which a step is given up. Near a solution five or six suffice.
const MOST: usize = 30;
/// Smallest and largest relative residual of a direction. In between it follows the force measure, so that convergence
/// stays quadratic (Dembo, Eisenstat and Steihaug, 1982).
const FORCING: (f64, f64) = (1e-10, 1e-3);
/// Largest relative residual with a second field, with an inexact solver, and in three dimensions. The preconditioner
/// is then no factorisation of the derivative, and each factor of ten costs matrix-vector products.
const LOOSE: f64 = 1e-1;
/// Relative residual above which a direction is rejected.
const USELESS: f64 = 0.5;
/// Smallest fraction of a direction that the line search tries.
const SHORTEST: f64 = 1.0 / 64.0;
/// Fraction of the predicted decrease of the force that a step must achieve (Armijo).
const DECREASE: f64 = 1e-4;

/// Iterates from the displacement `u`. The measures continue those in `convergence`.
pub fn iterate<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    mut u: Vec<f64>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
    convergence: &mut Convergence,
) -> Result<StepSolution<K, D>, FailedIteration> {
    let mut residual = evaluate(problem, &u, counts);
    if !residual.balance.is_sound() {
        return Err(inverted(problem, &residual, convergence.iterations()).into());
    }
    // The state after the last direction is judged, too.
    for iteration in 0..=MOST {
        if convergence.is_balanced(&residual.balance, problem) {
            return Ok(StepSolution::new(u, residual, convergence));
        }
        if problem.halo.is_interrupted() {
            return Err(StepError::Interrupted.into());
        }
        let (du, energy) = match direction(problem, &u, &residual, solver, counts) {
            Ok(found) => found,
            Err(unsolved) => {
                return Err(FailedIteration::without_direction(
                    problem,
                    u,
                    &residual,
                    convergence,
                    unsolved,
                ));
            }
        };
        if !convergence.has_begun() {
            convergence.begin(first_energy(
                problem,
                &du[..problem.nodes.constraints.free.len()],
                energy,
            ));
        }
        if convergence.reaches(Method::Newton, energy.abs(), &u, &residual.balance) {
            return Ok(StepSolution::new(u, residual, convergence));
        }
        if iteration == MOST {
            break;
        }
        let work = stability::is_decisive(problem, &residual.balance).then_some(energy);
        let Some((next, found)) = search(problem, &u, &du, &residual, counts) else {
            break;
        };
        stability::check(problem, convergence, &du, work, &found.balance)?;
        (u, residual) = (next, found);
    }
    Err(FailedIteration {
        error: Box::new(convergence.failed(problem, &residual, None)),
        best: Some(u),
    })
}

/// Solves K du = f_oob with the complete derivative K at this state. Returns du and the energy du . f_oob (N m). The
/// values of a second field follow the displacements in du.
fn direction<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    x: &[f64],
    residual: &Residual<K, D>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<(Vec<f64>, f64), SolveError> {
    if let Some((field, balance)) = problem.nodes.field.as_ref().zip(residual.balance.field.as_ref()) {
        let measure = Scales::of(problem, &residual.balance).measure(&residual.balance);
        let forcing = measure.clamp(FORCING.0, LOOSE);
        let CoupledDirection { dx, energy, krylov } =
            field.newton_direction(problem, x, residual, balance, forcing, solver)?;
        counts.factorisations += 2;
        counts.iterations += 1;
        counts.products += krylov.iterations + 1;
        counts.linear_iterations += krylov.iterations;
        return if krylov.residual < USELESS {
            Ok((dx, energy))
        } else {
            Err(SolveError::Residual(krylov.residual))
        };
    }
    let measure = residual.balance.measure();
    counts.factorisations += 1;
    counts.iterations += 1;
    // In three dimensions a general matrix takes more than twice the memory for the same number of iterations.
    let (du, krylov) = if solver.is_rough() || D == 3 {
        around_stiffness(problem, residual, measure.clamp(FORCING.0, LOOSE), solver)?
    } else {
        let linearised = ForceTangent::at(problem, residual);
        linearised.factorise(solver)?;
        let mut du = vec![0.0; residual.balance.f_oob.len()];
        let krylov = solver.solve_with(
            &mut |v, out| linearised.multiply(v, out),
            measure.clamp(FORCING.0, FORCING.1),
            &residual.balance.f_oob,
            &mut du,
        )?;
        (du, krylov)
    };
    counts.products += krylov.iterations + 1;
    counts.linear_iterations += krylov.iterations;
    if krylov.residual >= USELESS {
        return Err(SolveError::Residual(krylov.residual));
    }
    let energy = dot(problem.halo, D, &du, &residual.balance.f_oob);
    Ok((du, energy))
}

/// Solves for the direction without a general matrix: a Krylov method with the product of the derivative,
/// preconditioned by the symmetric stiffness at this state.
fn around_stiffness<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    residual: &Residual<K, D>,
    relative: f64,
    solver: &mut dyn LinearSolver,
) -> Result<(Vec<f64>, Krylov), SolveError> {
    let halo = problem.halo;
    let f = &residual.balance.f_oob;
    let linearised = ForceTangent::at(problem, residual);
    stiffness::factorise(problem, Some(&residual.trial), solver)?;
    let unknowns = Unknowns::of::<D>(&problem.nodes.constraints.free, halo);
    let mut nodal = vec![0.0; f.len()];
    let mut image = vec![0.0; f.len()];
    let mut force = vec![0.0; f.len()];
    let mut direction = vec![0.0; f.len()];
    let (found, krylov) = fgmres::solve(
        &unknowns,
        halo,
        |v| {
            unknowns.unpack(v, &mut nodal);
            linearised.multiply(&nodal, &mut image);
            unknowns.packed(&image)
        },
        |r| {
            unknowns.unpack(r, &mut force);
            solver.solve(&force, &mut direction)?;
            Ok(unknowns.packed(&direction))
        },
        &unknowns.packed(f),
        relative,
    )?;
    let mut du = vec![0.0; f.len()];
    unknowns.unpack(&found, &mut du);
    Ok((du, krylov))
}

/// Tries the full direction, half of it, a quarter, .., and returns the first state that reduces the out-of-balance
/// force; with a second field, the combined measure of forces and field.
fn search<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    u: &[f64],
    du: &[f64],
    residual: &Residual<K, D>,
    counts: &mut Counts,
) -> Option<(Vec<f64>, Residual<K, D>)> {
    let scales = problem
        .nodes
        .field
        .as_ref()
        .map(|_| Scales::of(problem, &residual.balance));
    let measure = |of: &Balance| scales.as_ref().map_or(of.norm, |scales| scales.measure(of));
    let before = measure(&residual.balance);
    let mut length = 1.0;
    while length >= SHORTEST {
        let next: Vec<f64> = u.iter().zip(du).map(|(u, du)| u + length * du).collect();
        let found = evaluate(problem, &next, counts);
        if found.balance.is_sound() && measure(&found.balance) <= (1.0 - DECREASE * length) * before {
            return Some((next, found));
        }
        length *= 0.5;
    }
    None
}
