//! Linear systems of a second field, which the nonlinear solution needs.

use crate::error::SolveError;
use crate::field::{CoupledDirection, Field, SecondBalance, Split};
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::step::problem::Problem;
use crate::step::residual::Residual;

/// Second field in the linear systems of a step.
pub trait FieldSolution<K: Kinematics<D>, const D: usize>: Field<K, D> {
    /// Assembles and factorises the symmetric matrix of the field at nodal `values`.
    fn factorise(
        &self,
        problem: &Problem<'_, K, D>,
        values: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<(), SolveError>;

    /// Solves for a direction of all unknowns with the symmetric matrices of both fields, one after the other. The
    /// right-hand side contains the out-of-balance forces, then what the balance of the field lacks.
    fn split(
        &self,
        problem: &Problem<'_, K, D>,
        out_of_balance: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<Split, SolveError>;

    /// Solves for the Newton direction of all unknowns at the state `x`, where `balance` is that of the field, to the
    /// relative residual `relative`.
    fn newton_direction(
        &self,
        problem: &Problem<'_, K, D>,
        x: &[f64],
        residual: &Residual<K, D>,
        balance: &SecondBalance,
        relative: f64,
        solver: &mut dyn LinearSolver,
    ) -> Result<CoupledDirection, SolveError>;
}
