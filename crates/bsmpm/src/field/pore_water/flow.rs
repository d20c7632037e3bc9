//! Input of pore-water flow: soils, permeability, theory-manual equation (T8.8), drains and inflows.

use crate::boundary::SurfacePoint;
use crate::field::pore_water::retention::Retention;
use crate::schedule::TimeInterval;
use crate::schedule::{between, turns};
use crate::tensor::Vector;

/// Coupled pore-water flow, with the excess pressure as an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow<const D: usize> {
    /// Bulk modulus of water; infinite if incompressible (Pa).
    pub bulk: f64,
    /// Soils by the number of the material; `None` if the pressure is hydrostatic.
    pub soils: Vec<Option<Soil<D>>>,
    /// Surfaces of bodies with a prescribed pressure.
    pub drains: Vec<Drain<D>>,
    /// Faces of the grid with a prescribed pressure.
    pub faces: Vec<DrainedFace>,
    /// Surfaces of bodies with a prescribed inflow.
    pub inflows: Vec<Inflow<D>>,
    /// Largest suction above the water level at the start, for soils that retain water under suction (Pa).
    pub suction: f64,
    /// Mode of analysis.
    pub motion: Motion,
}

/// Mode of a coupled analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Water flows through the ground.
    Flows,
    /// Undrained: no water flows or crosses a surface, no pressure is prescribed; the pressure follows from the strain.
    Undrained,
    /// Constant: every point keeps its pressure, which is not an unknown.
    Held,
}

impl<const D: usize> Flow<D> {
    /// Returns points and normals of all surfaces of bodies with flow: the drains, then the inflows.
    pub fn surfaces(&self) -> impl Iterator<Item = (&[SurfacePoint<D>], &[Vector<D>])> {
        let drains = self.drains.iter().map(|drain| (&drain.points[..], &drain.normals[..]));
        drains.chain(
            self.inflows
                .iter()
                .map(|inflow| (&inflow.points[..], &inflow.normals[..])),
        )
    }

    /// Returns whether each surface of [`Flow::surfaces`] is active.
    pub fn acting(&self) -> impl Iterator<Item = bool> {
        let drains = self.drains.iter().map(|drain| drain.acts);
        drains.chain(self.inflows.iter().map(|inflow| inflow.acts))
    }

    /// Returns whether an active surface lets water through in one direction only (seepage face, or runoff).
    pub fn is_one_way(&self) -> bool {
        self.drains
            .iter()
            .any(|drain| drain.acts && drain.given == Given::Seepage)
            || self.inflows.iter().any(|inflow| inflow.acts && inflow.runs_off)
    }

    /// Returns whether a prescribed value at an active surface changes abruptly in a step.
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

    /// Returns the largest air-entry suction head of the soils (m).
    pub fn entry(&self) -> f64 {
        let retention = self.soils.iter().flatten().filter_map(|soil| soil.retention.as_ref());
        retention.map(|retention| retention.curve.entry()).fold(0.0, f64::max)
    }

    /// Returns whether any soil retains water under suction and may be partly saturated.
    pub fn retains(&self) -> bool {
        self.soils.iter().flatten().any(|soil| soil.retention.is_some())
    }
}

impl<const D: usize> Flow<D> {
    /// Returns the permeability of a material along the axes at the volume ratio `J` (m/s); `None` without flow.
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
    /// Returns the ratio of the permeability at the volume ratio `J` to the initial one, for the initial `porosity`.
    pub fn relative(self, porosity: f64, J: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::KozenyCarman => kozeny_carman((1.0 - (1.0 - porosity) / J).max(0.0)) / kozeny_carman(porosity),
        }
    }

    /// Returns the derivative of ln of that ratio with respect to ln J.
    pub fn relative_change(self, porosity: f64, J: f64) -> f64 {
        // With the share of solids c = (1 - n0)/J: dc/d ln J = -c and ln k = 3 ln(1 - c) - 2 ln c.
        let solid = (1.0 - porosity) / J;
        match self {
            Self::KozenyCarman if solid < 1.0 => solid * (3.0 / (1.0 - solid) + 2.0 / solid),
            _ => 0.0,
        }
    }
}

