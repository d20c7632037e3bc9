//! The runs of a study, one after another: what they are made from, and what they gave.

use bsmpm_io::exit::{CHECK, DONE, LEFT, NO_CONVERGENCE};
use std::fs;
use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::table::{self, Columns};

use super::matrix::{MatrixRun, MatrixStudy};
use crate::Error;
use crate::launch::{Ending, LaunchTask, SolverProgram};

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
    pub directory: PathBuf,
    pub history: Option<Columns>,
    /// why it is no result
    pub failure: Option<String>,
    /// why it is one although it did not come to its end
    pub stopped: Option<String>,
    /// its exit code
    pub code: u8,
    pub cost: MatrixCost,
}

impl MatrixOutcome {
    /// Whether its history holds anything.
    pub fn has_rows(&self) -> bool {
        self.history.as_ref().is_some_and(|history| history.values.iter().any(|values| !values.is_empty()))
    }
}

/// What runs took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MatrixCost {
    pub steps: u64,
    pub cuts: u64,
    pub iterations: u64,
    pub seconds: f64,
}

impl MatrixCost {
    pub fn of(outcomes: &[&MatrixOutcome]) -> Self {
        outcomes.iter().fold(Self::default(), |sum, MatrixOutcome { cost, .. }| Self {
            steps: sum.steps + cost.steps,
            cuts: sum.cuts + cost.cuts,
            iterations: sum.iterations + cost.iterations,
            seconds: sum.seconds + cost.seconds,
        })
    }
}

impl Launcher<'_> {
    /// The outcome of a run, made now unless it is there.
    pub fn outcome(&self, study: &MatrixStudy, run: &MatrixRun) -> Result<MatrixOutcome, Error> {
        let directory = self.output.join("runs").join(slug(&study.title)).join(format!("{}.out", run.name));
        let case = self.base.join(run.case.as_ref().unwrap_or(&study.case));
        let mut arguments = vec![case.display().to_string()];
        for set in study.set.iter().chain(&run.set) {
            arguments.extend(["--set".to_owned(), set.clone()]);
        }
        arguments.extend(["--quiet", "--force", "--output"].map(str::to_owned));
        arguments.push(directory.display().to_string());
        let origin = self.origin(&case, &arguments);
        let task =
            LaunchTask { arguments: &arguments, directory: &directory, origin: origin.as_deref(), force: self.force };
        let code = self.solver.perform(&task, |manifest| manifest.argv.ends_with(&arguments))?;
        Ok(read(directory, code, run.may_stop))
    }

    /// Everything that a run is made from, as it stands now: the solver, its arguments, the text of the case. None where a
    /// part cannot be told.
    fn origin(&self, case: &Path, arguments: &[String]) -> Option<String> {
        let text = fs::read_to_string(case).ok()?;
        let command = [self.solver.command, arguments].concat().join(" ");
        Some(format!("{command}\n{}\n\n{text}", self.solver.stamp()?))
    }
}

/// What stands in a run's directory.
fn read(directory: PathBuf, code: Option<u8>, may_stop: bool) -> MatrixOutcome {
    let Ending { code, manifest, reason } = Ending::of(&directory, code);
    let history = table::read(&directory.join(HISTORY)).ok();
    let time = history.as_ref().and_then(|history| history.get("time")?.last().copied()).unwrap_or(0.0);
    let (mut failure, mut stopped) = (None, None);
    match code {
        DONE | CHECK => {}
        NO_CONVERGENCE | LEFT if may_stop => stopped = Some(format!("stopped at t = {time:.4}: {reason}")),
        code => failure = Some(format!("exit code {code} at t = {time:.4}: {reason}")),
    }
    let cost = manifest.map_or_else(MatrixCost::default, |manifest| MatrixCost {
        steps: manifest.summary.steps,
        cuts: manifest.summary.cutbacks,
        iterations: manifest.summary.iterations,
        seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
    });
    MatrixOutcome { directory, history, failure, stopped, code, cost }
}

/// The exit codes of runs, once if they are all the same.
pub(super) fn codes(outcomes: &[&MatrixOutcome]) -> String {
    let mut codes: Vec<String> = outcomes.iter().map(|outcome| outcome.code.to_string()).collect();
    if codes.iter().all(|code| *code == codes[0]) {
        codes.truncate(1);
    }
    codes.join(", ")
}

/// A title as the name of a directory.
pub(super) fn slug(title: &str) -> String {
    let letters =
        title.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' });
    let joined: String = letters.collect();
    joined.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}
