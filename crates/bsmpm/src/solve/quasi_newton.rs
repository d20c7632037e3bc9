//! Quasi-Newton iteration of a step, with one factorised stiffness K_0.

use crate::error::{SolveError, StepError};
use crate::field::solution::FieldSolution;
use crate::field::{Field, FieldBalance, FieldMatrix, Split};
use crate::kinematics::Kinematics;
use crate::linear::{LinearSolver, SolveReport};
use crate::method::{Method, QuasiNewton};
use crate::parallel::{Halo, dot};
use crate::solve::broyden::Broyden;
use crate::solve::convergence::{Convergence, first_energy, inverted};
use crate::solve::evaluate;
use crate::solve::found::StepSolution;
use crate::solve::multisecant::Multisecant;
use crate::solve::stability;
use crate::solve::unknowns::Unknowns;
use crate::step::problem::Problem;
use crate::step::report::Counts;
use crate::step::residual::{Balance, Residual};

/// Smallest fraction of a direction that is tried if points invert.
const SHORTEST: f64 = 1.0 / 16.0;

/// A search direction and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Nodal displacements (m), followed by the values of a second field.
    pub du: Vec<f64>,
    /// Energy du . f (N m).
    pub energy: f64,
    /// Report of the solution with K_0.
    pub solved: SolveReport,
}

/// Secants of one iteration. Both methods need one solution with K_0 per direction.
#[derive(Clone, Debug)]
pub enum Secants {
    /// See [`Multisecant`].
    Multisecant(Multisecant),
    /// See [`Broyden`].
    Broyden(Broyden),
}

impl Secants {
    /// Creates an empty history for a system whose unknowns are the `free` components, `D` per node.
    pub fn new<const D: usize>(method: QuasiNewton, free: &[bool], halo: &dyn Halo) -> Self {
        match method {
            QuasiNewton::Multisecant => Self::Multisecant(Multisecant::new(Unknowns::of::<D>(free, halo))),
            QuasiNewton::Broyden => Self::Broyden(Broyden::default()),
        }
    }

    /// Creates an empty history for the unknowns of a problem. With a second field, its values are among them and the
    /// multisecant method is used.
    fn of<K: Kinematics<D>, const D: usize>(method: QuasiNewton, problem: &Problem<'_, K, D>) -> Self {
        let free = &problem.nodes.constraints.free;
        let halo = problem.halo;
        let Some(field) = &problem.nodes.field else {
            return Self::new::<D>(method, free, halo);
        };
        let of_field = Field::<K, D>::unknowns(field);
        let unknowns = Unknowns::of::<D>(free, halo).with_field(free.len(), of_field, halo);
        Self::Multisecant(Multisecant::new(unknowns))
    }

    /// Returns the direction du = H f for the out-of-balance force `f` (N), `D` components per node.
    pub fn direction<const D: usize>(
        &mut self,
        f: &[f64],
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) -> Result<Direction, SolveError> {
        let mut w = vec![0.0; f.len()];
        let solved = solver.solve(f, &mut w)?;
        Ok(self.corrected::<D>(w, f, halo, solved))
    }

    /// Returns the direction of a problem's displacements, followed by the values of a second field.
    fn towards<K: Kinematics<D>, const D: usize>(
        &mut self,
        problem: &Problem<'_, K, D>,
        balance: &Balance,
        solver: &mut dyn LinearSolver,
    ) -> Result<Direction, SolveError> {
        match problem.nodes.field.as_ref().zip(balance.field.as_ref()) {
            Some((field, lacks)) => {
                let f: Vec<f64> = balance.f_oob.iter().copied().chain(lacks.lacking()).collect();
                let Split { z, f, solved } = field.split(problem, &f, solver)?;
                Ok(self.corrected::<D>(z, &f, problem.halo, solved))
            }
            None => self.direction::<D>(&balance.f_oob, problem.halo, solver),
        }
    }

    /// Corrects w = K_0^-1 f to the direction du.
    fn corrected<const D: usize>(
        &mut self,
        mut w: Vec<f64>,
        f: &[f64],
        halo: &dyn Halo,
        solved: SolveReport,
    ) -> Direction {
        let (du, energy) = match self {
            Self::Multisecant(secants) => {
                let energy = secants.correct(&mut w, f, halo);
                (w, energy)
            }
            Self::Broyden(secants) => {
                let du = secants.correct::<D>(w, halo);
                let energy = dot(halo, D, &du, f);
                (du, energy)
            }
        };
        Direction { du, energy, solved }
    }

    /// Records the fraction of the last direction that was taken: 1 for a full step.
    pub fn took(&mut self, length: f64) {
        match self {
            Self::Multisecant(secants) => secants.took(length),
            Self::Broyden(secants) => secants.took(length),
        }
    }
}

/// An iteration that did not converge.
#[derive(Clone, Debug)]
pub struct FailedIteration {
    /// Cause of the failure.
    pub error: Box<StepError>,
    /// Nodal displacement with the smallest out-of-balance force (m), if any state was sound.
    pub best: Option<Vec<f64>>,
}

