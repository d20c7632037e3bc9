//! Factor e_p in theory-manual equation (T7.7), which scales the distance at which material point p touches a rigid
//! body.

use super::ROUNDING;
use super::RigidContacts;
use super::body::{Pose, RigidBody, RigidState};
use super::near::{longest_edge, reach};
use super::point::{ContactStatus, tangents};
use super::surroundings::ParticleDomains;
use crate::parallel::Halo;
use crate::tensor::Vector;

/// The least, unless it was less, and the most of the part of its F's reach that contact leaves a point.
const EXTENT: [f64; 2] = [0.25, 1.5];
/// Part of a distance by which a place is moved to see whether what is nearest to it is a corner.
const ASIDE: f64 = 1e-3;

/// A point near a body.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    point: usize,
    body: usize,
    gap: f64, // m
    touches: bool,
}

impl<const D: usize> RigidContacts<D> {
    /// How far off a body the points of this rank are under `u` that are near one, m: of several the one that they
    /// touch, or that is nearest. Those that touch two are left out.
    pub fn held(&self, u: &[f64], halo: &dyn Halo) -> Vec<Held> {
        let motions = self.found(u, halo);
        let mut all = Vec::with_capacity(self.points.len());
        for near in &self.points {
            all.push(Held {
                point: near.point,
                body: near.body,
                gap: near.gap_after(&self.moved(near, u, &motions)),
                touches: near.status != ContactStatus::Open,
            });
        }
        all.sort_by(|a, b| {
            a.point
                .cmp(&b.point)
                .then(b.touches.cmp(&a.touches))
                .then(a.gap.total_cmp(&b.gap))
        });
        let of_a_point = all.chunk_by(|a, b| a.point == b.point);
        of_a_point
            .filter(|near| near.iter().filter(|held| held.touches).count() < 2)
            .map(|near| near[0])
            .collect()
    }

    /// Part of what every point of this rank reaches that it has from the end of the step on, with the bodies'
    /// `states` and the points as they are then: what is near one goes on as far from it as the step has left it,
    /// whatever its F has become. None without bodies: on all ranks or on none.
    pub fn extents_after(
        &self,
        held: &[Held],
        states: &[RigidState],
        after: &ParticleDomains<'_, D>,
    ) -> Option<Vec<f64>> {
        if self.is_empty() {
            return None;
        }
        let mut extents = after
            .points
            .extent
            .clone()
            .unwrap_or_else(|| vec![1.0; after.points.len()]);
        for Held { point, body, gap, .. } in held.iter().copied() {
            let pose = self.bodies[body].body.pose(&states[body].moved);
            let outline = &self.bodies[body].body.outline;
            let near = outline.nearest(&pose.seen(&after.points.x[point]));
            let (whole, _) = reach(after, point, &pose.turned(&near.normal));
            let extent = &mut extents[point];
            *extent = ((near.distance - gap) / whole).clamp(extent.min(EXTENT[0]), EXTENT[1]);
        }
        Some(extents)
    }
}

/// Of every point how much of its reach it has at the start, with the bodies as they stand. Points of soil that an
/// outline cuts lie as near to it as the rule of their cell puts them, and are not thrown out; where soil begins at the
/// outline, `is_soil` just off it, and no point reaches there, as in lattices that an outline is inclined to, the
/// nearest do. Corners touch nothing beside them so.
pub fn extents<const D: usize>(
    bodies: &[RigidBody<D>],
    states: &[RigidState],
    reaching: &ParticleDomains<'_, D>,
    is_soil: impl Fn(&Vector<D>) -> bool,
) -> Vec<f64> {
    let ParticleDomains { grid, points, .. } = reaching;
    let longest = (0..D).map(|axis| longest_edge(grid, axis)).fold(0.0, f64::max);
    let mut extents = Vec::with_capacity(points.len());
    for (p, &x) in points.x.iter().enumerate() {
        let mut cut = 1.0_f64;
        let mut flush = EXTENT[1];
        for (body, state) in bodies.iter().zip(states) {
            let pose = body.pose(&state.moved);
            if (x - pose.center).norm() > body.outline.radius() + 2.0 * longest {
                continue;
            }
            let near = body.outline.nearest(&pose.seen(&x));
            let normal = pose.turned(&near.normal);
            let (reach, _) = reach(reaching, p, &normal);
            let share = near.distance / reach;
            cut = cut.min(share.max(0.0));
            if share > 1.0 + ROUNDING && share < flush && is_beside_a_side(body, &pose, &x, &normal, near.distance) {
                let off_it = x - normal * (near.distance - ROUNDING * reach);
                flush = if is_soil(&off_it) { share } else { flush };
            }
        }
        extents.push(if cut < 1.0 || flush == EXTENT[1] { cut } else { flush });
    }
    extents
}

/// Whether what of an outline is nearest to a place moves with the place along it: that of a side does, that of a
/// corner, which pushes what is below the sides at it, does not.
fn is_beside_a_side<const D: usize>(
    body: &RigidBody<D>,
    pose: &Pose<D>,
    x: &Vector<D>,
    normal: &Vector<D>,
    distance: f64,
) -> bool {
    let foot = x - normal * distance;
    tangents(normal)[..D - 1]
        .iter()
        .flat_map(|along| [*along, -along])
        .all(|along| {
            let aside = along * (ASIDE * distance);
            let near = body.outline.nearest(&pose.seen(&(x + aside)));
            let moved = x + aside - pose.turned(&near.normal) * near.distance - foot;
            moved.dot(&along) > 0.25 * ASIDE * distance
        })
}
