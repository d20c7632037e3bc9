//! Which points are near a rigid body in a step, how far from it, and what they start the step as.

use super::body::{MOTIONS, Pose, RigidBody, RigidState};
use super::point::{Grip, RigidPoint, along, tangents};
use super::{BodyInStep, PENALTY, ROUNDING, RigidContacts};
use crate::error::StepError;
use crate::grid::{Grid, Shape};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use nalgebra::Matrix3;

/// Part of a cell within which a point is on the outline as a step begins.
const CLOSE: f64 = 1e-6;
/// Steps ahead of the meeting from which on material is near a body: it may be faster or slower than it starts.
const MEETING: f64 = 2.0;
/// Value of a node's function at a body from which on the body may stop the node.
const SEEN: f64 = 1e-3;
/// What a point reaches to a side at least and at most, over what it did at the start: large shear makes of a box what
/// no material fills.
const STRETCH: [f64; 2] = [0.25, 1.5];

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

/// What tells how far points reach.
#[derive(Clone, Copy)]
pub struct Reaching<'a, const D: usize> {
    /// the grid
    pub grid: &'a Grid<D>,
    /// the points
    pub points: &'a Points<D>,
    /// parts of a cell that the points of a material reach to each side at the start, at most
    pub reach: &'a [f64],
    /// volume per m^D of the grid at a place
    pub weight: fn(&Vector<D>) -> f64,
}

/// What of the scene the bodies see.
pub struct Surroundings<'a, const D: usize> {
    /// the bodies, and what they carry
    pub bodies: (&'a [RigidBody<D>], &'a [RigidState]),
    /// the points on their grid
    pub reaching: Reaching<'a, D>,
    /// shape functions
    pub shape: &'a Shape<D>,
    /// m/s2  force per mass at the end of the step
    pub body_force: Vector<D>,
    /// components that nothing else holds
    pub free: &'a [bool],
    /// whether inertia acts
    pub dynamic: bool,
}

impl<const D: usize> RigidContacts<D> {
    /// In a step from `t` to `t + dt`, with the statuses that the last displacement, `guess`, asks for; what touches as
    /// the step begins is on the outline all the same. `young` of a point, Pa. Two reductions, and an exchange with the
    /// neighbours in dynamics. Fails on all ranks where nothing holds a body.
    pub fn of(
        around: &Surroundings<'_, D>,
        young: impl Fn(usize) -> f64,
        (t, dt): (f64, f64),
        guess: &[f64],
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let (bodies, states) = around.bodies;
        if bodies.is_empty() || dt == 0.0 {
            return Ok(Self::default());
        }
        let mut contacts = Self {
            offsets: around.shape.offsets().to_vec(),
            points: Vec::new(),
            bodies: Vec::new(),
            length: dt,
            dt: if around.dynamic { dt } else { 0.0 },
            edge: around.reaching.grid.smallest_edge(),
            moving: Vec::new(),
        };
        let mut moving = vec![0.0; if around.dynamic { around.reaching.grid.nodes() } else { 0 }];
        let mut near = vec![0.0; 2 * bodies.len()];
        for (number, (body, state)) in bodies.iter().zip(states).enumerate() {
            let mut at = BodyInStep::of(body, state, (t, dt), around);
            let found = contacts.points.len();
            if body.acts {
                at.least = contacts.gather((number, &at), (around, &young), dt);
            }
            for point in &contacts.points[found..] {
                if !around.dynamic || point.gap > MEETING * comes(point, &at, around, dt) + CLOSE * contacts.edge {
                    continue;
                }
                near[2 * number] = 1.0;
                let seen = point.N.iter().zip(&contacts.offsets).filter(|(N, _)| **N > SEEN);
                seen.for_each(|(_, offset)| moving[point.first_node + offset] = 1.0);
            }
            near[2 * number + 1] = -at.least;
            contacts.bodies.push(at);
        }
        halo.maximum(&mut near);
        for (at, near) in contacts.bodies.iter_mut().zip(near.chunks_exact(2)) {
            at.least = -near[1];
            if around.dynamic && near[0] == 0.0 {
                at.fly(dt);
            }
        }
        let Self { points, bodies: at, .. } = &mut contacts;
        points.retain(|point| at[point.body].flight.is_none());
        if around.dynamic {
            halo.max(&mut moving, 1);
            let marked = |(c, free): (usize, &bool)| *free && moving[Nodal::<D>::node(c)] > 0.0;
            contacts.moving = around.free.iter().enumerate().map(marked).collect();
        }
        let motions = vec![Vector::zeros(); bodies.len()];
        let grip = |point: &RigidPoint<D>| {
            let moved = contacts.moved(point, guess, &motions);
            // What touches as the step begins goes on to: a body that goes away faster than the guess followed would
            // let go of all that it holds, which soil that yields cannot stand.
            let is_met = point.gap_after(&moved).min(point.gap_before()) <= CLOSE * contacts.edge;
            (if is_met { point.met(&moved) } else { Grip::Open }, moved)
        };
        let grips: Vec<(Grip, Vector<D>)> = contacts.points.iter().map(grip).collect();
        contacts.points.iter_mut().zip(grips).for_each(|(point, (grip, moved))| point.take(grip, &moved));
        contacts.settle(halo)?;
        Ok(contacts)
    }

