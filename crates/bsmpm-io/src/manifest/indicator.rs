//! Indicators in the manifest.

use serde::{Deserialize, Serialize};

/// Measure of the accuracy of a run, with the range found in good runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Indicator {
    /// Code for `bsmpm explain`; empty in runs of older programs.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub code: String,
    /// Value in this run.
    pub value: f64,
    /// Unit; `-` for none.
    pub unit: String,
    /// Description of the measure, with the value and its usual range or limit.
    pub meaning: String,
    /// Smallest and largest usual value.
    pub usual: [f64; 2],
    /// Whether the value is outside the usual range.
    pub unusual: bool,
    /// Smallest and largest value for which the result is likely to be correct within 10 %; none if this was not
    /// measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// Whether the value is beyond the limits.
    #[serde(default)]
    pub failed: bool,
    /// Whether the case accepts a value beyond the limits.
    #[serde(default)]
    pub accepted: bool,
    /// Meaning of a value outside the range, and remedy.
    #[serde(default)]
    pub advice: String,
}

impl Indicator {
    /// Creates an indicator from a value and its usual range.
    pub fn new(value: f64, unit: &str, meaning: &str, usual: [f64; 2]) -> Self {
        let unusual = !(usual[0]..=usual[1]).contains(&value);
        Self {
            code: String::new(),
            value,
            unit: unit.to_owned(),
            meaning: meaning.to_owned(),
            usual,
            unusual,
            limits: None,
            failed: false,
            accepted: false,
            advice: String::new(),
        }
    }

    /// Returns the same indicator with limits; `accepted` is whether the case accepts a value beyond them.
    #[must_use]
    pub fn limited(self, limits: Option<[f64; 2]>, accepted: bool) -> Self {
        let failed = limits.is_some_and(|[least, most]| !(least..=most).contains(&self.value));
        Self {
            limits,
            failed,
            accepted: failed && accepted,
            ..self
        }
    }

    /// Returns whether the indicator ends the run with its own exit code.
    pub fn ends_run(&self) -> bool {
        self.failed && !self.accepted
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        [self.value]
            .into_iter()
            .chain(self.usual)
            .chain(self.limits.into_iter().flatten())
    }
}
