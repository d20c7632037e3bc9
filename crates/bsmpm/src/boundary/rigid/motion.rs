//! Prescribed or free motion of a rigid body in a step, theory-manual equation (T7.10). Free motion is integrated by
//! [`Newmark`], except by backward Euler in the first step, at an impact and in the step after an impact.

use super::body::{MOTIONS, RigidBody, RigidState};
use super::surroundings::Surroundings;
use crate::step::newmark::Newmark;
use crate::tensor::Vector;
use nalgebra::Matrix3;

/// A body in one step.
#[derive(Clone, Debug)]
pub(super) struct BodyInStep<const D: usize> {
    pub body: RigidBody<D>,
    pub before: RigidState,
    /// m, m, rad  since the start, at the end of the step without the soil
    pub predicted: Vector<3>,
    /// N, N, N m  but for the soil's
    pub external: Vector<3>,
    /// N, N, N m  what is left of the external and inertial forces at the predicted place, without the soil
    pub unbalanced: Vector<3>,
    /// kg/s2, kg/s2, kg m2/s2  by which motions resist; 0 without inertia
    pub inertia: Vector<3>,
    /// inverse of what free motions resist with, the soil held; 0 for the others
    pub resists: Matrix3<f64>,
    /// m/s, m/s, rad/s  at the end of the step, if no material is near
    pub flight: Option<Vector<3>>,
    /// m  distance of the nearest material at the start, as the body is at the end
    pub least: f64,
    newmark: Option<Newmark>,
    is_struck: bool,         // whether it meets material in the step that it did not touch before
    acceleration: Vector<3>, // m/s2, m/s2, rad/s2  at the start of the step, as the integration takes it
}

impl<const D: usize> BodyInStep<D> {
    /// With its motions as they are without the soil.
    pub fn of(body: &RigidBody<D>, state: &RigidState, t: f64, dt: f64, around: &Surroundings<'_, D>) -> Self {
        let [before, after] = [t, t + dt].map(|t| body.pick(&state.moved, &body.on_path(t)));
        let zero = Vector::zeros();
        let still = Self {
            body: RigidBody {
                free: [false; MOTIONS],
                friction: 0.0,
                ..body.clone()
            },
            before: RigidState {
                moved: before,
                ..*state
            },
            predicted: after,
            external: zero,
            unbalanced: zero,
            inertia: zero,
            resists: Matrix3::zeros(),
            flight: None,
            least: f64::INFINITY,
            newmark: None,
            is_struck: false,
            acceleration: zero,
        };
        if !body.acts {
            return still;
        }
        let external = body.acting(t + dt, &around.body_force);
        let mut at = Self {
            body: body.clone(),
            external,
            ..still
        };
        let Some(newmark) = around.newmark else {
            // Without inertia it goes on as it did: soil is expected to.
            at.predicted = body.pick(&(before + state.velocity * dt), &after);
            at.unbalanced = external;
            return at;
        };
        at.newmark = Some(state.acceleration.map_or_else(Newmark::backward_euler, |_| newmark));
        at.acceleration = state.acceleration.unwrap_or_else(Vector::zeros);
        at.predicted = body.pick(&(before + at.unhindered(dt)), &after);
        at.inertia = body.mass * at.newmark.map_or(0.0, |newmark| newmark.factor(dt));
        at
    }

    /// m, m, rad  of the step, of motions that the soil does not hinder.
    fn unhindered(&self, dt: f64) -> Vector<3> {
        let Some(newmark) = self.newmark else {
            return Vector::zeros();
        };
        Vector::from_fn(|k, _| {
            let v = self.before.velocity[k];
            let a = self.acceleration[k];
            let resists = newmark.acting(a, newmark.acceleration(dt, 0.0, v, a));
            (self.external[k] / self.body.mass[k] - resists) / newmark.factor(dt)
        })
    }

    /// Integrates the step by backward Euler from now on, from the place that was predicted.
    pub fn strike(&mut self, dt: f64) {
        let blow = Newmark::backward_euler();
        self.is_struck = true;
        if self.newmark == Some(blow) {
            return;
        }
        self.newmark = Some(blow);
        self.acceleration = Vector::zeros();
        self.inertia = self.body.mass * blow.factor(dt);
        let off = self.before.moved + self.unhindered(dt) - self.predicted;
        self.unbalanced = self.body.pick(&self.inertia.component_mul(&off), &Vector::zeros());
    }

    /// Goes on as nothing is near: a constant force is then exact.
    pub fn fly(&mut self, dt: f64) {
        let gained = self.external.component_div(&self.body.mass) * dt;
        let moved = self.before.moved + (self.before.velocity + gained * 0.5) * dt;
        self.predicted = self.body.pick(&moved, &self.predicted);
        self.flight = Some(self.before.velocity + gained);
    }

    /// The state after the step of this `length` (s or pseudo-time), with what its free `motions` add to those that
    /// were predicted, what the material has slipped (m) and what work it was done (J).
    pub fn state(&self, motions: &Vector<3>, length: f64, slip: f64, work: f64) -> RigidState {
        let moved = self.predicted + motions;
        let mean = (moved - self.before.moved) / length;
        let (velocity, acceleration) = self.motion_after(&(moved - self.before.moved), length);
        RigidState {
            moved,
            velocity: self.body.pick(&velocity, &mean),
            acceleration,
            slipped: self.before.slipped + slip,
            work: self.before.work + work,
        }
    }

    /// Velocity and acceleration of free motions after a `step` (m, m, rad).
    fn motion_after(&self, step: &Vector<3>, length: f64) -> (Vector<3>, Option<Vector<3>>) {
        let zero = Vector::zeros();
        if let Some(end) = self.flight {
            let acceleration = self.external.component_div(&self.body.mass);
            return (end, Some(self.body.pick(&acceleration, &zero)));
        }
        let Some(newmark) = self.newmark else {
            return (step / length, None);
        };
        let v = &self.before.velocity;
        let a = &self.acceleration;
        let end = Vector::<3>::from_fn(|k, _| newmark.acceleration(length, step[k], v[k], a[k]));
        let velocity = Vector::from_fn(|k, _| v[k] + newmark.gained(length, a[k], end[k]));
        (velocity, (!self.is_struck).then(|| self.body.pick(&end, &zero)))
    }
}
