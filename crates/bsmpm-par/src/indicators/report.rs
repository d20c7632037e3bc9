//! How indicators are printed: their codes, and their values with a unit.

use bsmpm_io::manifest::Indicator;
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

/// Name, code and form of every indicator. Codes are stable, and never used again.
const KNOWN: [(&str, &str, Form); 28] = [
    ("pressure-noise-average", "I0001", Form::Percent),
    ("pressure-noise-plane", "I0002", Form::Percent),
    ("quadrature-defect", "I0003", Form::Percent),
    ("quadrature-defect-largest", "I0004", Form::Percent),
    ("points-per-cell", "I0005", Form::Number),
    ("compression", "I0006", Form::Percent),
    ("force-measure", "I0007", Form::Times),
    ("energy-measure", "I0008", Form::Times),
    ("water-measure", "I0009", Form::Times),
    ("water-balance", "I0010", Form::Percent),
    ("energy-closure", "I0011", Form::Percent),
    ("energy-loss", "I0012", Form::Percent),
    ("energy-growth", "I0013", Form::Percent),
    ("smoothing-length", "I0014", Form::Metres),
    ("slip", "I0015", Form::Percent),
    ("support-pull", "I0016", Form::Percent),
    ("front-setback", "I0017", Form::Metres),
    ("step-advance", "I0018", Form::Cells),
    ("wall-velocity", "I0019", Form::Percent),
    ("rigid-penetration", "I0020", Form::Cells),
    ("interface-shift", "I0021", Form::Cells),
    ("permeability-shift", "I0022", Form::Cells),
    ("cells-across-footing", "I0023", Form::Number),
    ("cells-across-opening", "I0024", Form::Number),
    ("force-noise", "I0025", Form::Percent),
    ("background-load-share", "I0026", Form::Percent),
    ("stiffness-loss", "I0027", Form::Number),
    ("background-work", "I0028", Form::Percent),
];

/// The code of an indicator by its name; empty for a name that is none.
pub(super) fn code(name: &str) -> &'static str {
    known(name).0
}

fn known(name: &str) -> (&'static str, Form) {
    let found = KNOWN.iter().find(|(known, _, _)| *known == name);
    found.map_or(("", Form::Number), |&(_, code, form)| (code, form))
}

/// All of them in a line.
pub fn line(indicators: &BTreeMap<String, Indicator>) -> String {
    let all = indicators.iter().map(|(name, found)| format!("{name} {}", known(name).1.of(found.value)));
    format!("Indicators: {}.", all.collect::<Vec<_>>().join(", "))
}

/// What is to be said of an indicator that is outside its usual range, its code first.
pub fn description(name: &str, found: &Indicator) -> String {
    let (code, form) = known(name);
    let range = match found.limits.filter(|_| found.ends_run()) {
        Some(limits) => format!("limit: {}", form.range(limits)),
        None => format!("usual: {}", form.range(found.usual)),
    };
    format!("{code}: {} is {} ({range}). {}", found.meaning, form.of(found.value), found.advice)
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

    /// A range of values, of which one bound may mean nothing.
    fn range(self, [least, most]: [f64; 2]) -> String {
        match self {
            Self::Times => format!("at most {most}"),
            _ if least == 0.0 => format!("below {}", self.of(most)),
            _ if most >= UNBOUNDED => format!("at least {}", self.of(least)),
            _ => format!("{} to {}", brief(least * if self == Self::Percent { 100.0 } else { 1.0 }), self.of(most)),
        }
    }
}

/// No value is too large from here on.
const UNBOUNDED: f64 = 1e3;

/// A number with two digits.
fn brief(number: f64) -> String {
    let rounded: f64 = format!("{number:.1e}").parse().unwrap_or(number);
    let size = rounded.abs();
    if size == 0.0 || (1e-3..1e6).contains(&size) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_indicator_has_a_code_of_its_own() {
        let mut codes: Vec<&str> = KNOWN.iter().map(|(_, code, _)| *code).collect();
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), KNOWN.len());
        assert!(codes.iter().all(|code| code.len() == 5 && code.starts_with('I')));
    }

    #[test]
    fn values_and_ranges_are_read_with_their_units() {
        let row = |value, usual| Indicator::new(value, "-", "numerical dissipation relative to the peak energy", usual);
        let told = description("energy-loss", &row(0.1234, [-0.1, 0.1]).advising("Reduce `analysis.dt`."));
        let expected = "I0012: numerical dissipation relative to the peak energy is 12 % (usual: -10 to 10 %). Reduce \
                        `analysis.dt`.";
        assert_eq!(told, expected);
        let failed = row(0.8, [0.0, 0.02]).limited(Some([0.0, 0.1]), false);
        assert!(description("force-noise", &failed).contains("is 80 % (limit: below 10 %)"));
        assert_eq!(Form::Number.range([10.0, 1e6]), "at least 10");
        assert_eq!(Form::Percent.of(1.2e-7), "1.2e-5 %");
        assert_eq!(Form::Times.of(1.5) + " " + &Form::Times.range([0.0, 1.0]), "1.50 times the tolerance at most 1");
    }
}
