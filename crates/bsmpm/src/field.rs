//! Second field: unknowns at the nodes besides the displacement. The only one is the excess pore pressure.
//!
//! Steps know the field by the traits [`Field`] and [`FieldBalance`], and the nonlinear solution also by
//! [`FieldSolution`](solution::FieldSolution). In nodal arrays of all unknowns, the values of the field follow the
//! displacements, one per node.

pub mod pore_water;
pub mod solution;

pub use pore_water::carried::{add_forces, pore_pressure};
pub use pore_water::follow::Follow as FieldMatrix;
pub use pore_water::linearised::WaterTangent as FieldTangent;
pub use pore_water::newton::{CoupledDirection, Scales};
pub use pore_water::nodes::PorePressureField as SecondField;
pub use pore_water::residual::WaterBalance as SecondBalance;
pub use pore_water::saved::WaterReport as FieldReport;
pub use pore_water::split::Split;

use crate::error::StepError;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::problem::Problem;
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
