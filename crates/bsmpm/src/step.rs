//! One load or time step from t to t + dt (chapter 1 of the theory manual). The numbers (1) to
//! (11) are those of the algorithm in Xie, Navas and López-Querol (2023), section 2.4.

pub mod adjoint;
pub mod apart;
pub mod blocks;
pub mod commit;
pub mod coupling;
pub mod extension;
pub mod nodes;
pub mod outflow;
pub mod problem;
pub mod reduced_matrix;
pub mod report;
pub mod residual;
pub mod smooth;
pub mod stiffness;
pub mod trial;
pub mod walls;

use crate::schedule::TimeInterval;
pub use report::{Counts, StepReport};

use crate::boundary::{Anchors, Surface};
use crate::dynamics::newmark::Newmark;
use crate::energy::StepEnergy;
use crate::error::StepError;
use crate::field::pore_water::backward::is_smooth;
use crate::field::pore_water::crossed::PreviousFlow;
use crate::grid::Shape;
use crate::initial;
use crate::interactions::background::ResistedDisplacement;
use crate::interactions::free_field::FreeField;
use crate::interactions::strip::StripConstraints;
use crate::interactions::{load, rigid};
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::{Backend, Halo, agreed};
use crate::points::{MappedPoints, Points};
use crate::solve::{self, found::StepSolution};
use commit::ConstitutiveUpdate;
use nodes::GridState;
use outflow::Outflow;
use problem::Problem;

/// Advances the material points by one step.
///
/// `guess` is the nodal displacement from which the iteration starts (m, D numbers per node of the window); the
/// converged displacement replaces it. `resisted` selects the part of the displacement that the background resists. If
/// the step fails, nothing but `counts` (the work done) has changed.
pub fn step<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    guess: &mut Vec<f64>,
    interval: TimeInterval,
    resisted: ResistedDisplacement,
    backend: &mut Backend<'_>,
    counts: &mut Counts,
) -> Result<StepReport, StepError> {
    let halo = backend.halo;
    let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?; // (1)
    let (mut nodes, free_field) = start(model, &shape, points, guess, interval, resisted, halo)?; // (2)
    let movable = nodes.movable();
    let mut attachments =
        StripConstraints::at(&model.boundary.strips, &points.surface, &model.grid, &movable, interval);
    attachments.wet(nodes.pore_pressure.as_ref());
    let mapped = MappedPoints { shape: &shape, points };
    let found = solve::contact::find(model, mapped, &mut nodes, &mut attachments, guess, backend, counts)?; // (3)-(9)
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        attachments: &attachments,
        points,
        halo,
    };
    let Outcome {
        mut report,
        mut surface,
        update,
        draft,
    } = Outcome::of(&problem, &found, interval)?;
    let carried = nodes.rigid.carried(&found.u, points.len(), halo);
    let held = nodes.rigid.held(&found.u, halo);
    let committed = commit::update_points(model, &shape, &nodes, found, update, points, halo); // (10), (11)
    *guess = committed.u;
    let reaching = model.reaching(points);
    let extent = nodes.rigid.extents_after(&held, &surface.bodies, &reaching);
    points.extent = extent.or(points.extent.take());
    points.tangential_force = carried.or(points.tangential_force.take());
    if let Some(draft) = draft {
        let (flows, turnover) = draft.close(model, points, &surface, halo);
        report.energy = flows;
        report.turnover = Some(turnover);
    }
    let end = interval.end();
    complete_report(model, points, &mut surface, &mut report, committed.content, end, halo);
    free_field.settle(&mut surface.held);
    points.surface = surface;
    points.free_field = free_field.columns;
    Ok(StepReport {
        advance: committed.advance,
        smoothed: committed.smoothed,
        beside_fixed: committed.beside_fixed,
        outflow: Outflow::of(model, points, end, halo),
        ..report
    })
}