/// Returns n^3/(1-n)^2 of the porosity n.
fn kozeny_carman(n: f64) -> f64 {
    n.powi(3) / (1.0 - n).powi(2)
}

/// Hydraulic properties of a soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Soil<const D: usize> {
    /// Initial porosity (-).
    pub porosity: f64,
    /// Permeability; `None`: undrained.
    pub permeability: Option<Permeability<D>>,
    /// Retention under suction; `None`: the soil stays saturated.
    pub retention: Option<Retention>,
}

/// Hydraulic conductivity.
#[derive(Clone, Debug, PartialEq)]
pub struct Permeability<const D: usize> {
    /// Permeability along the axes of the grid at the initial porosity (m/s).
    pub along: Vector<D>,
    /// Dependence on the porosity.
    pub law: PermeabilityLaw,
}

/// Dependence of the permeability on the porosity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PermeabilityLaw {
    /// Constant permeability.
    Constant,
    /// Proportional to n^3/(1-n)^2 (Kozeny 1927, Carman 1937).
    KozenyCarman,
}

/// Prescribed pressure at a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// Hydrostatic pressure, without excess pressure.
    StillWater,
    /// Height to which water rises, above the lower corner of the grid (m).
    Head(Course),
    /// Pore pressure (Pa).
    Pressure(Course),
    /// Seepage face: hydrostatic below the water level; above it, water leaves at zero pressure and cannot enter.
    Seepage,
}

/// Value as a function of time: rows (time in s, value), increasing in time; linear in between, constant outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Course(pub Vec<(f64, f64)>);

impl Given {
    /// Returns the prescribed value as a function of time; `None` if it follows from the hydrostatic pressure.
    pub fn course(&self) -> Option<&Course> {
        match self {
            Self::Head(course) | Self::Pressure(course) => Some(course),
            Self::StillWater | Self::Seepage => None,
        }
    }

    /// Returns whether the value changes abruptly in a step.
    fn turns(&self, interval: TimeInterval) -> bool {
        self.course().is_some_and(|course| course.turns(interval))
    }
}

impl Course {
    /// Returns whether the value changes abruptly in a step.
    fn turns(&self, interval: TimeInterval) -> bool {
        turns(&self.0, self.at(0.0), f64::abs, interval)
    }

    /// Returns the times of the rows (s).
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|row| row.0)
    }

    /// Returns the integral over time, exact for any position of the rows.
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

    /// Returns the value at time `t`; 0 without rows.
    pub fn at(&self, t: f64) -> f64 {
        let first = self.0.first().map_or(0.0, |row| row.1);
        let last = self.0.last().map_or(0.0, |row| row.1);
        between(&self.0, first, t).unwrap_or(last)
    }
}

/// Drain: surface of a body with a prescribed pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Drain<const D: usize> {
    /// Surface points at the start.
    pub points: Vec<SurfacePoint<D>>,
    /// Unit normal of the surface at every point at the start, of either sign (-).
    pub normals: Vec<Vector<D>>,
    /// Prescribed pressure.
    pub given: Given,
    /// Whether the drain is active.
    pub acts: bool,
}

/// Face of the grid with a prescribed pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct DrainedFace {
    /// Axis normal to the face.
    pub axis: usize,
    /// Whether it is the face at the upper end of the axis.
    pub upper: bool,
    /// Prescribed pressure.
    pub given: Given,
    /// Whether the drain is active.
    pub acts: bool,
}

/// Surface of a body with a prescribed inflow.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow<const D: usize> {
    /// Surface points at the start.
    pub points: Vec<SurfacePoint<D>>,
    /// Unit normal of the surface at every point at the start, of either sign (-).
    pub normals: Vec<Vector<D>>,
    /// Rate into the ground (m/s).
    pub rate: Course,
    /// Whether the inflow is limited to what the ground takes at zero surface pressure (rain); the rest runs off.
    pub runs_off: bool,
    /// Whether the inflow is active.
    pub acts: bool,
}