    /// How far off a body the points of this rank are under `u` that are near one, m: of several the one that they
    /// touch, or that is nearest. Those that touch two are left out.
    pub fn held(&self, u: &[f64], halo: &dyn Halo) -> Vec<Held> {
        let motions = self.found(u, halo);
        let held = |near: &RigidPoint<D>| {
            let gap = near.gap_after(&self.moved(near, u, &motions));
            Held { point: near.point, body: near.body, gap, touches: near.grip != Grip::Open }
        };
        let mut all: Vec<Held> = self.points.iter().map(held).collect();
        all.sort_by(|a, b| a.point.cmp(&b.point).then(b.touches.cmp(&a.touches)).then(a.gap.total_cmp(&b.gap)));
        let of_a_point = all.chunk_by(|a, b| a.point == b.point);
        of_a_point.filter(|near| near.iter().filter(|held| held.touches).count() < 2).map(|near| near[0]).collect()
    }

    /// Part of what every point of this rank reaches that it has from the end of the step on, with the bodies'
    /// `states` and the points as they are then: what is near one goes on as far from it as the step has left it,
    /// whatever its F has become.
    pub fn extents_after(&self, held: &[Held], states: &[RigidState], after: &Reaching<'_, D>) -> Option<Vec<f64>> {
        if held.is_empty() {
            return None;
        }
        let mut extents = after.points.extent.clone().unwrap_or_else(|| vec![1.0; after.points.len()]);
        for Held { point, body, gap, .. } in held.iter().copied() {
            let (pose, outline) = (self.bodies[body].body.pose(&states[body].moved), &self.bodies[body].body.outline);
            let near = outline.nearest(&pose.seen(&after.points.x[point]));
            let (whole, _) = reach(after, point, &pose.turned(&near.normal));
            let extent = &mut extents[point];
            *extent = ((near.distance - gap) / whole).clamp(extent.min(EXTENT[0]), EXTENT[1]);
        }
        Some(extents)
    }

