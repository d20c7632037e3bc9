//! Contact of faces as an [`Interaction`] of a step.

use super::Contacts;
use crate::error::StepError;
use crate::field::pore_water::carried;
use crate::interactions::state::InteractionState;
use crate::interactions::{
    Correction, EquilibriumState, Interaction, InteractionReports, InteractionWork, MOST_CORRECTIONS, NodalForces,
    StepContext, StepStart,
};
use crate::kinematics::Kinematics;
use crate::linear::MatrixAssembly;
use crate::points::MappedPoints;

/// Contact of faces in one step.
#[derive(Debug)]
struct ContactFaces<const D: usize> {
    contacts: Contacts<D>,
    start: f64, // s, start of the step
    has_friction: bool,
}

/// Begins the contact of faces in a step, if any face has contact.
pub fn begin<K: Kinematics<D>, const D: usize>(start: &StepStart<'_, K, D>) -> Option<Box<dyn Interaction<D>>> {
    let StepStart {
        model,
        shape,
        points,
        volume,
        halo,
        ..
    } = *start;
    if !model.boundary.has_contact() {
        return None;
    }
    let water = start
        .pore_pressure
        .map(|pores| carried::forces_on_faces(pores, model, shape, points, volume, halo));
    let mapped = MappedPoints { shape, points };
    let contacts = Contacts::of(model, mapped, &start.constraints.free, water.as_deref(), halo);
    let mut laws = model.boundary.supports.iter().filter_map(|face| face.contact);
    Some(Box::new(ContactFaces {
        contacts,
        start: start.input.interval.start,
        has_friction: laws.any(|law| law.friction > 0.0),
    }))
}

impl<const D: usize> Interaction<D> for ContactFaces<D> {
    fn note_unknowns(&mut self, context: &StepContext<'_, D>, last: &[f64]) {
        let free = &context.constraints.free;
        self.contacts
            .predict_statuses(context.boundary, context.grid, free, self.start, last);
    }

    fn apply_statuses(&self, free: &mut [bool], prescribed: &mut [Option<f64>]) {
        self.contacts.apply_statuses(free, prescribed);
    }

    fn hold_at_rest(&self, velocities: &mut [Option<f64>]) {
        self.contacts.set_at_rest(velocities);
    }

    fn mark_moving(&self, velocities: &[f64], dt: f64, moving: &mut Vec<bool>) {
        self.contacts.mark_stoppable(velocities, dt, moving);
    }

    fn add_reaction(&self, _context: &StepContext<'_, D>, u: &[f64], forces: NodalForces<'_>) {
        self.contacts.add_friction(u, forces.f_oob, forces.reaction);
    }

    fn add_nodal_product(&self, _context: &StepContext<'_, D>, reaction: &[f64], v: &[f64], out: &mut [f64]) {
        self.contacts.add_derivative(reaction, v, out);
    }

    fn assemble(&self, context: &StepContext<'_, D>, matrix: &mut dyn MatrixAssembly) {
        self.contacts.add_stiffness(matrix, context.halo);
    }

    fn has_friction(&self) -> bool {
        self.has_friction
    }

    fn most_corrections(&self) -> Option<usize> {
        Some(MOST_CORRECTIONS)
    }

    fn correct(
        &mut self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        correction: Correction,
    ) -> Result<usize, StepError> {
        let edge = context.grid.smallest_edge();
        let contacts = &mut self.contacts;
        Ok(contacts.correct_statuses(at.u, at.reaction, correction.force, edge, context.halo))
    }

    fn hold_neutral(&mut self, context: &StepContext<'_, D>, u: &[f64]) -> usize {
        self.contacts.make_neutral_stick(context.grid, u, context.halo)
    }

    fn add_work(&self, context: &StepContext<'_, D>, at: &EquilibriumState<'_>, work: &mut InteractionWork) {
        let [closing, friction] = self.contacts.work(at.u, at.reaction, context.halo);
        work.external -= &closing;
        work.integration -= &closing;
        work.friction += &friction;
    }

    fn finish(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        _after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        reports.contacts = self.contacts.report(context.boundary, at.u, at.reaction, context.halo);
        Ok(())
    }
}
