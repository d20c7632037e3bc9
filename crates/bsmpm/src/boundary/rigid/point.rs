//! A material point near a rigid body in one step: what pushes and rubs it.

use crate::nodal::Nodal;
use crate::tensor::Vector;

/// What a point does at an outline in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// Off it: no force.
    Open,
    /// On it, and held along it.
    Stick,
    /// On it, and rubbed along it with this sign; 0 without friction.
    Slip(f64),
}

/// A point near a body. Forces on it act where its box comes nearest to the outline, by the functions of its own cell.
#[derive(Clone, Debug)]
pub(super) struct RigidPoint {
    /// number of the body
    pub body: usize,
    /// number of the point
    pub point: usize,
    /// first node of its cell
    pub first_node: usize,
    /// N_I of the cell's nodes at that place
    pub N: Vec<f64>,
    /// unit normal out of the body, at the end of its motion
    pub normal: Vector<2>,
    /// m  from the body as it is at the end of the step, of the point as it is at the start
    pub gap: f64,
    /// m  of the body along the outline in the step, as predicted
    pub motion: f64,
    /// m  of the body there in any direction
    pub way: f64,
    /// m  from the body's reference point to the place, at the end
    pub arm: Vector<2>,
    /// N/m
    pub stiffness: f64,
    /// -
    pub friction: f64,
    /// N  along the outline, from the last step
    pub carried: f64,
    /// what it does
    pub grip: Grip,
}

impl RigidPoint {
    /// Along the outline: the normal turned by a right angle.
    pub fn along(&self) -> Vector<2> {
        Vector::<2>::new(-self.normal[1], self.normal[0])
    }

    /// m  of the material at the place.
    pub fn displacement<const D: usize>(&self, offsets: &[usize], u: &[f64]) -> Vector<2> {
        let mut sum = Vector::<2>::zeros();
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..2 {
                sum[component] += N * u[Nodal::<D>::at(self.first_node + offset, component)];
            }
        }
        sum
    }

    /// m  of the body's place, of small motions of the body.
    pub fn carried_by(&self, motions: &Vector<3>) -> Vector<2> {
        Vector::<2>::new(motions[0] - motions[2] * self.arm[1], motions[1] + motions[2] * self.arm[0])
    }

    /// N, N, N m  of a force at the place, as the body's motions feel it.
    pub fn on_motions(&self, force: &Vector<2>) -> Vector<3> {
        Vector::<3>::new(force[0], force[1], self.arm.perp(force))
    }

    /// m  from the outline, of material that has `moved` as seen from the body.
    pub fn gap_after(&self, moved: &Vector<2>) -> f64 {
        self.gap + self.normal.dot(moved)
    }

    /// m  of the material along the outline.
    pub fn slip(&self, moved: &Vector<2>) -> f64 {
        self.along().dot(moved) - self.motion
    }

    /// N  normal and tangential force on the material, that of its status.
    pub fn pushed(&self, moved: &Vector<2>) -> [f64; 2] {
        let normal = -self.stiffness * self.gap_after(moved);
        match self.grip {
            Grip::Open => [0.0; 2],
            Grip::Stick => [normal, self.held(moved)],
            Grip::Slip(sign) => [normal, sign * self.friction * normal],
        }
    }

    /// N  tangential force if it sticks.
    fn held(&self, moved: &Vector<2>) -> f64 {
        self.carried - self.stiffness * self.slip(moved)
    }

    /// N  force on the material.
    pub fn force(&self, moved: &Vector<2>) -> Vector<2> {
        let [normal, along] = self.pushed(moved);
        self.normal * normal + self.along() * along
    }

    /// N  change of the force with a change of what has moved; `whole`: with the part that is not symmetric.
    pub fn rate(&self, moved: &Vector<2>, whole: bool) -> Vector<2> {
        let normal = -self.stiffness * self.normal.dot(moved);
        match self.grip {
            Grip::Open => Vector::zeros(),
            Grip::Stick => self.normal * normal - self.along() * (self.stiffness * self.along().dot(moved)),
            Grip::Slip(sign) if whole => self.normal * normal + self.along() * (sign * self.friction * normal),
            Grip::Slip(_) => self.normal * normal,
        }
    }

    /// N m  friction's work on what slides, not positive; 0 where nothing does.
    pub fn rubbed(&self, moved: &Vector<2>) -> f64 {
        match self.grip {
            Grip::Slip(_) => self.pushed(moved)[1] * self.slip(moved),
            Grip::Open | Grip::Stick => 0.0,
        }
    }

    /// The status that a displacement asks for that closes the gap.
    pub fn met(&self, moved: &Vector<2>) -> Grip {
        let (held, limit) = (self.held(moved), -self.friction * self.stiffness * self.gap_after(moved));
        match self.friction {
            0.0 => Grip::Slip(0.0),
            _ if held.abs() > limit.max(0.0) => Grip::Slip(held.signum()),
            _ => Grip::Stick,
        }
    }

    /// The status that a displacement asks for, as far as forces are known to `force`, N, and lengths to `length`, m;
    /// and by how much it contradicts the one that is, N: of what has moved too far, what soil would have resisted
    /// with.
    pub fn corrected(&self, moved: &Vector<2>, (force, length): (f64, f64)) -> (Grip, f64) {
        let soil = 1.0 / super::PENALTY;
        if self.grip == Grip::Open {
            let depth = -self.gap_after(moved);
            return if depth > length { (self.met(moved), soil * self.stiffness * depth) } else { (Grip::Open, 0.0) };
        }
        let [normal, along] = self.pushed(moved);
        let limit = self.friction * normal.max(0.0);
        match self.grip {
            _ if normal < -force => (Grip::Open, -normal),
            Grip::Stick if along.abs() > limit + force => (Grip::Slip(along.signum()), along.abs() - limit),
            Grip::Slip(sign) if sign != 0.0 && sign * self.held(moved) < limit - force => {
                (Grip::Stick, soil * (limit - sign * self.held(moved)))
            }
            grip => (grip, 0.0),
        }
    }

    /// Row-major square of the symmetric part of its stiffness, D unknowns for each node of the cell.
    pub fn block<const D: usize>(&self) -> Vec<f64> {
        let order = self.N.len() * D;
        let mut block = vec![0.0; order * order];
        let across = |j: usize| -self.rate(&Vector::from_fn(|i, _| f64::from(u8::from(i == j))), false);
        let columns: [Vector<2>; 2] = std::array::from_fn(across);
        for (a, N_a) in self.N.iter().enumerate() {
            for (b, N_b) in self.N.iter().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    for i in 0..2 {
                        block[(a * D + i) * order + b * D + j] = N_a * N_b * column[i];
                    }
                }
            }
        }
        block
    }
}
