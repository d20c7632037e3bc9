//! Brings the initial stress to equilibrium with the constitutive laws: removes the out-of-balance force in parts,
//! theory-manual equation (T9.4).

use super::{UndeformedState, b_e_of, set_elastic};
use crate::error::StepError;
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::method::Criteria;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::solve::Backend;
use crate::solve::convergence::worst_nodes;
use crate::solve::found::StepSolution;
use crate::solve::round_off::RoundOff;
use crate::step::commit;
use crate::step::commit::ConstitutiveUpdate;
use crate::step::report::Counts;
use crate::step::residual::Residual;
use crate::tensor::Symmetric;

/// Energy criterion of a round, loose because the displacement is discarded.
const ANY: f64 = 1.0;
/// Force criterion of a round as a fraction of the tolerance, which leaves room for the error of the discarded
/// displacement.
const WITHIN: f64 = 0.5;
/// Rounds after which the search is given up.
const MOST_ROUNDS: usize = 60;
/// Smallest fraction of the out-of-balance force that a round removes.
const LEAST: f64 = 1.0 / 64.0;

/// Smallest vertical pressure, as a fraction of the largest, at the start of a law that needs a positive pressure.
const PRESSED: f64 = 1e-2;

/// Cost of a search for equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EquilibriumSearchReport {
    /// Equilibria that were found in sequence.
    pub rounds: usize,
    /// Evaluations of the forces.
    pub evaluations: usize,
}

/// Gives every point the vertical and shear stress of linear elastic equilibrium under the loads at time 0, and
/// `k0(material)` times the vertical stress as horizontal stress. In level ground the vertical stress is the weight
/// above, without quadrature errors. Below a step of the surface the stress is spread; a jump across a vertical line
/// would be in equilibrium, so `settle` would not remove it. Fails as [`set_elastic`].
pub fn set_spread<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    state: &mut InteractionState<D>,
    k0: impl Fn(u16) -> f64,
    halo: &dyn Halo,
    solver: &mut dyn LinearSolver,
) -> Result<(), StepError> {
    set_elastic(model, points, state, halo, solver)?;
    let mut most = [points.sigma.iter().map(|stress| -stress.0[D - 1]).fold(0.0, f64::max)];
    halo.all_reduce_max(&mut most);
    for p in 0..points.len() {
        let mut stress = points.sigma.at(p);
        // A law that needs a positive pressure cannot start where elastic soil is in tension, as at the crest of a
        // slope.
        if !model.materials[usize::from(points.material[p])].is_linear() && stress.0[D - 1] > -PRESSED * most[0] {
            stress = Symmetric::default();
            stress.0[D - 1] = -PRESSED * most[0];
        }
        let side = k0(points.material[p]) * stress.0[D - 1];
        (0..3).filter(|k| *k != D - 1).for_each(|k| stress.0[k] = side);
        let law = model.materials[usize::from(points.material[p])].at(points.height(p));
        let state = points.state.as_mut().map_or(&mut [][..], |state| state.of_point_mut(p));
        points.b_e.set(p, b_e_of(&law, &stress, state));
        points.sigma.set(p, stress);
    }
    Ok(())
}

/// Brings the initial stress to equilibrium under the loads at time 0, on and within the yield surfaces. Positions, F,
/// displacements and plastic strains keep their initial values; the state variables of the laws follow the stress.
/// Fails if there is no equilibrium.
pub fn settle<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    state: &mut InteractionState<D>,
    halo: &dyn Halo,
    solver: &mut dyn LinearSolver,
) -> Result<EquilibriumSearchReport, StepError> {
    let model = &model.settling();
    let sought = &of_a_round(model);
    let at_rest = vec![0.0; model.grid.nodes() * D];
    let mut held = None::<Vec<f64>>;
    let mut counts = Counts::default();
    let mut rounds = 0;
    let mut left = 1.0_f64;
    let mut part = 1.0_f64;
    loop {
        let mut start = UndeformedState::of(model, points, state, halo)?;
        let problem = start.problem(model, points, halo);
        let balance = Residual::of(&problem, &at_rest).balance;
        let is_balanced =
            balance.measure() <= model.criteria.force || RoundOff::of(&problem).covers(&balance, &problem);
        if is_balanced && (left == 0.0 || rounds == 0 && super::balance(model, points, state, halo)?.yielding == 0) {
            return Ok(EquilibriumSearchReport {
                rounds,
                evaluations: counts.evaluations,
            });
        }
        if rounds == MOST_ROUNDS {
            return Err(StepError::Unbalanced {
                rounds,
                force: balance.measure(),
                worst: worst_nodes(&problem, &balance),
            });
        }
        // Temporary forces balance the initial out-of-balance force, after stresses beyond yield are returned. They are
        // removed in parts.
        let held = held.get_or_insert(balance.f_oob);
        let next = (left - part).max(0.0);
        let f_ext = start.nodes.f_ext.iter_mut().zip(&*held);
        f_ext.for_each(|(force, held)| *force -= next * held);
        let backend = &mut Backend {
            halo,
            solver,
            counts: &mut counts,
        };
        match start.find(sought, points, backend) {
            Ok(found) => {
                take(model, &start, points, state, &found, halo)?;
                (left, part, rounds) = (next, 2.0 * part, rounds + 1);
            }
            Err(error) if !error.another_method_may_help() || part.min(left) <= LEAST => return Err(error),
            Err(_) => part = 0.5 * part.min(left),
        }
    }
}

/// Returns the model with the criteria of a round.
fn of_a_round<K: Kinematics<D>, const D: usize>(model: &Model<K, D>) -> Model<K, D> {
    let criteria = Criteria {
        energy: ANY,
        force: WITHIN * model.criteria.force,
        max_iterations: model.criteria.max_iterations,
    };
    Model {
        criteria,
        ..model.clone()
    }
}

/// Saves stress and state variables of an equilibrium in the points, and the tractions of strips.
fn take<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    start: &UndeformedState<D>,
    points: &mut Points<D>,
    interactions: &mut InteractionState<D>,
    found: &StepSolution<K, D>,
    halo: &dyn Halo,
) -> Result<(), StepError> {
    let ConstitutiveUpdate { answers, state } = commit::constitutive_update(model, &found.trial, points, halo)?;
    start.finish(model, points, interactions, &found.u, &found.reaction, halo);
    for (p, answer) in answers.iter().enumerate() {
        points.b_e.set(p, answer.b_e);
        points.sigma.set(p, answer.tau);
    }
    points.state = state;
    Ok(())
}
