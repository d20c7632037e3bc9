//! Data of histories and their checks.

use crate::words::{Geometry, Measurement, Side};

/// A quantity that is recorded every step.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// What is recorded.
    pub quantity: Quantity,
    /// Name of the column, or beginning of the columns' names.
    pub name: String,
    /// -  multiplies
    pub scale: f64,
    /// Kind of the geometry: what extensive numbers are of.
    pub geometry: Geometry,
    /// Whether its place is at a body that no stage places or removes: the point that it follows is one of those.
    pub lasts: bool,
}

/// The points that a history counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointSelection {
    /// by what they are made of
    pub made: Made,
    /// m  lower and upper corner of the box that they are in at that time, in the case's coordinates; `None`: anywhere
    pub within: Option<[[f64; 3]; 2]>,
}

/// What the points are of that a history counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Made {
    /// All of them.
    #[default]
    All,
    /// Those of the material of this number.
    Material(u16),
    /// Those of the body of this number.
    Body(usize),
}

/// What a history records.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// m  the x that `percentile` per cent of the points do not exceed
    Runout {
        /// %  100: the farthest point
        percentile: f64,
        /// the points that count
        of: PointSelection,
    },
    /// m  the farthest x of the lowest occupied row up to which the last cell's length is at least half filled
    Front,
    /// m  the largest y of any point, or of those near an x; 0 where there are none
    Height {
        /// m  of the points within half a cell of this x; `None`: of all
        at_x: Option<f64>,
        /// the points that count
        of: PointSelection,
    },
    /// m  the largest displacement of any point
    MaxDisplacement {
        /// the points that count
        of: PointSelection,
    },
    /// kg/m
    Mass {
        /// the points that count
        of: PointSelection,
    },
    /// kg/s  per metre of thickness (kg m/s per m)
    Momentum {
        /// the points that count
        of: PointSelection,
    },
    /// m  in the case's coordinates
    CentreOfMass {
        /// the points that count
        of: PointSelection,
    },
    /// kg m/s  about the origin of the case's coordinates, per metre of thickness (kg m2/s per m)
    AngularMomentum {
        /// the points that count
        of: PointSelection,
    },
    /// J/m
    KineticEnergy {
        /// the points that count
        of: PointSelection,
    },
    /// Pa  positive in tension
    MeanStress {
        /// the points that count
        of: PointSelection,
    },
    /// m
    MeanDisplacement {
        /// the points that count
        of: PointSelection,
    },
    /// m/s
    MeanVelocity {
        /// the points that count
        of: PointSelection,
    },
    /// -  mean and largest
    PlasticStrain {
        /// the points that count
        of: PointSelection,
    },
    /// N/m, N/m, N m/m  normal force, shear force and moment; in space N, N m of three forces and three moments
    SectionForces {
        /// m  ends of the line, in the case's coordinates; in space of the lines along t1 and t2 through the middle
        lines: Vec<[[f64; 3]; 2]>,
        /// They are diameters of a disc; in space middle lines of a rectangle else.
        round: bool,
        /// The section stays where it is in space; it goes with the material else.
        fixed: bool,
    },
    /// N/m  force of a face's supports on the body
    Reaction {
        /// The face.
        face: Face,
    },
    /// m  of the material that is at `at` at the start, by the motion about the point nearest to it
    Displacement {
        /// m  in the case's coordinates
        at: [f64; 3],
    },
    /// m/s  of the point nearest to `at` at the start
    Velocity {
        /// m  in the case's coordinates
        at: [f64; 3],
        /// of the place itself instead, by a plane through the points around it
        surface: bool,
    },
    /// Pa  Cauchy stress of the point nearest to `at` at the start
    Stress {
        /// m  in the case's coordinates
        at: [f64; 3],
        /// of the place itself instead, by a plane through the points around it
        surface: bool,
    },
    /// Pa  of the water, positive in compression, at the point nearest to `at` at the start
    PorePressure {
        /// m  in the case's coordinates
        at: [f64; 3],
        /// of the place itself instead, by a plane through the points around it
        surface: bool,
    },
    /// Pa  of the water in the pores of all points that count, positive in compression: mean, least, largest
    PorePressures {
        /// the points that count
        of: PointSelection,
    },
    /// of the pore water of the point nearest to `at` at the start: excess pressure, porosity or flux
    Pore {
        /// which of them
        what: Measurement,
        /// m  in the case's coordinates
        at: [f64; 3],
        /// of the place itself instead, by a plane through the points around it
        surface: bool,
    },
    /// m3/m  water that has left the ground, per metre of thickness
    WaterOutflow {
        /// Number of the drain, in the order of the file; `None`: all, less the inflows.
        drain: Option<usize>,
    },
    /// -  what the ground has gained of water and what has left it, over what crossed its surface or moved in it
    WaterBalance,
    /// -  oscillation of sigma_yy about its average over the grid and about a plane
    StressNoise,
    /// Pa  oscillation of the pressure about its average over the grid and about a plane
    PressureNoise {
        /// the points that count
        of: PointSelection,
    },
    /// m  the largest upward displacement of any point
    Heave {
        /// the points that count
        of: PointSelection,
    },
    /// Pa  mean normal pressure on the footing's base
    FootingPressure,
    /// N/m  force of the soil on the footing against its motion
    FootingForce,
    /// m  of the footing, downwards
    Penetration,
    /// -  largest distance that the material has slipped from the footing in the step, over the footing's motion
    Slip,
    /// -  part of a face's nodes that material is on, and of its normal force where it slides
    Contact {
        /// The face.
        face: Face,
    },
    /// m  least and largest distance of the material from a face
    Gap {
        /// The face.
        face: Face,
    },
    /// m/s  of the material along a face
    SlipRate {
        /// The face.
        face: Face,
    },
    /// W/m  dissipated by friction at a face
    FrictionPower {
        /// The face.
        face: Face,
    },
    /// of a rigid body: force, moment, displacement, rotation, velocity, slip or gap
    Rigid {
        /// which of them
        what: Measurement,
        /// number of the body
        body: usize,
    },
    /// of a strip: the footing, then the prescribed motions in the order of the file
    Strip {
        /// Its number.
        number: usize,
        /// What of it.
        measured: Measurement,
    },
    /// kg/m  that has left the grid
    Outflow,
    /// J/m  where the energy is, and where it went since the start
    Energy,
}

