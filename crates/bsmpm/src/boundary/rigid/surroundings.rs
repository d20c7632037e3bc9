//! Data of a step that rigid bodies use.

use super::body::{RigidBody, RigidState};
use crate::grid::{Grid, Shape};
use crate::points::Points;
use crate::step::newmark::Newmark;
use crate::tensor::Vector;
use crate::water::pore_pressure::PorePressure;

/// What gives how far points reach.
#[derive(Clone, Copy)]
pub struct ParticleDomains<'a, const D: usize> {
    /// the grid
    pub grid: &'a Grid<D>,
    /// the points
    pub points: &'a Points<D>,
    /// parts of a cell that the points of a material reach to each side at the start, at most
    pub reach: &'a [f64],
    /// volume per m^D of the grid at a place
    pub weight: fn(&Vector<D>) -> f64,
}

/// What of the scene the bodies see.
pub struct Surroundings<'a, const D: usize> {
    /// the bodies, and what they carry
    pub bodies: (&'a [RigidBody<D>], &'a [RigidState]),
    /// the points on their grid
    pub reaching: ParticleDomains<'a, D>,
    /// shape functions
    pub shape: &'a Shape<D>,
    /// m/s2  force per mass at the end of the step
    pub body_force: Vector<D>,
    /// components that nothing else holds
    pub free: &'a [bool],
    /// integration of inertia; `None` without
    pub newmark: Option<Newmark>,
    /// pore pressure that the soil carries, if any
    pub pore_pressure: Option<&'a PorePressure<D>>,
}
