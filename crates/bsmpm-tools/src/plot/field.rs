//! Fields that can colour the body.

use bsmpm_io::frame::{FieldValues, Frame};
use clap::ValueEnum;

use crate::picture::ticks::padded;

/// The share of points whose values lie beyond each end of the range of colours, so that a few wild ones do not set it.
const BEYOND: f64 = 0.005;

/// A quantity of the points as pictures show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FieldName {
    /// Horizontal Cauchy stress, kPa
    StressXx,
    /// Vertical Cauchy stress, kPa; of a solid along y
    StressYy,
    /// Cauchy stress out of the plane, kPa; of a solid the vertical one
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
    /// Deviatoric stress, kPa, of frames with `q`
    Q,
    /// Largest principal stress, kPa, of frames with `principal-stresses`
    PrincipalLargest,
    /// Smallest principal stress, kPa, of frames with `principal-stresses`
    PrincipalSmallest,
    /// Mobilised strength, of frames with `mobilised-strength`
    MobilisedStrength,
    /// Deviatoric strain, of frames with `deviatoric-strain`
    DeviatoricStrain,
    /// Where the stress is on the yield surface, of frames with `yielding`
    Yielding,
    /// Present density, kg/m3, of frames with `density`
    Density,
    /// Number of the body, of frames with `body`
    Body,
    /// Pore pressure, kPa, of frames with `pore-pressure`
    PorePressure,
    /// Pore pressure beyond that of still water, kPa, of frames with `excess-pressure`
    ExcessPressure,
    /// Share of the pores that water fills, of frames with `saturation`
    Saturation,
    /// Share of pores in the volume, of frames with `porosity`
    Porosity,
    /// Length of the flux of water, m/s, of frames with `flux`
    Flux,
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
        let principal = |component, quantity| PlotSource {
            field: "principal_stresses",
            components: 3,
            component: Some(component),
            scale: 1e-3,
            quantity,
            unit: "kPa",
        };
        let vector = |field, quantity, unit| PlotSource {
            field,
            components: 3,
            component: None,
            scale: 1.0,
            quantity,
            unit,
        };
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
            Self::Q => scalar("q", 1e-3, "Deviatoric stress", "kPa"),
            Self::PrincipalLargest => principal(0, "Largest principal stress"),
            Self::PrincipalSmallest => principal(2, "Smallest principal stress"),
            Self::MobilisedStrength => scalar("mobilised_strength", 1.0, "Mobilised strength", "-"),
            Self::DeviatoricStrain => scalar("deviatoric_strain", 1.0, "Deviatoric strain", "-"),
            Self::Yielding => scalar("yielding", 1.0, "Yielding", "-"),
            Self::Density => scalar("density", 1.0, "Density", "kg/m3"),
            Self::Body => scalar("body", 1.0, "Body", "-"),
            Self::PorePressure => scalar("pore_pressure", 1e-3, "Pore pressure", "kPa"),
            Self::ExcessPressure => scalar("excess_pressure", 1e-3, "Excess pore pressure", "kPa"),
            Self::Saturation => scalar("saturation", 1.0, "Saturation", "-"),
            Self::Porosity => scalar("porosity", 1.0, "Porosity", "-"),
            Self::Flux => vector("flux", "Flux of water", "m/s"),
        }
    }

    /// The name on the command line and of the pictures: `stress-yy`.
    pub(super) fn name(self) -> String {
        self.to_possible_value()
            .map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// The name of the frames' field.
    pub(super) fn field(self) -> &'static str {
        self.source().field
    }

    /// The label of the colour bar, of a plane or of a section of a solid across an axis.
    pub(super) fn label(self, across: Option<usize>) -> (&'static str, &'static str) {
        let source = self.source();
        let quantity = match (self, across) {
            (Self::StressXx, Some(0)) => "Stress σxx across the section",
            (Self::StressYy, Some(1)) => "Stress σyy across the section",
            (Self::StressYy, Some(_)) => "Horizontal stress σyy",
            (Self::StressZz, Some(_)) => "Vertical stress σzz",
            _ => source.quantity,
        };
        (quantity, source.unit)
    }

    /// The quantity at every point of a frame, in the unit of [`FieldName::label`].
    pub(crate) fn values(self, frame: &Frame) -> Option<Vec<f64>> {
        let PlotSource {
            field,
            components,
            component,
            scale,
            ..
        } = self.source();
        if self == Self::Body {
            let body = frame.fields.iter().find(|of| of.name == field)?;
            let FieldValues::U64(numbers) = &body.values else {
                return None;
            };
            return Some(numbers.iter().map(|&number| number as f64).collect());
        }
        let values = frame.real(field, components)?.chunks_exact(components);
        Some(match component {
            Some(component) => values.map(|point| scale * point[component]).collect(),
            None => values
                .map(|point| scale * point.iter().map(|value| value * value).sum::<f64>().sqrt())
                .collect(),
        })
    }

    /// The range of colours: all values but the most extreme; lengths and strains begin at zero.
    pub(super) fn range(self, values: &[Vec<f64>]) -> (f64, f64) {
        let mut all: Vec<f64> = values
            .iter()
            .flatten()
            .copied()
            .filter(|value| value.is_finite())
            .collect();
        all.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| {
            all.get((share * all.len().saturating_sub(1) as f64).round() as usize)
                .copied()
                .unwrap_or(0.0)
        };
        let (low, high) = (at(BEYOND), at(1.0 - BEYOND));
        match self {
            _ if self.begins_at_zero() && high > 0.0 => (0.0, high),
            _ if self.begins_at_zero() => (0.0, 1.0),
            _ if high > low => (low, high),
            _ => padded(low, high, 0.0),
        }
    }

    /// What lies beyond the range of colours by more than a twentieth of it, to be said below a title.
    pub(super) fn beyond(self, values: &[f64], (low, high): (f64, f64)) -> String {
        let (least, largest) = values
            .iter()
            .fold((high, low), |(least, most), &x| (x.min(least), x.max(most)));
        let room = 0.05 * (high - low);
        let end = |word: &str, value: f64| {
            let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
            let unit = if self.source().unit == "-" {
                ""
            } else {
                self.source().unit
            };
            format!(", {word} {rounded} {unit}").trim_end().to_owned()
        };
        let below = if least < low - room {
            end("least", least)
        } else {
            String::new()
        };
        below
            + &if largest > high + room {
                end("largest", largest)
            } else {
                String::new()
            }
    }

    /// Whether it is never negative, and 0 is where nothing is.
    fn begins_at_zero(self) -> bool {
        matches!(
            self,
            Self::PlasticStrain | Self::Displacement | Self::Velocity | Self::Q | Self::Flux
        ) || matches!(self, Self::MobilisedStrength | Self::DeviatoricStrain | Self::Yielding)
    }
}
