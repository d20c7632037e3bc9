//! End of a step, (10) and (11) in section 2.4 of Xie, Navas and López-Querol (2023): evaluates a converged
//! displacement, then updates the material points and the state of the interactions.

use super::commit::{self, ConstitutiveUpdate};
use super::nodes::GridState;
use super::outflow::Outflow;
use super::problem::Problem;
use super::report::StepReport;
use crate::boundary::{AnchoredPoints, Anchors};
use crate::energy::StepEnergy;
use crate::error::StepError;
use crate::grid::Shape;
use crate::interactions::InteractionReports;
use crate::interactions::load::LoadWork;
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::solve::found::StepSolution;

/// Result of an accepted step besides the material points.
pub struct AcceptedState<const D: usize> {
    /// Report of the step.
    pub report: StepReport,
    /// State of the interactions at the end of the step.
    pub state: InteractionState<D>,
    /// Converged nodal displacement (m), D numbers per node.
    pub u: Vec<f64>,
}

/// Result of a converged step before the material points are updated.
pub struct Acceptance<const D: usize> {
    report: StepReport,
    state: InteractionState<D>, // at the end of the step
    update: ConstitutiveUpdate,
    energy: Option<StepEnergy>, // `None` if neither dynamics nor an energy balance needs it
    load_work: LoadWork,
    interval: TimeInterval,
}

impl<const D: usize> Acceptance<D> {
    /// Evaluates a converged displacement of a step that began with the state `before`. Fails if points leave the grid,
    /// rigid bodies overlap, a constitutive law rejects a point, or the step is interrupted.
    pub fn of<K: Kinematics<D>>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        before: &InteractionState<D>,
        interval: TimeInterval,
    ) -> Result<Self, StepError> {
        let Problem {
            model, points, halo, ..
        } = *problem;
        let ground = AnchoredPoints {
            points,
            anchors: &before.anchors,
        };
        commit::check_inside(model, problem.shape, ground, &found.u, halo)?;
        let mut state = before.clone();
        let mut reports = InteractionReports::default();
        let context = problem.context();
        let dF = |p: usize| found.trial.dF(p);
        for interaction in problem.nodes.interactions.iter() {
            interaction.finish(&context, &found.state(&dF), &mut state, &mut reports)?;
        }
        state.anchors = Anchors::of(&model.surfaces(), &state.anchors, points.anchored(), halo);
        let load_work = reports.load_work;
        let mut report = StepReport {
            dt: interval.dt,
            ..StepReport::of(problem, found, reports, before)
        };
        let update = commit::constitutive_update(model, &found.trial, points, halo)?;
        report.second_order_works = commit::second_order_works(model, points, &update.answers, halo);
        if let Some(stiffness) = &mut report.artificial_stiffness {
            stiffness.internal_work =
                stiffness
                    .internal_work
                    .max(commit::stress_work(&found.trial, points, &update.answers, halo));
        }
        let accounts = model.balances_energy || model.regime == Regime::Dynamic;
        let energy = accounts.then(|| StepEnergy::of(problem, found, &update.answers, interval));
        if halo.rejects() {
            return Err(StepError::Interrupted);
        }
        Ok(Self {
            report,
            state,
            update,
            energy,
            load_work,
            interval,
        })
    }

    /// Updates the material points, and returns what else follows from the step.
    pub fn accept<K: Kinematics<D>>(
        self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        mut nodes: GridState<D>,
        found: StepSolution<K, D>,
        points: &mut Points<D>,
        halo: &dyn Halo,
    ) -> AcceptedState<D> {
        let Self {
            mut report,
            mut state,
            update,
            energy,
            load_work,
            interval,
        } = self;
        let committed = commit::update_points(model, shape, &nodes, found, update, points, halo);
        for interaction in nodes.interactions.iter_mut() {
            interaction.update(&model.grid, &committed.u, points, &mut state, halo);
        }
        if let Some(energy) = energy {
            let (flows, turnover) = energy.close(model, points, load_work, halo);
            report.energy = flows;
            report.turnover = Some(turnover);
        }
        complete_report(
            model,
            points,
            &mut state,
            &mut report,
            committed.content,
            interval.end(),
            halo,
        );
        let report = StepReport {
            advance: committed.advance,
            smoothed: committed.smoothed,
            beside_fixed: committed.beside_fixed,
            outflow: Outflow::of(model, points, interval.end(), halo),
            ..report
        };
        AcceptedState {
            report,
            state,
            u: committed.u,
        }
    }
}

/// Completes the state of the interactions and the report with the updated points at the end `t` of the step (s). The
/// points have taken in `content` of the second field.
fn complete_report<K, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    state: &mut InteractionState<D>,
    report: &mut StepReport,
    content: f64,
    t: f64,
    halo: &dyn Halo,
) {
    let strips = &model.boundary.strips;
    let places = state
        .anchors
        .places(&model.boundary, &model.grid, points.anchored(), halo);
    for (number, strip) in report.strips.iter_mut().enumerate() {
        strip.left_behind = places.left_behind(number, strips, t, &model.grid);
    }
    state.position = places.loads;
    let dt = report.dt;
    if let Some(water) = &mut report.water {
        water.complete(model, content, dt, state);
    }
}
