//! Data of a rigid body: position, motion, mass, and all forces except those of the soil.

use super::outline::Outline;
use crate::schedule::{Row, between};
use crate::tensor::Vector;

/// Overlap, as a fraction of the size of a body, below which two bodies only touch.
const TOUCHING: f64 = 1e-6;
/// Number of motions of a body: 2-D: displacements along x and y, rotation; 3-D: displacements along x, y and z.
pub const MOTIONS: usize = 3;

/// A rigid body. In 2-D its motions are the displacements of its reference point along x and y (m) and the rotation
/// about it (rad, counter-clockwise); forces and masses are per metre of thickness. In 3-D it does not rotate, and the
/// units are those of translations.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody<const D: usize = 2> {
    /// Whether the body is present. An absent body follows its path; its free motions rest.
    pub acts: bool,
    /// Outline about the reference point, in its initial orientation.
    pub outline: Outline,
    /// Initial position of the reference point (m), from the grid's lower corner; for a body with mass, its centre of
    /// mass.
    pub center: Vector<D>,
    /// Friction coefficient (-).
    pub friction: f64,
    /// Motions that follow from forces; the path prescribes the others.
    pub free: [bool; MOTIONS],
    /// Increasing times (s, or pseudo-time) and prescribed motions: linear between rows, from 0 at time 0, constant
    /// after the last row.
    pub path: Vec<(f64, Vector<3>)>,
    /// Mass of each motion (kg, kg and kg m2).
    pub mass: Vector<3>,
    /// Increasing times (s, or pseudo-time) and external forces (N, N and N m): linear between rows, from 0
    /// at time 0, constant after the last row.
    pub load: Vec<(f64, Vector<3>)>,
    /// Initial velocity of the free motions (m/s, m/s and rad/s).
    pub velocity: Vector<3>,
}

/// State of a rigid body between steps; the same on every rank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidState {
    /// Motion since the start (m, m and rad).
    pub moved: Vector<3>,
    /// Velocity (m/s, m/s and rad/s); per pseudo-time without inertia.
    pub velocity: Vector<3>,
    /// Acceleration at the start of the next step (m/s2, m/s2 and rad/s2); `None` without inertia, at the start and
    /// after an impact.
    pub acceleration: Option<Vector<3>>,
    /// Slip distance of the material along the outline (m): sum over the steps of the mean slip, weighted with the
    /// normal force.
    pub slipped: f64,
    /// Work on the material since the start (J).
    pub work: f64,
}

/// Position and orientation of a body.
#[derive(Clone, Copy, Debug)]
pub struct Pose<const D: usize> {
    /// Reference point (m).
    pub center: Vector<D>,
    cos: f64,
    sin: f64,
}

impl<const D: usize> RigidBody<D> {
    /// Returns the initial state.
    pub fn at_rest(&self) -> RigidState {
        RigidState {
            velocity: self.pick(&self.velocity, &Vector::zeros()),
            ..RigidState::default()
        }
    }

    /// Returns the motions on the path at time `t`.
    pub fn on_path(&self, t: f64) -> Vector<3> {
        course(&self.path, t)
    }

    /// Returns the prescribed motions at time `t`; 0 for free motions.
    pub fn prescribed(&self, t: f64) -> Vector<3> {
        self.pick(&Vector::zeros(), &self.on_path(t))
    }

    /// Returns the external forces at time `t`: the load, and the mass times `g` (m/s2). The forces of the soil are not
    /// included.
    pub fn acting(&self, t: f64, g: &Vector<D>) -> Vector<3> {
        course(&self.load, t) + Vector::<3>::from_fn(|k, _| if k < D { self.mass[k] * g[k] } else { 0.0 })
    }

    /// Returns whether any motion is free.
    pub fn is_free(&self) -> bool {
        self.free.contains(&true)
    }

    /// Returns 1 for free motions, 0 for prescribed ones.
    pub fn freedom(&self) -> [f64; MOTIONS] {
        self.free.map(|is_free| if is_free { 1.0 } else { 0.0 })
    }

    /// Combines the free motions of `free` with the prescribed motions of `other`.
    pub fn pick(&self, free: &Vector<3>, other: &Vector<3>) -> Vector<3> {
        Vector::from_fn(|k, _| if self.free[k] { free[k] } else { other[k] })
    }

    /// Returns whether a point of its outline lies inside the outline of `other`, after the motions `moved` and
    /// `there`. Checked at the points of [`Outline::places`].
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

    /// Returns the least and the largest coordinate of its outline along an axis after the motion `moved` (m from the
    /// grid's lower corner); `None` in 3-D.
    pub fn extent(&self, moved: &Vector<3>, axis: usize) -> Option<[f64; 2]> {
        let pose = self.pose(moved);
        let along = self.outline.places().into_iter().map(|x| pose.place(&x)[axis]);
        along.fold(None, |extent, x| {
            Some(extent.map_or([x; 2], |[least, most]: [f64; 2]| [least.min(x), most.max(x)]))
        })
    }

    /// Returns the pose after the motion `moved`.
    pub fn pose(&self, moved: &Vector<3>) -> Pose<D> {
        let (sin, cos) = if D == 2 { moved[2].sin_cos() } else { (0.0, 1.0) };
        Pose {
            center: self.center + Vector::<D>::from_fn(|k, _| moved[k]),
            cos,
            sin,
        }
    }
}

/// Returns the first pair of bodies that overlap. Pairs without relative motion since the start do not count, because
/// they may be parts of one shape.
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
    /// Rotates a vector from the initial to the present orientation.
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

    /// Returns the position `x` relative to the reference point, in the initial orientation.
    pub fn seen(&self, x: &Vector<D>) -> Vector<D> {
        self.rotated(&(x - self.center), -self.sin)
    }

    /// Returns the position in space of a position relative to the body; the inverse of [`Self::seen`].
    pub fn place(&self, seen: &Vector<D>) -> Vector<D> {
        self.center + self.turned(seen)
    }
}

/// Interpolates linearly between rows, from zero at time 0; constant after the last row.
fn course(rows: &[Row<Vector<3>>], t: f64) -> Vector<3> {
    between(rows, Vector::zeros(), t).unwrap_or_else(|| rows.last().map_or_else(Vector::zeros, |(_, value)| *value))
}
