//! Rigid bodies.

use super::MotionPath;

/// A rigid body that pushes and rubs the soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Rigid {
    /// what histories call it
    pub name: String,
    /// its shape at the start
    pub shape: RigidShape,
    /// m  its reference point at the start
    pub about: [f64; 2],
    /// -  coefficient of friction
    pub friction: f64,
    /// along x and y
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
    /// s (quasi-static: pseudo-time), increasing, and the share that acts then; empty: the ramp holds
    pub amplitude: Vec<(f64, f64)>,
    /// m/s, m/s and rad/s  at the start, of free motions
    pub velocity: [f64; 3],
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
}
