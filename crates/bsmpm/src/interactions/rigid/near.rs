//! Contact detection: material points near a rigid body, their gaps, contact positions and stiffness, theory-manual
//! equations (T7.7) to (T7.9).

use super::body::Pose;
use super::motion::BodyInStep;
use super::point::{ContactStatus, RigidPoint, along, tangents};
use super::surroundings::{ParticleDomains, Surroundings};
use super::{CLOSE, PENALTY, RigidContacts};
use crate::error::StepError;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Grid, Shape};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;

/// Material counts as near a body if the two could meet within this number of steps at their present velocities, which
/// may change in the step.
const MEETING: f64 = 2.0;
/// Least shape function of a node at a body for which the body may stop the node.
const SEEN: f64 = 1e-3;
/// Bounds of a material point's half width after deformation, relative to its initial value: after large shear, the
/// deformed box is larger than the material.
const STRETCH: [f64; 2] = [0.25, 1.5];

impl<const D: usize> RigidContacts<D> {
    /// Detects the contacts of a step and predicts their statuses from `guess`, the displacement of the last step (m).
    /// Points in contact at the start of the step remain closed. `young` returns the Young's modulus of a material
    /// point (Pa). One reduction; in dynamic analyses also a ghost exchange; further reductions if a body moves freely.
    /// Fails on all ranks if nothing supports a free motion.
    pub fn of(
        around: &Surroundings<'_, D>,
        young: impl Fn(usize) -> f64,
        interval: TimeInterval,
        guess: &[f64],
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let (bodies, _) = around.bodies;
        let dt = interval.dt;
        if bodies.is_empty() || dt == 0.0 {
            return Ok(Self::default());
        }
        let mut contacts = Self {
            offsets: around.shape.offsets().to_vec(),
            points: Vec::new(),
            bodies: Vec::new(),
            length: dt,
            dt: if around.newmark.is_some() { dt } else { 0.0 },
            edge: around.reaching.grid.smallest_edge(),
            moving: Vec::new(),
        };
        let mut moving = contacts.gather(around, young, interval, halo);
        if around.newmark.is_some() {
            halo.ghost_max(&mut moving, 1);
            let free = around.free.iter().enumerate();
            let marked = free.map(|(c, free)| *free && moving[Nodal::<D>::node(c)] > 0.0);
            contacts.moving = marked.collect();
        }
        let moved = contacts.recall(guess);
        contacts.hold_neutral(&moved, &vec![false; moved.len()], halo);
        contacts.strike(halo);
        contacts.settle(halo)?;
        Ok(contacts)
    }

