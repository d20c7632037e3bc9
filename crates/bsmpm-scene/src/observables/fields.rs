//! Lists of the fields of material points: those that frames have on request, and those of profiles along a line. A new
//! field is an entry here, with its word, documentation, unit and value.

use super::columns::{self, Columns};
use crate::words::Word;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::material::{LayeredMaterial, Material};
use bsmpm::observe::{self, invariants};
use bsmpm::points::Points;
use bsmpm::tensor::{Symmetric, Vector};
use std::fmt;
use std::ops::Range;

/// Material points with what they belong to, for the fields of a frame.
#[derive(Clone, Copy)]
pub struct PointSample<'a, const D: usize> {
    /// Material points of this rank.
    pub points: &'a Points<D>,
    /// Materials by number.
    pub materials: &'a [LayeredMaterial],
    /// Ids of the points of every body; empty if no frame reports bodies.
    pub bodies: &'a [Range<u64>],
    /// Water at the time of the frame.
    pub water: Option<PoreWater<'a, D>>,
    /// Darcy velocity of every point (m/s), if frames have it; empty where no water flows.
    pub fluxes: &'a [Vector<D>],
}

/// Fields at a place of a profile, interpolated from the points around it.
#[derive(Clone, Copy, Debug)]
pub struct PlaceSample {
    /// Displacement (m).
    pub displacement: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Cauchy stress (Pa).
    pub stress: Symmetric,
    /// Accumulated plastic strain (-).
    pub plastic_strain: f64,
    /// Pore pressure (Pa).
    pub pore_pressure: f64,
    /// Excess pore pressure (Pa).
    pub excess_pressure: f64,
}

/// Defines the enum of the fields of frames. An entry is `/// documentation`
/// `Name = "word": "name in frames", "unit", components, is_of_flow => value;` with the array of the values of a point.
macro_rules! frame_fields {
    ($sample:ident, $p:ident => $(
        $(#[doc = $doc:literal])+
        $variant:ident = $word:literal: $field:literal, $unit:literal, $components:literal, $is_of_flow:literal => $value:expr;
    )+) => {
        /// A field that frames have on request.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum FrameField {
            $($(#[doc = $doc])+ $variant,)+
        }

        words! { FrameField { $($variant = $word: concat!($($doc),+),)+ } }

        impl FrameField {
            /// Name in frames.
            pub fn field(self) -> &'static str {
                match self { $(Self::$variant => $field,)+ }
            }

            /// Unit of its numbers.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$variant => $unit,)+ }
            }

            /// Numbers of a point.
            pub fn components(self) -> usize {
                match self { $(Self::$variant => $components,)+ }
            }

            /// Whether it is of water that flows.
            pub fn is_of_flow(self) -> bool {
                match self { $(Self::$variant => $is_of_flow,)+ }
            }

            /// Adds the numbers of point `p` to a row.
            pub fn put<const D: usize>(self, $sample: &PointSample<'_, D>, $p: usize, row: &mut Vec<f64>) {
                match self { $(Self::$variant => row.extend($value),)+ }
            }
        }
    };
}

frame_fields! { sample, p =>
    /// Deviatoric stress sqrt(3/2 s:s) in Pa.
    Q = "q": "q", "Pa", 1, false => [invariants::deviatoric(&sample.points.sigma.at(p))];
    /// Principal Cauchy stresses in Pa, in descending order, positive in tension.
    PrincipalStresses = "principal-stresses": "principal_stresses", "Pa", 3, false =>
        invariants::principal(&sample.points.sigma.at(p));
    /// Mobilised strength 1/F: the stress reaches the yield surface if the strength is divided by F. It is 1 at
    /// yield, and 0 for a law without strength.
    MobilisedStrength = "mobilised-strength": "mobilised_strength", "-", 1, false => [sample.mobilised(p)];
    /// Deviatoric logarithmic strain since the start, sqrt(2/3 e:e).
    DeviatoricStrain = "deviatoric-strain": "deviatoric_strain", "-", 1, false =>
        [invariants::deviatoric_strain(sample.points, p)];
    /// 1 if the stress is on the yield surface (within 1e-4 of the strength), otherwise 0.
    Yielding = "yielding": "yielding", "-", 1, false =>
        [f64::from(u8::from(Material::is_yielding(sample.mobilised(p))))];
    /// Present density in kg/m3.
    Density = "density": "density", "kg/m3", 1, false => [invariants::density(sample.points, p)];
    /// Pore pressure in Pa, positive in compression.
    PorePressure = "pore-pressure": "pore_pressure", "Pa", 1, false =>
        [sample.water.map_or(0.0, |water| water.pressure(p))];
    /// Excess pore pressure in Pa: pore pressure minus hydrostatic pressure of the present water level.
    ExcessPressure = "excess-pressure": "excess_pressure", "Pa", 1, true =>
        [sample.water.map_or(0.0, |water| water.excess(p))];
    /// Darcy velocity in m/s: volume of water per area and time, relative to the soil.
    Flux = "flux": "flux", "m/s", 3, true =>
        observe::in_space(sample.fluxes.get(p).unwrap_or(&Vector::zeros()));
    /// Present porosity, where water flows.
    Porosity = "porosity": "porosity", "-", 1, true => [sample.water.map_or(0.0, |water| water.porosity(p))];
    /// Degree of saturation, where water flows.
    Saturation = "saturation": "saturation", "-", 1, true => [sample.water.map_or(0.0, |water| water.saturation(p))];
    /// Total stress in Pa: effective stress minus pore pressure, positive in tension.
    TotalStress = "total-stress": "total_stress", "Pa", 6, false => sample.total_stress(p).0;
    /// Number of the body in the order of the case. run.json and the frame contain the names.
    Body = "body": "body", "-", 1, false => [sample.body(p) as f64];
}

