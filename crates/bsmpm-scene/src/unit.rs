//! Reads numbers with units exactly: `"2.5 mm"` becomes 0.0025.

mod dimension;

pub use dimension::Dimension;
pub(crate) use dimension::dimensions;

use crate::nearest::hint;
use dimension::Worth::{self, Over, Radian, Ten, Times};
use dimension::{ALIASES, MASSES_PER_AREA, NOT_OFFERED, UNITS};

/// Value of `text`, a number followed by a unit of the dimension `expected`, in SI (angles in degrees).
///
/// # Errors
/// In words: no number, no unit, an unknown unit, a unit of another dimension, or a number that no double holds.
pub fn parse(text: &str, expected: Dimension) -> Result<f64, String> {
    let (value, found) = parse_any(text, Some(expected))?;
    // What is N per metre in plane strain was written so in every geometry.
    if found == expected.units_of() || (found, expected) == (Dimension::LineForce, Dimension::Force) {
        return Ok(value);
    }
    let unit = split(text).map_or("", |(_, unit)| unit);
    let units = match expected {
        Dimension::Number => String::new(),
        _ => format!(" ({})", list(expected)),
    };
    Err(format!(
        "E0021: the value has the wrong unit: expected {expected}{units}, found `{unit}`, a unit of {}.",
        noun(found)
    ))
}

/// Value of `text`, a number followed by a unit of the dimension `of` and `/m`, e.g. `"2 kPa/m"`, in SI.
pub(crate) fn parse_per_metre(text: &str, of: Dimension) -> Result<f64, String> {
    let upper = text
        .trim()
        .strip_suffix('m')
        .and_then(|rest| rest.trim_end().strip_suffix('/'));
    let Some(upper) = upper else {
        let units: Vec<String> = of.units().map(|unit| format!("{unit}/m")).collect();
        return Err(format!(
            "E0021: the unit of \"{}\" must be a unit per metre, because the value is a change with height. Use one \
             of {}.",
            crate::report::shortened(text),
            units.join(", ")
        ));
    };
    parse(upper, of)
}

/// Value and dimension of `text`, whatever its unit; `meant` helps to guess what an unknown unit stands for.
pub(crate) fn parse_any(text: &str, meant: Option<Dimension>) -> Result<(f64, Dimension), String> {
    let written = crate::report::shortened(text);
    let units = meant.map_or(String::new(), |dimension| format!(" ({})", list(dimension)));
    let Some((number, unit)) = split(text) else {
        return Err(format!(
            "E0022: \"{written}\" is not a number with a unit{units}. Write the number first, then the unit."
        ));
    };
    if unit.is_empty() {
        return Err(format!(
            "E0022: \"{written}\" has no unit{units}. Add a unit, or write the number without quotes in SI units \
             (angles in degrees)."
        ));
    }
    let plain = unit
        .replace('²', "2")
        .replace('³', "3")
        .replace(['µ', 'μ'], "u")
        .replace('^', "")
        .replace('°', "deg");
    if let Some((mass, force)) = MASSES_PER_AREA.iter().find(|(mass, _)| *mass == plain) {
        return Err(format!(
            "E0021: `{mass}` in \"{written}\" is a mass per area, not a stress. Write a force per area: `{force}`."
        ));
    }
    let alias = ALIASES.iter().find(|(alias, _)| *alias == plain);
    let plain = alias.map_or(plain, |(_, name)| (*name).to_owned());
    let known = UNITS.iter().chain(&NOT_OFFERED).find_map(|(dimension, units)| {
        let (_, worth) = units.iter().find(|(name, _)| *name == plain)?;
        Some((*dimension, *worth))
    });
    let Some((dimension, worth)) = known else {
        let all = UNITS
            .iter()
            .filter(|(dimension, _)| meant.is_none_or(|meant| meant == *dimension));
        let near = hint(&plain, all.flat_map(|(_, units)| units.iter().map(|(name, _)| *name)));
        let end = if near.is_empty() { "." } else { &near };
        let known = meant.map_or(String::new(), |dimension| format!(" Known units: {}.", list(dimension)));
        return Err(format!(
            "E0020: the unit `{}` of the value \"{written}\" is not known{end}{known}",
            crate::report::shortened(unit)
        ));
    };
    Ok((value(number, worth)?, dimension))
}

