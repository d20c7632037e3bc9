//! Outcome of a run: state, results and cost.

use std::fs;
use std::iter::Sum;
use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::exit::{
    self, CHECK, CHECKPOINT, DIRECTORY, DONE, INDICATOR, LEFT, MEMORY, NO_CONVERGENCE, STALLED, STOPPED,
};
use bsmpm_io::manifest::Manifest;
use bsmpm_io::table::{self, Columns};
use serde::Serialize;

use super::beside;
use crate::Error;
use crate::report::word;

/// Not begun: too little memory, restarts that come to nothing, a directory or a checkpoint that cannot be used.
const REFUSED: [u8; 4] = [MEMORY, STALLED, DIRECTORY, CHECKPOINT];

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RunState {
    /// It came to the end of the case; its own checks may have failed, or its indicators be beyond their limits.
    Done,
    /// It was stopped, by a limit or a signal, and goes on when it is asked for again.
    Stopped,
    /// It found no equilibrium at the smallest step.
    NoConvergence,
    /// Material left the grid or the physical range.
    Left,
    /// It ended for another reason, as its code says.
    Broken,
    /// It was not begun: its case has errors.
    Invalid,
    /// It was not begun: it needs more memory than all runs may take.
    Memory,
}

/// What there is of a run.
#[derive(Clone, Debug)]
pub(crate) struct Outcome {
    pub state: RunState,
    /// That of bsmpm-par, or the launcher's where there is no manifest; none if it was not begun.
    pub code: Option<u8>,
    /// Why it ended early, or its last word.
    pub reason: String,
    pub manifest: Option<Manifest>,
    pub history: Option<Columns>,
    pub cost: RunCost,
    /// Whether it was there from before.
    pub kept: bool,
    pub directory: Option<PathBuf>,
}

/// What it took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct RunCost {
    /// s  of processor time, all ranks together
    pub cpu_seconds: f64,
    /// s  by the clock
    pub wall_seconds: f64,
    /// bytes  the sum of the ranks' peaks; of several runs that of the largest
    pub peak_memory: u64,
    pub steps: u64,
    pub iterations: u64,
    pub cuts: u64,
}

impl Sum for RunCost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), |sum, cost| Self {
            cpu_seconds: sum.cpu_seconds + cost.cpu_seconds,
            wall_seconds: sum.wall_seconds + cost.wall_seconds,
            peak_memory: sum.peak_memory.max(cost.peak_memory),
            steps: sum.steps + cost.steps,
            iterations: sum.iterations + cost.iterations,
            cuts: sum.cuts + cost.cuts,
        })
    }
}

impl RunCost {
    fn of(manifest: &Manifest) -> Self {
        Self {
            cpu_seconds: manifest.summary.cpu_seconds,
            wall_seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
            peak_memory: manifest.summary.peak_memory.iter().sum(),
            steps: manifest.summary.steps,
            iterations: manifest.summary.iterations,
            cuts: manifest.summary.cutbacks,
        }
    }
}

impl Outcome {
    /// That of the run in a directory; `code` is what its process ended with, if it was made now.
    pub fn read(directory: &Path, code: Option<u8>) -> Self {
        let kept = code.is_none();
        let manifest = Manifest::read(directory).ok();
        // A launcher may hide the program's own exit code, which is in the manifest; but not where the run was refused
        // and the manifest is that of before.
        let refused = code.filter(|code| REFUSED.contains(code));
        let own = refused.or(manifest.as_ref().and_then(|manifest| manifest.exit_code));
        let code = own.or(code).unwrap_or(u8::MAX);
        let state = match code {
            DONE | CHECK | INDICATOR => RunState::Done,
            STOPPED => RunState::Stopped,
            NO_CONVERGENCE => RunState::NoConvergence,
            LEFT => RunState::Left,
            _ => RunState::Broken,
        };
        let failure = manifest.as_ref().and_then(|manifest| manifest.failure.as_ref());
        let reason = failure.map_or_else(|| last_line(directory), |failure| failure.reason.clone());
        let history = table::read(&directory.join(HISTORY)).ok();
        let cost = manifest.as_ref().map_or_else(RunCost::default, RunCost::of);
        Self {
            state,
            code: Some(code),
            reason,
            manifest,
            history,
            cost,
            kept,
            directory: Some(directory.to_owned()),
        }
    }

    /// That of a run that never began.
    pub fn never(state: RunState, reason: String) -> Self {
        let cost = RunCost::default();
        Self {
            state,
            code: None,
            reason,
            manifest: None,
            history: None,
            cost,
            kept: false,
            directory: None,
        }
    }

    /// That of a run that could not be started.
    pub fn broken(reason: String) -> Self {
        Self::never(RunState::Broken, reason)
    }

    /// The error that it is where it is needed; `what` names it.
    pub fn error(&self, what: String) -> Error {
        Error::Run {
            what,
            code: self.code.unwrap_or(exit::BUG),
            reason: self.reason.clone(),
        }
    }

    /// The time, s or pseudo-time, that its history has come to.
    pub fn time(&self) -> f64 {
        self.history
            .as_ref()
            .and_then(|history| history.get("time")?.last().copied())
            .unwrap_or(0.0)
    }

    /// Whether its history holds anything.
    pub fn has_rows(&self) -> bool {
        self.history
            .as_ref()
            .is_some_and(|history| history.values.iter().any(|values| !values.is_empty()))
    }

    /// How it stands, in a few words for a table.
    pub fn words(&self) -> String {
        let code = self
            .code
            .filter(|_| self.state != RunState::Done)
            .map_or_else(String::new, |code| format!(" ({code})"));
        format!("{}{code}", word(self.state))
    }
}

fn last_line(directory: &Path) -> String {
    let text = fs::read_to_string(beside(directory, "log")).unwrap_or_default();
    text.lines()
        .rev()
        .find(|line| !line.trim().is_empty())
        .unwrap_or("its log is empty")
        .to_owned()
}
