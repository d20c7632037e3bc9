//! Active-set method for contact, theory-manual equations (T7.1), (T7.2): finds equilibrium with fixed contact
//! statuses, then corrects wrong statuses.

use crate::error::StepError;
use crate::interactions::strip::StripConstraints;
use crate::kinematics::Kinematics;
use crate::method::Criteria;
use crate::model::Model;
use crate::parallel::{Backend, Halo};
use crate::points::MappedPoints;
use crate::solve::bordered::BorderedSolver;
use crate::solve::found::StepSolution;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::report::Counts;

/// Corrections of statuses after which a step is given up.
const MOST: usize = 40;
/// Corrections with rigid bodies, whose statuses are finally corrected one by one.
const MOST_AT_BODIES: usize = 60;
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
    attachments: &mut StripConstraints<D>,
    guess: &[f64],
    backend: &mut Backend<'_>,
    counts: &mut Counts,
) -> Result<StepSolution<K, D>, StepError> {
    let halo = backend.halo;
    let faces = model.boundary.has_contact();
    let strips = model.boundary.has_strip_contact();
    if !faces && !strips && nodes.rigid.is_empty() {
        return find_at_statuses(model, mapped, nodes, attachments, guess, backend, counts);
    }
    attachments.predict_status(guess);
    let rough = rough(model);
    let mut u = guess.to_vec();
    let mut history = Vec::new();
    let mut is_rough = true;
    let mut first_guess = true;
    let most = if nodes.rigid.is_empty() { MOST } else { MOST_AT_BODIES };
    for pass in 0..most {
        let judged = if is_rough { &rough } else { model };
        let found = match find_at_statuses(judged, mapped, nodes, attachments, &u, backend, counts) {
            Ok(found) => found,
            // If all nodes of the contact faces slide, a body that only these faces support can move freely.
            Err(error) if !faces || error.is_final() || nodes.contacts.hold_neutral(&model.grid, &u, halo) == 0 => {
                return Err(error);
            }
            Err(_) => {
                nodes.apply_contact_statuses();
                nodes.count(halo);
                continue;
            }
        };
        history.extend(found.history.iter().copied());
        first_guess &= found.first_guess;
        let corrected = correct(judged, nodes, attachments, &found, pass, halo)?;
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

/// Finds equilibrium from the displacement `u` (m) with the present statuses of nodes and attachments.
fn find_at_statuses<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    mapped: MappedPoints<'_, D>,
    nodes: &GridState<D>,
    attachments: &StripConstraints<D>,
    u: &[f64],
    backend: &mut Backend<'_>,
    counts: &mut Counts,
) -> Result<StepSolution<K, D>, StepError> {
    let problem = Problem {
        model,
        shape: mapped.shape,
        nodes,
        attachments,
        points: mapped.points,
        halo: backend.halo,
    };
    let solver = &mut *backend.solver;
    match nodes.rigid.is_coupled() {
        true => super::find(&problem, u, &mut BorderedSolver::of(&problem, solver), counts),
        false => super::find(&problem, u, solver, counts),
    }
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
    nodes: &mut GridState<D>,
    attachments: &mut StripConstraints<D>,
    found: &StepSolution<K, D>,
    pass: usize,
    halo: &dyn Halo,
) -> Result<usize, StepError> {
    let doubt = DOUBT * model.criteria.force * found.scale;
    let mut corrected = 0;
    if model.boundary.has_strip_contact() {
        corrected += attachments.correct(&found.u, doubt, halo);
    }
    corrected += nodes.rigid.correct(&found.u, doubt, pass, halo)?;
    nodes.contacts.first_energy = found.first_energy;
    if model.boundary.has_contact() {
        let edge = model.grid.smallest_edge();
        corrected += nodes.contacts.correct(&found.u, &found.reaction, doubt, edge, halo);
        nodes.apply_contact_statuses();
        nodes.count(halo);
    }
    Ok(corrected)
}
