//! Contact detection: material points near a rigid body, their gaps, contact positions and stiffness, theory-manual
//! equations (T7.7) to (T7.9).

use super::motion::BodyInStep;
use super::point::{ContactStatus, RigidPoint, along, tangents};
use super::surroundings::{ParticleDomains, Surroundings};
use super::{CLOSE, PENALTY, RigidContacts};
use crate::error::StepError;
use crate::grid::{Grid, Shape};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;
use crate::water::pore_pressure::PorePressure;

/// Steps ahead of the meeting from which on material is near a body: it may be faster or slower than it starts.
const MEETING: f64 = 2.0;
/// Value of a node's function at a body from which on the body may stop the node.
const SEEN: f64 = 1e-3;
/// What a point reaches to a side at least and at most, over what it did at the start: large shear makes of a box what
/// no material fills.
const STRETCH: [f64; 2] = [0.25, 1.5];

impl<const D: usize> RigidContacts<D> {
    /// In a step from `t` to `t + dt`, with the statuses that the last displacement, `guess`, asks for; what touches as
    /// the step begins is on the outline all the same. `young` of a point, Pa. Two reductions, and an exchange with the
    /// neighbours in dynamics. Fails on all ranks where nothing holds a body.
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

    /// Adds the bodies with the points near them, and returns marks of the nodes that they may stop; none without
    /// inertia. One reduction.
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

    /// Gives every point the status that the last displacement, `guess`, asks for, and returns how the material at it
    /// moves then as seen from its body, m.
    fn recall(&mut self, guess: &[f64]) -> Vec<Vector<D>> {
        let motions = vec![Vector::zeros(); self.bodies.len()];
        let moved = self.points.iter().map(|point| self.moved(point, guess, &motions));
        let moved: Vec<Vector<D>> = moved.collect();
        for (point, moved) in self.points.iter_mut().zip(&moved) {
            // What touches as the step begins goes on to: a body that goes away faster than the guess followed would
            // let go of all that it holds, which soil that yields cannot stand.
            let is_met = point.gap_after(moved).min(point.gap_before()) <= CLOSE * self.edge;
            let status = if is_met { point.met(moved) } else { ContactStatus::Open };
            point.take(status, moved);
        }
        moved
    }

    /// Adds the points near a body; the distance of the nearest, m.
    fn gather_at(
        &mut self,
        number: usize,
        at: &BodyInStep<D>,
        around: &Surroundings<'_, D>,
        young: &impl Fn(usize) -> f64,
        dt: f64,
    ) -> f64 {
        let outline = &at.body.outline;
        let after = at.body.pose(&at.predicted);
        let ParticleDomains { grid, points, .. } = around.reaching;
        let mut least = f64::INFINITY;
        let longest = (0..D).map(|axis| longest_edge(grid, axis)).fold(0.0, f64::max);
        for patch in around.shape.patches() {
            for p in patch.points.clone() {
                let x = points.x[p];
                let bound = (x - after.center).norm() - outline.radius() - 2.0 * longest;
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
                    .push(rigid_point(number, at, around, patch.first_node, p, &foot));
            }
        }
        least
    }
}

/// Where a point comes nearest to a body at the end of its motion.
struct Foot<const D: usize> {
    place: Vector<D>,  // m
    normal: Vector<D>, // unit vector out of the body
    gap: f64,          // m
    stiffness: f64,    // N/m  of the contact there
}

/// A point, off the body of that number, of the cell whose functions begin with a node.
fn rigid_point<const D: usize>(
    number: usize,
    at: &BodyInStep<D>,
    around: &Surroundings<'_, D>,
    first_node: usize,
    p: usize,
    foot: &Foot<D>,
) -> RigidPoint<D> {
    let Foot { place, normal, .. } = *foot;
    let points = around.reaching.points;
    let seen = at.body.pose(&at.before.moved).seen(&place);
    let after = at.body.pose(&at.predicted);
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

/// How far a point and the body at it come in a step as they start it, m.
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

/// m  longest edge of the cells along an axis.
pub(super) fn longest_edge<const D: usize>(grid: &Grid<D>, axis: usize) -> f64 {
    let knots = &grid.axes()[axis];
    (0..knots.cells())
        .map(|cell| knots.breakpoint(cell + 1) - knots.breakpoint(cell))
        .fold(0.0, f64::max)
}

/// m  how far a point reaches along a normal, by the ellipse in its box in the lattice of the cell that it was in at
/// the start, deformed by its F; and an edge of that cell.
pub(super) fn reach<const D: usize>(around: &ParticleDomains<'_, D>, p: usize, normal: &Vector<D>) -> (f64, f64) {
    let (half, size, edge) = half_edges(around, p, normal);
    let reach = half.iter().map(|half| half.powi(2)).sum::<f64>().sqrt();
    (reach.clamp(STRETCH[0] * size.min(), STRETCH[1] * size.max()), edge)
}

/// N  force of pore water at a point of a cell whose functions begin with a node, along the normal at a place, m.
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

/// m  how far a point spans along a normal with the edge of its box that spans most: its volume over that is the area
/// of an outline that belongs to it, as one row of points touches an outline.
fn column<const D: usize>(around: &ParticleDomains<'_, D>, p: usize, normal: &Vector<D>) -> f64 {
    let (half, size, _) = half_edges(around, p, normal);
    (2.0 * half.amax()).max(STRETCH[0] * size.min())
}

/// m  how far each half edge of a point's box, deformed by its F, goes along a normal; those half edges; and an edge of
/// the point's cell at the start.
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
    // A box that was cut holds less.
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

/// What the nodes of a point's cell have to say of a place beside it: N_I + grad N_I . (place - x), so that a force
/// there keeps its moment. The functions themselves, gone on with to the place, would let a node that the point hardly
/// touches take up all that is asked there; linear ones do so either way, and speak of the point alone.
fn values<const D: usize>(shape: &Shape<D>, p: usize, offset: &Vector<D>) -> Vec<f64> {
    let reaches = if shape.width() > 2 { 1.0 } else { 0.0 };
    let functions = shape.of(p).into_iter();
    functions.map(|(N, grad)| N + reaches * grad.dot(offset)).collect()
}