/// The double nearest to the decimal number `text`.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    let written = crate::report::shortened(text);
    let value: f64 = text.parse().unwrap_or(f64::NAN);
    let mantissa = text.split(['e', 'E']).next().unwrap_or(text);
    match value {
        _ if value.is_nan() || text.contains("inf") => Err(format!(
            "E0010: {written} is infinite or not a number. Write a finite number."
        )),
        _ if value.is_infinite() => Err(format!(
            "E0010: {written} is too large: the largest number that the program can read is 1.8e308. Correct the \
                 exponent of the number."
        )),
        0.0 if mantissa.contains(|c: char| matches!(c, '1'..='9')) => Err(format!(
            "E0010: {written} is too small: the smallest number above zero that the program can read is 4.9e-324. \
                 Write 0 for zero."
        )),
        _ => Ok(value + 0.0), // -0.0 becomes 0.0
    }
}

fn value(number: &str, worth: Worth) -> Result<f64, String> {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    match worth {
        Ten(shift) => {
            let exponent: i64 = exponent.parse().map_err(|_| {
                format!(
                    "E0010: the exponent of {number} is too large or too small for the program. Correct the exponent."
                )
            })?;
            finite(&format!("{mantissa}e{}", exponent.saturating_add(shift.into())))
        }
        Times(factor) => finite(number).map(|value| value * factor),
        Over(divisor) => finite(number).map(|value| value / divisor),
        Radian => finite(number).map(f64::to_degrees),
    }
}

