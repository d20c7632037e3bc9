//! A node on a face with contact: status, friction force, theory-manual equation (T7.3), and correction of the status.

use crate::boundary::coulomb::{Contact, Status, transverse};
use crate::nodal::Nodal;
use crate::tensor::Vector;

/// Part of a cell within which material cannot have come since the last step, if its node was not free to move then:
/// what F says of the gap is off by the curvature of the motion.
const KEPT: f64 = 0.05;

/// Times the force by which statuses may be contradicted, by which friction may be off Coulomb's law for the slip, or
/// for a node that alone sticks: the tolerance of the forces themselves.
const TURNED: f64 = 100.0;

/// Parts of the displacement that is round-off, beside friction, from which on a slip has left it.
const BESIDE: f64 = 1e-3;

/// Displacements that are round-off, of the smallest slip about which friction is linearised: one that is not known, or
/// less, is taken for it.
const LEAST: f64 = 1e3;

/// A node on a face with contact whose normal component nothing else holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactNode<const D: usize> {
    /// of the window
    pub node: usize,
    /// number of the face among the supports
    pub support: usize,
    /// that the face is normal to
    pub axis: usize,
    /// sign along the axis of what leads off the face
    pub inward: f64,
    /// of the face
    pub law: Contact,
    /// components that friction acts on: not those that a support, or another such face, decides
    pub along: [bool; D],
    /// m  at the start of the step; infinite without material
    pub gap: f64,
    /// N  part of the normal force that pore water carries
    pub water_force: f64,
    /// what it does
    pub status: Status<D>,
    /// whether it sticks as the one between others that slide in opposite directions
    pub is_neutral: bool,
    /// components that did not move in the last step
    pub rested: [bool; D],
    /// N/m  what resists a slip beside the direction of friction: in space, where it is known
    pub transverse_stiffness: f64,
    /// m  slip about which that is linear; that of the last step as it begins
    pub slip_length: f64,
}

/// What a displacement and reaction ask of a node: its status, and what resists a slip beside that.
pub(super) struct StatusCorrection<const D: usize> {
    pub status: Status<D>,
    pub transverse_stiffness: f64,
    pub slip_length: f64,
}

impl<const D: usize> ContactNode<D> {
    /// The status that the last displacement had, and which components were at rest; `edge` is that of the cell, m,
    /// `had_material` whether something moved behind the node: where nothing was, nothing rested.
    pub fn predict_status(&mut self, t: f64, guess: &[f64], edge: f64, had_material: bool) {
        let last = Vector::<D>::from_fn(|c, _| guess.get(Nodal::<D>::at(self.node, c)).copied().unwrap_or(0.0));
        let normal = self.inward * last[self.axis];
        if t > 0.0 && had_material && normal == 0.0 && self.gap < KEPT * edge {
            self.gap = 0.0;
        }
        let slip = Vector::from_fn(|component, _| if self.along[component] { last[component] } else { 0.0 });
        self.status = if self.law.lifts && normal > -self.gap {
            Status::Open
        } else {
            self.met(&slip)
        };
        (self.transverse_stiffness, self.slip_length) = (0.0, slip.norm());
        let has_friction = self.law.friction > 0.0;
        self.rested = std::array::from_fn(|component| {
            let held = component == self.axis || has_friction && self.along[component];
            t > 0.0 && had_material && self.gap == 0.0 && held && last[component] == 0.0
        });
    }

    /// On the face, coming along it by `slip`.
    pub fn met(&self, slip: &Vector<D>) -> Status<D> {
        match slip.try_normalize(0.0) {
            _ if self.law.friction == 0.0 => Status::Slip(Vector::zeros()),
            Some(direction) => Status::Slip(direction),
            None => Status::Stick,
        }
    }

    /// Whether the statuses decide a component.
    pub fn decides(&self, component: usize) -> bool {
        component == self.axis || self.along[component]
    }

    /// m  where the status holds a component.
    pub fn holds(&self) -> [Option<f64>; D] {
        std::array::from_fn(|component| match self.status {
            Status::Stick | Status::Slip(_) if component == self.axis => Some(-self.inward * self.gap),
            Status::Stick if self.along[component] => Some(0.0),
            _ => None,
        })
    }

    /// N  normal force of the face on the body, positive where it pushes.
    pub fn pushed(&self, reaction: &[f64]) -> f64 {
        let normal = reaction[Nodal::<D>::at(self.node, self.axis)];
        if self.status == Status::Open {
            0.0
        } else {
            self.inward * normal
        }
    }

    /// N  most that friction can be, by Coulomb's law for the effective normal force.
    pub fn limit(&self, reaction: &[f64]) -> f64 {
        self.law.friction * (self.pushed(reaction) - self.water_force).max(0.0)
    }