    /// Adds the points near a body; the distance of the nearest, m.
    fn gather(
        &mut self,
        (number, at): (usize, &BodyInStep<D>),
        (around, young): (&Surroundings<'_, D>, &impl Fn(usize) -> f64),
        dt: f64,
    ) -> f64 {
        let (body, before, after) = (&at.body, at.body.pose(&at.before.moved), at.body.pose(&at.predicted));
        let (shape, Reaching { grid, points, .. }, mut least) = (around.shape, around.reaching, f64::INFINITY);
        let longest = (0..D).map(|axis| longest_edge(grid, axis)).fold(0.0, f64::max);
        let radius = body.outline.radius();
        for patch in shape.patches() {
            for p in patch.points.clone() {
                let x = points.x[p];
                let bound = (x - after.center).norm() - radius - 2.0 * longest;
                if bound > least.max(longest) {
                    continue;
                }
                let near = body.outline.nearest(&after.seen(&x));
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
                if around.dynamic {
                    stiffness += points.mass[p] / (dt * dt);
                }
                let place = x - normal * reach;
                let seen = before.seen(&place);
                let tangents = tangents(&normal);
                let step = after.place(&seen) - place;
                let carried = points.grip.as_ref().map_or([0.0; 2], |grip| along(&tangents, &grip[p]));
                self.points.push(RigidPoint {
                    body: number,
                    point: p,
                    first_node: patch.first_node,
                    N: values(shape, p, &(place - x)),
                    normal,
                    gap,
                    motion: along(&tangents, &step),
                    approach: normal.dot(&step),
                    way: step.norm(),
                    arm: after.turned(&seen),
                    stiffness: PENALTY * stiffness,
                    friction: body.friction,
                    carried,
                    grip: Grip::Open,
                    transverse_share: 0.0,
                });
            }
        }
        least
    }
}

impl<const D: usize> BodyInStep<D> {
    /// With its motions as they are without the soil.
    fn of(body: &RigidBody<D>, state: &RigidState, (t, dt): (f64, f64), around: &Surroundings<'_, D>) -> Self {
        let [before, after] = [t, t + dt].map(|t| body.pick(&state.moved, &body.on_path(t)));
        let before = RigidState { moved: before, ..*state };
        let (resists, least) = (Matrix3::zeros(), f64::INFINITY);
        let zero = Vector::zeros();
        let still = Self {
            body: RigidBody { free: [false; MOTIONS], friction: 0.0, ..body.clone() },
            before,
            predicted: after,
            external: zero,
            inertia: zero,
            resists,
            flight: None,
            least,
        };
        if !body.acts {
            return still;
        }
        let external = body.acting(t + dt, &around.body_force);
        // Without inertia it goes on as it did: soil is expected to.
        let (mut step, mut inertia) = (state.velocity * dt, Vector::zeros());
        if around.dynamic {
            inertia = body.mass / (dt * dt);
            step += external.component_div(&body.mass) * (dt * dt);
        }
        let predicted = body.pick(&(before.moved + step), &after);
        Self { body: body.clone(), predicted, external, inertia, ..still }
    }

    /// Goes on as nothing is near: a constant force is then exact.
    fn fly(&mut self, dt: f64) {
        let gained = self.external.component_div(&self.body.mass) * dt;
        let moved = self.before.moved + (self.before.velocity + gained * 0.5) * dt;
        self.predicted = self.body.pick(&moved, &self.predicted);
        self.flight = Some(self.before.velocity + gained);
    }
}

/// Of every point how much of its reach it has at the start, with the bodies as they stand. Points of soil that an
/// outline cuts lie as near to it as the rule of their cell puts them, and are not thrown out; where soil begins at the
/// outline, `is_soil` just off it, and no point reaches there, as in lattices that an outline is inclined to, the
/// nearest do. Corners touch nothing beside them so.
pub fn extents<const D: usize>(
    (bodies, states): (&[RigidBody<D>], &[RigidState]),
    reaching: &Reaching<'_, D>,
    is_soil: impl Fn(&Vector<D>) -> bool,
) -> Vec<f64> {
    let Reaching { grid, points, .. } = reaching;
    let longest = (0..D).map(|axis| longest_edge(grid, axis)).fold(0.0, f64::max);
    let of = |p: usize| {
        let x = points.x[p];
        let (mut cut, mut flush) = (1.0_f64, EXTENT[1]);
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
            if share > 1.0 + ROUNDING && share < flush && is_beside_a_side(body, &pose, &x, (&normal, near.distance)) {
                let off_it = x - normal * (near.distance - ROUNDING * reach);
                flush = if is_soil(&off_it) { share } else { flush };
            }
        }
        if cut < 1.0 || flush == EXTENT[1] { cut } else { flush }
    };
    (0..points.len()).map(of).collect()
}

