//! Rigid bodies as an [`Interaction`] of a step.

use super::{ParticleDomains, RigidContacts, Surroundings, overlapping};
use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::interactions::state::InteractionState;
use crate::interactions::{
    Correction, EquilibriumState, Interaction, InteractionReports, InteractionWork, MOST_CORRECTIONS_OF_BODIES,
    MotionCoupling, StepContext, StepInput, StepStart,
};
use crate::kinematics::Kinematics;
use crate::linear::MatrixAssembly;
use crate::model::Regime;
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;

/// Rigid bodies in a step, and what the update of the material points needs.
#[derive(Debug)]
struct RigidBodies<const D: usize> {
    contacts: RigidContacts<D>,
    reach: Vec<f64>,               // see `ParticleDomains`
    weight: fn(&Vector<D>) -> f64, // see `ParticleDomains`
}

/// Begins the rigid bodies of a step, if there are any and the step has a length: finds the material points near them.
pub fn begin<K: Kinematics<D>, const D: usize>(
    start: &StepStart<'_, K, D>,
) -> Result<Option<Box<dyn Interaction<D>>>, StepError> {
    let StepStart { model, points, .. } = *start;
    let StepInput {
        interval, last, state, ..
    } = start.input;
    if model.boundary.rigid.is_empty() {
        return Ok(None);
    }
    let around = Surroundings {
        bodies: (&model.boundary.rigid, &state.bodies),
        reaching: model.reaching(points),
        shape: start.shape,
        body_force: model.body_force(interval.end()).unwrap_or_else(Vector::zeros),
        free: &start.constraints.free,
        newmark: (model.regime == Regime::Dynamic).then_some(model.newmark),
        pore_pressure: start.pore_pressure,
    };
    let contacts = RigidContacts::of(&around, |p| model.young(points, p), interval, last, start.halo)?;
    if contacts.is_empty() {
        return Ok(None);
    }
    Ok(Some(Box::new(RigidBodies {
        contacts,
        reach: model.boundary.reach.clone(),
        weight: K::weight,
    })))
}

impl<const D: usize> Interaction<D> for RigidBodies<D> {
    fn mark_untied(&self, context: &StepContext<'_, D>, _interval: TimeInterval, marks: &mut [bool]) {
        let touched = self.contacts.touched_nodes(context.grid.nodes(), context.halo);
        marks
            .iter_mut()
            .zip(touched)
            .for_each(|(mark, touched)| *mark |= touched);
    }

    fn mark_moving(&self, _velocities: &[f64], _dt: f64, moving: &mut Vec<bool>) {
        let by_bodies = &self.contacts.moving;
        if !by_bodies.is_empty() {
            moving.resize(by_bodies.len(), false);
            moving
                .iter_mut()
                .zip(by_bodies)
                .for_each(|(moving, by_body)| *moving |= by_body);
        }
    }

    fn mark_stopped(&self, stopped: &mut [bool]) {
        let by_bodies = self.contacts.moving.iter();
        stopped
            .iter_mut()
            .zip(by_bodies)
            .for_each(|(stopped, by_body)| *stopped |= by_body);
    }

    fn has_penalty(&self) -> bool {
        true
    }

    fn add_force(&self, context: &StepContext<'_, D>, u: &[f64], out: &mut Contributions) {
        self.contacts.add_forces(u, out, context.halo);
    }

    fn add_product(&self, context: &StepContext<'_, D>, v: &[f64], out: &mut Contributions) {
        self.contacts.multiply(v, out, context.halo);
    }

    fn assemble(&self, _context: &StepContext<'_, D>, matrix: &mut dyn MatrixAssembly) {
        self.contacts.add_stiffness(matrix);
    }

    fn coupling(&self, context: &StepContext<'_, D>) -> Option<MotionCoupling> {
        if !self.contacts.is_coupled() {
            return None;
        }
        let (columns, blocks) = self.contacts.motion_coupling(context.grid, context.halo);
        let motions: Vec<(usize, usize)> = self.contacts.free_motions().collect();
        let mut stiffness = Vec::with_capacity(motions.len() * motions.len());
        for &(body, k) in &motions {
            for &(other, l) in &motions {
                stiffness.push(if body == other { blocks[body][(k, l)] } else { 0.0 });
            }
        }
        Some(MotionCoupling { columns, stiffness })
    }

    fn penalty_energy(&self, du: &[f64], halo: &dyn Halo) -> Exact {
        self.contacts.energy(du, halo)
    }

    fn has_friction(&self) -> bool {
        self.contacts.is_rough()
    }

    fn most_corrections(&self) -> Option<usize> {
        Some(MOST_CORRECTIONS_OF_BODIES)
    }

    fn correct(
        &mut self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        correction: Correction,
    ) -> Result<usize, StepError> {
        let Correction { force, pass } = correction;
        self.contacts.correct_statuses(at.u, force, pass, context.halo)
    }

    fn add_work(&self, context: &StepContext<'_, D>, at: &EquilibriumState<'_>, work: &mut InteractionWork) {
        let [given, grown, friction] = self.contacts.work(at.u, context.halo);
        work.external += &given;
        work.integration -= &grown;
        work.friction += &friction;
    }

    fn finish(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        (reports.rigid, after.bodies) = self.contacts.finish_step(at.u, context.halo);
        match overlapping(&context.boundary.rigid, &after.bodies) {
            Some(bodies) => Err(StepError::Overlapping { bodies }),
            None => Ok(()),
        }
    }

    fn update(
        &mut self,
        grid: &Grid<D>,
        u: &[f64],
        points: &mut Points<D>,
        after: &mut InteractionState<D>,
        halo: &dyn Halo,
    ) {
        let carried = self.contacts.carried(u, points.len(), halo);
        let held = self.contacts.held(u, halo);
        let reaching = ParticleDomains {
            grid,
            points,
            reach: &self.reach,
            weight: self.weight,
        };
        let extent = self.contacts.extents_after(&held, &after.bodies, &reaching);
        points.extent = extent.or(points.extent.take());
        points.tangential_force = carried.or(points.tangential_force.take());
    }
}
