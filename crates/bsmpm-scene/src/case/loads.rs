//! Data of footings, prescribed displacements, loads and initial stress.

use super::{Base, Face};
use bsmpm::interactions::strip::StripContact;
use bsmpm::material::Profile;
use bsmpm::schedule::between;
use bsmpm::tensor::Vector;
use std::sync::Arc;

/// A displacement as a function of time, linear between its rows; zero at the start, constant after the last row.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionPath {
    /// s (quasi-static: pseudo-time), increasing, and m; of a plane nothing along its normal
    pub rows: Vec<(f64, [f64; 3])>,
}

impl MotionPath {
    /// Whether it leads anywhere.
    pub fn moves(&self) -> bool {
        self.rows.iter().any(|(_, moved)| *moved != [0.0; 3])
    }

    /// m  Where it is at the time `t`.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let rows: Vec<(f64, Vector<3>)> = self.rows.iter().map(|(t, moved)| (*t, (*moved).into())).collect();
        between(&rows, Vector::zeros(), t).map_or([0.0; 3], Into::into)
    }

    /// m  the largest displacement of any row
    pub fn farthest(&self) -> f64 {
        self.rows
            .iter()
            .map(|(_, moved)| moved[0].hypot(moved[1]).hypot(moved[2]))
            .fold(0.0, f64::max)
    }

    /// Ends it where it is at the time `until`.
    pub(crate) fn stay(&mut self, until: f64) {
        if !self.rows.is_empty() {
            let moved = self.at(until);
            self.rows.retain(|row| row.0 < until);
            self.rows.push((until, moved));
        }
    }
}

/// A rectangle in space along the axes, or the disc inscribed in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// m  its lower corner, like the upper one along the axis that is normal to it
    pub lower: [f64; 3],
    /// m  its upper corner
    pub upper: [f64; 3],
    /// whether it is the disc; of one the part inside the grid counts
    pub round: bool,
}

impl Plate {
    /// The axis that is normal to it.
    pub fn normal(&self) -> usize {
        (0..3).find(|&axis| self.lower[axis] == self.upper[axis]).unwrap_or(2)
    }

    /// m  its middle
    pub fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|axis| 0.5 * (self.lower[axis] + self.upper[axis]))
    }

    /// m  ends of the lines through its middle along the axes that follow the normal one
    pub fn lines(&self) -> [[[f64; 3]; 2]; 2] {
        let normal = self.normal();
        let middle = self.middle();
        [(normal + 1) % 3, (normal + 2) % 3].map(|axis| {
            [self.lower, self.upper]
                .map(|end| std::array::from_fn(|along| if along == axis { end[along] } else { middle[along] }))
        })
    }

    /// m  of a disc
    pub fn radius(&self) -> f64 {
        (0..3)
            .map(|axis| 0.5 * (self.upper[axis] - self.lower[axis]))
            .fold(0.0, f64::max)
    }

    /// m2  of the part of it within a box
    pub fn area(&self, [lower, upper]: [[f64; 3]; 2]) -> f64 {
        const CHORDS: usize = 4096;
        let axes: Vec<usize> = (0..3).filter(|axis| *axis != self.normal()).collect();
        let within = |axis: usize, [from, to]: [f64; 2]| (to.min(upper[axis]) - from.max(lower[axis])).max(0.0);
        let [along, across] = [axes[0], axes[1]];
        let [length, width] = [along, across].map(|axis| within(axis, [self.lower[axis], self.upper[axis]]));
        if !self.round {
            return length * width;
        }
        let middle = self.middle();
        let start = self.lower[along].max(lower[along]);
        let chords = (0..CHORDS).map(|k| {
            let off = start + (k as f64 + 0.5) / CHORDS as f64 * length - middle[along];
            let half = (self.radius().powi(2) - off * off).max(0.0).sqrt();
            within(across, [middle[across] - half, middle[across] + half])
        });
        chords.sum::<f64>() * length / CHORDS as f64
    }

    /// Whether a place in its plane is part of it.
    pub fn covers(&self, at: [f64; 3]) -> bool {
        let within = (0..3).all(|axis| self.lower[axis] <= at[axis] && at[axis] <= self.upper[axis]);
        let middle = self.middle();
        let far: f64 = (0..3).map(|axis| (at[axis] - middle[axis]).powi(2)).sum();
        within && (!self.round || far <= self.radius().powi(2))
    }
}

/// A rigid strip that moves, section 3.3 of the paper; of a solid a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Footing {
    /// its base at the start: a segment or a plate
    pub site: Site,
    /// its motion
    pub path: MotionPath,
    /// what it holds; of one in contact what it may hold
    pub base: Base,
    /// friction, and whether material comes off, instead
    pub contact: Option<StripContact<3>>,
    /// whether it lies on ground that stands without it, and has no part in the stress at the start
    pub rests: bool,
}

