//! Dimensions of quantities and their units.

use std::fmt;

/// What a quantity measures. Values are SI; angles are in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A pure number.
    Number,
    /// m
    Length,
    /// s  of the analysis
    Time,
    /// s  by the clock on the wall
    Duration,
    /// Pa
    Stress,
    /// kg/m3
    Density,
    /// N/m3
    UnitWeight,
    /// degrees
    Angle,
    /// m/s
    Velocity,
    /// m/s  of water through soil, in real time
    Seepage,
    /// m/s2
    Acceleration,
    /// N/m
    LineForce,
    /// N
    Force,
}

/// What one unit is worth.
#[derive(Clone, Copy)]
pub(super) enum Worth {
    Ten(i32),
    Times(f64),
    Over(f64),
    Radian,
}

use Worth::{Over, Radian, Ten, Times};

/// s  of a day
const DAY: f64 = 86_400.0;
pub(super) const UNITS: [(Dimension, &[(&str, Worth)]); 10] = [
    (
        Dimension::Length,
        &[
            ("m", Ten(0)),
            ("cm", Ten(-2)),
            ("mm", Ten(-3)),
            ("um", Ten(-6)),
            ("nm", Ten(-9)),
            ("km", Ten(3)),
        ],
    ),
    (
        Dimension::Time,
        &[
            ("s", Ten(0)),
            ("ms", Ten(-3)),
            ("us", Ten(-6)),
            ("ns", Ten(-9)),
            ("min", Times(60.0)),
            ("h", Times(3600.0)),
            ("d", Times(DAY)),
            ("day", Times(DAY)),
            ("week", Times(7.0 * DAY)),
            ("year", Times(365.25 * DAY)),
        ],
    ),
    (
        Dimension::Stress,
        &[
            ("Pa", Ten(0)),
            ("kPa", Ten(3)),
            ("MPa", Ten(6)),
            ("GPa", Ten(9)),
            ("N/m2", Ten(0)),
            ("kN/m2", Ten(3)),
            ("MN/m2", Ten(6)),
        ],
    ),
    (
        Dimension::Density,
        &[("kg/m3", Ten(0)), ("t/m3", Ten(3)), ("g/cm3", Ten(3))],
    ),
    (
        Dimension::UnitWeight,
        &[("N/m3", Ten(0)), ("kN/m3", Ten(3)), ("MN/m3", Ten(6))],
    ),
    (Dimension::Angle, &[("deg", Ten(0)), ("rad", Radian)]),
    (
        Dimension::Velocity,
        &[
            ("m/s", Ten(0)),
            ("cm/s", Ten(-2)),
            ("mm/s", Ten(-3)),
            ("km/s", Ten(3)),
            ("mm/h", Over(3.6e6)),
            ("m/h", Over(3600.0)),
            ("mm/day", Over(1e3 * DAY)),
            ("cm/day", Over(1e2 * DAY)),
            ("m/day", Over(DAY)),
            ("m/year", Over(365.25 * DAY)),
        ],
    ),
    (
        Dimension::Acceleration,
        &[
            ("m/s2", Ten(0)),
            ("cm/s2", Ten(-2)),
            ("mm/s2", Ten(-3)),
            ("g", Times(9.806_65)),
        ],
    ),
    (
        Dimension::LineForce,
        &[("N/m", Ten(0)), ("kN/m", Ten(3)), ("MN/m", Ten(6))],
    ),
    (Dimension::Force, &[("N", Ten(0)), ("kN", Ten(3)), ("MN", Ten(6))]),
];

