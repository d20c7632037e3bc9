//! Stability check: rejects elastic quasi-static states with negative second-order work, theory-manual equation
//! (T5.17).

use crate::error::StepError;
use crate::interactions::Interaction;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::local_dot;
use crate::solve::convergence::Convergence;
use crate::stabilisation::Stabilisation;
use crate::step::problem::Problem;
use crate::step::residual::Balance;

/// Force measure below which a state counts as near equilibrium. Farther away, a step may pass several equilibria.
const NEAR: f64 = 1e-3;

/// Returns whether the work of a direction from this state decides on stability: near equilibrium, without inertia
/// (which decides where an unstable body moves), and with a symmetric derivative (no friction, yielding or second
/// field).
pub fn is_decisive<K, const D: usize>(problem: &Problem<'_, K, D>, before: &Balance) -> bool {
    let has_friction = problem.nodes.interactions.iter().any(Interaction::has_friction);
    let is_coupled = problem.nodes.field.is_some();
    before.measure() < NEAR
        && problem.nodes.inertia.is_none()
        && !has_friction
        && !is_coupled
        && is_symmetric(problem.model)
}

/// Rejects a direction `du` (m, nodal; its length does not matter) near static equilibrium whose second-order work is
/// negative beyond round-off. `work` is du . f_oob before the direction was taken (N m), if it [`is_decisive`]; `after`
/// contains the forces afterwards. All ranks agree. One reduction.
pub fn check<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    convergence: &Convergence,
    du: &[f64],
    work: Option<f64>,
    after: &Balance,
) -> Result<(), StepError> {
    let Some(before) = work.filter(|_| after.measure() < NEAR) else {
        return Ok(());
    };
    let halo = problem.halo;
    let sums = halo.reproducible_sum(&[&after.f_oob, du].map(|with| local_dot(halo, D, du, with)));
    let work = before - sums[0];
    if is_negative(work, sums[1].sqrt(), convergence.round_off() * bulkiness(problem.model)) {
        return Err(StepError::Unstable {
            iteration: convergence.iterations(),
            work,
        });
    }
    Ok(())
}

/// Returns whether the complete derivative is symmetric.
fn is_symmetric<K, const D: usize>(model: &Model<K, D>) -> bool {
    let elastic = model
        .materials
        .iter()
        .all(|material| !material.yields() && !material.is_graded());
    elastic && (model.materials.len() == 1 || model.stabilisation == Stabilisation::None)
}

/// Returns the largest ratio of oedometric modulus to Young's modulus, the factor by which round-off is larger in
/// nearly incompressible material.
fn bulkiness<K, const D: usize>(model: &Model<K, D>) -> f64 {
    model
        .materials
        .iter()
        .map(|material| material.elastic().oedometric() / material.elastic().young)
        .fold(1.0, f64::max)
}

/// Returns whether a `work` (N m) along a direction of length `du` (m) is negative, if each force is known to
/// `round_off` (N).
fn is_negative(work: f64, du: f64, round_off: f64) -> bool {
    work < -2.0 * round_off * du
}

#[cfg(test)]
mod tests {
    use super::is_negative;

    #[test]
    fn work_within_the_round_off_of_both_forces_has_no_sign() {
        assert!(!is_negative(1.0, 1.0, 0.0) && !is_negative(0.0, 1.0, 0.0) && is_negative(-1e-300, 1.0, 0.0));
        assert!(!is_negative(-1.9e-3, 2.0, 5e-4) && is_negative(-2.1e-3, 2.0, 5e-4));
        assert!(!is_negative(f64::NAN, 1.0, 1.0));
    }
}
