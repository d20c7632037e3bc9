//! Data of a step that rigid bodies use.

use super::body::{RigidBody, RigidState};
use crate::dynamics::newmark::Newmark;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Grid, Shape};
use crate::points::Points;
use crate::tensor::Vector;

/// Data from which the domains of material points follow.
#[derive(Clone, Copy)]
pub struct ParticleDomains<'a, const D: usize> {
    /// The grid.
    pub grid: &'a Grid<D>,
    /// Material points.
    pub points: &'a Points<D>,
    /// Per material: initial half width of a material point's domain, in cell edges, at most.
    pub reach: &'a [f64],
    /// Returns the volume per m^D of the grid at a position (geometry weight).
    pub weight: fn(&Vector<D>) -> f64,
}

/// Data of the step that contact with rigid bodies needs.
pub struct Surroundings<'a, const D: usize> {
    /// Bodies and their states.
    pub bodies: (&'a [RigidBody<D>], &'a [RigidState]),
    /// Material points and their grid.
    pub reaching: ParticleDomains<'a, D>,
    /// Shape functions at the material points.
    pub shape: &'a Shape<D>,
    /// Body force per mass at the end of the step (m/s2).
    pub body_force: Vector<D>,
    /// Nodal components that no other condition prescribes.
    pub free: &'a [bool],
    /// Time integration; `None` without inertia.
    pub newmark: Option<Newmark>,
    /// Pore pressure, if there is water.
    pub pore_pressure: Option<&'a PorePressure<D>>,
}
