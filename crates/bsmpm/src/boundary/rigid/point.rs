//! A material point in contact with a rigid body: forces, theory-manual equations (T7.9), (T7.3), and contact status.

use crate::nodal::Nodal;
use crate::tensor::Vector;

/// What a point does at an outline in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactStatus {
    /// Off it: no force.
    Open,
    /// On it, and held along it.
    Stick,
    /// On it, and slipping towards here along it: a unit vector of its tangents' components; 0 without friction.
    Slip(Along),
}

/// Components along the tangents of an outline: of a plane the first.
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

/// Part of the friction by which it may be off Coulomb's law for what would hold the point, in space.
const TURNED: f64 = 0.02;

/// A point near a body. Forces on it act where its box comes nearest to the outline, by the functions of its own cell.
#[derive(Clone, Debug)]
pub(super) struct RigidPoint<const D: usize> {
    /// number of the body
    pub body: usize,
    /// number of the point
    pub point: usize,
    /// first node of its cell
    pub first_node: usize,
    /// N_I of the cell's nodes at that place
    pub N: Vec<f64>,
    /// unit normal out of the body, at the end of its motion
    pub normal: Vector<D>,
    /// m  from the body as it is at the end of the step, of the point as it is at the start
    pub gap: f64,
    /// m  of the body along the outline in the step, as predicted
    pub motion: Along,
    /// m  of the body towards the point in the step, as predicted
    pub approach: f64,
    /// m  of the body there in any direction
    pub way: f64,
    /// m  from the body's reference point to the place, at the end
    pub arm: Vector<D>,
    /// N/m
    pub stiffness: f64,
    /// -
    pub friction: f64,
    /// N  part of the normal force that pore water carries
    pub water: f64,
    /// N  along the outline, from the last step
    pub carried: Along,
    /// what it does
    pub status: ContactStatus,
    /// of what would hold it, the part that friction leaves of what is beside its direction; in space
    pub transverse_share: f64,
}

/// The tangents of an outline: of a plane the normal turned by a right angle.
pub(super) fn tangents<const D: usize>(normal: &Vector<D>) -> [Vector<D>; 2] {
    let mut tangents = [Vector::zeros(); 2];
    if D == 2 {
        (tangents[0][0], tangents[0][1]) = (-normal[1], normal[0]);
        return tangents;
    }
    // The axis that is least along the normal, without its part along it; and what is across both.
    let least = (0..D)
        .min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
        .unwrap_or(0);
    let mut axis = Vector::<D>::zeros();
    axis[least] = 1.0;
    let first = (axis - normal * normal[least]).normalize();
    let second = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| normal[i] * first[j] - normal[j] * first[i]);
    [first, Vector::from_fn(|k, _| second[k])]
}

/// Components of a vector along tangents.
pub(super) fn along<const D: usize>(tangents: &[Vector<D>; 2], v: &Vector<D>) -> Along {
    [tangents[0].dot(v), if D == 2 { 0.0 } else { tangents[1].dot(v) }]
}

impl<const D: usize> RigidPoint<D> {
    /// The vector of components along the outline.
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

