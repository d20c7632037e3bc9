//! Second field: unknowns at the nodes besides the displacement. The only one is the excess pore pressure.
//!
//! Steps and the nonlinear solution know the field by the traits [`Field`] and [`FieldBalance`]. In nodal arrays of all
//! unknowns, the values of the field follow the displacements, one per node.

pub mod pore_water;

pub use pore_water::carried::{add_forces, pore_pressure};
pub use pore_water::follow::Follow as FieldMatrix;
pub use pore_water::linearised::WaterTangent as FieldTangent;
pub use pore_water::newton::{CoupledDirection, Scales};
pub use pore_water::nodes::PorePressureField as SecondField;
pub use pore_water::residual::WaterBalance as SecondBalance;
pub use pore_water::saved::WaterReport as FieldReport;
pub use pore_water::split::Split;

use crate::error::{SolveError, StepError};
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::problem::Problem;
use crate::step::residual::Residual;
use crate::step::trial::DeformationIncrement;

/// Second field in one step.
pub trait Field<K: Kinematics<D>, const D: usize> {
    /// Returns, per node, whether the value is an unknown.
    fn unknowns(&self) -> &[bool];

    /// Returns the nodal values from which the iteration starts.
    fn start(&self) -> &[f64];

    /// Returns the norm of the round-off of the balance.
    fn round_off(&self) -> f64;

    /// Evaluates the balance of the field for nodal `values` and the deformation of `trial`, and stores the part of the
    /// stress that the field carries in `trial`. Communicates.
    fn balance(
        &self,
        problem: &Problem<'_, K, D>,
        trial: &mut DeformationIncrement<K, D>,
        values: &[f64],
    ) -> SecondBalance;

    /// Linearises the balance at nodal `values`.
    fn tangent<'a>(
        &'a self,
        problem: &Problem<'_, K, D>,
        trial: &DeformationIncrement<K, D>,
        values: &'a [f64],
    ) -> FieldTangent<'a, D>;

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

    /// Stores the converged nodal `values` in the material points, which have moved. Returns how much they took in,
    /// over all ranks. One reduction.
    fn save(
        &self,
        model: &Model<K, D>,
        trial: &DeformationIncrement<K, D>,
        values: &[f64],
        points: &mut Points<D>,
        halo: &dyn Halo,
    ) -> f64;
}

/// Balance of a second field at the nodes.
pub trait FieldBalance {
    /// Returns what the balance lacks, one number per node; zero where the value is not an unknown.
    fn lacking(&self) -> impl Iterator<Item = f64>;

    /// Returns the residual relative to its largest term (-); zero if it is at most `round_off`.
    fn measure(&self, round_off: f64) -> f64;

    /// Returns whether, on all ranks, every point has an admissible state and no number overflowed.
    fn is_sound(&self) -> bool;

    /// Returns the error of points without an admissible state in an `iteration`, if there are any.
    fn error(&self, iteration: usize) -> Option<StepError>;
}
