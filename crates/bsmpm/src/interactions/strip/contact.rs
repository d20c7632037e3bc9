//! Contact law of a surface point of a footing that can slide or separate, theory-manual equations (T7.5), (T7.6).

use crate::interactions::coulomb::{Contact, Status, transverse};
use crate::tensor::Vector;

/// Tolerance for the direction of friction, as a multiple of the tolerance for statuses: beyond it, the direction is
/// corrected to that of the trial.
const TURNED: f64 = 100.0;

/// Contact of a strip with the soil (T7.5), (T7.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripContact<const D: usize> {
    /// Friction coefficient, and whether the material can separate.
    pub law: Contact,
    /// Unit normal of the base, towards the material.
    pub inward: Vector<D>,
}

/// Contact law and status of a point in a step. Friction acts along the unit vector of [`Status::Slip`], which is zero
/// without friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactState<const D: usize> {
    contact: StripContact<D>,
    pub status: Status<D>,
    /// Pore pressure (Pa).
    pub water: f64,
    transverse_share: f64, // stiffness across the direction of friction, part of the penalty (3-D)
    open_before: bool,     // at the start of the step
}

impl<const D: usize> StripContact<D> {
    /// Returns the traction on the body for the `carried` state (Pa): zero for an open point.
    pub fn acting(&self, carried: &Vector<D>) -> Vector<D> {
        if self.is_open(carried) {
            Vector::zeros()
        } else {
            *carried
        }
    }

    /// Returns whether the `carried` state is a gap, that is a negative normal part.
    pub fn is_open(&self, carried: &Vector<D>) -> bool {
        self.law.lifts && self.inward.dot(carried) < 0.0
    }
}

impl<const D: usize> ContactState<D> {
    /// Creates the state at the start of a step from the `carried` traction or gap.
    pub fn of(contact: StripContact<D>, carried: &Vector<D>) -> Self {
        let open_before = contact.is_open(carried);
        let closed = if contact.law.friction == 0.0 {
            Status::Slip(Vector::zeros())
        } else {
            Status::Stick
        };
        Self {
            contact,
            status: if open_before { Status::Open } else { closed },
            transverse_share: 0.0,
            open_before,
            water: 0.0,
        }
    }

    /// Returns the traction on the body at the start of the step (Pa).
    pub fn before(&self, carried: &Vector<D>) -> Vector<D> {
        self.contact.acting(carried)
    }

    /// Returns the traction from which the elastic trial starts (Pa). A point that was open starts without friction.
    pub fn start(&self, carried: &Vector<D>) -> Vector<D> {
        if self.open_before {
            self.normal(carried)
        } else {
            *carried
        }
    }

    /// Returns the traction on the body for an elastic `trial` (Pa).
    pub fn traction(&self, trial: &Vector<D>) -> Vector<D> {
        self.part(trial) + self.friction(trial)
    }

    /// Returns the part of a trial traction, or of a displacement, on which the status acts with a symmetric stiffness:
    /// all of it, the normal part, or nothing; in 3-D slip also a share across the direction of friction.
    pub fn part(&self, vector: &Vector<D>) -> Vector<D> {
        match self.status {
            Status::Open => Vector::zeros(),
            Status::Stick => *vector,
            Status::Slip(along) if self.transverse_share > 0.0 => {
                let normal = self.normal(vector);
                normal + transverse(&(vector - normal), &along) * self.transverse_share
            }
            Status::Slip(_) => self.normal(vector),
        }
    }

    /// Returns Coulomb's limit at a total pressure, from the effective pressure (Pa).
    fn limit(&self, pressure: f64) -> f64 {
        let effective = if self.water > 0.0 {
            (pressure - self.water).max(0.0)
        } else {
            pressure
        };
        self.contact.law.friction * effective
    }

    /// Returns the friction for an elastic `trial` (Pa).
    fn friction(&self, trial: &Vector<D>) -> Vector<D> {
        match self.status {
            Status::Slip(along) if self.water > 0.0 => along * self.limit(self.contact.inward.dot(trial)),
            _ => self.rubbing(trial),
        }
    }

    /// Returns friction, or its derivative, linear in the normal part of `vector`.
    pub fn rubbing(&self, vector: &Vector<D>) -> Vector<D> {
        match self.status {
            Status::Slip(along) => along * (self.contact.law.friction * self.contact.inward.dot(vector)),
            Status::Open | Status::Stick => Vector::zeros(),
        }
    }

    /// Returns the state carried to the next step (Pa). For an open point it is the penalty times the displacement of
    /// the strip relative to the material since separation: the normal part is the negative gap, the tangential part
    /// the relative motion along the base.
    pub fn carry(&self, trial: &Vector<D>, carried: &Vector<D>) -> Vector<D> {
        let offset = if self.open_before {
            carried - self.normal(carried)
        } else {
            Vector::zeros()
        };
        if self.status == Status::Open {
            trial + offset
        } else {
            self.traction(trial)
        }
    }

