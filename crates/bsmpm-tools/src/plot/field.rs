//! Fields that can colour the body.

use bsmpm_io::frame::{FieldValues, Frame};
use clap::ValueEnum;

use crate::picture::axes::Label;
use crate::picture::bar::PointedEnds;
use crate::picture::ticks::ValueRange;

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

impl PlotSource {
    /// A component of the Cauchy stress.
    fn stress(component: usize, quantity: &'static str) -> Self {
        Self {
            field: "stress",
            components: 6,
            component: Some(component),
            scale: 1e-3,
            quantity,
            unit: "kPa",
        }
    }

    /// A principal stress.
    fn principal(component: usize, quantity: &'static str) -> Self {
        Self {
            field: "principal_stresses",
            components: 3,
            ..Self::stress(component, quantity)
        }
    }

    /// A field of one component.
    fn scalar(field: &'static str, scale: f64, quantity: &'static str, unit: &'static str) -> Self {
        Self {
            field,
            components: 1,
            component: Some(0),
            scale,
            quantity,
            unit,
        }
    }

    /// The length of a vector.
    fn vector(field: &'static str, quantity: &'static str, unit: &'static str) -> Self {
        Self {
            components: 3,
            component: None,
            ..Self::scalar(field, 1.0, quantity, unit)
        }
    }
}

impl FieldName {
    fn source(self) -> PlotSource {
        match self {
            Self::StressXx => PlotSource::stress(0, "Horizontal stress σxx"),
            Self::StressYy => PlotSource::stress(1, "Vertical stress σyy"),
            Self::StressZz => PlotSource::stress(2, "Out-of-plane stress σzz"),
            Self::StressXy => PlotSource::stress(3, "Shear stress σxy"),
            Self::Pressure => PlotSource::scalar("pressure", 1e-3, "Pressure", "kPa"),
            Self::PlasticStrain => PlotSource::scalar("plastic_strain", 1.0, "Accumulated plastic strain", "-"),
            Self::Displacement => PlotSource::vector("displacement", "Displacement", "m"),
            Self::Velocity => PlotSource::vector("velocity", "Velocity", "m/s"),
            Self::Q => PlotSource::scalar("q", 1e-3, "Deviatoric stress", "kPa"),
            Self::PrincipalLargest => PlotSource::principal(0, "Largest principal stress"),
            Self::PrincipalSmallest => PlotSource::principal(2, "Smallest principal stress"),
            Self::MobilisedStrength => PlotSource::scalar("mobilised_strength", 1.0, "Mobilised strength", "-"),
            Self::DeviatoricStrain => PlotSource::scalar("deviatoric_strain", 1.0, "Deviatoric strain", "-"),
            Self::Yielding => PlotSource::scalar("yielding", 1.0, "Yielding", "-"),
            Self::Density => PlotSource::scalar("density", 1.0, "Density", "kg/m3"),
            Self::Body => PlotSource::scalar("body", 1.0, "Body", "-"),
            Self::PorePressure => PlotSource::scalar("pore_pressure", 1e-3, "Pore pressure", "kPa"),
            Self::ExcessPressure => PlotSource::scalar("excess_pressure", 1e-3, "Excess pore pressure", "kPa"),
            Self::Saturation => PlotSource::scalar("saturation", 1.0, "Saturation", "-"),
            Self::Porosity => PlotSource::scalar("porosity", 1.0, "Porosity", "-"),
            Self::Flux => PlotSource::vector("flux", "Flux of water", "m/s"),
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
    pub(super) fn label(self, across: Option<usize>) -> Label<'static> {
        let source = self.source();
        let quantity = match (self, across) {
            (Self::StressXx, Some(0)) => "Stress σxx across the section",
            (Self::StressYy, Some(1)) => "Stress σyy across the section",
            (Self::StressYy, Some(_)) => "Horizontal stress σyy",
            (Self::StressZz, Some(_)) => "Vertical stress σzz",
            _ => source.quantity,
        };
        Label::of(quantity, source.unit)
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
    pub(super) fn range(self, values: &[Vec<f64>]) -> ValueRange {
        let mut all: Vec<f64> = values
            .iter()
            .flatten()
            .copied()
            .filter(|value| value.is_finite())
            .collect();
        all.sort_unstable_by(f64::total_cmp);
        let last = all.len().saturating_sub(1) as f64;
        let [low, high] = [BEYOND, 1.0 - BEYOND].map(|share| {
            let at = (share * last).round() as usize;
            all.get(at).copied().unwrap_or(0.0)
        });
        match self {
            _ if self.begins_at_zero() && high > 0.0 => ValueRange::of(0.0, high),
            _ if self.begins_at_zero() => ValueRange::UNIT,
            _ if high > low => ValueRange::of(low, high),
            _ => ValueRange::of(low, high).padded(0.0),
        }
    }

    /// The ends of the range of colours beyond which values lie by more than a twentieth of it.
    pub(super) fn exceeded(values: &[f64], range: ValueRange) -> PointedEnds {
        let ValueRange { low, high } = range;
        let room = 0.05 * range.length();
        PointedEnds {
            lower: least(values, high) < low - room,
            upper: largest(values, low) > high + room,
        }
    }

    /// The extreme values beyond the ends of the range of colours, to be said below a title.
    pub(super) fn beyond(self, values: &[f64], range: ValueRange) -> String {
        let exceeded = Self::exceeded(values, range);
        let mut text = String::new();
        if exceeded.lower {
            text += &self.extreme("least", least(values, range.high));
        }
        if exceeded.upper {
            text += &self.extreme("largest", largest(values, range.low));
        }
        text
    }

    /// An extreme value, to three digits and with its unit.
    fn extreme(self, word: &str, value: f64) -> String {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        let unit = match self.source().unit {
            "-" => "",
            unit => unit,
        };
        format!(", {word} {rounded} {unit}").trim_end().to_owned()
    }

    /// Whether it is never negative, and 0 is where nothing is.
    fn begins_at_zero(self) -> bool {
        matches!(
            self,
            Self::PlasticStrain | Self::Displacement | Self::Velocity | Self::Q | Self::Flux
        ) || matches!(self, Self::MobilisedStrength | Self::DeviatoricStrain | Self::Yielding)
    }
}

/// The least of some values, at most `bound`.
fn least(values: &[f64], bound: f64) -> f64 {
    values.iter().fold(bound, |least, &value| value.min(least))
}

/// The largest of some values, at least `bound`.
fn largest(values: &[f64], bound: f64) -> f64 {
    values.iter().fold(bound, |largest, &value| value.max(largest))
}
