//! Footings and prescribed segments as an [`Interaction`] of a step.

use super::{StripConstraints, nodes_at};
use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::Contributions;
use crate::interactions::state::InteractionState;
use crate::interactions::{
    Correction, EquilibriumState, Interaction, InteractionReports, InteractionWork, MOST_CORRECTIONS, StepContext,
    StepStart,
};
use crate::linear::MatrixAssembly;
use crate::parallel::Halo;
use crate::schedule::TimeInterval;

/// Begins the footings and prescribed segments of a step, if there are any.
pub fn begin<K, const D: usize>(start: &StepStart<'_, K, D>) -> Option<Box<dyn Interaction<D>>> {
    let model = start.model;
    let strips = &model.boundary.strips;
    if strips.is_empty() {
        return None;
    }
    let free = &start.constraints.free;
    let mut constraints = StripConstraints::at(strips, start.input.state, &model.grid, free, start.input.interval);
    constraints.wet(start.pore_pressure);
    Some(Box::new(constraints))
}

impl<const D: usize> Interaction<D> for StripConstraints<D> {
    fn mark_untied(&self, context: &StepContext<'_, D>, interval: TimeInterval, marks: &mut [bool]) {
        for node in nodes_at(&context.boundary.strips, context.grid, interval.start) {
            marks[node] = true;
        }
    }

    fn has_penalty(&self) -> bool {
        true
    }

    fn add_force(&self, _context: &StepContext<'_, D>, u: &[f64], out: &mut Contributions) {
        self.add_forces(u, out);
    }

    fn add_product(&self, _context: &StepContext<'_, D>, v: &[f64], out: &mut Contributions) {
        self.multiply(v, out);
    }

    fn assemble(&self, _context: &StepContext<'_, D>, matrix: &mut dyn MatrixAssembly) {
        self.add_stiffness(matrix);
    }

    fn penalty_energy(&self, du: &[f64], _halo: &dyn Halo) -> Exact {
        self.energy(du)
    }

    fn has_friction(&self) -> bool {
        self.has_friction
    }

    fn most_corrections(&self) -> Option<usize> {
        self.has_contact.then_some(MOST_CORRECTIONS)
    }

    fn predict(&mut self, guess: &[f64]) {
        self.predict_status(guess);
    }

    fn correct(
        &mut self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        correction: Correction,
    ) -> Result<usize, StepError> {
        if !self.has_contact {
            return Ok(0);
        }
        Ok(self.correct_statuses(at.u, correction.force, context.halo))
    }

    fn add_work(&self, _context: &StepContext<'_, D>, at: &EquilibriumState<'_>, work: &mut InteractionWork) {
        let strips = self.work(at.u);
        work.external += &strips.given;
        work.external -= &strips.friction_work;
        work.integration -= &strips.grown;
        work.penalty += &strips.given;
        work.penalty -= &strips.taken;
        work.penalty -= &strips.friction_work;
    }

    fn finish_start(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) {
        let strips = &context.boundary.strips;
        (reports.strips, after.traction) = self.finish_step(strips, context.grid, &after.traction, at.u, context.halo);
    }

    fn finish(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        self.finish_start(context, at, after, reports);
        Ok(())
    }
}
