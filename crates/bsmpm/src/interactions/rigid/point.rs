//! A material point in contact with a rigid body: forces, theory-manual equations (T7.9), (T7.3), and contact status.

use crate::nodal::Nodal;
use crate::tensor::Vector;

/// Contact status of a material point at an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactStatus {
    /// Separated: no force.
    Open,
    /// In contact, without slip.
    Stick,
    /// In contact, sliding. Friction on the material acts along this unit vector of tangential components; 0 without
    /// friction.
    Slip(Along),
}

/// Components along the tangents of an outline; in 2-D only the first is used.
pub type Along = [f64; 2];

fn size(along: Along) -> f64 {
    along[0].hypot(along[1])
}

fn product(a: Along, b: Along) -> f64 {
    if b[1] == 0.0 {
        a[0] * b[0]
    } else {
        a[0] * b[0] + a[1] * b[1]
    }
}

/// Error of linearised friction, as a fraction of Coulomb's limit, above which its direction is corrected (3-D).
const TURNED: f64 = 0.02;

/// A material point near a body. Contact forces act where its domain is nearest to the outline, through the shape
/// functions of its own cell.
#[derive(Clone, Debug)]
pub(super) struct RigidPoint<const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Index of the material point.
    pub point: usize,
    /// First node of its cell.
    pub first_node: usize,
    /// N_I of the cell's nodes at the contact position.
    pub N: Vec<f64>,
    /// Unit normal out of the body, at the end of its motion.
    pub normal: Vector<D>,
    /// Gap between the body at the end of the step and the point at the start (m).
    pub gap: f64,
    /// Predicted tangential motion of the body in the step (m).
    pub motion: Along,
    /// Predicted motion of the body towards the point in the step (m).
    pub approach: f64,
    /// Length of the predicted motion of the body at the contact position (m).
    pub way: f64,
    /// Lever arm from the body's reference point to the contact position at the end of the step (m).
    pub arm: Vector<D>,
    /// Penalty stiffness (N/m).
    pub stiffness: f64,
    /// Friction coefficient (-).
    pub friction: f64,
    /// Part of the normal force that pore water carries (N).
    pub water: f64,
    /// Tangential force at the end of the last step (N).
    pub carried: Along,
    /// Contact status.
    pub status: ContactStatus,
    /// Stiffness across the direction of friction, as a fraction of the penalty stiffness (3-D).
    pub transverse_share: f64,
}

/// Returns the unit tangents for a normal; in 2-D the normal rotated by a right angle, and zero.
pub(super) fn tangents<const D: usize>(normal: &Vector<D>) -> [Vector<D>; 2] {
    let mut tangents = [Vector::zeros(); 2];
    if D == 2 {
        (tangents[0][0], tangents[0][1]) = (-normal[1], normal[0]);
        return tangents;
    }
    // The first tangent is the coordinate axis with the least normal component, projected onto the tangential plane;
    // the second is the cross product of normal and first tangent.
    let least = (0..D)
        .min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
        .unwrap_or(0);
    let mut axis = Vector::<D>::zeros();
    axis[least] = 1.0;
    let first = (axis - normal * normal[least]).normalize();
    let second = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| normal[i] * first[j] - normal[j] * first[i]);
    [first, Vector::from_fn(|k, _| second[k])]
}

/// Returns the components of a vector along tangents.
pub(super) fn along<const D: usize>(tangents: &[Vector<D>; 2], v: &Vector<D>) -> Along {
    [tangents[0].dot(v), if D == 2 { 0.0 } else { tangents[1].dot(v) }]
}

impl<const D: usize> RigidPoint<D> {
    /// Returns the vector with these tangential components.
    pub fn vector(&self, along: Along) -> Vector<D> {
        let [first, second] = tangents(&self.normal);
        if D == 2 {
            first * along[0]
        } else {
            first * along[0] + second * along[1]
        }
    }

    fn components(&self, v: &Vector<D>) -> Along {
        along(&tangents(&self.normal), v)
    }

