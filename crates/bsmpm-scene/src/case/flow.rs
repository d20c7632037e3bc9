//! Water that flows.

use super::Face;
use bsmpm::water::flow::{Course, Given, Soil};

/// Pore water whose excess pressure is an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// N/m3  of the water, where there is none that is still
    pub unit_weight: f64,
    /// Pa  bulk modulus of the water; infinite: incompressible
    pub bulk: f64,
    /// By the number of the material; `None` where the pressure is that of the still water.
    pub soils: Vec<Option<Soil<2>>>,
    /// Surfaces at which the pressure is given, in the order of the file.
    pub drains: Vec<Drain>,
    /// Surfaces through which water is put in, in the order of the file.
    pub inflows: Vec<Inflow>,
}

/// A surface at which the pressure is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Drain {
    /// What histories call it.
    pub name: Option<String>,
    /// Where it is.
    pub site: DrainSite,
    /// The pressure, heights in the case's coordinates.
    pub given: Given,
}

/// Where a drain is.
#[derive(Clone, Debug, PartialEq)]
pub enum DrainSite {
    /// A face of the grid.
    Face(Face),
    /// m  straight pieces of bodies' surfaces at the start, each by its ends
    Lines(Vec<[[f64; 2]; 2]>),
}

/// A surface through which water is put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow {
    /// m  ends of a segment of a body's surface at the start
    pub ends: [[f64; 2]; 2],
    /// m/s  into the ground
    pub rate: Course,
}
