//! The excess pore pressure as second field of a step.

use crate::error::{SolveError, StepError};
use crate::field::pore_water::linearised::WaterTangent;
use crate::field::pore_water::matrix;
use crate::field::pore_water::newton::{self, CoupledDirection};
use crate::field::pore_water::nodes::PorePressureField;
use crate::field::pore_water::residual::WaterBalance;
use crate::field::pore_water::saved;
use crate::field::pore_water::split::Split;
use crate::field::solution::FieldSolution;
use crate::field::{Field, FieldBalance};
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::problem::Problem;
use crate::step::residual::Residual;
use crate::step::trial::DeformationIncrement;

impl<K: Kinematics<D>, const D: usize> Field<K, D> for PorePressureField<D> {
    fn unknowns(&self) -> &[bool] {
        &self.free
    }

    fn start(&self) -> &[f64] {
        &self.guess
    }

    fn round_off(&self) -> f64 {
        self.round_off
    }

    fn balance(
        &self,
        problem: &Problem<'_, K, D>,
        trial: &mut DeformationIncrement<K, D>,
        values: &[f64],
    ) -> WaterBalance {
        WaterBalance::of(problem, self, trial, values)
    }

    fn tangent<'a>(
        &'a self,
        problem: &Problem<'_, K, D>,
        trial: &DeformationIncrement<K, D>,
        values: &'a [f64],
    ) -> WaterTangent<'a, D> {
        WaterTangent::at(problem, self, trial, values)
    }

    fn save(
        &self,
        model: &Model<K, D>,
        trial: &DeformationIncrement<K, D>,
        values: &[f64],
        points: &mut Points<D>,
        halo: &dyn Halo,
    ) -> f64 {
        saved::save(model, self, trial, values, points, halo)
    }
}

impl<K: Kinematics<D>, const D: usize> FieldSolution<K, D> for PorePressureField<D> {
    fn factorise(
        &self,
        problem: &Problem<'_, K, D>,
        values: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<(), SolveError> {
        matrix::factorise(problem, self, values, solver)
    }

    fn split(
        &self,
        problem: &Problem<'_, K, D>,
        out_of_balance: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<Split, SolveError> {
        Split::of(problem, self, out_of_balance, solver)
    }

    fn newton_direction(
        &self,
        problem: &Problem<'_, K, D>,
        x: &[f64],
        residual: &Residual<K, D>,
        balance: &WaterBalance,
        relative: f64,
        solver: &mut dyn LinearSolver,
    ) -> Result<CoupledDirection, SolveError> {
        newton::direction(problem, self, x, residual, balance, relative, solver)
    }
}

impl FieldBalance for WaterBalance {
    fn lacking(&self) -> impl Iterator<Item = f64> {
        self.excess.iter().map(|excess| -excess)
    }

    fn measure(&self, round_off: f64) -> f64 {
        if self.norm <= round_off {
            0.0
        } else {
            self.norm / self.scale
        }
    }

    fn is_sound(&self) -> bool {
        self.closed == 0 && self.finite
    }

    fn error(&self, iteration: usize) -> Option<StepError> {
        (self.closed > 0).then_some(StepError::Closed {
            count: self.closed,
            iteration,
        })
    }
}