/// Prescribed motion of what lies at a face of the grid or at a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedMotion {
    /// where
    pub site: Site,
    /// its motion
    pub path: MotionPath,
    /// which components; of one in contact what it may hold
    pub base: Base,
    /// friction, and whether material comes off, instead
    pub contact: Option<StripContact<3>>,
    /// whether it lies on ground that stands without it, and has no part in the stress at the start
    pub rests: bool,
}

/// Where a strip or a prescribed motion acts at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Site {
    /// A face of the grid.
    Face(Face),
    /// m  a segment
    Segment {
        /// one end
        from: [f64; 2],
        /// the other
        to: [f64; 2],
    },
    /// Of a solid.
    Plate(Plate),
}

impl Site {
    /// m  ends of a segment
    pub fn ends(&self) -> Option<[[f64; 2]; 2]> {
        if let Self::Segment { from, to } = *self {
            Some([from, to])
        } else {
            None
        }
    }
}

/// s (quasi-static: pseudo-time), increasing, and the share of a load that acts then along each axis, linear between,
/// from 0 at time 0; empty: its ramp holds. Of a rigid body in a plane the third is that of the moment.
pub type Shares = Vec<(f64, Vector<3>)>;

/// Whether a load keeps its direction, reversed at most.
pub(crate) fn keeps_direction(shares: &Shares) -> bool {
    shares
        .iter()
        .all(|(_, share)| *share == Vector::<3>::from_element(share[0]))
}

/// A load on the body's surface that follows the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction {
    /// where at the start
    pub line: LoadedLine,
    /// what acts there
    pub push: Push,
    /// s (quasi-static: pseudo-time)  over which it grows linearly; 0: at once
    pub ramp: f64,
    /// what acts of it in time
    pub amplitude: Shares,
}

/// m  corners of a triangle in space
pub type Triangle = [[f64; 3]; 3];

/// Where a traction acts at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadedLine {
    /// m  a segment
    Segment {
        /// one end
        from: [f64; 2],
        /// the other
        to: [f64; 2],
    },
    /// m  the part of a circle inside the grid
    Circle {
        /// its centre
        center: [f64; 2],
        /// its radius
        radius: f64,
    },
    /// Of a solid.
    Plate(Plate),
    /// Of a solid: a curved surface in pieces as small as the spacing of points, turned alike
    Triangles(Arc<[Triangle]>),
}

/// What a traction is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Push {
    /// Pa  force per area of the start, along the axes, by the height at the start in the case's coordinates; direction
    /// and force stay
    Stress([Profile; 3]),
    /// Pa  against the body, by the height at the start in the case's coordinates; it turns and stretches with the
    /// surface
    Pressure {
        /// the pressure
        profile: Profile,
        /// 1 where the body lies on the left of a segment from its first end, inside a circle, beyond a plate along its
        /// normal, or where triangles are seen to turn counter-clockwise from, else -1
        side: f64,
    },
}

impl Traction {
    /// Ends of a segment, m.
    pub fn ends(&self) -> Option<[[f64; 2]; 2]> {
        match self.line {
            LoadedLine::Segment { from, to } => Some([from, to]),
            LoadedLine::Circle { .. } | LoadedLine::Plate(_) | LoadedLine::Triangles(_) => None,
        }
    }

    /// Pa  the largest force per area when fully applied.
    pub fn largest(&self) -> f64 {
        let ends = match &self.line {
            LoadedLine::Segment { from, to } => [from[1], to[1]],
            LoadedLine::Circle { center, radius } => [center[1] - radius, center[1] + radius],
            LoadedLine::Plate(plate) => [plate.lower[2], plate.upper[2]],
            LoadedLine::Triangles(all) => {
                let heights = all.iter().flatten().map(|corner| corner[2]);
                [
                    heights.clone().fold(f64::INFINITY, f64::min),
                    heights.fold(f64::NEG_INFINITY, f64::max),
                ]
            }
        };
        let [low, high] = ends.map(|height| match self.push {
            Push::Stress(stress) => stress.iter().fold(0.0, |sum: f64, along| sum.hypot(along.at(height))),
            Push::Pressure { profile, .. } => profile.at(height).abs(),
        });
        low.max(high)
    }
}

/// A force at a point of the body, which follows the body.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLoad {
    /// m  where at the start
    pub at: [f64; 3],
    /// N per m of thickness; of a solid N
    pub force: [f64; 3],
    /// s (quasi-static: pseudo-time)  over which it grows linearly; 0: at once
    pub ramp: f64,
    /// what acts of it in time
    pub amplitude: Shares,
}

/// The stress at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// Weight of what lies above as vertical stress, and a part of it as horizontal stress: per material that part.
    AtRest(Vec<f64>),
    /// The elastic equilibrium under the loads at time 0.
    Elastic,
}
