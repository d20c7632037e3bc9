//! Input of pore-water flow: soils, permeability, theory-manual equation (T8.8), drains and inflows.

use crate::boundary::SurfacePoint;
use crate::schedule::TimeInterval;
use crate::schedule::{between, turns};
use crate::tensor::Vector;
use crate::water::retention::Retention;

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
    /// Pa  the largest suction above still water at the start, where soils keep water under suction
    pub suction: f64,
    /// what the water does
    pub motion: Motion,
}

/// What water does that may flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// It flows.
    Flows,
    /// It stays where it is: nothing flows, crosses a surface or is given, and the pressure follows the strain.
    Undrained,
    /// No pressure is an unknown: every point keeps the one that it has.
    Held,
}

impl<const D: usize> Flow<D> {
    /// Points and normals of all surfaces of bodies that water crosses: those of the drains, then those of the inflows.
    pub fn surfaces(&self) -> impl Iterator<Item = (&[SurfacePoint<D>], &[Vector<D>])> {
        let drains = self.drains.iter().map(|drain| (&drain.points[..], &drain.normals[..]));
        drains.chain(
            self.inflows
                .iter()
                .map(|inflow| (&inflow.points[..], &inflow.normals[..])),
        )
    }

    /// Which of those water crosses now.
    pub fn acting(&self) -> impl Iterator<Item = bool> {
        let drains = self.drains.iter().map(|drain| drain.acts);
        drains.chain(self.inflows.iter().map(|inflow| inflow.acts))
    }

    /// Whether a surface lets water through one way only.
    pub fn is_one_way(&self) -> bool {
        self.drains
            .iter()
            .any(|drain| drain.acts && drain.given == Given::Seepage)
            || self.inflows.iter().any(|inflow| inflow.acts && inflow.runs_off)
    }

    /// Whether what is given at a surface that water crosses now turns sharply in a step.
    pub fn turns(&self, interval: TimeInterval) -> bool {
        self.drains
            .iter()
            .any(|drain| drain.acts && drain.given.turns(interval))
            || self.faces.iter().any(|face| face.acts && face.given.turns(interval))
            || self
                .inflows
                .iter()
                .any(|inflow| inflow.acts && inflow.rate.turns(interval))
    }

    /// m  the largest suction head at which air enters a soil
    pub fn entry(&self) -> f64 {
        let retention = self.soils.iter().flatten().filter_map(|soil| soil.retention.as_ref());
        retention.map(|retention| retention.curve.entry()).fold(0.0, f64::max)
    }

    /// Whether a soil may be partly saturated.
    pub fn retains(&self) -> bool {
        self.soils.iter().flatten().any(|soil| soil.retention.is_some())
    }
}

impl<const D: usize> Flow<D> {
    /// m/s  of a material, along the axes, where it has become `J` times the volume of the start; `None` where nothing
    /// flows
    pub fn permeability(&self, material: u16, J: f64) -> Option<Vector<D>> {
        if self.motion != Motion::Flows {
            return None;
        }
        let soil = self.soils[usize::from(material)].as_ref()?;
        soil.permeability
            .as_ref()
            .map(|permeability| permeability.along * permeability.law.relative(soil.porosity, J))
    }
}

impl PermeabilityLaw {
    /// Permeability over that of the start, of a soil of this porosity then that has become `J` times its volume.
    pub fn relative(self, porosity: f64, J: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::KozenyCarman => kozeny_carman((1.0 - (1.0 - porosity) / J).max(0.0)) / kozeny_carman(porosity),
        }
    }

    /// What the logarithm of that changes by per change of ln J.
    pub fn relative_change(self, porosity: f64, J: f64) -> f64 {
        let solid = (1.0 - porosity) / J;
        match self {
            Self::KozenyCarman if solid < 1.0 => solid * (3.0 / (1.0 - solid) + 2.0 / solid),
            _ => 0.0,
        }
    }
}

/// n^3/(1-n)^2 of a porosity n.
fn kozeny_carman(n: f64) -> f64 {
    n.powi(3) / (1.0 - n).powi(2)
}

/// What a soil is to water.
#[derive(Clone, Debug, PartialEq)]
pub struct Soil<const D: usize> {
    /// -  share of pores in the volume at the start
    pub porosity: f64,
    /// `None`: undrained, nothing flows
    pub permeability: Option<Permeability<D>>,
    /// how much water it keeps under suction; `None`: its pores stay full
    pub retention: Option<Retention>,
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
    /// that of the still water below its level; above it no pressure, and water only comes out: a seepage face
    Seepage,
}

/// A number that follows time (s): rows, increasing in time; linear between, constant before the first and after the
/// last.
#[derive(Clone, Debug, PartialEq)]
pub struct Course(pub Vec<(f64, f64)>);

impl Given {
    /// What follows time of itself.
    pub fn course(&self) -> Option<&Course> {
        match self {
            Self::Head(course) | Self::Pressure(course) => Some(course),
            Self::StillWater | Self::Seepage => None,
        }
    }

    /// Whether that turns sharply in a step.
    fn turns(&self, interval: TimeInterval) -> bool {
        self.course().is_some_and(|course| course.turns(interval))
    }
}

impl Course {
    /// Whether it turns sharply in a step.
    fn turns(&self, interval: TimeInterval) -> bool {
        turns(&self.0, self.at(0.0), f64::abs, interval)
    }

    /// Of its rows, s.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|row| row.0)
    }

    /// Its integral over a time: exact, wherever the rows are.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        let within = self.times().filter(|t| from < *t && *t < to);
        let mut start = from;
        let mut sum = 0.0;
        for end in within.chain([to]) {
            sum += 0.5 * (end - start) * (self.at(start) + self.at(end));
            start = end;
        }
        sum
    }

    /// At time `t`; 0 of none.
    pub fn at(&self, t: f64) -> f64 {
        let first = self.0.first().map_or(0.0, |row| row.1);
        let last = self.0.last().map_or(0.0, |row| row.1);
        between(&self.0, first, t).unwrap_or(last)
    }
}

/// A drained surface of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Drain<const D: usize> {
    /// on the surface, at the start
    pub points: Vec<SurfacePoint<D>>,
    /// -  of every point: unit normal of the surface at the start, to either side
    pub normals: Vec<Vector<D>>,
    /// the pressure there
    pub given: Given,
    /// whether water crosses it now
    pub acts: bool,
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
    /// whether water crosses it now
    pub acts: bool,
}

/// A surface through which water is put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow<const D: usize> {
    /// on the surface, at the start
    pub points: Vec<SurfacePoint<D>>,
    /// -  of every point: unit normal of the surface at the start, to either side
    pub normals: Vec<Vector<D>>,
    /// m/s  into the ground
    pub rate: Course,
    /// no more than the ground takes without pressure at its surface: what is left runs off (rain)
    pub runs_off: bool,
    /// whether water crosses it now
    pub acts: bool,
}