    /// Returns the share of the step in which a point that opens or closes is in contact; 1 for other points.
    pub fn share(&self, carried: &Vector<D>, trial: &Vector<D>) -> f64 {
        let [before, after] = [carried, trial].map(|traction| self.contact.inward.dot(traction));
        match (self.open_before, self.status == Status::Open) {
            (false, true) if before > after => (before / (before - after)).clamp(0.0, 1.0),
            (true, false) if after > before => (after / (after - before)).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }

    /// Returns the gap at the start of the step (m).
    pub fn gap_before(&self, carried: &Vector<D>, penalty: f64) -> f64 {
        if self.open_before {
            -self.contact.inward.dot(carried) / penalty
        } else {
            0.0
        }
    }

    /// Returns the gap for a `trial` (m).
    pub fn gap(&self, trial: &Vector<D>, penalty: f64) -> f64 {
        if self.status == Status::Open {
            (-self.contact.inward.dot(trial) / penalty).max(0.0)
        } else {
            0.0
        }
    }

    /// Returns the tangential distance that a point that closes in this step moved while it was open (m).
    pub fn moved_on(&self, carried: &Vector<D>, penalty: f64) -> f64 {
        let came_back = self.open_before && self.status != Status::Open;
        if came_back {
            (carried - self.normal(carried)).norm() / penalty
        } else {
            0.0
        }
    }

    /// Returns the normal traction, positive in compression (Pa).
    pub fn pressure(&self, trial: &Vector<D>) -> f64 {
        if self.status == Status::Open {
            0.0
        } else {
            self.contact.inward.dot(trial)
        }
    }

    /// Returns the plastic slip (m): what the return mapping to Coulomb's cone removed from the `trial`, divided by the
    /// penalty.
    pub fn slid(&self, trial: &Vector<D>, penalty: f64) -> Vector<D> {
        match self.status {
            Status::Slip(_) => (trial - self.traction(trial)) / penalty,
            Status::Open | Status::Stick => Vector::zeros(),
        }
    }

    /// Predicts the status from the `trial` traction of the last step's displacement; `before` is the traction from
    /// which the trial starts. A point that is closed at the start of the step stays closed even without pressure:
    /// initial stress arises in the first step only, and yielding soil would find no equilibrium if all points opened.
    pub fn recall(&mut self, trial: &Vector<D>, before: &Vector<D>) {
        let [pressed, presses] = [before, trial].map(|traction| self.contact.inward.dot(traction));
        if self.contact.law.lifts && self.open_before && presses < 0.0 {
            self.status = Status::Open;
            return;
        }
        let pressure = if presses > 0.0 { presses } else { pressed };
        self.take(self.met(trial, pressure, 0.0), trial);
    }

    /// Corrects the status if the `trial` contradicts it by more than `doubt` (Pa). Returns whether it changed.
    pub fn correct(&mut self, trial: &Vector<D>, doubt: f64) -> bool {
        let before = self.status;
        let status = self.corrected(trial, doubt);
        if status != before {
            self.take(status, trial);
        }
        status != before
    }

    /// Sets the status and the stiffness across the direction of friction, mu p/|t|: the derivative of mu p t/|t|
    /// there, for the tangential trial t.
    fn take(&mut self, status: Status<D>, trial: &Vector<D>) {
        self.status = status;
        let limit = self.limit(self.contact.inward.dot(trial).max(0.0));
        let shear = (trial - self.normal(trial)).norm();
        let turns = D > 2 && matches!(status, Status::Slip(_)) && shear > 0.0;
        self.transverse_share = if turns { (limit / shear).min(1.0) } else { 0.0 };
    }

    /// Returns the status that follows from a `trial` if this contradicts the present one by more than `doubt` (Pa).
    fn corrected(&self, trial: &Vector<D>, doubt: f64) -> Status<D> {
        let pressure = self.contact.inward.dot(trial);
        match self.status {
            Status::Open if pressure > doubt => self.met(trial, pressure, 0.0),
            Status::Open => Status::Open,
            _ if self.contact.law.lifts && pressure < -doubt => Status::Open,
            Status::Stick => self.met(trial, pressure, doubt),
            Status::Slip(along) if along.norm_squared() > 0.0 => {
                let shear = trial - self.normal(trial);
                let limit = self.limit(pressure);
                let friction_force = self.traction(trial) - self.normal(trial);
                let is_off = (friction_force - shear.normalize() * limit).norm() > TURNED * doubt;
                match shear.dot(&along) {
                    _ if pressure < -doubt => Status::Slip(Vector::zeros()),
                    // A point that slid against friction has to stick first. Reversing the direction at once alternates
                    // without end.
                    slid if slid < limit - doubt => Status::Stick,
                    _ if is_off => Status::Slip(shear.normalize()),
                    _ => self.status,
                }
            }
            Status::Slip(_) if pressure > doubt => self.met(trial, pressure, 0.0),
            Status::Slip(_) => self.status,
        }
    }

    /// Returns the status of a closed point for a `trial` with this pressure (Pa).
    fn met(&self, trial: &Vector<D>, pressure: f64, doubt: f64) -> Status<D> {
        let friction = self.contact.law.friction;
        let shear = trial - self.normal(trial);
        let limit = self.limit(pressure.max(0.0));
        match shear.try_normalize(0.0) {
            _ if friction == 0.0 || pressure < -doubt => Status::Slip(Vector::zeros()),
            Some(along) if shear.norm() > limit + doubt => Status::Slip(along),
            _ => Status::Stick,
        }
    }

    fn normal(&self, vector: &Vector<D>) -> Vector<D> {
        self.contact.inward * self.contact.inward.dot(vector)
    }
}
