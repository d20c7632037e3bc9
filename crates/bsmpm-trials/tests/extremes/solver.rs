//! Runs of the program: results or reasons.

use crate::support::results::{all_finite, history, last_frame, manifest};
use crate::support::{Output, Scratch};
use crate::table::Found;
use bsmpm_io::frame::Frame;
use bsmpm_io::manifest::Manifest;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// After this long a run counts as hanging, s.
const PATIENCE: u64 = 900;

/// Runs by what they were made from: several rows look at one.
static RUNS: Mutex<BTreeMap<(String, usize, String), Arc<Run>>> = Mutex::new(BTreeMap::new());

/// Forgets all runs and deletes what they left.
pub fn forget() {
    RUNS.lock().unwrap_or_else(PoisonError::into_inner).clear();
}

/// A run that has ended.
pub struct Run {
    scratch: Scratch,
    output: Output,
}

impl Run {
    /// The run of a case's text on so many ranks with further arguments, made now unless it is there.
    pub fn of(text: &str, ranks: usize, further: &[&str]) -> Arc<Self> {
        let key = (text.to_owned(), ranks, further.join(" "));
        let mut runs = RUNS.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(
            runs.entry(key)
                .or_insert_with(|| Arc::new(Self::make(text, ranks, further))),
        )
    }

    fn make(text: &str, ranks: usize, further: &[&str]) -> Self {
        let scratch = Scratch::with_case(text);
        let arguments = [&["case.toml", "-q"], further].concat();
        let output = scratch.job(Some(ranks), &arguments).within(PATIENCE).run();
        Self { scratch, output }
    }

    pub fn directory(&self) -> PathBuf {
        self.scratch.path("case.out")
    }

    /// The number that `value` takes from a run that came to its end, or the reason that the program gave for not
    /// coming there. Every number that it left must be finite, too.
    pub fn found<F: Into<Found>>(&self, value: impl FnOnce(&Self) -> F) -> Found {
        match self.output.code {
            Some(0 | 75) => {
                all_finite(&self.directory());
                value(self).into()
            }
            Some(code @ (80 | 81)) => {
                all_finite(&self.directory());
                let failure = self.manifest().failure.expect("a reason");
                Found::Warned(
                    code,
                    format!("t = {:.4}: {}", failure.time, first_sentence(&failure.reason)),
                )
            }
            Some(82) => {
                all_finite(&self.directory());
                let failed = self
                    .manifest()
                    .indicators
                    .into_iter()
                    .find(|(_, indicator)| indicator.failed);
                let (name, indicator) = failed.expect("an indicator beyond its limit");
                Found::Warned(82, format!("{name} is {:.2}: {}", indicator.value, indicator.meaning))
            }
            Some(65) => Found::Warned(65, first_sentence(&self.output.stderr)),
            code => Found::Broken(format!("exit code {code:?}: {}", self.output.stderr)),
        }
    }

    /// The same, but a warning that contains `part` is an answer, too.
    pub fn found_or_warned<F: Into<Found>>(&self, part: &str, value: impl FnOnce(&Self) -> F) -> Found {
        let warned = (self.output.code != Some(65)).then(|| {
            self.manifest()
                .warnings
                .into_iter()
                .find(|warning| warning.contains(part))
        });
        match (self.found(value), warned.flatten()) {
            (Found::Figure(value, _), Some(warning)) => {
                let figure = if value.is_finite() {
                    format!("; figure {value:.3}")
                } else {
                    String::new()
                };
                Found::Warned(0, first_sentence(&warning) + &figure)
            }
            (found, _) => found,
        }
    }

    pub fn manifest(&self) -> Manifest {
        manifest(&self.directory())
    }

    /// A column of the history.
    pub fn column(&self, name: &str) -> Vec<f64> {
        history(&self.directory())
            .get(name)
            .unwrap_or_else(|| panic!("no column {name}"))
            .to_vec()
    }

    /// The last number of a column of the history.
    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a row")
    }

    /// The last frame.
    pub fn frame(&self) -> Frame {
        last_frame(&self.directory())
    }

    /// Accepted steps, iterations and cuts.
    pub fn effort(&self) -> String {
        let sums = self.manifest().summary;
        format!(
            "{} steps, {} iterations, {} cuts",
            sums.steps, sums.iterations, sums.cutbacks
        )
    }
}

/// Up to the first full stop or the end of the line.
fn first_sentence(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    line.split("; ").next().unwrap_or_default().to_owned()
}
