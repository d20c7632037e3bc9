//! One load or time step from t to t + dt (chapter 1 of the theory manual). The numbers (1) to
//! (11) are those of the algorithm in Xie, Navas and López-Querol (2023), section 2.4.

pub mod acceptance;
pub mod adjoint;
pub mod apart;
mod averages;
pub mod blocks;
pub mod commit;
pub mod constraints;
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

pub use report::{Counts, StepReport};

use crate::dynamics::newmark::Newmark;
use crate::error::StepError;
use crate::grid::Shape;
use crate::initial;
use crate::interactions::StepInput;
use crate::interactions::artificial_stiffness::ResistedDisplacement;
use crate::interactions::free_field::FreeField;
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::{Halo, agreed};
use crate::points::{MappedPoints, Points};
use crate::schedule::TimeInterval;
use crate::solve::{self, Backend};
use acceptance::Acceptance;
use nodes::GridState;
use problem::Problem;

/// Advances the material points and the state of the interactions by one step.
///
/// `guess` is the nodal displacement from which the iteration starts (m, D numbers per node of the window); the
/// converged displacement replaces it. `resisted` selects the part of the displacement that the artificial stiffness
/// resists. If the step fails, nothing has changed but the counts of the work done.
pub fn step<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    state: &mut InteractionState<D>,
    guess: &mut Vec<f64>,
    interval: TimeInterval,
    resisted: ResistedDisplacement,
    backend: &mut Backend<'_>,
) -> Result<StepReport, StepError> {
    let halo = backend.halo;
    // (1) Shape functions at the material points.
    let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?;
    // (2) From material points to nodes; interactions begin the step.
    let free_field = FreeField::after(model, points, state, interval, halo)?;
    let input = StepInput {
        state,
        interval,
        last: guess,
        resisted,
        columns: &free_field.actions,
    };
    let mut nodes = GridState::from_points_after(model, &shape, points, input, halo)?;
    damp_sudden_load(model, points, input, &mut nodes, halo)?;
    // (3) to (9) Equilibrium: trial deformation (4), out-of-balance force (5), stiffness (6), solution (7), update of
    // the displacement (8), convergence and statuses of contact (9).
    let mapped = MappedPoints { shape: &shape, points };
    let found = solve::contact::find(model, mapped, &mut nodes, guess, backend)?;
    // (10), (11) Nothing has changed so far. Evaluate the converged state; then update the material points.
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo,
    };
    let acceptance = Acceptance::of(&problem, &found, state, interval)?;
    let accepted = acceptance.accept(model, &shape, nodes, found, points, halo);
    *state = accepted.state;
    state.columns = free_field.columns;
    *guess = accepted.u;
    Ok(accepted.report)
}

/// Selects a dissipative time integration for the first step, if the forces at time 0 are out of balance.
fn damp_sudden_load<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    input: StepInput<'_, D>,
    nodes: &mut GridState<D>,
    halo: &dyn Halo,
) -> Result<(), StepError> {
    if let Some(inertia) = nodes.inertia.as_mut().filter(|_| input.interval.start == 0.0)
        && initial::is_pushed(model, points, input.state, halo)?
    {
        inertia.newmark = Newmark::for_sudden_load();
    }
    Ok(())
}
