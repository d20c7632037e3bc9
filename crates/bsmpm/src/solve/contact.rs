//! Active-set method for contact, theory-manual equations (T7.1), (T7.2): finds equilibrium with fixed contact
//! statuses, then corrects wrong statuses.

use crate::error::StepError;
use crate::interactions::{Correction, MotionCoupling};
use crate::kinematics::Kinematics;
use crate::method::Criteria;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::MappedPoints;
use crate::solve::Backend;
use crate::solve::bordered::BorderedSolver;
use crate::solve::found::StepSolution;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;

/// Force by which a status may be contradicted, as a fraction of the force tolerance times the largest force: forces
/// are not known more accurately.
const DOUBT: f64 = 1e-2;
/// Convergence criteria while statuses still change, when more accuracy is not needed.
const ROUGH: f64 = 1e-2;

/// Finds equilibrium from the previous displacement `guess` (m), and leaves the final contact statuses in `nodes`.
pub fn find<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    nodes: &mut GridState<D>,
    guess: &[f64],
    backend: &mut Backend<'_>,
) -> Result<StepSolution<K, D>, StepError> {
    let halo = backend.halo;
    let Some(most) = nodes.interactions.most_corrections() else {
        return find_at_statuses(model, mapped, nodes, guess, None, backend);
    };
    for interaction in nodes.interactions.iter_mut() {
        interaction.predict(guess);
    }
    let rough = rough(model);
    let mut u = guess.to_vec();
    let mut first_energy = None;
    let mut history = Vec::new();
    let mut is_rough = true;
    let mut first_guess = true;
    for pass in 0..most {
        let judged = if is_rough { &rough } else { model };
        let found = match find_at_statuses(judged, mapped, nodes, &u, first_energy, backend) {
            Ok(found) => found,
            // If all nodes of the contact faces slide, a body that only these faces support can move freely.
            Err(error) if !error.another_method_may_help() || hold_neutral(model, mapped, nodes, &u, halo) == 0 => {
                return Err(error);
            }
            Err(_) => continue,
        };
        history.extend(found.history.iter().copied());
        first_guess &= found.first_guess;
        first_energy = found.first_energy;
        let corrected = correct(judged, mapped, nodes, &found, pass, halo)?;
        if corrected == 0 && !is_rough {
            return Ok(StepSolution {
                history,
                first_guess,
                ..found
            });
        }
        is_rough &= corrected > 0;
        u = found.u;
    }
    Err(StepError::Unsettled { passes: most })
}

/// Finds equilibrium from the displacement `u` (m) with the present statuses. `first_energy`: see
/// [`find`](super::find).
fn find_at_statuses<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    nodes: &GridState<D>,
    u: &[f64],
    first_energy: Option<f64>,
    backend: &mut Backend<'_>,
) -> Result<StepSolution<K, D>, StepError> {
    let problem = Problem {
        model,
        shape: mapped.shape,
        nodes,
        points: mapped.points,
        halo: backend.halo,
    };
    let solver = &mut *backend.solver;
    let counts = &mut *backend.counts;
    let context = problem.context();
    let couplings: Vec<MotionCoupling> = nodes
        .interactions
        .iter()
        .filter_map(|each| each.coupling(&context))
        .collect();
    match couplings.is_empty() {
        true => super::find(&problem, u, first_energy, solver, counts),
        false => super::find(
            &problem,
            u,
            first_energy,
            &mut BorderedSolver::of(&problem, couplings, solver),
            counts,
        ),
    }
}

/// Makes nodes stick that hinder a body from moving freely, after no equilibrium was found from `u` (m). Returns their
/// number over all ranks.
fn hold_neutral<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    nodes: &mut GridState<D>,
    u: &[f64],
    halo: &dyn Halo,
) -> usize {
    let mut interactions = std::mem::take(&mut nodes.interactions);
    let context = nodes.context(model, mapped.shape, mapped.points, halo);
    let held = interactions
        .iter_mut()
        .map(|interaction| interaction.hold_neutral(&context, u));
    let held = held.sum();
    nodes.interactions = interactions;
    if held > 0 {
        nodes.apply_statuses();
        nodes.count(halo);
    }
    held
}

/// Returns the model with loose criteria, for an equilibrium whose statuses will change.
fn rough<K: Kinematics<D>, const D: usize>(model: &Model<K, D>) -> Model<K, D> {
    let criteria = Criteria {
        energy: model.criteria.energy.max(ROUGH),
        force: model.criteria.force.max(ROUGH),
        ..model.criteria
    };
    Model {
        criteria,
        ..model.clone()
    }
}

/// Corrects the statuses that an equilibrium contradicts, and returns their number. `model` has the criteria by which
/// the equilibrium was accepted.
fn correct<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    nodes: &mut GridState<D>,
    found: &StepSolution<K, D>,
    pass: usize,
    halo: &dyn Halo,
) -> Result<usize, StepError> {
    let force = DOUBT * model.criteria.force * found.scale;
    let mut interactions = std::mem::take(&mut nodes.interactions);
    let context = nodes.context(model, mapped.shape, mapped.points, halo);
    let dF = |p: usize| found.trial.dF(p);
    let at = found.state(&dF);
    let corrected = interactions
        .iter_mut()
        .map(|interaction| interaction.correct(&context, &at, Correction { force, pass }))
        .sum::<Result<usize, _>>();
    nodes.interactions = interactions;
    if corrected.as_ref().is_ok_and(|corrected| *corrected > 0) {
        nodes.apply_statuses();
        nodes.count(halo);
    }
    corrected
}