    /// Adds the bodies and the material points near them, and returns marks of the nodes that a body may stop; empty
    /// without inertia. One reduction.
    fn gather(
        &mut self,
        around: &Surroundings<'_, D>,
        young: impl Fn(usize) -> f64,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Vec<f64> {
        let (bodies, states) = around.bodies;
        let dt = interval.dt;
        let is_dynamic = around.newmark.is_some();
        let mut moving = vec![0.0; if is_dynamic { around.reaching.grid.nodes() } else { 0 }];
        let mut near = vec![0.0; 2 * bodies.len()];
        for (number, (body, state)) in bodies.iter().zip(states).enumerate() {
            let mut at = BodyInStep::of(body, state, interval.start, dt, around);
            let found = self.points.len();
            if body.acts {
                at.least = self.gather_at(number, &at, around, &young, dt);
            }
            for point in &self.points[found..] {
                if !is_dynamic || point.gap > MEETING * comes(point, &at, around, dt) + CLOSE * self.edge {
                    continue;
                }
                near[2 * number] = 1.0;
                let seen = point.N.iter().zip(&self.offsets).filter(|(N, _)| **N > SEEN);
                seen.for_each(|(_, offset)| moving[point.first_node + offset] = 1.0);
            }
            near[2 * number + 1] = -at.least;
            self.bodies.push(at);
        }
        halo.all_reduce_max(&mut near);
        for (at, near) in self.bodies.iter_mut().zip(near.chunks_exact(2)) {
            at.least = -near[1];
            if is_dynamic && near[0] == 0.0 {
                at.fly(dt);
            }
        }
        let bodies = &self.bodies;
        self.points.retain(|point| bodies[point.body].flight.is_none());
        moving
    }

    /// Predicts the status of every point from `guess` and returns the displacement of the material there relative to
    /// its body (m).
    fn recall(&mut self, guess: &[f64]) -> Vec<Vector<D>> {
        let motions = vec![Vector::zeros(); self.bodies.len()];
        let moved = self.points.iter().map(|point| self.moved(point, guess, &motions));
        let moved: Vec<Vector<D>> = moved.collect();
        for (point, moved) in self.points.iter_mut().zip(&moved) {
            // A point in contact at the start of the step remains closed. If the body moves away faster than the guess,
            // all points would open otherwise, and yielding soil could not bear that.
            let is_met = point.gap_after(moved).min(point.gap_before()) <= CLOSE * self.edge;
            let status = if is_met { point.met(moved) } else { ContactStatus::Open };
            point.take(status, moved);
        }
        moved
    }

    /// Adds the material points near a body and returns the least gap (m).
    fn gather_at(
        &mut self,
        number: usize,
        at: &BodyInStep<D>,
        around: &Surroundings<'_, D>,
        young: &impl Fn(usize) -> f64,
        dt: f64,
    ) -> f64 {
        let outline = &at.body.outline;
        let radius = outline.radius();
        let poses = BodyPoses {
            before: at.body.pose(&at.before.moved),
            after: at.body.pose(&at.predicted),
        };
        let after = &poses.after;
        let ParticleDomains { grid, points, .. } = around.reaching;
        let mut least = f64::INFINITY;
        let longest = (0..D).map(|axis| longest_edge(grid, axis)).fold(0.0, f64::max);
        for patch in around.shape.patches() {
            for p in patch.points.clone() {
                let x = points.x[p];
                let bound = (x - after.center).norm() - radius - 2.0 * longest;
                if bound > least.max(longest) {
                    continue;
                }
                let near = outline.nearest(&after.seen(&x));
                let normal = after.turned(&near.normal);
                let (whole, edge) = reach(&around.reaching, p, &normal);
                let extent = points.extent.as_ref().map_or(1.0, |extent| extent[p]);
                let reach = whole * extent;
                let gap = near.distance - reach;
                least = least.min(gap);
                if gap > longest {
                    continue;
                }
                let volume = points.volume[p] * points.F.at(p).determinant();
                let mut stiffness = young(p) * volume / (2.0 * whole * edge);
                if around.newmark.is_some() {
                    stiffness += points.mass[p] / (dt * dt);
                }
                let foot = Foot {
                    place: x - normal * reach,
                    normal,
                    gap,
                    stiffness: PENALTY * stiffness,
                };
                self.points
                    .push(rigid_point(number, at, &poses, around, patch.first_node, p, &foot));
            }
        }
        least
    }
}

/// Poses of a body at both ends of a step.
struct BodyPoses<const D: usize> {
    before: Pose<D>,
    after: Pose<D>,
}

/// Contact position of a material point, for the body at the end of its motion.
struct Foot<const D: usize> {
    place: Vector<D>,  // m
    normal: Vector<D>, // unit vector out of the body
    gap: f64,          // m
    stiffness: f64,    // N/m, penalty
}

/// Creates the contact point of material point `p` with body `number`; `first_node` is the first node of the point's
/// cell.
fn rigid_point<const D: usize>(
    number: usize,
    at: &BodyInStep<D>,
    poses: &BodyPoses<D>,
    around: &Surroundings<'_, D>,
    first_node: usize,
    p: usize,
    foot: &Foot<D>,
) -> RigidPoint<D> {
    let Foot { place, normal, .. } = *foot;
    let points = around.reaching.points;
    let seen = poses.before.seen(&place);
    let after = &poses.after;
    let tangents = tangents(&normal);
    let step = after.place(&seen) - place;
    let pores = around.pore_pressure.filter(|_| at.body.friction > 0.0);
    let water = pores.map_or(0.0, |pores| pressing(pores, around, first_node, p, &normal, &place));
    let carried = points.tangential_force.as_ref();
    RigidPoint {
        body: number,
        point: p,
        first_node,
        N: values(around.shape, p, &(place - points.x[p])),
        normal,
        gap: foot.gap,
        motion: along(&tangents, &step),
        approach: normal.dot(&step),
        way: step.norm(),
        arm: after.turned(&seen),
        stiffness: foot.stiffness,
        friction: at.body.friction,
        water,
        carried: carried.map_or([0.0; 2], |carried| along(&tangents, &carried[p])),
        status: ContactStatus::Open,
        transverse_share: 0.0,
    }
}

/// Returns the distance that a material point and the body there move together in a step at their initial velocities
/// (m).
fn comes<const D: usize>(point: &RigidPoint<D>, at: &BodyInStep<D>, around: &Surroundings<'_, D>, dt: f64) -> f64 {
    let v = around
        .reaching
        .points
        .motion
        .as_ref()
        .map_or_else(Vector::zeros, |motion| motion.v[point.point]);
    let step = at.predicted - at.before.moved;
    dt * v.norm() + point.carried_by(&step).norm()
}

/// Returns the longest cell edge along an axis (m).
pub(super) fn longest_edge<const D: usize>(grid: &Grid<D>, axis: usize) -> f64 {
    let knots = &grid.axes()[axis];
    (0..knots.cells())
        .map(|cell| knots.breakpoint(cell + 1) - knots.breakpoint(cell))
        .fold(0.0, f64::max)
}

/// Returns the half width of a material point's domain along a normal (m), and the shortest edge of its initial cell
/// (m). The domain is the ellipse in the point's initial box, deformed by F.
pub(super) fn reach<const D: usize>(around: &ParticleDomains<'_, D>, p: usize, normal: &Vector<D>) -> (f64, f64) {
    let (half, size, edge) = half_edges(around, p, normal);
    let reach = half.iter().map(|half| half.powi(2)).sum::<f64>().sqrt();
    (reach.clamp(STRETCH[0] * size.min(), STRETCH[1] * size.max()), edge)
}

/// Returns the force of pore water on the outline at the position `place` (m) of material point `p` (N), along the
/// normal.
fn pressing<const D: usize>(
    pores: &PorePressure<D>,
    around: &Surroundings<'_, D>,
    first_node: usize,
    p: usize,
    normal: &Vector<D>,
    place: &Vector<D>,
) -> f64 {
    let shape = around.shape;
    let points = around.reaching.points;
    let values = shape.of(p).into_iter().zip(shape.offsets());
    let pressure = pores.at(values.map(|((N, _), offset)| (first_node + offset, N)), place);
    pressure * points.volume[p] * points.F.at(p).determinant() / column(&around.reaching, p, normal)
}

/// Returns the width of a material point's domain along a normal, by the box edge with the largest extent there (m).
/// One row of points touches an outline, so the volume divided by this width is the point's area on the outline.
fn column<const D: usize>(around: &ParticleDomains<'_, D>, p: usize, normal: &Vector<D>) -> f64 {
    let (half, size, _) = half_edges(around, p, normal);
    (2.0 * half.amax()).max(STRETCH[0] * size.min())
}

/// Returns the extents of the half edges of a material point's box, deformed by F, along a normal (m); the undeformed
/// half edges (m); and the shortest edge of its initial cell (m).
fn half_edges<const D: usize>(
    around: &ParticleDomains<'_, D>,
    p: usize,
    normal: &Vector<D>,
) -> (Vector<D>, Vector<D>, f64) {
    let ParticleDomains {
        grid,
        points,
        reach,
        weight,
    } = around;
    let placed = points.x[p] - points.u[p];
    let placed = if grid.locate(&placed).is_some() {
        placed
    } else {
        points.x[p]
    };
    let start = grid.locate(&placed);
    let size = start.map_or_else(|| Vector::repeat(grid.smallest_edge()), |cell| grid.cell_box(&cell).1);
    let share = reach.get(usize::from(points.material[p])).copied().unwrap_or(0.5);
    let box_volume: f64 = size.iter().map(|edge| 2.0 * share * edge).product();
    // A point that fills only part of its box, because the boundary of the material cut it, gets a smaller box of the
    // same shape.
    let share = share
        * (points.volume[p] / weight(&placed) / box_volume)
            .min(1.0)
            .powf(1.0 / D as f64);
    let F = points.F.at(p);
    let along = Vector::from_fn(|j, _| {
        let along = (0..D).map(|i| F[(i, j)] * normal[i]).sum::<f64>();
        along * share * size[j]
    });
    (along, size * share, size.min())
}

/// Returns the shape functions at an `offset` (m) from a material point, extrapolated linearly: N_I + grad N_I .
/// offset, so that a force there keeps its moment. Splines evaluated outside their cell could load a node that hardly
/// touches the point with most of the force. Degree 1 is not extrapolated.
fn values<const D: usize>(shape: &Shape<D>, p: usize, offset: &Vector<D>) -> Vec<f64> {
    let reaches = if shape.width() > 2 { 1.0 } else { 0.0 };
    let functions = shape.of(p).into_iter();
    functions.map(|(N, grad)| N + reaches * grad.dot(offset)).collect()
}