/// Other names of units, as people write them.
pub(super) const ALIASES: [(&str, &str); 24] = [
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("mins", "min"),
    ("minute", "min"),
    ("minutes", "min"),
    ("hr", "h"),
    ("hrs", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("days", "day"),
    ("weeks", "week"),
    ("yr", "year"),
    ("yrs", "year"),
    ("years", "year"),
    ("m/d", "m/day"),
    ("cm/d", "cm/day"),
    ("mm/d", "mm/day"),
    ("m/yr", "m/year"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
];

/// Pa  One pound-force per square foot: 4.448 221 615 260 5 N over (0.3048 m)^2.
const PSF: f64 = 47.880_258_980_335_84;
/// Units that are read, but not offered.
pub(super) const NOT_OFFERED: [(Dimension, &[(&str, Worth)]); 6] = [
    (Dimension::Length, &[("ft", Times(0.3048)), ("in", Times(0.0254))]),
    (
        Dimension::Stress,
        &[
            ("bar", Ten(5)),
            ("kgf/m2", Times(9.806_65)),
            ("kgf/cm2", Times(98_066.5)),
            ("tf/m2", Times(9806.65)),
            ("psf", Times(PSF)),
            ("ksf", Times(1e3 * PSF)),
            ("tsf", Times(2e3 * PSF)),
            ("psi", Times(144.0 * PSF)),
            ("ksi", Times(144e3 * PSF)),
        ],
    ),
    (Dimension::UnitWeight, &[("pcf", Over(0.3048 / PSF))]),
    (
        Dimension::Velocity,
        &[("ft/s", Times(0.3048)), ("ft/day", Over(DAY / 0.3048))],
    ),
    (
        Dimension::LineForce,
        &[("lbf/ft", Times(0.3048 * PSF)), ("kip/ft", Times(304.8 * PSF))],
    ),
    (
        Dimension::Force,
        &[
            ("lbf", Times(0.3048 * 0.3048 * PSF)),
            ("kip", Times(304.8 * 0.3048 * PSF)),
        ],
    ),
];

/// Masses per area, which some write for a stress, and the unit of force per area that is meant.
pub(super) const MASSES_PER_AREA: [(&str, &str); 4] = [
    ("t/m2", "tf/m2"),
    ("kg/cm2", "kgf/cm2"),
    ("kg/m2", "kgf/m2"),
    ("ton/m2", "tf/m2"),
];

/// The dimensions that have units, in the order of messages.
pub(crate) fn dimensions() -> impl Iterator<Item = Dimension> {
    UNITS.iter().map(|(dimension, _)| *dimension)
}

impl Dimension {
    /// Its units, the first one SI; none for a pure number.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        table(self).iter().map(|(name, _)| *name)
    }

    /// The dimension whose units it has.
    pub(super) fn units_of(self) -> Self {
        match self {
            Self::Duration => Self::Time,
            Self::Seepage => Self::Velocity,
            other => other,
        }
    }

    /// The dimension whose SI unit is called so.
    pub(crate) fn of_unit(name: &str) -> Option<Self> {
        UNITS
            .iter()
            .find(|(_, units)| units[0].0 == name)
            .map(|(dimension, _)| *dimension)
    }

    /// Largest magnitude that is taken for meant: what is derived from such values stays finite.
    pub fn limit(self) -> f64 {
        match self {
            Self::Number => 1e100,
            Self::Length | Self::Density | Self::Velocity => 1e9,
            Self::Seepage => 1e18,
            Self::Time | Self::Duration | Self::Acceleration => 1e12,
            Self::Stress | Self::LineForce | Self::Force => 1e18,
            Self::UnitWeight => 1e10,
            Self::Angle => 1e6,
        }
    }

    /// Smallest magnitude of what must not be zero that is taken for meant: what is divided by it stays finite.
    pub fn least(self) -> f64 {
        1.0 / self.limit()
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number => "a pure number",
            Self::Length => "a length",
            Self::Time => "a time",
            Self::Duration => "a wall-clock time",
            Self::Stress => "a stress",
            Self::Density => "a density",
            Self::UnitWeight => "a unit weight",
            Self::Angle => "an angle",
            Self::Velocity => "a velocity",
            Self::Seepage => "a velocity of water",
            Self::Acceleration => "an acceleration",
            Self::LineForce => "a force per metre of thickness",
            Self::Force => "a force",
        })
    }
}

fn table(dimension: Dimension) -> &'static [(&'static str, Worth)] {
    UNITS
        .iter()
        .find(|(known, _)| *known == dimension.units_of())
        .map_or(&[], |(_, units)| *units)
}