/// A face of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// axis that it is normal to
    pub axis: usize,
    /// the face at the axis' upper end
    pub upper: bool,
}

impl Face {
    /// The face at a side, if the geometry has one there.
    pub fn of(side: Side, geometry: Geometry) -> Option<Self> {
        Side::of(geometry).iter().enumerate().find_map(|(axis, sides)| {
            let number = sides.iter().position(|own| *own == side)?;
            let upper = number == 1;
            Some(Self { axis, upper })
        })
    }

    /// Where it is.
    pub fn side(self, geometry: Geometry) -> Side {
        Side::of(geometry)[self.axis][usize::from(self.upper)]
    }
}

/// One column of the history file.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit of its numbers; `scaled UNIT` where a scale multiplies.
    pub unit: String,
}

impl Quantity {
    /// The points that it counts.
    pub fn counted(&self) -> PointSelection {
        match *self {
            Self::Mass { of } | Self::Momentum { of } | Self::CentreOfMass { of } | Self::AngularMomentum { of } => of,
            Self::KineticEnergy { of } | Self::MeanStress { of } | Self::Runout { of, .. } => of,
            Self::MeanDisplacement { of } | Self::MeanVelocity { of } | Self::PlasticStrain { of } => of,
            Self::PorePressures { of } | Self::PressureNoise { of } => of,
            Self::Height { of, .. } | Self::MaxDisplacement { of } | Self::Heave { of } => of,
            _ => PointSelection::default(),
        }
    }

