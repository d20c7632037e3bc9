//! What acts on the bodies besides gravity: rigid strips, prescribed motions, tractions, point loads, initial stress.

use super::{Base, Face};
use bsmpm::boundary::StripContact;
use bsmpm::material::Profile;

/// A displacement as a function of time, linear between its rows; zero at the start, constant after the last row.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionPath {
    /// s (quasi-static: pseudo-time), increasing, and m
    pub rows: Vec<(f64, [f64; 2])>,
}

/// A rigid strip that moves, section 3.3 of the paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Footing {
    /// m  one end of its base at the start
    pub from: [f64; 2],
    /// m  the other end
    pub to: [f64; 2],
    /// its motion
    pub path: MotionPath,
    /// what it holds; of one in contact what it may hold
    pub base: Base,
    /// friction, and whether material comes off, instead
    pub contact: Option<StripContact<2>>,
}

/// Prescribed motion of what lies at a face of the grid or at a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    /// where
    pub site: Site,
    /// its motion
    pub path: MotionPath,
    /// which components; of one in contact what it may hold
    pub base: Base,
    /// friction, and whether material comes off, instead
    pub contact: Option<StripContact<2>>,
}

/// Where a prescribed motion acts at the start.
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
}

/// A load on the body's surface that follows the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction {
    /// where at the start
    pub line: Line,
    /// what acts there
    pub push: Push,
    /// s (quasi-static: pseudo-time)  over which it grows linearly; 0: at once
    pub ramp: f64,
    /// s (quasi-static: pseudo-time), increasing, and the share that acts then; empty: the ramp holds
    pub amplitude: Vec<(f64, f64)>,
}

/// Where a traction acts at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
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
    /// m  of a solid a rectangle: a box without extent along one axis
    Rectangle {
        /// its lower corner
        lower: [f64; 3],
        /// its upper corner
        upper: [f64; 3],
    },
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
        /// 1 where the body lies on the left of a segment from its first end, inside a circle, or beyond a rectangle
        /// along its normal, else -1
        side: f64,
    },
}

impl Traction {
    /// Ends of a segment, m.
    pub fn ends(&self) -> Option<[[f64; 2]; 2]> {
        match self.line {
            Line::Segment { from, to } => Some([from, to]),
            Line::Circle { .. } | Line::Rectangle { .. } => None,
        }
    }

    /// Pa  the largest force per area when fully applied.
    pub fn largest(&self) -> f64 {
        let ends = match self.line {
            Line::Segment { from, to } => [from[1], to[1]],
            Line::Circle { center, radius } => [center[1] - radius, center[1] + radius],
            Line::Rectangle { lower, upper } => [lower[2], upper[2]],
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
    pub at: [f64; 2],
    /// N/m
    pub force: [f64; 2],
    /// s (quasi-static: pseudo-time)  over which it grows linearly; 0: at once
    pub ramp: f64,
    /// s (quasi-static: pseudo-time), increasing, and the share that acts then; empty: the ramp holds
    pub amplitude: Vec<(f64, f64)>,
}

/// The stress at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// Weight of what lies above as vertical stress, and a part of it as horizontal stress: per material that part.
    AtRest(Vec<f64>),
    /// The elastic equilibrium under the loads at time 0.
    Elastic,
}
