//! One load or time step from t to t + dt (chapter 1 of the theory manual). The numbers (1) to
//! (11) are those of the algorithm in Xie, Navas and López-Querol (2023), section 2.4.

pub mod adjoint;
pub mod apart;
pub mod blocks;
pub mod commit;
pub mod coupling;
pub mod damping;
pub mod extension;
pub mod inertia;
pub mod mass;
pub mod newmark;
pub mod nodes;
pub mod outflow;
pub mod problem;
pub mod reduced_system;
pub mod report;
pub mod residual;
pub mod smooth;
pub mod stiffness;
pub mod trial;
pub mod walls;

pub use report::{Counts, StepReport};

use crate::background::Resisted;
use crate::boundary::strip::StripAttachments;
use crate::boundary::{Anchors, Surface, load, rigid};
use crate::energy::Draft;
use crate::error::StepError;
use crate::free_field::FreeField;
use crate::grid::Shape;
use crate::initial;
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::{Halo, LinearSolver, agreed};
use crate::points::Points;
use crate::solve;
use crate::water::backward::is_smooth;
use crate::water::crossed::Flowed;
use commit::Committed;
use newmark::Newmark;
use nodes::Nodes;
use outflow::Outflow;
use problem::Problem;

/// Steps the points from `t` to `t + dt`, starting from the nodal displacement `guess` (D numbers per node of the
/// window; replaced by the converged one), of which the background resists what is `resisted`. On an error nothing has
/// changed but `counts`, the work that was done.
pub fn step<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    guess: &mut Vec<f64>,
    (t, dt): (f64, f64),
    resisted: Resisted,
    (halo, solver): (&dyn Halo, &mut dyn LinearSolver),
    counts: &mut Counts,
) -> Result<StepReport, StepError> {
    let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?; // (1)
    let mut nodes = Nodes::after(model, (&shape, points), guess, (t, dt), halo)?; // (2)
    if resisted == Resisted::Change {
        nodes.resist_change_from(guess, &model.grid, halo);
    }
    let free_field = FreeField::after(model, points, (t, dt), halo)?;
    free_field.drive(&mut nodes);
    if let Some(inertia) = nodes.inertia.as_mut().filter(|_| t == 0.0)
        && initial::is_pushed(model, points, halo)?
    {
        inertia.newmark = Newmark::of_the_end();
    }
    let movable = nodes.movable();
    let mut attachments = StripAttachments::at(
        &model.boundary.strips,
        &points.surface,
        (&model.grid, &movable),
        (t, dt),
    );
    attachments.wet(nodes.pore_pressure.as_ref());
    let found = solve::contact::find(
        model,
        &shape,
        &mut nodes,
        (&mut attachments, points),
        guess,
        (halo, solver),
        counts,
    )?; // (3)-(9)
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        attachments: &attachments,
        points,
        halo,
    };
    commit::check_inside(model, &shape, points, &found.u, halo)?;
    let (strips, traction) =
        attachments.conclude((&model.boundary.strips, &model.grid), &points.surface, &found.u, halo);
    let (rigid, bodies) = nodes.rigid.conclude(&found.u, halo);
    if let Some(bodies) = rigid::overlapping(&model.boundary.rigid, &bodies) {
        return Err(StepError::Overlapping { bodies });
    }
    let carried = nodes.rigid.carried(&found.u, points.len(), halo);
    let held = nodes.rigid.held(&found.u, halo);
    let mut report = StepReport {
        dt,
        strips,
        rigid,
        ..StepReport::of(&problem, &found)
    };
    if !model.boundary.moves(t, dt) {
        report.background_share = report::background_share(&problem, &found);
    }
    let anchors = Anchors::of(&model.surfaces(), &points.surface.anchors, points.anchored(), halo);
    let position = load::moved(
        &model.boundary.loads,
        &points.surface,
        (&model.grid, &nodes.active),
        &found.u,
        halo,
    );
    let pressure = nodes.followers.tractions::<K>(
        (&model.boundary.loads, &model.grid),
        points,
        (&found.u, &|p| found.trial.dF(p)),
        halo,
    );
    let mut surface = Surface {
        traction,
        position,
        pressure,
        anchors,
        bodies,
        ..points.surface.clone()
    };
    let (answers, state) = commit::answers(model, &found.trial, points, halo)?;
    report.second_order_works = commit::second_order_works(model, points, &answers, halo);
    if let Some([_, internal]) = &mut report.background {
        *internal = internal.max(commit::stress_work(&found.trial, points, &answers, halo));
    }
    let accounts = model.balances_energy || model.regime == Regime::Dynamic;
    let draft = accounts.then(|| Draft::of(&problem, (&found, &answers), (t, dt)));
    if halo.rejects() {
        return Err(StepError::Interrupted);
    }
    // (10), (11)
    let Committed {
        u,
        advance,
        smoothed,
        content,
        beside_fixed,
    } = commit::commit(model, (&shape, &nodes), (found, (answers, state)), points, halo);
    *guess = u;
    if let Some(extent) = nodes
        .rigid
        .extents_after(&held, &surface.bodies, &model.reaching(points))
    {
        points.extent = Some(extent);
    }
    if carried.is_some() {
        points.tangential_force = carried;
    }
    let account = draft.map(|draft| draft.close(model, points, &surface, halo));
    let places = surface
        .anchors
        .places((&model.boundary, &model.grid), points.anchored(), halo);
    let strips = &model.boundary.strips;
    for number in 0..strips.len() {
        report.strips[number].left_behind = places.left_behind(number, strips, t + dt, &model.grid);
    }
    surface.position = places.loads;
    free_field.settle(&mut surface.held);
    if let Some(water) = &mut report.water {
        water.stored = content;
        surface.crossed.add(1.0, &water.crossed);
        let flowed = || Flowed {
            dt,
            crossed: water.crossed.clone(),
            left: water.left,
        };
        surface.flowed = is_smooth(model).then(flowed);
    }
    points.surface = surface;
    points.free_field = free_field.columns;
    let outflow = Outflow::of(model, (points, t + dt), halo);
    let (energy, turnover) = account.map_or((None, None), |(flows, turnover)| (flows, Some(turnover)));
    Ok(StepReport {
        energy,
        turnover,
        advance,
        smoothed,
        beside_fixed,
        outflow,
        ..report
    })
}