    /// Returns the displacement of the material at the contact position (m).
    pub fn displacement(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mut sum = Vector::<D>::zeros();
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                sum[component] += N * u[Nodal::<D>::at(self.first_node + offset, component)];
            }
        }
        sum
    }

    /// Returns the displacement of the body at the contact position for small motions of the body (m).
    pub fn carried_by(&self, motions: &Vector<3>) -> Vector<D> {
        let mut carried = Vector::<D>::from_fn(|k, _| motions[k]);
        if D == 2 {
            carried[0] -= motions[2] * self.arm[1];
            carried[1] += motions[2] * self.arm[0];
        }
        carried
    }

    /// Returns a force at the contact position as forces on the body's motions (N, N, N m; in 3-D N).
    pub fn on_motions(&self, force: &Vector<D>) -> Vector<3> {
        let turns = self.arm[0] * force[1] - self.arm[1] * force[0];
        Vector::<3>::from_fn(|k, _| if k < D { force[k] } else { turns })
    }

    /// Returns the tangential displacement at the contact position for small motions of the body (m).
    pub fn along_motion(&self, motions: &Vector<3>) -> Along {
        self.components(&self.carried_by(motions))
    }

    /// Returns the gap at the start of the step (m).
    pub fn gap_before(&self) -> f64 {
        self.gap + self.approach
    }

    /// Returns the gap of material that has `moved` relative to the body (m).
    pub fn gap_after(&self, moved: &Vector<D>) -> f64 {
        self.gap + self.normal.dot(moved)
    }

    /// Returns the slip of the material relative to the body (m).
    pub fn slip(&self, moved: &Vector<D>) -> Along {
        let along = self.components(moved);
        [along[0] - self.motion[0], along[1] - self.motion[1]]
    }

    /// Returns the length of the slip (m).
    pub fn slipped(&self, moved: &Vector<D>) -> f64 {
        size(self.slip(moved))
    }

    /// Returns the normal and the tangential force on the material for the present status (N).
    pub fn pushed(&self, moved: &Vector<D>) -> (f64, Along) {
        let normal = -self.stiffness * self.gap_after(moved);
        match self.status {
            ContactStatus::Open => (0.0, [0.0; 2]),
            ContactStatus::Stick => (normal, self.held(moved)),
            ContactStatus::Slip(towards) => {
                let beside = self.transverse(towards, || self.held(moved));
                let limit = self.limit(normal);
                (normal, [0, 1].map(|k| towards[k] * limit + beside[k]))
            }
        }
    }

    /// Returns Coulomb's limit for the effective normal force (N).
    fn limit(&self, normal: f64) -> f64 {
        let effective = if self.water > 0.0 {
            (normal - self.water).max(0.0)
        } else {
            normal
        };
        self.friction * effective
    }

    /// Returns the part of friction across `towards`: mu N t/|t| linearised about the trial force t of the last
    /// correction (Newton).
    fn transverse(&self, towards: Along, held: impl Fn() -> Along) -> Along {
        if self.transverse_share == 0.0 {
            return [0.0; 2];
        }
        let held = held();
        let along = product(towards, held);
        [0, 1].map(|k| self.transverse_share * (held[k] - towards[k] * along))
    }

    /// Sets a status and linearises friction about the displacement `moved` (m).
    pub fn take(&mut self, status: ContactStatus, moved: &Vector<D>) {
        let held = size(self.held(moved));
        let limit = self.limit(-self.stiffness * self.gap_after(moved));
        let turns = D > 2 && matches!(status, ContactStatus::Slip(_)) && held > 0.0;
        self.status = status;
        self.transverse_share = if turns { (limit.max(0.0) / held).min(1.0) } else { 0.0 };
    }

    /// Returns the tangential trial force, which acts if the point sticks (N).
    fn held(&self, moved: &Vector<D>) -> Along {
        let slip = self.slip(moved);
        [0, 1].map(|k| self.carried[k] - self.stiffness * slip[k])
    }

    /// Returns the force on the material (N).
    pub fn force(&self, moved: &Vector<D>) -> Vector<D> {
        let (normal, along) = self.pushed(moved);
        self.normal * normal + self.vector(along)
    }

    /// Returns the force on the material at the start of a step without inertia (N).
    fn before(&self) -> Vector<D> {
        let depth = -self.gap_before();
        if depth > 0.0 {
            self.normal * (self.stiffness * depth) + self.vector(self.carried)
        } else {
            Vector::zeros()
        }
    }

    /// Returns the mean force of the step, which the work uses, and the force at the end less the mean (N). With
    /// inertia, the force at the end replaces the mean, because the penalty stiffness, and with it the force at the
    /// start, depends on the step size.
    pub fn mean(&self, moved: &Vector<D>, inertia: bool) -> (Vector<D>, Vector<D>) {
        let after = self.force(moved);
        let mean = if inertia { after } else { (self.before() + after) * 0.5 };
        (mean, after - mean)
    }

    /// Returns the derivative of the force in the direction `moved` (N); `whole`: including the unsymmetric part.
    pub fn rate(&self, moved: &Vector<D>, whole: bool) -> Vector<D> {
        let normal = -self.stiffness * self.normal.dot(moved);
        match self.status {
            ContactStatus::Open => Vector::zeros(),
            ContactStatus::Stick => self.rate_if_held(moved),
            ContactStatus::Slip(towards) => {
                let transverse =
                    self.transverse(towards, || self.components(moved).map(|along| -self.stiffness * along));
                let beside = self.vector(transverse);
                let friction_force = if whole { self.friction * normal } else { 0.0 };
                self.normal * normal + self.vector(towards.map(|part| part * friction_force)) + beside
            }
        }
    }

    /// As [`Self::rate`], for a point that sticks.
    fn rate_if_held(&self, moved: &Vector<D>) -> Vector<D> {
        let held = self.components(moved).map(|along| self.stiffness * along);
        -self.normal * (self.stiffness * self.normal.dot(moved)) - self.vector(held)
    }

    /// As [`Self::rate`], with the symmetric part only and with sliding points that have friction made to stick.
    pub fn rate_if_stuck(&self, moved: &Vector<D>) -> Vector<D> {
        match self.status {
            ContactStatus::Slip(_) if self.friction > 0.0 => self.rate_if_held(moved),
            _ => self.rate(moved, false),
        }
    }

    /// Returns the work of friction on the slip (N m), not positive; 0 unless the point slides.
    pub fn friction_work(&self, moved: &Vector<D>) -> f64 {
        match self.status {
            ContactStatus::Slip(_) => product(self.pushed(moved).1, self.slip(moved)),
            ContactStatus::Open | ContactStatus::Stick => 0.0,
        }
    }

    /// Returns the status of a closed point after the displacement `moved` (m).
    pub fn met(&self, moved: &Vector<D>) -> ContactStatus {
        let held = self.held(moved);
        let limit = self.limit(-self.stiffness * self.gap_after(moved));
        match self.friction {
            0.0 => ContactStatus::Slip([0.0; 2]),
            _ if size(held) > limit.max(0.0) => ContactStatus::Slip(held.map(|part| part / size(held))),
            _ => ContactStatus::Stick,
        }
    }

    /// Returns the status that follows from the displacement `moved` (m), and the force by which it contradicts the
    /// present status (N). `force` (N) and `length` (m) are the tolerances. A displacement is converted to a force with
    /// the stiffness of the soil.
    pub fn corrected(&self, moved: &Vector<D>, force: f64, length: f64) -> (ContactStatus, f64) {
        let soil = 1.0 / super::PENALTY;
        if self.status == ContactStatus::Open {
            let depth = -self.gap_after(moved);
            return if depth > length {
                (self.met(moved), soil * self.stiffness * depth)
            } else {
                (ContactStatus::Open, 0.0)
            };
        }
        let (normal, along) = self.pushed(moved);
        let limit = self.limit(normal.max(0.0));
        match self.status {
            _ if normal < -force => (ContactStatus::Open, -normal),
            ContactStatus::Stick if size(along) > limit + force => (
                ContactStatus::Slip(along.map(|part| part / size(along))),
                size(along) - limit,
            ),
            ContactStatus::Slip(towards) if towards != [0.0; 2] => self.slip_on(towards, moved, limit, force),
            status => (status, 0.0),
        }
    }

    /// As [`Self::corrected`], for a point that slides `towards`; `limit` is Coulomb's limit (N).
    fn slip_on(&self, towards: Along, moved: &Vector<D>, limit: f64, force: f64) -> (ContactStatus, f64) {
        let soil = 1.0 / super::PENALTY;
        let held = self.held(moved);
        let against = product(towards, held);
        let sticks = if D == 2 {
            against < limit - force
        } else {
            size(held) < limit - force || against <= 0.0
        };
        if sticks {
            return (ContactStatus::Stick, soil * (limit - against));
        }
        // In 2-D, friction has one direction only.
        if D == 2 {
            return (self.status, 0.0);
        }
        let now = held.map(|part| part / size(held));
        let (_, friction_force) = self.pushed(moved);
        let off = (friction_force[0] - limit * now[0]).hypot(friction_force[1] - limit * now[1]);
        if off > TURNED * limit + force {
            (ContactStatus::Slip(now), off)
        } else {
            (self.status, 0.0)
        }
    }

    /// Returns the symmetric part of its stiffness, a row-major square with D unknowns per node of the cell (N/m).
    pub fn block(&self) -> Vec<f64> {
        let order = self.N.len() * D;
        let mut block = vec![0.0; order * order];
        let columns: [Vector<D>; D] = std::array::from_fn(|j| {
            let unit = Vector::from_fn(|i, _| f64::from(u8::from(i == j)));
            -self.rate(&unit, false)
        });
        for (a, N_a) in self.N.iter().enumerate() {
            for (b, N_b) in self.N.iter().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    for i in 0..D {
                        block[(a * D + i) * order + b * D + j] = N_a * N_b * column[i];
                    }
                }
            }
        }
        block
    }
}
