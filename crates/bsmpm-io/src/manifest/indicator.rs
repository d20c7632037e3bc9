//! Cheap measures of how far a run can be trusted.

use serde::{Deserialize, Serialize};

/// One measure, and where it lies in runs that were found to be good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Indicator {
    /// What was found.
    pub value: f64,
    /// Its unit; `-` for none.
    pub unit: String,
    /// What it says.
    pub meaning: String,
    /// Least and largest value that is usual.
    pub usual: [f64; 2],
    /// Whether the value lies outside.
    pub unusual: bool,
    /// What a value outside means, and what to do then.
    #[serde(default)]
    pub advice: String,
}

impl Indicator {
    /// A value, judged by its usual range.
    pub fn new(value: f64, unit: &str, meaning: &str, usual: [f64; 2]) -> Self {
        let unusual = !(usual[0]..=usual[1]).contains(&value);
        Self { value, unit: unit.to_owned(), meaning: meaning.to_owned(), usual, unusual, advice: String::new() }
    }

    /// The same with what to do where it is unusual.
    #[must_use]
    pub fn advising(self, advice: &str) -> Self {
        Self { advice: advice.to_owned(), ..self }
    }

    pub(super) fn numbers(&self) -> [f64; 3] {
        [self.value, self.usual[0], self.usual[1]]
    }
}
