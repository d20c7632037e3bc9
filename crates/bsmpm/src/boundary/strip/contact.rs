//! Contact law of a surface point of a footing that can slide or separate, theory-manual equations (T7.5), (T7.6).

use crate::boundary::coulomb::{Contact, Status, transverse};
use crate::tensor::Vector;

/// Times the traction by which statuses may be contradicted, by which friction may be off Coulomb's law for its trial:
/// the tolerance of the forces themselves.
const TURNED: f64 = 100.0;

/// Contact of a strip (T7.5), (T7.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripContact<const D: usize> {
    /// friction, and whether material comes off it
    pub law: Contact,
    /// unit normal of the base, towards the material
    pub inward: Vector<D>,
}

/// The law at a point, and what the point does in a step. Friction is along the unit vector of [`Status::Slip`], which
/// is zero where there is no friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactState<const D: usize> {
    contact: StripContact<D>,
    pub status: Status<D>,
    /// Pa  what pore water carries of the pressure
    pub water: f64,
    transverse_share: f64, // of a tangential trial, the part that friction leaves of what is beside its direction; in space
    open_before: bool,     // at the start of the step
}

impl<const D: usize> StripContact<D> {
    /// Pa  the traction on the body of what is `carried` from step to step.
    pub fn acting(&self, carried: &Vector<D>) -> Vector<D> {
        if self.is_open(carried) {
            Vector::zeros()
        } else {
            *carried
        }
    }

    /// Whether what is carried is a gap and no traction.
    pub fn is_open(&self, carried: &Vector<D>) -> bool {
        self.law.lifts && self.inward.dot(carried) < 0.0
    }
}

impl<const D: usize> ContactState<D> {
    /// At the start of a step, as far as what is `carried` reports.
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

    /// Pa  on the body at the start of the step.
    pub fn before(&self, carried: &Vector<D>) -> Vector<D> {
        self.contact.acting(carried)
    }

    /// What the elastic law goes on from, Pa: material that comes back has no friction yet.
    pub fn start(&self, carried: &Vector<D>) -> Vector<D> {
        if self.open_before {
            self.normal(carried)
        } else {
            *carried
        }
    }

    /// Pa  on the body, of an elastic law's `trial`.
    pub fn traction(&self, trial: &Vector<D>) -> Vector<D> {
        self.part(trial) + self.friction(trial)
    }

    /// The part of a traction, or of a displacement by what stiffness it has, that acts in the direction of itself.
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

    /// Pa  the most that friction can be at a pressure, by Coulomb's law for the effective one.
    fn limit(&self, pressure: f64) -> f64 {
        let effective = if self.water > 0.0 {
            (pressure - self.water).max(0.0)
        } else {
            pressure
        };
        self.contact.law.friction * effective
    }

    /// Pa  friction under an elastic law's `trial`.
    fn friction(&self, trial: &Vector<D>) -> Vector<D> {
        match self.status {
            Status::Slip(along) if self.water > 0.0 => along * self.limit(self.contact.inward.dot(trial)),
            _ => self.rubbing(trial),
        }
    }

    /// How friction grows with a normal part.
    pub fn rubbing(&self, vector: &Vector<D>) -> Vector<D> {
        match self.status {
            Status::Slip(along) => along * (self.contact.law.friction * self.contact.inward.dot(vector)),
            Status::Open | Status::Stick => Vector::zeros(),
        }
    }

    /// Pa  what the next step goes on from. Of a point that is off the material the penalty times what the strip is
    /// ahead of it: against the normal the gap, along it what it has moved on since it came off.
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

    /// Part of the step in which the point is on the material, if it comes off it or meets it; 1 if it does not.
    pub fn share(&self, carried: &Vector<D>, trial: &Vector<D>) -> f64 {
        let [before, after] = [carried, trial].map(|traction| self.contact.inward.dot(traction));
        match (self.open_before, self.status == Status::Open) {
            (false, true) if before > after => (before / (before - after)).clamp(0.0, 1.0),
            (true, false) if after > before => (after / (after - before)).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }

    /// m  the gap that a step starts with.
    pub fn gap_before(&self, carried: &Vector<D>, penalty: f64) -> f64 {
        if self.open_before {
            -self.contact.inward.dot(carried) / penalty
        } else {
            0.0
        }
    }

    /// m  the gap under a `trial`.
    pub fn gap(&self, trial: &Vector<D>, penalty: f64) -> f64 {
        if self.status == Status::Open {
            (-self.contact.inward.dot(trial) / penalty).max(0.0)
        } else {
            0.0
        }
    }

    /// m  how far a point that has come back has moved along itself while it was off.
    pub fn moved_on(&self, carried: &Vector<D>, penalty: f64) -> f64 {
        let came_back = self.open_before && self.status != Status::Open;
        if came_back {
            (carried - self.normal(carried)).norm() / penalty
        } else {
            0.0
        }
    }

    /// Pa  normal traction, positive where the strip pushes.
    pub fn pressure(&self, trial: &Vector<D>) -> f64 {
        if self.status == Status::Open {
            0.0
        } else {
            self.contact.inward.dot(trial)
        }
    }

    /// m  the part of a slip that friction takes: of the `trial`, what the return to Coulomb's cone took off.
    pub fn slid(&self, trial: &Vector<D>, penalty: f64) -> Vector<D> {
        match self.status {
            Status::Slip(_) => (trial - self.traction(trial)) / penalty,
            Status::Open | Status::Stick => Vector::zeros(),
        }
    }

    /// The status that the last step's displacement makes likely; `before`: what the law started from. What is on the
    /// material as the step begins is expected to stay on it, even if nothing presses there yet: initial stress does
    /// from the first step on, and soil that yields could not stand if all points let go of it.
    pub fn recall(&mut self, trial: &Vector<D>, before: &Vector<D>) {
        let [pressed, presses] = [before, trial].map(|traction| self.contact.inward.dot(traction));
        if self.contact.law.lifts && self.open_before && presses < 0.0 {
            self.status = Status::Open;
            return;
        }
        let pressure = if presses > 0.0 { presses } else { pressed };
        self.take(self.met(trial, pressure, 0.0), trial);
    }

    /// Corrects the status that a `trial` contradicts by more than `doubt`, Pa; whether it did.
    pub fn correct(&mut self, trial: &Vector<D>, doubt: f64) -> bool {
        let before = self.status;
        let status = self.corrected(trial, doubt);
        if status != before {
            self.take(status, trial);
        }
        status != before
    }

    /// Takes a status, about the `trial` that asked for it: of friction in space the derivative of mu p t/|t| is beside
    /// its direction mu p/|t|.
    fn take(&mut self, status: Status<D>, trial: &Vector<D>) {
        self.status = status;
        let limit = self.limit(self.contact.inward.dot(trial).max(0.0));
        let shear = (trial - self.normal(trial)).norm();
        let turns = D > 2 && matches!(status, Status::Slip(_)) && shear > 0.0;
        self.transverse_share = if turns { (limit / shear).min(1.0) } else { 0.0 };
    }

    /// The status that a `trial` asks for, where it contradicts the present one by more than `doubt`, Pa.
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
                    // Whoever slid against friction has to stick first: to turn it at once goes back and forth for
                    // ever.
                    slid if slid < limit - doubt => Status::Stick,
                    _ if is_off => Status::Slip(shear.normalize()),
                    _ => self.status,
                }
            }
            Status::Slip(_) if pressure > doubt => self.met(trial, pressure, 0.0),
            Status::Slip(_) => self.status,
        }
    }

    /// On the material, under a `trial` of that pressure.
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
