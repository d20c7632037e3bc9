//! Data of a rigid body: position, motion, mass, and all forces except those of the soil.

use super::outline::Outline;
use crate::schedule::{Row, between};
use crate::tensor::Vector;

/// Part of a body's size by which another one that only touches it may be in it.
const TOUCHING: f64 = 1e-6;
/// Motions of a body: in the plane along x, along y, and its rotation; in space along x, y and z.
pub const MOTIONS: usize = 3;

/// A rigid body. Its three motions in the plane are those of its reference point along x and y, m, and its rotation
/// about it, rad, counter-clockwise, and all is per metre of thickness; in space it does not turn.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody<const D: usize = 2> {
    /// whether it is there; one that is not goes on along its path, and else stays where it is, at rest
    pub acts: bool,
    /// about the reference point, as it stands at the start
    pub outline: Outline,
    /// m  the reference point at the start, from the grid's lower corner; of a body with mass its centre
    pub center: Vector<D>,
    /// -  coefficient of friction
    pub friction: f64,
    /// which motions follow from forces; the others are on the path
    pub free: [bool; MOTIONS],
    /// s (or pseudo-time), increasing, and the motions; linear between, from 0 at time 0, constant after the last
    pub path: Vec<(f64, Vector<3>)>,
    /// kg, kg and kg m2
    pub mass: Vector<3>,
    /// s (or pseudo-time), increasing, and what acts: N, N and N m; linear between, constant after the last
    pub load: Vec<(f64, Vector<3>)>,
    /// m/s, m/s and rad/s  at the start, of motions that are free
    pub velocity: Vector<3>,
}

/// What a body carries from step to step; the same on every rank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidState {
    /// m, m and rad  since the start
    pub moved: Vector<3>,
    /// m/s, m/s and rad/s; without inertia per pseudo-time
    pub velocity: Vector<3>,
    /// m/s2, m/s2 and rad/s2  that the next step starts with; `None` without inertia, at the start and after a blow
    pub acceleration: Option<Vector<3>>,
    /// m  way of the material along its outline, mean by normal force of every step
    pub slipped: f64,
    /// J  its work on the material so far
    pub work: f64,
}

/// Where a body is.
#[derive(Clone, Copy, Debug)]
pub struct Pose<const D: usize> {
    /// m  its reference point
    pub center: Vector<D>,
    cos: f64,
    sin: f64,
}

impl<const D: usize> RigidBody<D> {
    /// Its state at the start.
    pub fn at_rest(&self) -> RigidState {
        RigidState {
            velocity: self.pick(&self.velocity, &Vector::zeros()),
            ..RigidState::default()
        }
    }

    /// On the path at time `t`.
    pub fn on_path(&self, t: f64) -> Vector<3> {
        course(&self.path, t)
    }

    /// Motions that the path prescribes at time `t`; 0 of those that are free.
    pub fn prescribed(&self, t: f64) -> Vector<3> {
        self.pick(&Vector::zeros(), &self.on_path(t))
    }

    /// What acts on it at time `t` but for the soil: its load, and the force per mass `g`, m/s2.
    pub fn acting(&self, t: f64, g: &Vector<D>) -> Vector<3> {
        course(&self.load, t) + Vector::<3>::from_fn(|k, _| if k < D { self.mass[k] * g[k] } else { 0.0 })
    }

    /// Whether any motion follows from forces.
    pub fn is_free(&self) -> bool {
        self.free.contains(&true)
    }

    /// 1 of motions that are free, 0 of the others.
    pub fn freedom(&self) -> [f64; MOTIONS] {
        self.free.map(|is_free| if is_free { 1.0 } else { 0.0 })
    }

    /// Of motions that are free those of one, else those of the other.
    pub fn pick(&self, free: &Vector<3>, other: &Vector<3>) -> Vector<3> {
        Vector::from_fn(|k, _| if self.free[k] { free[k] } else { other[k] })
    }

    /// Whether its outline, once it has `moved`, has a part inside of another body's, which has moved, too: looked for
    /// at places along it.
    pub fn reaches_into(&self, moved: &Vector<3>, other: &Self, there: &Vector<3>) -> bool {
        let own = self.pose(moved);
        let others = other.pose(there);
        let apart = (own.center - others.center).norm() - self.outline.radius() - other.outline.radius();
        let both = self.acts && other.acts;
        both && apart < 0.0
            && self.outline.places().iter().any(|x| {
                let near = other.outline.nearest(&others.seen(&own.place(x)));
                near.distance < -TOUCHING * other.outline.radius()
            })
    }

    /// m  the least and the largest coordinate of its outline along an axis of the plane once it has `moved`, from the
    /// grid's lower corner; none in space.
    pub fn extent(&self, moved: &Vector<3>, axis: usize) -> Option<[f64; 2]> {
        let pose = self.pose(moved);
        let along = self.outline.places().into_iter().map(|x| pose.place(&x)[axis]);
        along.fold(None, |extent, x| {
            Some(extent.map_or([x; 2], |[least, most]: [f64; 2]| [least.min(x), most.max(x)]))
        })
    }

    /// Where it is once it has `moved`.
    pub fn pose(&self, moved: &Vector<3>) -> Pose<D> {
        let (sin, cos) = if D == 2 { moved[2].sin_cos() } else { (0.0, 1.0) };
        Pose {
            center: self.center + Vector::<D>::from_fn(|k, _| moved[k]),
            cos,
            sin,
        }
    }
}

/// The first pair of bodies that overlap, if any do. Such a pair that has not moved against each other since the start
/// does not count: it may be drawn so, as parts of one shape.
pub fn overlapping<const D: usize>(bodies: &[RigidBody<D>], states: &[RigidState]) -> Option<[usize; 2]> {
    let mut pairs = (0..states.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
    pairs.find(|&[a, b]| {
        let [moved_a, moved_b] = [a, b].map(|number| &states[number].moved);
        moved_a != moved_b
            && (bodies[a].reaches_into(moved_a, &bodies[b], moved_b)
                || bodies[b].reaches_into(moved_b, &bodies[a], moved_a))
    })
}

impl<const D: usize> Pose<D> {
    /// A vector of the body as it stood at the start, turned with it.
    pub fn turned(&self, v: &Vector<D>) -> Vector<D> {
        self.rotated(v, self.sin)
    }

    fn rotated(&self, v: &Vector<D>, sin: f64) -> Vector<D> {
        let mut turned = *v;
        if D == 2 {
            (turned[0], turned[1]) = (self.cos * v[0] - sin * v[1], sin * v[0] + self.cos * v[1]);
        }
        turned
    }

    /// A place as the body sees it, from its reference point and turned back.
    pub fn seen(&self, x: &Vector<D>) -> Vector<D> {
        self.rotated(&(x - self.center), -self.sin)
    }

    /// Where a place that the body sees is.
    pub fn place(&self, seen: &Vector<D>) -> Vector<D> {
        self.center + self.turned(seen)
    }
}

/// Linear between rows, from zero at time 0, constant after the last.
fn course(rows: &[Row<Vector<3>>], t: f64) -> Vector<3> {
    between(rows, Vector::zeros(), t).unwrap_or_else(|| rows.last().map_or_else(Vector::zeros, |(_, value)| *value))
}