impl FailedIteration {
    /// Reports that the linear system could not be solved at a state. Without earlier iterations, the system itself is
    /// reported as the cause.
    pub fn without_direction<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        best: Vec<f64>,
        residual: &Residual<K, D>,
        convergence: &Convergence,
        unsolved: SolveError,
    ) -> Self {
        if convergence.iterations() == 0 {
            return unsolved.into();
        }
        Self::with_best(convergence.failed(problem, residual, Some(unsolved)), best)
    }

    /// Reports a failure with the nodal displacement `best` before it (m).
    fn with_best(error: StepError, best: Vec<f64>) -> Self {
        Self {
            error: Box::new(error),
            best: Some(best),
        }
    }
}

impl<E: Into<StepError>> From<E> for FailedIteration {
    fn from(error: E) -> Self {
        Self {
            error: Box::new(error.into()),
            best: None,
        }
    }
}

/// How the secants are used.
#[derive(Clone, Copy, Debug)]
pub struct SecantMethod {
    /// Quasi-Newton update.
    pub update: QuasiNewton,
    /// Whether slow convergence is continued up to the limit of iterations.
    pub is_patient: bool,
}

/// Iterates from the displacement `u` and its `residual` with the factorised K_0, up to the limit of iterations. Unless
/// the method is patient, the iteration stops when convergence is out of reach.
pub fn iterate<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    method: SecantMethod,
    mut u: Vec<f64>,
    mut residual: Residual<K, D>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
    convergence: &mut Convergence,
) -> Result<StepSolution<K, D>, FailedIteration> {
    let mut secants = Secants::of(method.update, problem);
    let mut matrix = FieldMatrix::of(problem, &u);
    let mut best = u.clone();
    let mut least = residual.balance.norm;
    while convergence.iterations() < problem.model.criteria.max_iterations
        && (method.is_patient || !convergence.stalls())
    {
        if convergence.is_balanced(&residual.balance, problem) {
            return Ok(StepSolution::new(u, residual, convergence));
        }
        if problem.halo.is_interrupted() {
            return Err(StepError::Interrupted.into());
        }
        let mut direction = next_direction(problem, &mut secants, &residual, &best, solver, counts, convergence)?;
        let energy = direction.energy.abs();
        if convergence.reaches(Method::QuasiNewton(method.update), energy, &u, &residual.balance) {
            return Ok(StepSolution::new(u, residual, convergence)); // (9)
        }
        // The direction's own energy is a sum of products with secants, which has a different round-off.
        let work = stability::is_decisive(problem, &residual.balance)
            .then(|| dot(problem.halo, D, &direction.du, &residual.balance.f_oob));
        let of_field = convergence.field(&residual.balance).unwrap_or(0.0);
        matrix.tame(problem, &u, &mut direction.du, of_field);
        match advance(problem, &mut u, &direction.du, &mut residual, counts) {
            Ok(length) => secants.took(length), // (8), (4), (5)
            Err(inverted) => return Err(FailedIteration::with_best(inverted, best)),
        }
        stability::check(problem, convergence, &direction.du, work, &residual.balance)?;
        let of_field = convergence.field(&residual.balance).unwrap_or(0.0);
        if matrix.up(problem, &u, of_field, solver)? {
            counts.factorisations += 1;
            secants = Secants::of(method.update, problem);
        }
        if residual.balance.norm < least {
            (least, best) = (residual.balance.norm, u.clone());
        }
    }
    Err(FailedIteration::with_best(
        convergence.failed(problem, &residual, None),
        best,
    ))
}

/// Steps (6), (7): solves for the next direction. Fails with the `best` displacement so far if the linear system cannot
/// be solved.
fn next_direction<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    secants: &mut Secants,
    residual: &Residual<K, D>,
    best: &[f64],
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
    convergence: &mut Convergence,
) -> Result<Direction, FailedIteration> {
    let direction = secants
        .towards(problem, &residual.balance, solver)
        .map_err(|unsolved| {
            FailedIteration::without_direction(problem, best.to_vec(), residual, convergence, unsolved)
        })?;
    counts.iterations += 1;
    counts.linear_iterations += direction.solved.iterations;
    counts.factorisations += direction.solved.factorisations;
    if !convergence.has_begun() {
        let du = &direction.du[..problem.nodes.constraints.free.len()];
        convergence.begin(first_energy(problem, du, direction.energy));
    }
    Ok(direction)
}

/// Step (8): takes the full direction, or half, a quarter, .. of it until no point inverts. Returns the fraction.
fn advance<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    u: &mut Vec<f64>,
    du: &[f64],
    residual: &mut Residual<K, D>,
    counts: &mut Counts,
) -> Result<f64, StepError> {
    let mut length = 1.0;
    loop {
        let next: Vec<f64> = u.iter().zip(du).map(|(u, du)| u + length * du).collect();
        let found = evaluate(problem, &next, counts);
        if found.balance.is_sound() {
            (*u, *residual) = (next, found);
            return Ok(length);
        }
        if length <= SHORTEST {
            return Err(inverted(problem, &found, counts.iterations));
        }
        length *= 0.5;
    }
}
