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
//! equilibrium shows a direction of negative second-order work. That is a product of what is there already. It says nothing
//! of directions in which no iteration went: a state that passes may be unstable. Nor is it a proof where points yield:
//! flow that is not associated leaves K without symmetry, and slopes beyond failure have such steps.

use crate::error::StepError;
use crate::kinematics::Kinematics;
use crate::seam::dots;
use crate::step::equilibrium::Scene;
use crate::step::progress::Progress;
use crate::step::residual::Residual;
use crate::step::trial::Trial;

/// Force measure below which a state counts as near equilibrium: farther off a step may pass several equilibria.
const NEAR: f64 = 1e-3;

/// What an iteration did between two states.
#[derive(Clone, Copy, Debug)]
pub struct Move<'a> {
    /// m, nodal  its direction; how much of it was taken changes no sign
    pub du: &'a [f64],
    /// N m  du . f_oob before it
    pub energy: f64,
    /// force measure |f_oob| / largest force before it
    pub measure: f64,
}

/// Refuses a move near static equilibrium of elastic material whose second-order work is negative beyond round-off; agreed by
/// all ranks, for one reduction where both its ends are near. In dynamics inertia decides where an unstable body goes.
pub fn check<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    progress: &Progress,
    made: Move<'_>,
    after: &Residual<D>,
) -> Result<(), StepError> {
    let near = made.measure.max(after.balance.measure()) < NEAR;
    if !near || scene.nodes.inertia.is_some() {
        return Ok(());
    }
    let sums = dots(scene.halo, D, &[(made.du, &after.balance.f_oob), (made.du, made.du)]);
    let work = made.energy - sums[0];
    if is_negative(work, sums[1].sqrt(), progress.round_off()) && !yields(scene, &after.trial) {
        return Err(StepError::Unstable { iteration: progress.iterations(), work });
    }
    Ok(())
}

/// Whether a `work` in N m along a direction of the length `du` in m is negative for forces that are each known to
/// `round_off` in N.
fn is_negative(work: f64, du: f64, round_off: f64) -> bool {
    work < -2.0 * round_off * du
}

/// Whether any point of any rank yields.
fn yields<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, trial: &Trial<D>) -> bool {
    let Scene { model, points, halo, .. } = *scene;
    let flows = |p| trial.respond(model, points, p).is_ok_and(|response| response.yielding().is_some());
    let mut any = [f64::from(u8::from((0..points.len()).any(flows)))];
    halo.maximum(&mut any);
    any[0] > 0.0
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
