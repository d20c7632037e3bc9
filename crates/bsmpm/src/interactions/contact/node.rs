//! A node on a face with contact: status, friction force, theory-manual equation (T7.3), and correction of the status.

use crate::interactions::coulomb::{Contact, Status, transverse};
use crate::nodal::Nodal;
use crate::tensor::Vector;

/// Gap, in cell edges, below which a node without normal displacement in the last step counts as closed: a gap computed
/// from F is inaccurate where the deformation varies.
const KEPT: f64 = 0.05;

/// Tolerance for the direction of friction, and for the stick status of a neutral node, as a multiple of the tolerance
/// of forces.
const TURNED: f64 = 100.0;

/// Slip across the direction of friction, as a fraction of the round-off length, above which the direction may be
/// corrected.
const BESIDE: f64 = 1e-3;

/// Smallest slip about which friction is linearised, in round-off lengths. It replaces an unknown or smaller slip.
const LEAST: f64 = 1e3;

/// A node on a contact face. No other condition prescribes its normal component.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactNode<const D: usize> {
    /// Local node.
    pub node: usize,
    /// Index of the face among the supports.
    pub support: usize,
    /// Axis normal to the face.
    pub axis: usize,
    /// Sign of the inward normal along the axis.
    pub inward: f64,
    /// Contact law of the face.
    pub law: Contact,
    /// Components on which friction acts; not those that a support or another contact face decides.
    pub along: [bool; D],
    /// Gap at the start of the step (m); infinite without material.
    pub gap: f64,
    /// Part of the normal force that pore water carries (N).
    pub water_force: f64,
    /// Contact status.
    pub status: Status<D>,
    /// Whether the node was made to stick between nodes that slide in opposite directions.
    pub is_neutral: bool,
    /// Components without displacement in the last step.
    pub rested: [bool; D],
    /// Stiffness against slip across the direction of friction (N/m); 0 in 2-D.
    pub transverse_stiffness: f64,
    /// Slip about which friction is linearised (m); at first the slip of the last step.
    pub slip_length: f64,
}

/// Status and linearisation of friction that follow from a displacement and reaction.
pub(super) struct StatusCorrection<const D: usize> {
    pub status: Status<D>,
    pub transverse_stiffness: f64,
    pub slip_length: f64,
}

impl<const D: usize> ContactNode<D> {
    /// Predicts the status, and the components at rest, from `guess`, the displacement of the last step (m). `edge` is
    /// the cell edge (m). `had_material` states whether material moved behind the node; if not, no component counts as
    /// at rest.
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

    /// Returns the status of a closed node with this `slip` (m).
    pub fn met(&self, slip: &Vector<D>) -> Status<D> {
        match slip.try_normalize(0.0) {
            _ if self.law.friction == 0.0 => Status::Slip(Vector::zeros()),
            Some(direction) => Status::Slip(direction),
            None => Status::Stick,
        }
    }

    /// Returns whether the contact status decides a component.
    pub fn decides(&self, component: usize) -> bool {
        component == self.axis || self.along[component]
    }

    /// Returns the displacements that the status prescribes (m).
    pub fn holds(&self) -> [Option<f64>; D] {
        std::array::from_fn(|component| match self.status {
            Status::Stick | Status::Slip(_) if component == self.axis => Some(-self.inward * self.gap),
            Status::Stick if self.along[component] => Some(0.0),
            _ => None,
        })
    }

    /// Returns the normal force of the face on the body, positive in compression (N).
    pub fn pushed(&self, reaction: &[f64]) -> f64 {
        let normal = reaction[Nodal::<D>::at(self.node, self.axis)];
        if self.status == Status::Open {
            0.0
        } else {
            self.inward * normal
        }
    }

    /// Returns Coulomb's limit for the effective normal force (N).
    pub fn limit(&self, reaction: &[f64]) -> f64 {
        self.law.friction * (self.pushed(reaction) - self.water_force).max(0.0)
    }

    /// Returns the components of a nodal array on which friction acts.
    fn tangential(&self, nodal: &[f64]) -> Vector<D> {
        Vector::from_fn(|c, _| {
            if self.along[c] {
                nodal[Nodal::<D>::at(self.node, c)]
            } else {
                0.0
            }
        })
    }

    /// Returns the tangential force of the face on the body (N).
    pub fn friction(&self, reaction: &[f64]) -> Vector<D> {
        match self.status {
            Status::Open => Vector::zeros(),
            Status::Stick | Status::Slip(_) => self.tangential(reaction),
        }
    }

    /// Returns the displacement along the face (m).
    pub fn slip(&self, u: &[f64]) -> Vector<D> {
        match self.status {
            Status::Open => Vector::zeros(),
            Status::Stick | Status::Slip(_) => self.tangential(u),
        }
    }

    /// Returns whether linearised friction along `direction` differs from Coulomb's law along `now` by more than the
    /// tolerance, based on `force` (N), while the slip and its part across `direction` exceed round-off, based on
    /// `length` (m).
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

    /// Returns the friction on the body (N): mu N u_t / |u_t|, linearised about the last slip along `direction`. The
    /// part of `slip` (m) across `direction` rotates the friction.
    pub fn friction_force(&self, direction: &Vector<D>, slip: &Vector<D>, limit: f64) -> Vector<D> {
        let along = -direction * limit;
        if self.transverse_stiffness == 0.0 {
            return along;
        }
        along - transverse(slip, direction) * self.transverse_stiffness
    }

    /// Returns the stiffness against slip across the direction of friction, row-major, D by D (N/m); `None` if zero.
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

    /// Returns a status with friction linearised about a slip of `slip_length` (m).
    fn linearised(&self, status: Status<D>, slip_length: f64, reaction: &[f64]) -> StatusCorrection<D> {
        let slips = D > 2 && self.law.friction > 0.0 && matches!(status, Status::Slip(_));
        let transverse_stiffness = if slips { self.limit(reaction) / slip_length } else { 0.0 };
        StatusCorrection {
            status,
            transverse_stiffness,
            slip_length,
        }
    }

    /// Returns the status and linearisation that follow from the displacement `u` (m) and the reaction (N), with the
    /// tolerances `force` (N) and `length` (m).
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
                // In 3-D, friction rotates with the slip. It first gets a stiffness across its direction; without it, a
                // node with little slip would move freely across. In 2-D there is one direction only.
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
