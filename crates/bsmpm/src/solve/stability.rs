//! Whether the equilibrium that a quasi-static iteration comes near is stable: the sign of the second-order work on its way.
//!
//! Under dead loads an elastic equilibrium is stable where du . K du > 0 for all du (Hill, 1958, J. Mech. Phys. Solids 6,
//! 236-249). No iteration shuns the others, and there round-off decides to which of several states it goes. A nearly
//! incompressible body has them where its pressure p is several times G: against isochoric motions, and such as F-bar averages
//! out, the geometric stiffness of a pressure that grows with depth is not negative as an integral, but is as the sum over a
//! few points, and only G resists it. In the mode that a heavy column loses first, with 3 points a cell and axis, it works
//! -1.16e-3 and G 1.00e-3; over 24 points the same two would be 0.20e-3 and 1.22e-3. On quadratic splines that begins at p/G
//! of 4, 10, 22, 65 and 80 with 2 to 6 points.
//!
//! A step s of the iteration changes the out-of-balance force by -K s, K a mean of its way: s . (f_old - f_new) < 0 near
//! equilibrium shows a direction of negative second-order work. It says nothing of directions in which no iteration went: a
//! state that passes may be unstable. Nor does it prove anything where K is not symmetric: in flow that is not associated
//! (slopes beyond failure have such steps), or where an average of F-bar spans materials of unequal stiffness or density, of
//! which A S of two points 1:10 has x . A S x < 0. So it is asked only of a single elastic material, or without averages.

use crate::error::StepError;
use crate::kinematics::Kinematics;
use crate::material::Material;
use crate::model::Model;
use crate::seam::dots;
use crate::solve::convergence::Convergence;
use crate::stabilisation::Stabilisation;
use crate::step::problem::Problem;
use crate::step::residual::Balance;

/// Force measure below which a state counts as near equilibrium: farther off a step may pass several equilibria.
const NEAR: f64 = 1e-3;

/// Whether anything follows from the work of a direction that is taken at this state: not far from equilibrium, nor in
/// dynamics, where inertia decides where an unstable body goes, nor without symmetry.
pub fn tells<K, const D: usize>(problem: &Problem<'_, K, D>, before: &Balance) -> bool {
    before.measure() < NEAR && problem.nodes.inertia.is_none() && is_symmetric(problem.model)
}

/// Refuses a direction du (m, nodal; how much of it was taken changes no sign) near static equilibrium whose second-order
/// work is negative beyond round-off: `work` is du . f_oob before it was taken, N m, where that [`tells`] anything; `after` are
/// the forces then. Agreed by all ranks; one reduction.
pub fn check<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    progress: &Convergence,
    (du, work): (&[f64], Option<f64>),
    after: &Balance,
) -> Result<(), StepError> {
    let Some(before) = work.filter(|_| after.measure() < NEAR) else { return Ok(()) };
    let sums = dots(problem.halo, D, &[(du, &after.f_oob), (du, du)]);
    let work = before - sums[0];
    if is_negative(work, sums[1].sqrt(), progress.round_off() * bulkiness(problem.model)) {
        return Err(StepError::Unstable { iteration: progress.iterations(), work });
    }
    Ok(())
}

/// Whether the complete derivative is symmetric.
fn is_symmetric<K, const D: usize>(model: &Model<K, D>) -> bool {
    let elastic = model.materials.iter().all(|material| matches!(material, Material::Hencky(_)));
    elastic && (model.materials.len() == 1 || model.stabilisation == Stabilisation::None)
}

/// Largest stiffness against dilation over Young's modulus, by which the round-off of nearly incompressible stress is larger.
fn bulkiness<K, const D: usize>(model: &Model<K, D>) -> f64 {
    let of = |material: &Material| material.elastic().oedometric() / material.elastic().young;
    model.materials.iter().map(of).fold(1.0, f64::max)
}

/// Whether a `work` in N m along a direction of the length `du` in m is negative for forces that are each known to
/// `round_off` in N.
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
