//! What a run of a batch left, and whether it counts.

use bsmpm_io::exit::{CHECK, DONE, LEFT, NO_CONVERGENCE, STOPPED};
use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::table::{self, Columns};
use serde::Serialize;

use crate::launch::Ending;
use crate::report::word;

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RunState {
    /// It came to the end of the case; its own checks may have failed.
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
    /// Its exit code, if it was begun.
    pub code: Option<u8>,
    /// Why it did not come to its end; empty if it did.
    pub reason: String,
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
    /// bytes  the sum of the ranks' peaks
    pub peak_memory: u64,
    pub steps: u64,
    pub iterations: u64,
    pub cuts: u64,
}

impl Outcome {
    /// That of the run in a directory; `code` is what its process ended with, if it was made now.
    pub fn read(directory: &Path, code: Option<u8>) -> Self {
        let kept = code.is_none();
        let Ending { code, manifest, reason } = Ending::of(directory, code);
        let state = match code {
            DONE | CHECK => RunState::Done,
            STOPPED => RunState::Stopped,
            NO_CONVERGENCE => RunState::NoConvergence,
            LEFT => RunState::Left,
            _ => RunState::Broken,
        };
        let cost = manifest.map_or_else(RunCost::default, |manifest| RunCost {
            cpu_seconds: manifest.summary.cpu_seconds,
            wall_seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
            peak_memory: manifest.summary.peak_memory.iter().sum(),
            steps: manifest.summary.steps,
            iterations: manifest.summary.iterations,
            cuts: manifest.summary.cutbacks,
        });
        let history = table::read(&directory.join(HISTORY)).ok();
        let time = || history.as_ref().and_then(|history| history.get("time")?.last().copied()).unwrap_or(0.0);
        let reason = match state {
            RunState::Done => String::new(),
            RunState::Stopped => format!("at time {}", crate::record::short(time())),
            _ => reason,
        };
        Self { state, code: Some(code), reason, history, cost, kept, directory: Some(directory.to_owned()) }
    }

    /// That of a run that never began.
    pub fn never(state: RunState, reason: String) -> Self {
        let cost = RunCost::default();
        Self { state, code: None, reason, history: None, cost, kept: false, directory: None }
    }

    /// That of a run that could not be started.
    pub fn broken(reason: String) -> Self {
        Self::never(RunState::Broken, reason)
    }

    /// How it stands, in a few words for a table.
    pub fn words(&self) -> String {
        let code =
            self.code.filter(|_| self.state != RunState::Done).map_or_else(String::new, |code| format!(" ({code})"));
        format!("{}{code}", word(self.state))
    }
}
