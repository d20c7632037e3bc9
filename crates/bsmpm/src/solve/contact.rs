//! Active-set method for contact, theory-manual equations (T7.1), (T7.2): finds equilibrium with fixed contact
//! statuses, then corrects wrong statuses.

use crate::boundary::strip::StripAttachments;
use crate::error::StepError;
use crate::grid::Shape;
use crate::kinematics::Kinematics;
use crate::method::Criteria;
use crate::model::Model;
use crate::parallel::{Halo, LinearSolver};
use crate::points::Points;
use crate::solve::bordered::Bordered;
use crate::solve::found::Found;
use crate::step::nodes::Nodes;
use crate::step::problem::Problem;
use crate::step::report::Counts;

/// Corrections after which a step is given up.
const MOST: usize = 40;
/// The same with rigid bodies, whose statuses are corrected one by one in the end.
const MOST_AT_BODIES: usize = 60;
/// Part of the force tolerance, of the largest force, by which forces may contradict a status: they are known no
/// better.
const DOUBT: f64 = 1e-2;
/// Criteria of both measures while statuses change: where they will, more would be for nothing.
const ROUGH: f64 = 1e-2;

/// Finds equilibrium from the last displacement `guess`, and leaves the statuses that it has in the `nodes`.
pub fn find<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    nodes: &mut Nodes<D>,
    (attachments, points): (&mut StripAttachments<D>, &Points<D>),
    guess: &[f64],
    (halo, solver): (&dyn Halo, &mut dyn LinearSolver),
    counts: &mut Counts,
) -> Result<Found<K, D>, StepError> {
    let (faces, strips) = (model.boundary.has_contact(), model.boundary.has_strip_contact());
    if !faces && !strips && nodes.rigid.is_empty() {
        return super::find(
            &Problem {
                model,
                shape,
                nodes,
                attachments,
                points,
                halo,
            },
            guess,
            solver,
            counts,
        );
    }
    attachments.recall(guess);
    let Criteria {
        energy,
        force,
        max_iterations,
    } = model.criteria;
    let criteria = Criteria {
        energy: energy.max(ROUGH),
        force: force.max(ROUGH),
        max_iterations,
    };
    let rough = Model {
        criteria,
        ..model.clone()
    };
    let (mut u, mut history, mut is_rough, mut first_guess) = (guess.to_vec(), Vec::new(), true, true);
    let most = if nodes.rigid.is_empty() { MOST } else { MOST_AT_BODIES };
    for pass in 0..most {
        let judged = if is_rough { &rough } else { model };
        let problem = Problem {
            model: judged,
            shape,
            nodes,
            attachments,
            points,
            halo,
        };
        let found = match nodes.rigid.is_coupled() {
            true => super::find(&problem, &u, &mut Bordered::of(&problem, solver), counts),
            false => super::find(&problem, &u, solver, counts),
        };
        let found = match found {
            Ok(found) => found,
            // With all nodes of its faces sliding, what they alone hold is free to move.
            Err(error) if !faces || error.is_final() || nodes.contacts.hold_neutral(&model.grid, &u, halo) == 0 => {
                return Err(error);
            }
            Err(_) => {
                nodes.meet();
                nodes.count(halo);
                continue;
            }
        };
        history.extend(found.history.iter().copied());
        first_guess &= found.first_guess;
        let doubt = (DOUBT * judged.criteria.force * found.scale, model.grid.smallest_edge());
        let mut corrected = if strips {
            attachments.correct(&found.u, doubt.0, halo)
        } else {
            0
        };
        corrected += nodes.rigid.correct(&found.u, (doubt.0, pass), halo)?;
        nodes.contacts.first_energy = found.first_energy;
        if faces {
            corrected += nodes.contacts.correct(&found.u, &found.reaction, doubt, halo);
            nodes.meet();
            nodes.count(halo);
        }
        if corrected == 0 && !is_rough {
            return Ok(Found {
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
