//! One load step, t -> t + dt: section 2.4 of the paper, numbered as there.

pub mod apart;
pub mod broyden;
pub mod commit;
mod coupling;
pub mod equilibrium;
pub mod inertia;
pub mod linearised;
pub mod mass;
pub mod multisecant;
pub mod newmark;
pub mod newton;
pub mod nodes;
pub mod progress;
pub mod quasi_newton;
pub mod residual;
pub mod round_off;
pub mod smooth;
pub mod stability;
pub mod stiffness;
pub mod trial;
pub mod unknowns;
pub mod variational;

use crate::boundary::strip::Grips;
use crate::boundary::{Anchors, StripReport, Surface, load};
use crate::energy::{Draft, Flows, Turnover};
use crate::error::{Measures, StepError};
use crate::grid::Shape;
use crate::initial;
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::points::Points;
use crate::seam::{Halo, LinearSolver, agreed};
use crate::step::commit::Committed;
use crate::step::newmark::Newmark;
use crate::step::nodes::Nodes;

/// Work of one or more attempts, failed ones included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// quasi-Newton and Newton iterations
    pub iterations: usize,
    /// evaluations of the residual
    pub evaluations: usize,
    /// iterations of the linear solver
    pub linear_iterations: usize,
    /// products with the complete derivative
    pub products: usize,
    /// factorisations
    pub factorisations: usize,
}

/// What an accepted step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// iterations from the guess that led to convergence
    pub iterations: usize,
    /// Newton iterations among them; 0 where the quasi-Newton method got there
    pub newton_iterations: usize,
    /// both measures of every iteration
    pub history: Vec<Measures>,
    /// force measure |f_oob| / largest force of the accepted state
    pub force: f64,
    /// nodes that carry material, over all ranks
    pub active_nodes: usize,
    /// unknowns of the linear system, over all ranks
    pub unknowns: usize,
    /// active nodes without mass, whose velocity and averages count as zero
    pub massless_nodes: usize,
    /// cells (ghost penalty: faces) with the soft background, over all ranks
    pub background_cells: usize,
    /// whether the forces alone decided: the methods led on no further, and forces balanced far below their tolerance
    pub settled: bool,
    /// whether the first guess of the displacement led to convergence
    pub first_guess: bool,
    /// N  force of every support on the body, by component, in the order of the model's supports
    pub reactions: Vec<Vec<f64>>,
    /// what every rigid strip did
    pub strips: Vec<StripReport>,
    /// J  work u . B u on the soft background, and f_int . u of all internal forces, the background's among them; if there
    /// is a background
    pub background: Option<[f64; 2]>,
    /// J  where the energy went, if the model balances it
    pub energy: Option<Flows>,
    /// J  what bounds the energy, in dynamics and where the model balances it
    pub turnover: Option<Turnover>,
    /// share of a pass of S by which the elastic state was smoothed, mean over the points
    pub smoothed: f64,
}

/// Steps the points from `t` to `t + dt`, starting from the nodal displacement `guess` (D numbers per node of the
/// window; replaced by the converged one). On an error nothing has changed but `counts`, which tells the work done.
pub fn step<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    guess: &mut Vec<f64>,
    (t, dt): (f64, f64),
    (halo, solver): (&dyn Halo, &mut dyn LinearSolver),
    counts: &mut Counts,
) -> Result<Report, StepError> {
    let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?; // (1)
    let mut nodes = Nodes::map(model, &shape, points, (t, dt), halo)?; // (2)
    if let Some(inertia) = nodes.inertia.as_mut().filter(|_| t == 0.0)
        && initial::is_pushed(model, points, halo)?
    {
        inertia.newmark = Newmark::of_the_end();
    }
    let grips = Grips::at(&model.boundary.strips, &points.surface, (&model.grid, &nodes.free), (t, dt));
    let scene = equilibrium::Scene { model, shape: &shape, nodes: &nodes, grips: &grips, points, halo };
    let found = equilibrium::find(&scene, guess, solver, counts)?; // (3)-(9)
    commit::check_inside(model, &shape, points, &found.u, halo)?;
    let (strips, traction) = grips.conclude(&model.boundary.strips, &found.u, halo);
    let mut report = Report { strips, ..found.report(&scene) };
    let anchors = Anchors::of(&model.boundary, points, halo);
    let position = load::moved(&model.boundary.loads, &points.surface, (&model.grid, &nodes.active), &found.u, halo);
    let mut surface = Surface { traction, position, anchors };
    let responses = commit::responses(model, &found.trial, points, halo)?;
    let accounts = model.balances_energy || model.regime == Regime::Dynamic;
    let draft = accounts.then(|| Draft::of(&scene, (&found, &responses), (t, dt)));
    if halo.rejects() {
        return Err(StepError::Interrupted);
    }
    let Committed { u, smoothed } = commit::commit(model, (&shape, &nodes), (found, &responses), points, halo); // (10), (11)
    *guess = u;
    let account = draft.map(|draft| draft.close(model, points, &surface, halo));
    let places = surface.anchors.places(&model.boundary, points, halo);
    for (number, strip) in model.boundary.strips.iter().enumerate() {
        report.strips[number].left_behind = places.left_behind(number, strip, t + dt, &model.grid);
    }
    surface.position = places.loads;
    points.surface = surface;
    let (energy, turnover) = account.map_or((None, None), |(flows, turnover)| (flows, Some(turnover)));
    Ok(Report { energy, turnover, smoothed, ..report })
}