/// Number and unit of `text`, both trimmed; `None` if it does not begin with a decimal number.
fn split(text: &str) -> Option<(&str, &str)> {
    let text = text.trim();
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut end = usize::from(text.starts_with(['+', '-']));
    let whole = digits(end);
    end += whole;
    let mut fraction = 0;
    if text[end..].starts_with('.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    Some((&text[..end], text[end..].trim_start()))
}

fn list(dimension: Dimension) -> String {
    let units: Vec<&str> = dimension.units().collect();
    if units.is_empty() {
        "none: a pure number".to_owned()
    } else {
        units.join(", ")
    }
}

fn noun(dimension: Dimension) -> String {
    dimension
        .to_string()
        .trim_start_matches("an ")
        .trim_start_matches("a ")
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::Dimension::*;
    use super::*;

    #[test]
    fn prefixes_keep_every_bit() {
        let rows = [
            ("2.5 mm", Length, 2.5e-3),
            ("0.25ms", Time, 2.5e-4),
            ("5840 kPa", Stress, 5.84e6),
            (" 20.4 kN/m3 ", UnitWeight, 20.4e3),
            ("20.4 kN/m^3", UnitWeight, 20.4e3),
            ("20.4 kN/m³", UnitWeight, 20.4e3),
            ("1.8e0 t/m3", Density, 1800.0),
            ("1.8 g/cm3", Density, 1800.0),
            ("-3.1E+2 cm/s", Velocity, -3.1),
            ("981 cm/s2", Acceleration, 9.81),
            ("1.5 min", Time, 90.0),
            ("21.9 °", Angle, 21.9),
            ("5 µm", Length, 5e-6),
            ("2.5 kN/m", LineForce, 2500.0),
            ("2.5 kN/m", Force, 2500.0),
            ("-2.5 MN", Force, -2.5e6),
            (".5 km", Length, 500.0),
            ("20 year", Time, 631_152_000.0),
            ("60 d", Time, 5_184_000.0),
            ("1 day", Time, 86_400.0),
            ("3 days", Time, 259_200.0),
            ("2 hours", Time, 7200.0),
            ("2 years", Time, 2.0 * 365.25 * 86_400.0),
            ("30 sec", Time, 30.0),
            ("2 bar", Stress, 2e5),
            ("1 kgf/cm2", Stress, 98_066.5),
            ("200 psf", Stress, 9_576.051_796_067_168),
            ("1 tsf", Stress, 95_760.517_960_671_68),
            ("1 psi", Stress, 6_894.757_293_168_361),
            ("125 pcf", UnitWeight, 19_635.932_980_780_774),
            ("1 ft", Length, 0.3048),
            ("1 in", Length, 0.0254),
            ("1 lbf", Force, 4.448_221_615_260_5),
            ("1 kip/ft", LineForce, 14_593.902_937_206_364),
            ("30 degrees", Angle, 30.0),
            ("10 tf/m^2", Stress, 98_066.5),
            ("2 week", Time, 1_209_600.0),
            ("1e-9 m/s", Velocity, 1e-9),
            ("10 mm/h", Velocity, 10.0 / 3.6e6),
            ("0.1 m/day", Velocity, 0.1 / 86_400.0),
            ("2.2 GPa", Stress, 2.2e9),
        ];
        for (text, dimension, value) in rows {
            assert_eq!(
                parse(text, dimension).map(f64::to_bits),
                Ok(f64::to_bits(value)),
                "{text}"
            );
        }
        assert!((parse("0.5 rad", Angle).unwrap() - 0.5_f64.to_degrees()).abs() < 1e-15);
        assert_eq!(parse("-0.0 m", Length).map(f64::to_bits), Ok(0));
    }

    #[test]
    fn growth_per_metre() {
        for (text, of, value) in [
            ("2 kPa/m", Stress, 2e3),
            ("-.5deg / m", Angle, -0.5),
            ("3 kN/m2/m", Stress, 3e3),
        ] {
            assert_eq!(parse_per_metre(text, of), Ok(value), "{text}");
        }
        for (text, says) in [
            (
                "2 kPa",
                "must be a unit per metre, because the value is a change with height. Use one of Pa/m, kPa/m",
            ),
            ("2 m/m", "expected a stress"),
            ("/m", "E0022"),
        ] {
            let error = parse_per_metre(text, Stress).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }

    #[test]
    fn wrong_units_say_which() {
        let rows = [
            (
                "5 kPa",
                Length,
                "expected a length (m, cm, mm, um, nm, km), found `kPa`, a unit of stress",
            ),
            ("5 m", Number, "expected a pure number, found `m`, a unit of length"),
            ("5", Length, "has no unit"),
            ("5 KPa", Stress, "did you mean `kPa`?"),
            (
                "5 t/m2",
                Stress,
                "is a mass per area, not a stress. Write a force per area: `tf/m2`",
            ),
            ("5 kg/cm2", Stress, "Write a force per area: `kgf/cm2`"),
            (
                "5 furlong",
                Length,
                "E0020: the unit `furlong` of the value \"5 furlong\" is not known. Known units: m, cm",
            ),
            ("five m", Length, "not a number with a unit"),
            ("nan m", Length, "E0022"),
            ("inf m", Length, "E0022"),
            ("1e400 m", Length, "too large"),
            ("1e-400 m", Length, "too small"),
            (
                "1e99999999999999999999 m",
                Length,
                "too large or too small for the program",
            ),
            ("1_000 m", Length, "E0020"),
            ("", Length, "E0022"),
            ("-", Length, "E0022"),
            ("5 \u{202e}m", Length, "\\u{202e}"),
            (
                "5 kN",
                LineForce,
                "expected a force per metre of thickness (N/m, kN/m, MN/m), found `kN`",
            ),
            ("5 kPa", Force, "expected a force (N, kN, MN)"),
            ("5 kPa", LineForce, "expected a force per metre of thickness (N/m"),
        ];
        for (text, dimension, says) in rows {
            let error = parse(text, dimension).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