    /// m  of the material at the place.
    pub fn displacement(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mut sum = Vector::<D>::zeros();
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                sum[component] += N * u[Nodal::<D>::at(self.first_node + offset, component)];
            }
        }
        sum
    }

    /// m  of the body's place, of small motions of the body.
    pub fn carried_by(&self, motions: &Vector<3>) -> Vector<D> {
        let mut carried = Vector::<D>::from_fn(|k, _| motions[k]);
        if D == 2 {
            carried[0] -= motions[2] * self.arm[1];
            carried[1] += motions[2] * self.arm[0];
        }
        carried
    }

    /// N, N, N m  of a force at the place, as the body's motions feel it; in space N.
    pub fn on_motions(&self, force: &Vector<D>) -> Vector<3> {
        let turns = self.arm[0] * force[1] - self.arm[1] * force[0];
        Vector::<3>::from_fn(|k, _| if k < D { force[k] } else { turns })
    }

    /// m  along the outline of small motions of the body.
    pub fn along_motion(&self, motions: &Vector<3>) -> Along {
        self.components(&self.carried_by(motions))
    }

    /// m  from the outline as the step begins.
    pub fn gap_before(&self) -> f64 {
        self.gap + self.approach
    }

    /// m  from the outline, of material that has `moved` as seen from the body.
    pub fn gap_after(&self, moved: &Vector<D>) -> f64 {
        self.gap + self.normal.dot(moved)
    }

    /// m  of the material along the outline.
    pub fn slip(&self, moved: &Vector<D>) -> Along {
        let along = self.components(moved);
        [along[0] - self.motion[0], along[1] - self.motion[1]]
    }

    /// m  its length.
    pub fn slipped(&self, moved: &Vector<D>) -> f64 {
        size(self.slip(moved))
    }

    /// N  normal and tangential force on the material, that of its status.
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

    /// N  the most that friction can be, by Coulomb's law for the effective normal force.
    fn limit(&self, normal: f64) -> f64 {
        let effective = if self.water > 0.0 {
            (normal - self.water).max(0.0)
        } else {
            normal
        };
        self.friction * effective
    }

    /// What friction leaves of what is beside its direction: Newton's linear form of mu N t/|t| about the last t.
    fn transverse(&self, towards: Along, held: impl Fn() -> Along) -> Along {
        if self.transverse_share == 0.0 {
            return [0.0; 2];
        }
        let held = held();
        let along = product(towards, held);
        [0, 1].map(|k| self.transverse_share * (held[k] - towards[k] * along))
    }

    /// Takes a status that what has `moved` asks for.
    pub fn take(&mut self, status: ContactStatus, moved: &Vector<D>) {
        let held = size(self.held(moved));
        let limit = self.limit(-self.stiffness * self.gap_after(moved));
        let turns = D > 2 && matches!(status, ContactStatus::Slip(_)) && held > 0.0;
        self.status = status;
        self.transverse_share = if turns { (limit.max(0.0) / held).min(1.0) } else { 0.0 };
    }

    /// N  tangential force if it sticks.
    fn held(&self, moved: &Vector<D>) -> Along {
        let slip = self.slip(moved);
        [0, 1].map(|k| self.carried[k] - self.stiffness * slip[k])
    }

    /// N  force on the material.
    pub fn force(&self, moved: &Vector<D>) -> Vector<D> {
        let (normal, along) = self.pushed(moved);
        self.normal * normal + self.vector(along)
    }

    /// N  force on the material as a step without inertia begins.
    fn before(&self) -> Vector<D> {
        let depth = -self.gap_before();
        if depth > 0.0 {
            self.normal * (self.stiffness * depth) + self.vector(self.carried)
        } else {
            Vector::zeros()
        }
    }

    /// N  mean of the forces as the step begins and ends, which counts for work; and what the one at its end is more.
    /// With inertia it is the one at the end: the stiffness, and with it the force at the start, is one of the step.
    pub fn mean(&self, moved: &Vector<D>, inertia: bool) -> (Vector<D>, Vector<D>) {
        let after = self.force(moved);
        let mean = if inertia { after } else { (self.before() + after) * 0.5 };
        (mean, after - mean)
    }

    /// N  change of the force with a change of what has moved; `whole`: with the part that is not symmetric.
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

    /// N  the same of a point that sticks.
    fn rate_if_held(&self, moved: &Vector<D>) -> Vector<D> {
        let held = self.components(moved).map(|along| self.stiffness * along);
        -self.normal * (self.stiffness * self.normal.dot(moved)) - self.vector(held)
    }

    /// N  the same with friction that holds whatever touches.
    pub fn rate_if_stuck(&self, moved: &Vector<D>) -> Vector<D> {
        match self.status {
            ContactStatus::Slip(_) if self.friction > 0.0 => self.rate_if_held(moved),
            _ => self.rate(moved, false),
        }
    }

    /// N m  friction's work on what slides, not positive; 0 where nothing does.
    pub fn friction_work(&self, moved: &Vector<D>) -> f64 {
        match self.status {
            ContactStatus::Slip(_) => product(self.pushed(moved).1, self.slip(moved)),
            ContactStatus::Open | ContactStatus::Stick => 0.0,
        }
    }

    /// The status that a displacement asks for that closes the gap.
    pub fn met(&self, moved: &Vector<D>) -> ContactStatus {
        let held = self.held(moved);
        let limit = self.limit(-self.stiffness * self.gap_after(moved));
        match self.friction {
            0.0 => ContactStatus::Slip([0.0; 2]),
            _ if size(held) > limit.max(0.0) => ContactStatus::Slip(held.map(|part| part / size(held))),
            _ => ContactStatus::Stick,
        }
    }

    /// The status that a displacement asks for, as far as forces are known to `force`, N, and lengths to `length`, m;
    /// and by how much it contradicts the one that is, N: of what has moved too far, what soil would have resisted
    /// with.
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

    /// As [`Self::corrected`] of a point that slips `towards`; `limit`: the largest friction force, N.
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
        // On a line there is nothing to turn.
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

    /// Row-major square of the symmetric part of its stiffness, D unknowns for each node of the cell.
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
