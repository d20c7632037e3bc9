//! Data of pore-water flow, drains and inflows.

use super::{Case, Face, LoadedLine, Plate, Site};
use bsmpm::field::pore_water::flow::{Course, Given, Motion, Soil};

/// Pore water whose excess pressure is an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// N/m3  of the water, where there is none that is still
    pub unit_weight: f64,
    /// Pa  bulk modulus of the water; infinite: incompressible
    pub bulk: f64,
    /// By the number of the material; `None` where the pressure is that of the still water. Of a plane nothing is
    /// along the third axis.
    pub soils: Vec<Option<Soil<3>>>,
    /// Surfaces at which the pressure is given, in the order of the file.
    pub drains: Vec<Drain>,
    /// Surfaces through which water is put in, in the order of the file.
    pub inflows: Vec<Inflow>,
    /// Pa  the largest suction at the start; without a level of `[water]` there is none
    pub suction: f64,
    /// What the water does.
    pub motion: Motion,
    /// The same once it rests: while strength is divided.
    pub at_rest: Motion,
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
    /// m  the part of a circle inside the grid
    Circle {
        /// its middle
        center: [f64; 2],
        /// its radius
        radius: f64,
    },
    /// Of a solid: a part of bodies' surfaces at the start.
    Plate(Plate),
}

impl DrainSite {
    /// Its parts, but for a face of the grid.
    pub fn lines(&self) -> Vec<LoadedLine> {
        match self {
            Self::Face(_) => Vec::new(),
            Self::Lines(pieces) => pieces
                .iter()
                .map(|[from, to]| LoadedLine::Segment { from: *from, to: *to })
                .collect(),
            Self::Circle { center, radius } => vec![LoadedLine::Circle {
                center: *center,
                radius: *radius,
            }],
            Self::Plate(plate) => vec![LoadedLine::Plate(*plate)],
        }
    }
}

/// A surface through which water is put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow {
    /// A segment or plate of a body's surface at the start.
    pub site: Site,
    /// m/s  into the ground
    pub rate: Course,
    /// What the ground does not take runs off.
    pub runs_off: bool,
}

impl Case {
    /// Pa  suction at the start at `at` (m, in the case's coordinates) as it presses the grains of a material together:
    /// chi s; 0 where its pores stay full, or below the water
    pub(crate) fn suction_at(&self, material: u16, at: [f64; 3]) -> f64 {
        let Some(flow) = self.flow.as_ref().filter(|flow| flow.retains()) else {
            return 0.0;
        };
        let Some(water) = &self.water else { return 0.0 };
        let Some((height, _)) = water.table.table(at[0], 0.0) else {
            return 0.0;
        };
        let up = self.grid.dims() - 1;
        let suction = (water.unit_weight * (at[up] - height)).clamp(0.0, flow.suction);
        let soil = flow.soils[usize::from(material)].as_ref();
        soil.map_or(0.0, |soil| {
            soil.retained(-suction, water.unit_weight).effective * suction
        })
    }
}

impl Flow {
    /// Whether a soil may be partly saturated.
    pub(crate) fn retains(&self) -> bool {
        self.soils.iter().flatten().any(|soil| soil.retention.is_some())
    }
}