impl<const D: usize> PointSample<'_, D> {
    fn mobilised(&self, p: usize) -> f64 {
        invariants::mobilised(self.materials, self.points, p)
    }

    fn total_stress(&self, p: usize) -> Symmetric {
        let total = self.water.map(|water| water.total_stress(p));
        total.unwrap_or_else(|| self.points.sigma.at(p))
    }

    /// Number of the body of a point.
    fn body(&self, p: usize) -> usize {
        self.bodies.partition_point(|ids| ids.end <= self.points.id[p])
    }
}

impl fmt::Display for FrameField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Defines the enum of the quantities of profiles. An entry is `/// documentation`
/// `Name = "word": COLUMNS, "unit" => value;` with the values at a place in `D` dimensions.
macro_rules! profile_quantities {
    ($sample:ident => $(
        $(#[doc = $doc:literal])+
        $variant:ident = $word:literal: $columns:ident, $unit:literal => $value:expr;
    )+) => {
        /// What a profile reports at its places.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum ProfileQuantity {
            $($(#[doc = $doc])+ $variant,)+
        }

        words! { ProfileQuantity { $($variant = $word: concat!($($doc),+),)+ } }

        impl ProfileQuantity {
            /// Unit of its numbers.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$variant => $unit,)+ }
            }

            fn columns(self) -> Columns {
                match self { $(Self::$variant => columns::$columns,)+ }
            }

            /// Adds the numbers at a place to a row.
            pub fn put<const D: usize>(self, $sample: &PlaceSample, row: &mut Vec<f64>) {
                match self { $(Self::$variant => row.extend($value),)+ }
            }
        }
    };
}

profile_quantities! { sample =>
    /// Displacement in m.
    Displacement = "displacement": VECTOR, "m" => &sample.displacement[..D];
    /// Velocity in m/s, in dynamic analyses.
    Velocity = "velocity": VECTOR, "m/s" => &sample.velocity[..D];
    /// Cauchy stress in Pa, positive in tension.
    Stress = "stress": STRESS, "Pa" => observe::stress_components::<D>(&sample.stress.0);
    /// Mean stress in Pa, positive in compression.
    P = "p": SCALAR, "Pa" => [invariants::pressure(&sample.stress)];
    /// Deviatoric stress sqrt(3/2 s:s) in Pa.
    Q = "q": SCALAR, "Pa" => [invariants::deviatoric(&sample.stress)];
    /// Accumulated plastic strain, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain increments.
    PlasticStrain = "plastic-strain": SCALAR, "-" => [sample.plastic_strain];
    /// Pore pressure in Pa, positive in compression.
    PorePressure = "pore-pressure": SCALAR, "Pa" => [sample.pore_pressure];
    /// Excess pore pressure in Pa: pore pressure minus hydrostatic pressure of the present water level.
    ExcessPressure = "excess-pressure": SCALAR, "Pa" => [sample.excess_pressure];
}

impl fmt::Display for ProfileQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl ProfileQuantity {
    /// Names of its columns along so many axes.
    pub fn column_names(self, dims: usize) -> Vec<String> {
        let suffixes = self.columns().in_dimensions(dims).iter();
        suffixes.map(|(suffix, _)| format!("{self}{suffix}")).collect()
    }
}
