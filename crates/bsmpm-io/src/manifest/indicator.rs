//! Indicators in the manifest.

use serde::{Deserialize, Serialize};

/// One measure, and where it lies in runs that were found to be good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Indicator {
    /// The code by which `bsmpm explain` explains it; empty in runs of older programs.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub code: String,
    /// What was found.
    pub value: f64,
    /// Its unit; `-` for none.
    pub unit: String,
    /// What was measured, with the value and its usual range or limit.
    pub meaning: String,
    /// Least and largest value that is usual.
    pub usual: [f64; 2],
    /// Whether the value lies outside.
    pub unusual: bool,
    /// Least and largest value up to which the answer is likely to be right within 10 %; none where no measurement
    /// shows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// Whether the value lies beyond the limits.
    #[serde(default)]
    pub failed: bool,
    /// Whether the case accepts that.
    #[serde(default)]
    pub accepted: bool,
    /// What a value outside the range means, and what to do then.
    #[serde(default)]
    pub advice: String,
}

impl Indicator {
    /// A value, judged by its usual range.
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

    /// The same with limits, and whether the case accepts a value beyond them.
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

    /// Whether it ends the run with a code of its own.
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
