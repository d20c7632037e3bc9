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

/// Bounds of the factor e_p after a step; the lower bound is the previous factor if that is smaller.
const EXTENT: [f64; 2] = [0.25, 1.5];
/// Offset, as a fraction of the distance, for the check whether the nearest part of an outline is a corner.
const ASIDE: f64 = 1e-3;

/// A material point near a body.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    point: usize,
    body: usize,
    gap: f64, // m
    touches: bool,
}

impl<const D: usize> RigidContacts<D> {
    /// Returns the gaps under `u` (m) of this rank's material points near a body. Of several bodies, the one in contact
    /// or the nearest counts. Points in contact with two bodies are omitted. One reduction if a body moves freely.
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

    /// Returns the factors e_p of all material points of this rank after the step, so that points near a body keep
    /// their gap although their F has changed. `states` are the bodies' states, and `after` has the material points, at
    /// the end of the step. `None` on all ranks without bodies.
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

/// Returns the initial factors e_p of all material points. A point whose domain overlaps an outline gets the factor
/// with which it just touches. If soil begins at an outline (`is_soil` at a position just outside) but no domain
/// reaches it, as with inclined outlines, the nearest points get a factor above 1, with which they touch; not at
/// corners.
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

/// Returns whether the nearest point of the outline moves when `x` moves tangentially, as at a side. At a corner it
/// stays; a corner pushes points below the adjacent sides.
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