/// Step (2): transfers the points to the nodes and drives the lateral nodes by the free-field columns.
fn start<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    guess: &[f64],
    interval: TimeInterval,
    resisted: ResistedDisplacement,
    halo: &dyn Halo,
) -> Result<(GridState<D>, FreeField<D>), StepError> {
    let mut nodes = GridState::from_points_after(model, shape, points, guess, interval, halo)?;
    if resisted == ResistedDisplacement::Change {
        nodes.resist_change_from(guess, &model.grid, halo);
    }
    let free_field = FreeField::after(model, points, interval, halo)?;
    free_field.drive(&mut nodes);
    if let Some(inertia) = nodes.inertia.as_mut().filter(|_| interval.start == 0.0)
        && initial::is_pushed(model, points, halo)?
    {
        inertia.newmark = Newmark::for_sudden_load();
    }
    Ok((nodes, free_field))
}

/// Result of a converged step before the material points are updated.
struct Outcome<const D: usize> {
    report: StepReport,
    surface: Surface<D>, // of the body at the end of the step
    update: ConstitutiveUpdate,
    draft: Option<StepEnergy>, // energy terms; `None` if neither dynamics nor an energy balance needs them
}

impl<const D: usize> Outcome<D> {
    /// Evaluates a converged displacement. Fails if points leave the grid, rigid bodies overlap, a constitutive law
    /// rejects a point, or the step is interrupted.
    fn of<K: Kinematics<D>>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        interval: TimeInterval,
    ) -> Result<Self, StepError> {
        let Problem { model, nodes, halo, .. } = *problem;
        let points = problem.points;
        commit::check_inside(model, problem.shape, points, &found.u, halo)?;
        let Model { boundary, grid, .. } = model;
        let start = &points.surface;
        let (strips, traction) = problem
            .attachments
            .finish_step(&boundary.strips, grid, start, &found.u, halo);
        let (rigid, bodies) = nodes.rigid.finish_step(&found.u, halo);
        if let Some(bodies) = rigid::overlapping(&boundary.rigid, &bodies) {
            return Err(StepError::Overlapping { bodies });
        }
        let mut report = StepReport {
            dt: interval.dt,
            strips,
            rigid,
            ..StepReport::of(problem, found)
        };
        if !boundary.moves(interval.start, interval.dt) {
            report.background_share = report::background_share(problem, found);
        }
        let surface = Surface {
            traction,
            anchors: Anchors::of(&model.surfaces(), &start.anchors, points.anchored(), halo),
            position: load::moved(&boundary.loads, start, grid, &nodes.active, &found.u, halo),
            pressure: nodes.followers.tractions::<K>(
                &boundary.loads,
                grid,
                points,
                &found.u,
                &|p| found.trial.dF(p),
                halo,
            ),
            bodies,
            ..start.clone()
        };
        let update = commit::constitutive_update(model, &found.trial, points, halo)?;
        report.second_order_works = commit::second_order_works(model, points, &update.answers, halo);
        if let Some([_, internal]) = &mut report.background {
            *internal = internal.max(commit::stress_work(&found.trial, points, &update.answers, halo));
        }
        let accounts = model.balances_energy || model.regime == Regime::Dynamic;
        let draft = accounts.then(|| StepEnergy::of(problem, found, &update.answers, interval));
        if halo.rejects() {
            return Err(StepError::Interrupted);
        }
        Ok(Self {
            draft,
            report,
            surface,
            update,
        })
    }
}

/// Completes the surface and the report with the updated points at the end `t` of the step (s). The points have taken
/// in `content` of water (m3).
fn complete_report<K, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    surface: &mut Surface<D>,
    report: &mut StepReport,
    content: f64,
    t: f64,
    halo: &dyn Halo,
) {
    let strips = &model.boundary.strips;
    let places = surface
        .anchors
        .places(&model.boundary, &model.grid, points.anchored(), halo);
    for (number, strip) in report.strips.iter_mut().enumerate() {
        strip.left_behind = places.left_behind(number, strips, t, &model.grid);
    }
    surface.position = places.loads;
    if let Some(water) = &mut report.water {
        water.stored = content;
        surface.crossed.add(1.0, &water.crossed);
        surface.flowed = is_smooth(model).then(|| PreviousFlow {
            dt: report.dt,
            crossed: water.crossed.clone(),
            left: water.left,
        });
    }
}