    /// The components along the face of a nodal array.
    fn tangential(&self, nodal: &[f64]) -> Vector<D> {
        Vector::from_fn(|c, _| {
            if self.along[c] {
                nodal[Nodal::<D>::at(self.node, c)]
            } else {
                0.0
            }
        })
    }

    /// N  force of the face along itself on the body.
    pub fn friction(&self, reaction: &[f64]) -> Vector<D> {
        match self.status {
            Status::Open => Vector::zeros(),
            Status::Stick | Status::Slip(_) => self.tangential(reaction),
        }
    }

    /// m  displacement along the face.
    pub fn slip(&self, u: &[f64]) -> Vector<D> {
        match self.status {
            Status::Open => Vector::zeros(),
            Status::Stick | Status::Slip(_) => self.tangential(u),
        }
    }

    /// Whether friction about `direction` is off Coulomb's law for the slip by more than the forces are known, N, and
    /// the slip beside it more than round-off, m.
    fn is_off(
        &self,
        direction: &Vector<D>,
        slip: &Vector<D>,
        now: Vector<D>,
        limit: f64,
        force: f64,
        length: f64,
    ) -> bool {
        let beside = transverse(slip, direction).norm();
        let off = self.friction_force(direction, slip, limit) + now * limit;
        slip.norm() > length && beside > BESIDE * length && off.norm() > TURNED * force
    }

    /// N  friction on the body where it slips along `direction` but for `slip`, m: Newton's linear form of
    /// mu N u_t / |u_t| about the last slip, of which the part beside `direction` turns it.
    pub fn friction_force(&self, direction: &Vector<D>, slip: &Vector<D>, limit: f64) -> Vector<D> {
        let along = -direction * limit;
        if self.transverse_stiffness == 0.0 {
            return along;
        }
        along - transverse(slip, direction) * self.transverse_stiffness
    }

    /// Row-major square of what resists a slip beside the direction of friction, N/m; none where nothing does.
    pub fn resists(&self) -> Option<Vec<f64>> {
        let Status::Slip(direction) = self.status else {
            return None;
        };
        let along = self.along.map(|is_along| f64::from(u8::from(is_along)));
        let entries = (0..D * D).map(|k| {
            let i = k / D;
            let j = k % D;
            self.transverse_stiffness * (along[i] * f64::from(u8::from(i == j)) - direction[i] * direction[j])
        });
        (self.transverse_stiffness > 0.0).then(|| entries.collect())
    }

    /// A status with what then resists a slip beside it, linear about a slip of `slip_length`, m.
    fn linearised(&self, status: Status<D>, slip_length: f64, reaction: &[f64]) -> StatusCorrection<D> {
        let slips = D > 2 && self.law.friction > 0.0 && matches!(status, Status::Slip(_));
        let transverse_stiffness = if slips { self.limit(reaction) / slip_length } else { 0.0 };
        StatusCorrection {
            status,
            transverse_stiffness,
            slip_length,
        }
    }

    /// What displacement and reaction ask for.
    pub fn corrected(&self, u: &[f64], reaction: &[f64], force: f64, length: f64) -> StatusCorrection<D> {
        let least = LEAST * length;
        let kept = StatusCorrection {
            status: self.status,
            transverse_stiffness: self.transverse_stiffness,
            slip_length: self.slip_length,
        };
        if self.status == Status::Open {
            let beyond = -self.gap - self.inward * u[Nodal::<D>::at(self.node, self.axis)];
            return if beyond > length {
                self.linearised(self.met(&self.tangential(u)), least, reaction)
            } else {
                kept
            };
        }
        if self.law.lifts && self.pushed(reaction) < -force {
            return self.linearised(Status::Open, least, reaction);
        }
        match self.status {
            Status::Stick => {
                let held = self.friction(reaction);
                let doubt = if self.is_neutral { TURNED * force } else { force };
                let slips = held.norm() > self.limit(reaction) + doubt;
                if slips {
                    self.linearised(Status::Slip(-held.normalize()), least, reaction)
                } else {
                    kept
                }
            }
            Status::Slip(direction) if self.law.friction > 0.0 => {
                let slip = self.slip(u);
                let along = slip.dot(&direction);
                if along < -length {
                    return self.linearised(Status::Stick, least, reaction);
                }
                // In space friction turns with the slip: once it resists what is beside it, as else a node that hardly
                // slips would go where friction does not look. On a line there is nothing to turn.
                if D > 2 && self.transverse_stiffness == 0.0 && self.limit(reaction) > force {
                    return self.linearised(self.status, self.slip_length.max(least), reaction);
                }
                match slip.try_normalize(0.0) {
                    Some(now) if self.is_off(&direction, &slip, now, self.limit(reaction), force, length) => {
                        let length = along.max(least);
                        let turned = (direction * (length - along) + slip).normalize();
                        self.linearised(Status::Slip(turned), length, reaction)
                    }
                    _ => kept,
                }
            }
            _ => kept,
        }
    }
}
