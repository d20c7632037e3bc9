//! What can colour the body.

use bsmpm_io::frame::Frame;
use clap::ValueEnum;

use crate::picture::ticks::padded;

/// The share of points whose values lie beyond each end of the range of colours, so that a few wild ones do not set it.
const BEYOND: f64 = 0.005;

/// A quantity of the points as pictures show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FieldName {
    /// Horizontal Cauchy stress, kPa
    StressXx,
    /// Vertical Cauchy stress, kPa
    StressYy,
    /// Cauchy stress out of the plane, kPa
    StressZz,
    /// Shear stress, kPa
    StressXy,
    /// Mean pressure, positive in compression, kPa
    Pressure,
    /// Accumulated plastic strain
    PlasticStrain,
    /// Length of the displacement, m
    Displacement,
    /// Length of the velocity, m/s
    Velocity,
}

/// How a quantity is taken from a frame.
struct PlotSource {
    field: &'static str,
    components: usize,
    /// The component; none takes the length of the vector.
    component: Option<usize>,
    scale: f64,
    quantity: &'static str,
    unit: &'static str,
}

impl FieldName {
    fn source(self) -> PlotSource {
        let stress = |component, quantity| PlotSource {
            field: "stress",
            components: 6,
            component: Some(component),
            scale: 1e-3,
            quantity,
            unit: "kPa",
        };
        let vector =
            |field, quantity, unit| PlotSource { field, components: 3, component: None, scale: 1.0, quantity, unit };
        let scalar = |field, scale, quantity, unit| PlotSource {
            field,
            components: 1,
            component: Some(0),
            scale,
            quantity,
            unit,
        };
        match self {
            Self::StressXx => stress(0, "Horizontal stress σxx"),
            Self::StressYy => stress(1, "Vertical stress σyy"),
            Self::StressZz => stress(2, "Out-of-plane stress σzz"),
            Self::StressXy => stress(3, "Shear stress σxy"),
            Self::Pressure => scalar("pressure", 1e-3, "Pressure", "kPa"),
            Self::PlasticStrain => scalar("plastic_strain", 1.0, "Accumulated plastic strain", "-"),
            Self::Displacement => vector("displacement", "Displacement", "m"),
            Self::Velocity => vector("velocity", "Velocity", "m/s"),
        }
    }

    /// The name on the command line and of the pictures: `stress-yy`.
    pub(super) fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// The name of the frames' field.
    pub(super) fn field(self) -> &'static str {
        self.source().field
    }

    /// The label of the colour bar.
    pub(super) fn label(self) -> (&'static str, &'static str) {
        let source = self.source();
        (source.quantity, source.unit)
    }

    /// The quantity at every point of a frame, in the unit of [`FieldName::label`].
    pub(crate) fn values(self, frame: &Frame) -> Option<Vec<f64>> {
        let PlotSource { field, components, component, scale, .. } = self.source();
        let values = frame.real(field, components)?.chunks_exact(components);
        Some(match component {
            Some(component) => values.map(|point| scale * point[component]).collect(),
            None => values.map(|point| scale * point.iter().map(|value| value * value).sum::<f64>().sqrt()).collect(),
        })
    }

    /// The range of colours: all values but the most extreme; lengths and strains begin at zero.
    pub(super) fn range(self, values: &[Vec<f64>]) -> (f64, f64) {
        let mut all: Vec<f64> = values.iter().flatten().copied().filter(|value| value.is_finite()).collect();
        all.sort_unstable_by(f64::total_cmp);
        let at =
            |share: f64| all.get((share * all.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(0.0);
        let (low, high) = (at(BEYOND), at(1.0 - BEYOND));
        match self {
            Self::PlasticStrain | Self::Displacement | Self::Velocity if high > 0.0 => (0.0, high),
            Self::PlasticStrain | Self::Displacement | Self::Velocity => (0.0, 1.0),
            _ if high > low => (low, high),
            _ => padded(low, high, 0.0),
        }
    }
}
