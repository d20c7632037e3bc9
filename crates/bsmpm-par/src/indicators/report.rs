//! Prints indicators with codes and units.

use bsmpm_io::manifest::Indicator;
use bsmpm_messages::{code_of, without_code};
use std::collections::BTreeMap;

/// How a value is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Percent,
    Number,
    Cells,
    Metres,
    /// A multiple of a tolerance.
    Times,
}

/// The form of every indicator whose value is no part of a whole.
const FORMS: [(&str, Form); 13] = [
    ("points-per-cell", Form::Number),
    ("force-measure", Form::Times),
    ("energy-measure", Form::Times),
    ("water-measure", Form::Times),
    ("smoothing-length", Form::Metres),
    ("front-setback", Form::Metres),
    ("step-advance", Form::Cells),
    ("rigid-penetration", Form::Cells),
    ("interface-shift", Form::Cells),
    ("permeability-shift", Form::Cells),
    ("cells-across-footing", Form::Number),
    ("cells-across-opening", Form::Number),
    ("stiffness-loss", Form::Number),
];

fn form(name: &str) -> Form {
    FORMS
        .iter()
        .find(|(known, _)| *known == name)
        .map_or(Form::Percent, |&(_, form)| form)
}

/// The indicator with its code, what was measured, and what to do, from a text with places for the value, its range and
/// `which`, the one that is meant.
pub(super) fn worded(name: &str, text: &str, which: &str, found: Indicator) -> Indicator {
    let code = code_of(text).unwrap_or_default().to_owned();
    let text = without_code(text);
    // The range stands in the first sentence.
    let end = text
        .find("{range}")
        .and_then(|range| Some(range + text[range..].find(". ")?));
    let (measure, advice) = end.map_or((text, ""), |end| (&text[..end], &text[end + 2..]));
    let form = form(name);
    let measure = measure
        .replace("{which}", which)
        .replace("{value}", &form.of(found.value));
    let meaning = measure.replace("{range}", &form.range_of(&found));
    let advice = advice.to_owned();
    Indicator {
        code,
        meaning,
        advice,
        ..found
    }
}

/// All of them in a line.
pub fn line(indicators: &BTreeMap<String, Indicator>) -> String {
    let all = indicators
        .iter()
        .map(|(name, found)| format!("{name} {}", form(name).of(found.value)));
    format!("Indicators: {}.", all.collect::<Vec<_>>().join(", "))
}

/// What is to be said of an indicator that is outside its usual range, its code first.
pub fn description(found: &Indicator) -> String {
    format!("{}: {}. {}", found.code, found.meaning, found.advice)
}

/// What is to be said of the indicators that end a run, by their names.
pub fn acceptance(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!(
        "Beyond this limit an error of 10 % or more is likely. To accept it: output.accept = [{}]",
        quoted.join(", ")
    )
}

impl Form {
    /// A value with its unit.
    fn of(self, value: f64) -> String {
        match self {
            Self::Percent => format!("{} %", brief(100.0 * value)),
            Self::Number => brief(value),
            Self::Cells => format!("{} cells", brief(value)),
            Self::Metres => format!("{} m", brief(value)),
            Self::Times => format!("{value:.2} times the tolerance"),
        }
    }

    /// The range that an indicator is outside of, or would be.
    fn range_of(self, found: &Indicator) -> String {
        match found.limits.filter(|_| found.failed) {
            Some(limits) if found.accepted => format!("limit: {}, accepted by output.accept", self.range(limits)),
            Some(limits) => format!("limit: {}", self.range(limits)),
            None => format!("usual: {}", self.range(found.usual)),
        }
    }

    /// A range of values, of which one bound may mean nothing.
    fn range(self, [least, most]: [f64; 2]) -> String {
        match self {
            Self::Times => format!("at most {most}"),
            _ if least == 0.0 => format!("below {}", self.of(most)),
            _ if most >= UNBOUNDED => format!("at least {}", self.of(least)),
            _ => format!(
                "{} to {}",
                brief(least * if self == Self::Percent { 100.0 } else { 1.0 }),
                self.of(most)
            ),
        }
    }
}

/// No value is too large from here on.
const UNBOUNDED: f64 = 1e3;

/// A number with two digits.
fn brief(number: f64) -> String {
    let rounded: f64 = format!("{number:.1e}").parse().unwrap_or(number);
    let size = rounded.abs();
    if size == 0.0 || (1e-3..1e6).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(name: &str, text: &str, found: Indicator) -> String {
        description(&worded(name, text, "`body.0`", found))
    }

    #[test]
    fn values_and_ranges_are_read_with_their_units() {
        let row = |value, usual| Indicator::new(value, "-", "", usual);
        let text = "I0012: dissipation is {value} of the peak ({range}), so the motion is damped. Reduce `dt`. Or not.";
        assert_eq!(
            described("energy-loss", text, row(0.1234, [-0.1, 0.1])),
            "I0012: dissipation is 12 % of the peak (usual: -10 to 10 %), so the motion is damped. Reduce `dt`. Or not."
        );
        let failed = row(0.8, [0.0, 0.02]).limited(Some([0.0, 0.1]), false);
        let text = "I0025: {which} scatters by {value} ({range}). Average it.";
        assert_eq!(
            described("force-noise", text, failed),
            "I0025: `body.0` scatters by 80 % (limit: below 10 %). Average it."
        );
        assert_eq!(Form::Number.range([10.0, 1e6]), "at least 10");
        assert_eq!(Form::Percent.of(1.2e-7), "1.2e-5 %");
        assert_eq!(
            Form::Times.of(1.5) + " " + &Form::Times.range([0.0, 1.0]),
            "1.50 times the tolerance at most 1"
        );
    }
}
