//! Data of rigid bodies.

use super::{MotionPath, Shares};
use bsmpm::interactions::rigid::{Outline, Terrain};
use bsmpm::schedule::between;

/// A rigid body that pushes the soil, with friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Rigid {
    /// what histories call it
    pub name: String,
    /// its shape at the start
    pub shape: RigidShape,
    /// m  its reference point at the start, of a plane
    pub about: [f64; 2],
    /// -  coefficient of friction
    pub friction: f64,
    /// of the reference point
    pub path: MotionPath,
    /// s (quasi-static: pseudo-time), increasing, and rad, counter-clockwise
    pub rotation: Vec<(f64, f64)>,
    /// whether its motions along x, along y and about the reference point follow from forces
    pub free: [bool; 3],
    /// kg/m and kg m  mass, and its second moment about the centroid, per metre of thickness; in axisymmetry kg, of the
    /// whole body
    pub mass: [f64; 2],
    /// N/m, N/m and N  when fully applied: force, and moment about the reference point, per metre of thickness; in
    /// axisymmetry N, on the whole body
    pub force: [f64; 3],
    /// s (quasi-static: pseudo-time)  over which the force grows linearly; 0: at once
    pub ramp: f64,
    /// what acts of it in time
    pub amplitude: Shares,
    /// m/s, m/s and rad/s  at the start, of free motions
    pub velocity: [f64; 3],
}

impl Rigid {
    /// Whether it is given a way that leaves its place.
    pub fn is_moved(&self) -> bool {
        self.path.rows.iter().any(|(_, moved)| *moved != [0.0; 3])
            || self.rotation.iter().any(|(_, angle)| *angle != 0.0)
    }

    /// Ends its way where it is at the time `until`.
    pub(crate) fn stay(&mut self, until: f64) {
        self.path.stay(until);
        if let Some(angle) = between(&self.rotation, 0.0, until) {
            self.rotation.retain(|row| row.0 < until);
            self.rotation.push((until, angle));
        }
    }
}

/// Shape of a rigid body at the start, m, in the case's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum RigidShape {
    /// Corners, counter-clockwise.
    Polygon(Vec<[f64; 2]>),
    /// A circle.
    Circle {
        /// its centre
        center: [f64; 2],
        /// its radius
        radius: f64,
    },
    /// Of a solid.
    InSpace(RigidSolid),
}

/// Shape of a rigid body in space at the start, m, in the case's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum RigidSolid {
    /// A cuboid along the axes.
    Box {
        /// its lower corner
        lower: [f64; 3],
        /// its upper corner
        upper: [f64; 3],
    },
    /// A sphere.
    Sphere {
        /// its centre
        center: [f64; 3],
        /// its radius
        radius: f64,
    },
    /// A polygon turned about a vertical.
    Revolved {
        /// x and y of the vertical
        about: [f64; 2],
        /// distance from it and height, counter-clockwise, with the mirror image of what reaches the vertical
        corners: Vec<[f64; 2]>,
    },
    /// What lies under heights.
    Terrain(Terrain),
}

impl RigidSolid {
    /// m  its reference point
    pub fn reference(&self) -> [f64; 3] {
        match self {
            Self::Box { lower, upper } => [0, 1, 2].map(|axis| 0.5 * (lower[axis] + upper[axis])),
            Self::Sphere { center, .. } => *center,
            Self::Revolved { about: [x, y], corners } => [
                *x,
                *y,
                corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min),
            ],
            Self::Terrain(_) => [0.0; 3],
        }
    }

    /// m  corners of a box that it lies in.
    pub fn corners(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Box { lower, upper } => [*lower, *upper],
            Self::Sphere { center, radius } => [-radius, *radius].map(|by| center.map(|at| at + by)),
            Self::Revolved { about: [x, y], corners } => {
                let most = |of: fn(&[f64; 2]) -> f64| corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
                let radius = most(|corner| corner[0]);
                [
                    [x - radius, y - radius, -most(|corner| -corner[1])],
                    [x + radius, y + radius, most(|corner| corner[1])],
                ]
            }
            Self::Terrain(terrain) => {
                let top = terrain.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                [[f64::NEG_INFINITY; 3], [f64::INFINITY, f64::INFINITY, top]]
            }
        }
    }

    /// Its outline about the reference point.
    pub fn outline(&self) -> Outline {
        match self {
            Self::Box { lower, upper } => Outline::Box([0, 1, 2].map(|axis| 0.5 * (upper[axis] - lower[axis]))),
            Self::Sphere { radius, .. } => Outline::Circle(*radius),
            Self::Revolved { corners, .. } => {
                let bottom = self.reference()[2];
                Outline::Revolved(corners.iter().map(|[r, z]| [*r, z - bottom].into()).collect())
            }
            Self::Terrain(terrain) => Outline::Terrain(Box::new(terrain.clone())),
        }
    }
}
