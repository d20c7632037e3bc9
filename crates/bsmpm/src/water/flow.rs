//! Water that flows: what the soils, the drains and the inflows are to it.

use crate::boundary::SurfacePoint;
use crate::schedule::between;
use crate::tensor::Vector;

/// Everything that makes the excess pressure an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow<const D: usize> {
    /// Pa  bulk modulus of the water; infinite: incompressible
    pub bulk: f64,
    /// by the material's number; `None` where the pressure is that of the still water
    pub soils: Vec<Option<Soil<D>>>,
    /// surfaces of bodies at which the pressure is given
    pub drains: Vec<Drain<D>>,
    /// faces of the grid at which the pressure is given
    pub faces: Vec<DrainedFace>,
    /// surfaces of bodies through which water is put in
    pub inflows: Vec<Inflow<D>>,
}

/// What a soil is to water.
#[derive(Clone, Debug, PartialEq)]
pub struct Soil<const D: usize> {
    /// -  share of pores in the volume at the start
    pub porosity: f64,
    /// `None`: undrained, nothing flows
    pub permeability: Option<Permeability<D>>,
}

/// Hydraulic conductivity.
#[derive(Clone, Debug, PartialEq)]
pub struct Permeability<const D: usize> {
    /// m/s  along each axis of space, at the porosity of the start
    pub along: Vector<D>,
    /// how it follows the porosity
    pub law: PermeabilityLaw,
}

/// How the permeability follows the porosity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PermeabilityLaw {
    /// not at all
    Constant,
    /// n^3/(1-n)^2 (Kozeny 1927, Carman 1937)
    KozenyCarman,
}

/// The pressure that is given at a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// that of the still water: no excess
    StillWater,
    /// m above the grid's lower corner: water that would rise to this height
    Head(Course),
    /// Pa  of the pore water
    Pressure(Course),
}

/// A number that follows time (s): rows, increasing in time; linear between, constant before the first and after the
/// last.
#[derive(Clone, Debug, PartialEq)]
pub struct Course(pub Vec<(f64, f64)>);

impl Course {
    /// At time `t`; 0 of none.
    pub fn at(&self, t: f64) -> f64 {
        let value = |row: Option<&(f64, f64)>| row.map_or(0.0, |row| row.1);
        between(&self.0, value(self.0.first()), t).unwrap_or(value(self.0.last()))
    }
}

/// A drained surface of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Drain<const D: usize> {
    /// on the surface, at the start
    pub points: Vec<SurfacePoint<D>>,
    /// the pressure there
    pub given: Given,
}

/// A drained face of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct DrainedFace {
    /// that the face is normal to
    pub axis: usize,
    /// the face at the end of the axis
    pub upper: bool,
    /// the pressure there
    pub given: Given,
}

/// A surface through which water is put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow<const D: usize> {
    /// on the surface, at the start
    pub points: Vec<SurfacePoint<D>>,
    /// m/s  into the ground
    pub rate: Course,
}
