//! Resultant forces of footings and prescribed segments.

use super::Strip;
use crate::tensor::Vector;

/// Resultant force of a strip on the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resultant<const D: usize> {
    pub force: Vector<D>, // N
    pub moment: f64,      // N m, about the strip's centroid in the plane of axes 0 and 1, counter-clockwise
}

impl<const D: usize> Resultant<D> {
    /// Adds a force (N) at the lever arm `arm` (m) from the centroid.
    fn add(&mut self, force: Vector<D>, arm: Vector<D>) {
        self.force += force;
        self.moment += arm[0] * force[1] - arm[1] * force[0];
    }
}

/// Returns the resultants of all strips from the `carried` tractions of their points (Pa). Strips whose motions a point
/// follows divide its force in the same proportions, so that force times motion equals the work.
pub(super) fn resultants<const D: usize>(strips: &[Strip<D>], carried: &[Vec<Vector<D>>]) -> Vec<Resultant<D>> {
    let middles: Vec<Vector<D>> = strips.iter().map(Strip::middle).collect();
    let mut resultants = vec![
        Resultant {
            force: Vector::zeros(),
            moment: 0.0
        };
        strips.len()
    ];
    for (number, strip) in strips.iter().enumerate() {
        for (at, (point, carried)) in strip.points.iter().zip(&carried[number]).enumerate() {
            let acting = strip.contact.map_or(*carried, |contact| contact.acting(carried)) * point.area;
            resultants[number].add(strip.own(at, &acting), point.x - middles[number]);
            for other in strip.others(at) {
                resultants[other.strip].add(other.of(&acting), point.x - middles[other.strip]);
            }
        }
    }
    resultants
}
