//! If all material points below a free rigid body slide outwards (quasi-static analysis), makes the point with the
//! least slip stick.

use super::body::MOTIONS;
use super::point::{ContactStatus, RigidPoint};
use super::{BodyInStep, RigidContacts};
use crate::parallel::Halo;
use crate::tensor::Vector;
use nalgebra::Matrix3;

/// Ratio of the stiffness of a motion to that with all points sticking, below which the motion is loose. Its root is
/// the inclination of the base to the motion at that limit.
const LOOSE: f64 = 1e-6;
/// Relative increase of slips against the motion, so that only one of two equal slips sticks.
const AGAINST: f64 = 0.01;

/// Direction and slip of a sliding point with respect to a loose motion.
#[derive(Clone, Copy)]
struct SlidingPoints {
    towards: f64, // direction of friction along the motion: 1 or -1
    slip: f64,    // size of the motion that undoes the slip; the least one sticks
}

impl<const D: usize> RigidContacts<D> {
    /// Makes the point with the least slip stick, for each body with a loose motion whose points slide in both
    /// directions. `moved` is the displacement of the material at every point relative to its body (m). Points that
    /// were just `released` do not count for the least slip. Returns the number of these points on all ranks. Two
    /// reductions for each check, and two more per loose motion.
    pub(super) fn hold_neutral(&mut self, moved: &[Vector<D>], released: &[bool], halo: &dyn Halo) -> usize {
        if self.dt > 0.0 || !self.is_coupled() || !self.is_rough() {
            return 0;
        }
        let mut held = 0;
        for _ in 0..MOTIONS {
            let loose = self.loose_motions(halo);
            if loose.iter().all(Option::is_none) {
                break;
            }
            let sliding: Vec<Option<SlidingPoints>> = self
                .points
                .iter()
                .zip(moved)
                .map(|(p, m)| sliding(p, m, &loose))
                .collect();
            let mut extremes = vec![f64::NEG_INFINITY; 3 * self.bodies.len()]; // towards, against, - least slip
            for ((point, sliding), released) in self.points.iter().zip(&sliding).zip(released) {
                let Some(SlidingPoints { towards, slip }) = *sliding else {
                    continue;
                };
                let least = if *released { f64::NEG_INFINITY } else { -slip };
                let of_body = extremes[3 * point.body..].iter_mut();
                of_body
                    .zip([towards, -towards, least])
                    .for_each(|(most, value)| *most = most.max(value));
            }
            halo.all_reduce_max(&mut extremes);
            let mut count = [0.0];
            for (point, sliding) in self.points.iter_mut().zip(&sliding) {
                let [towards, against, least] = [0, 1, 2].map(|k| extremes[3 * point.body + k]);
                if towards > 0.0 && against > 0.0 && sliding.is_some_and(|sliding| sliding.slip <= -least) {
                    point.status = ContactStatus::Stick;
                    count[0] += 1.0;
                }
            }
            halo.all_reduce_sum(&mut count);
            held += count[0] as usize;
            if count[0] == 0.0 {
                break;
            }
        }
        held
    }

    /// Returns, per body, the motion with the least stiffness if it is loose. Two reductions.
    fn loose_motions(&self, halo: &dyn Halo) -> Vec<Option<Vector<3>>> {
        let stuck = self.stiffness_by(RigidPoint::rate_if_stuck, halo);
        let now = self.stiffness(false, halo);
        let bodies = self.bodies.iter().zip(stuck.iter().zip(&now));
        bodies.map(|(at, (stuck, now))| loosest(at, stuck, now)).collect()
    }
}

/// Returns the motion with the least ratio of the stiffness `now` to that with all points `stuck`, if it is loose: the
/// lowest mode of a generalised eigenvalue problem.
fn loosest<const D: usize>(at: &BodyInStep<D>, stuck: &Matrix3<f64>, now: &Matrix3<f64>) -> Option<Vector<3>> {
    if !at.body.is_free() {
        return None;
    }
    let free = at.body.freedom();
    let whole = among_free(stuck, free);
    let part = among_free(now, free);
    let inverse = whole.cholesky()?.l().try_inverse()?;
    let eigen = (inverse * part * inverse.transpose()).symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    (eigen.eigenvalues[least] < LOOSE).then(|| inverse.transpose() * eigen.eigenvectors.column(least))
}

/// Returns the stiffness of the free motions, with a unit diagonal for the prescribed ones.
fn among_free(stiffness: &Matrix3<f64>, free: [f64; MOTIONS]) -> Matrix3<f64> {
    Matrix3::from_fn(|k, l| stiffness[(k, l)] * free[k] * free[l] + if k == l { 1.0 - free[k] } else { 0.0 })
}

/// Returns direction and slip of a point that slides along the loose motion of its body; `None` for others.
fn sliding<const D: usize>(
    point: &RigidPoint<D>,
    moved: &Vector<D>,
    loose: &[Option<Vector<3>>],
) -> Option<SlidingPoints> {
    let motion = loose[point.body]?;
    let ContactStatus::Slip(towards) = point.status else {
        return None;
    };
    let along = point.along_motion(&motion);
    let friction = towards[0] * along[0] + towards[1] * along[1];
    let size = along[0].hypot(along[1]);
    let weighed = if friction < 0.0 { 1.0 + AGAINST } else { 1.0 };
    (friction != 0.0).then(|| SlidingPoints {
        towards: friction.signum(),
        slip: weighed * point.slipped(moved) / size,
    })
}
