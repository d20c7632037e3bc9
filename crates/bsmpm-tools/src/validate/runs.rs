//! Makes the runs of a study of the validation matrix, one after another.

use std::fs;
use std::path::Path;

use super::matrix::{MatrixRun, MatrixStudy};
use crate::Error;
use crate::launch::{LaunchTask, Outcome, RunState, SolverProgram};
use crate::report::some;

/// How runs are started.
pub(super) struct Launcher<'a> {
    pub solver: SolverProgram<'a>,
    /// what the matrix names is relative to
    pub base: &'a Path,
    pub output: &'a Path,
    pub force: bool,
}

/// What a run left.
pub(super) struct MatrixOutcome {
    pub run: Outcome,
    /// why it is no result
    pub failure: Option<String>,
    /// why it is one although it did not come to its end
    pub stopped: Option<String>,
}

impl Launcher<'_> {
    /// The outcome of a run, made now unless it is there.
    pub fn outcome(&self, study: &MatrixStudy, run: &MatrixRun) -> Result<MatrixOutcome, Error> {
        let case = self.base.join(run.case.as_ref().unwrap_or(&study.case));
        let mut task = LaunchTask {
            case: &case,
            set: &[&study.set[..], &run.set].concat(),
            further: Vec::new(),
            directory: self
                .output
                .join("runs")
                .join(slug(&study.title))
                .join(format!("{}.out", run.name)),
            origin: None,
            from: None,
            force: self.force,
            resume: false,
        };
        let arguments = task.arguments(&["--force"]);
        task.origin = self.origin(&case, &arguments);
        let outcome = self
            .solver
            .outcome(&task, |manifest| manifest.argv.ends_with(&arguments))?;
        Ok(MatrixOutcome::of(outcome, run.may_stop))
    }

    /// Everything that a run is made from, as it stands now: the solver, its arguments, the text of the case. None
    /// where a part cannot be determined.
    fn origin(&self, case: &Path, arguments: &[String]) -> Option<String> {
        let text = fs::read_to_string(case).ok()?;
        let command = [self.solver.command, arguments].concat().join(" ");
        Some(format!("{command}\n{}\n\n{text}", self.solver.stamp()?))
    }
}

impl MatrixOutcome {
    fn of(run: Outcome, may_stop: bool) -> Self {
        let at = format!("at t = {:.4}: {}", run.time(), run.reason);
        let (failure, stopped) = match run.state {
            RunState::Done => (None, None),
            RunState::NoConvergence | RunState::Left if may_stop => (None, Some(format!("stopped {at}"))),
            _ => (Some(format!("exit code {} {at}", some(run.code))), None),
        };
        Self { run, failure, stopped }
    }
}

/// The exit codes of runs, once if they are all the same.
pub(super) fn codes(outcomes: &[&MatrixOutcome]) -> String {
    let mut codes: Vec<String> = outcomes.iter().map(|outcome| some(outcome.run.code)).collect();
    if codes.iter().all(|code| *code == codes[0]) {
        codes.truncate(1);
    }
    codes.join(", ")
}

/// A title as the name of a directory.
pub(super) fn slug(title: &str) -> String {
    let letters = title.chars().map(|c| {
        if c.is_ascii_alphanumeric() || c == '.' {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    });
    let joined: String = letters.collect();
    joined
        .split('-')
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("-")
}