/// Whether what of an outline is nearest to a place moves with the place along it: that of a side does, that of a
/// corner, which pushes what is below the sides at it, does not.
fn is_beside_a_side<const D: usize>(
    body: &RigidBody<D>,
    pose: &Pose<D>,
    x: &Vector<D>,
    (normal, distance): (&Vector<D>, f64),
) -> bool {
    let foot = x - normal * distance;
    tangents(normal)[..D - 1].iter().flat_map(|along| [*along, -along]).all(|along| {
        let aside = along * (ASIDE * distance);
        let near = body.outline.nearest(&pose.seen(&(x + aside)));
        let moved = x + aside - pose.turned(&near.normal) * near.distance - foot;
        moved.dot(&along) > 0.25 * ASIDE * distance
    })
}

/// How far a point and the body at it come in a step as they start it, m.
fn comes<const D: usize>(point: &RigidPoint<D>, at: &BodyInStep<D>, around: &Surroundings<'_, D>, dt: f64) -> f64 {
    let v = around.reaching.points.motion.as_ref().map_or_else(Vector::zeros, |motion| motion.v[point.point]);
    let step = at.predicted - at.before.moved;
    dt * v.norm() + point.carried_by(&step).norm()
}

/// m  longest edge of the cells along an axis.
fn longest_edge<const D: usize>(grid: &Grid<D>, axis: usize) -> f64 {
    let knots = &grid.axes()[axis];
    (0..knots.cells()).map(|cell| knots.breakpoint(cell + 1) - knots.breakpoint(cell)).fold(0.0, f64::max)
}

/// m  how far a point reaches along a normal, by the ellipse in its box in the lattice of the cell that it was in at
/// the start, deformed by its F; and an edge of that cell.
fn reach<const D: usize>(around: &Reaching<'_, D>, p: usize, normal: &Vector<D>) -> (f64, f64) {
    let Reaching { grid, points, reach, weight } = around;
    let placed = points.x[p] - points.u[p];
    let placed = if grid.locate(&placed).is_some() { placed } else { points.x[p] };
    let start = grid.locate(&placed);
    let size = start.map_or_else(|| Vector::repeat(grid.smallest_edge()), |cell| grid.cell_box(&cell).1);
    let share = reach.get(usize::from(points.material[p])).copied().unwrap_or(0.5);
    let box_volume: f64 = size.iter().map(|edge| 2.0 * share * edge).product();
    // A box that was cut holds less.
    let share = share * (points.volume[p] / weight(&placed) / box_volume).min(1.0).powf(1.0 / D as f64);
    let F = points.F.at(p);
    let along = |j: usize| (0..D).map(|i| F[(i, j)] * normal[i]).sum::<f64>() * share * size[j];
    let reach = (0..D).map(|j| along(j).powi(2)).sum::<f64>().sqrt();
    let edge = size.min();
    (reach.clamp(STRETCH[0] * share * edge, STRETCH[1] * share * size.max()), edge)
}

/// What the nodes of a point's cell have to say of a place beside it: N_I + grad N_I . (place - x), so that a force
/// there keeps its moment. The functions themselves, gone on with to the place, would let a node that the point hardly
/// touches take up all that is asked there; linear ones do so either way, and speak of the point alone.
fn values<const D: usize>(shape: &Shape<D>, p: usize, offset: &Vector<D>) -> Vec<f64> {
    let reaches = if shape.width() > 2 { 1.0 } else { 0.0 };
    let of = |(N, grad): (f64, Vector<D>)| N + reaches * grad.dot(offset);
    shape.of(p).into_iter().map(of).collect()
}
