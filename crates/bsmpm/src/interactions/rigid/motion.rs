//! Prescribed or free motion of a rigid body in a step, theory-manual equation (T7.10).

use super::body::{MOTIONS, RigidBody, RigidState};
use super::surroundings::Surroundings;
use crate::dynamics::newmark::Newmark;
use crate::tensor::Vector;
use nalgebra::Matrix3;

/// A rigid body in one step.
#[derive(Clone, Debug)]
pub(super) struct BodyInStep<const D: usize> {
    pub body: RigidBody<D>,
    pub before: RigidState,
    /// Predicted motion since the start, at the end of the step, without the soil (m, m, rad).
    pub predicted: Vector<3>,
    /// External force without the soil's (N, N, N m).
    pub external: Vector<3>,
    /// Residual of the external and inertial forces at the predicted position, without the soil (N, N, N m).
    pub unbalanced: Vector<3>,
    /// Stiffness from inertia (kg/s2, kg/s2, kg m2/s2); 0 without inertia.
    pub inertia: Vector<3>,
    /// Inverse stiffness of the free motions with the soil fixed; 0 for prescribed motions.
    pub resists: Matrix3<f64>,
    /// Velocity at the end of the step if no material is near (m/s, m/s, rad/s).
    pub flight: Option<Vector<3>>,
    /// Least gap between the material at the start of the step and the body at its end (m).
    pub least: f64,
    newmark: Option<Newmark>,
    is_struck: bool,         // whether it touches new material in the step
    acceleration: Vector<3>, // m/s2, m/s2, rad/s2, at the start of the step, for the integration
}

impl<const D: usize> BodyInStep<D> {
    /// Creates the body for the step from `t` to `t + dt`, with its motion predicted without the soil.
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
            // Without inertia, the prediction continues with the velocity of the last step.
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

    /// Returns the displacements of the step without contact forces (m, m, rad).
    fn unhindered(&self, dt: f64) -> Vector<3> {
        let Some(newmark) = self.newmark else {
            return Vector::zeros();
        };
        // Balance m ((1 - alpha) a' + alpha a) = F, with Newmark's a' = c d + a'(d = 0) linear in the displacement d;
        // `factor` is that of d in the balance per mass, so d = (F / m - acting(a, a'(0))) / factor.
        Vector::from_fn(|k, _| {
            let v = self.before.velocity[k];
            let a = self.acceleration[k];
            let resists = newmark.acting(a, newmark.acceleration(dt, 0.0, v, a));
            (self.external[k] / self.body.mass[k] - resists) / newmark.factor(dt)
        })
    }

    /// Changes the step to backward Euler and keeps the predicted position.
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

    /// Moves the body under its external force alone, because no material is near; exact for a constant force.
    pub fn fly(&mut self, dt: f64) {
        let gained = self.external.component_div(&self.body.mass) * dt;
        let moved = self.before.moved + (self.before.velocity + gained * 0.5) * dt;
        self.predicted = self.body.pick(&moved, &self.predicted);
        self.flight = Some(self.before.velocity + gained);
    }

    /// Returns the state after a step of this `length` (s or pseudo-time) with the free `motions` beyond the predicted
    /// ones, the `slip` of the material (m) and the `work` on it (J).
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

    /// Returns the velocity and acceleration of free motions after the displacement `step` (m, m, rad).
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