    /// Its kind, which has its definition, unit and columns.
    pub fn measurement(&self) -> Measurement {
        match self {
            Self::Runout { .. } => Measurement::Runout,
            Self::Front => Measurement::Front,
            Self::Height { .. } => Measurement::Height,
            Self::MaxDisplacement { .. } => Measurement::MaxDisplacement,
            Self::Mass { .. } => Measurement::Mass,
            Self::Outflow => Measurement::Outflow,
            Self::Momentum { .. } => Measurement::Momentum,
            Self::CentreOfMass { .. } => Measurement::CentreOfMass,
            Self::AngularMomentum { .. } => Measurement::AngularMomentum,
            Self::KineticEnergy { .. } => Measurement::KineticEnergy,
            Self::MeanStress { .. } => Measurement::MeanStress,
            Self::MeanDisplacement { .. } => Measurement::MeanDisplacement,
            Self::MeanVelocity { .. } => Measurement::MeanVelocity,
            Self::PlasticStrain { .. } => Measurement::PlasticStrain,
            Self::SectionForces { .. } => Measurement::SectionForces,
            Self::Reaction { .. } => Measurement::Reaction,
            Self::Displacement { .. } => Measurement::Displacement,
            Self::Velocity { .. } => Measurement::Velocity,
            Self::Stress { .. } => Measurement::Stress,
            Self::PorePressure { .. } => Measurement::PorePressure,
            Self::PorePressures { .. } => Measurement::PorePressures,
            Self::Pore { what, .. } => *what,
            Self::WaterOutflow { .. } => Measurement::WaterOutflow,
            Self::WaterBalance => Measurement::WaterBalance,
            Self::StressNoise => Measurement::StressNoise,
            Self::PressureNoise { .. } => Measurement::PressureNoise,
            Self::Heave { .. } => Measurement::Heave,
            Self::FootingPressure => Measurement::FootingPressure,
            Self::FootingForce => Measurement::FootingForce,
            Self::Penetration => Measurement::Penetration,
            Self::Slip => Measurement::Slip,
            Self::Contact { .. } => Measurement::Contact,
            Self::Gap { .. } => Measurement::Gap,
            Self::SlipRate { .. } => Measurement::SlipRate,
            Self::FrictionPower { .. } => Measurement::FrictionPower,
            Self::Rigid { what, .. } => *what,
            Self::Energy => Measurement::Energy,
            Self::Strip { measured, .. } => *measured,
        }
    }
}

impl History {
    /// What the physics' numbers are multiplied with.
    pub fn factor(&self) -> f64 {
        let measured = self.quantity.measurement();
        let whole = self
            .geometry
            .unit(measured.unit())
            .map_or(1.0, |_| self.geometry.whole());
        self.scale * whole
    }

    /// Its columns in the history file.
    pub fn columns(&self) -> Vec<Column> {
        let columns = self.quantity.measurement().columns_in(self.geometry.dims());
        let columns = columns.iter().enumerate().map(|(number, (suffix, _))| Column {
            name: format!("{}{suffix}", self.name),
            unit: self.unit_of(number),
        });
        columns.collect()
    }

    /// Unit of the column with a number.
    fn unit_of(&self, number: usize) -> String {
        let in_plane = self.quantity.measurement().unit_of(number, self.geometry.dims());
        let unit = self.geometry.unit(in_plane).unwrap_or(in_plane);
        if self.scale == 1.0 {
            unit.to_owned()
        } else {
            format!("scaled {unit}")
        }
    }
}

/// Bounds of a history column at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Name of the column.
    pub quantity: String,
    /// s (quasi-static: pseudo-time)  within (0, end]; hit exactly
    pub at: f64,
    /// Least value, in the column's unit.
    pub min: Option<f64>,
    /// Largest value, in the column's unit.
    pub max: Option<f64>,
}
