//! Many runs of one case with different settings, side by side: each is validated in `order` before anything runs, begun when
//! there is room in `pool`, and what it left is read in `outcome`. Runs that have ended are kept, those that were stopped go
//! on, and one that fails does not end the others.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::Error;
use crate::launch::{LaunchTask, SolverProgram};
use crate::slurm::clock;

mod options;
mod order;
mod outcome;
mod pool;

pub use options::Options;
pub(crate) use order::RunOrder;
pub(crate) use outcome::{Outcome, RunCost, RunState};
pub(crate) use pool::{Limits, PoolLoad};

/// How the runs of a batch are made.
pub(crate) struct Batch<'a> {
    pub solver: SolverProgram<'a>,
    /// The case file.
    pub path: &'a Path,
    /// Below it are the runs, in `runs`.
    pub output: &'a Path,
    pub limits: Limits,
    /// Of each run, by the clock.
    pub max_wall: Option<Duration>,
    /// Repeat runs that are there.
    pub force: bool,
}

impl Batch<'_> {
    /// What the runs gave, in the order of the orders; `told` gets each as soon as it is there.
    pub fn run(&self, orders: &[RunOrder], ranks: usize, told: impl FnMut(usize, &Outcome)) -> Vec<Outcome> {
        self.with(orders, ranks, |order| self.outcome(order), told)
    }

    /// The same with something else in the place of each run.
    pub fn with(
        &self,
        orders: &[RunOrder],
        ranks: usize,
        made: impl Fn(&RunOrder) -> Outcome + Sync,
        told: impl FnMut(usize, &Outcome),
    ) -> Vec<Outcome> {
        let loads: Vec<PoolLoad> = orders.iter().map(|order| order.load(ranks)).collect();
        pool::all(&loads, self.limits, |index| made(&orders[index]), told)
    }

    /// Where a run is written.
    pub fn directory(&self, order: &RunOrder) -> PathBuf {
        self.output.join("runs").join(format!("{}.out", order.name))
    }

    /// The outcome of one run, made now unless it is there.
    fn outcome(&self, order: &RunOrder) -> Outcome {
        let directory = self.directory(order);
        let mut arguments = vec![self.path.display().to_string()];
        for set in &order.set {
            arguments.extend(["--set".to_owned(), set.clone()]);
        }
        arguments.extend(["--quiet".to_owned(), "--output".to_owned(), directory.display().to_string()]);
        if let Some(limit) = self.max_wall {
            arguments.extend(["--max-wall".to_owned(), clock(limit.as_secs())]);
        }
        let origin = self.origin(order);
        let task =
            LaunchTask { arguments: &arguments, directory: &directory, origin: origin.as_deref(), force: self.force };
        if task.is_there(|manifest| manifest.case.text == order.case.text) {
            return Outcome::read(&directory, None);
        }
        match self.solver.advance(&task) {
            Ok(code) => Outcome::read(&directory, Some(code)),
            Err(error) => Outcome::broken(error.to_string()),
        }
    }

    /// Everything that a run is made from, as it stands now; its launcher, too, for the cost depends on the ranks.
    fn origin(&self, order: &RunOrder) -> Option<String> {
        Some(format!("{}\n{}\n\n{}", self.solver.command.join(" "), self.solver.stamp()?, order.case.text))
    }
}

/// Bytes that runs side by side may take together: what is asked for, or what this machine has free, if it can be told.
fn memory(asked: Option<u64>) -> u64 {
    let free = || {
        let text = fs::read_to_string("/proc/meminfo").ok()?;
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
    };
    asked.or_else(free).unwrap_or(u64::MAX)
}

/// The bytes of the case file.
///
/// # Errors
/// [`Error::NoCase`].
pub(crate) fn load(path: &Path) -> Result<Vec<u8>, Error> {
    bsmpm_scene::load(path).map_err(|source| Error::NoCase { path: path.to_owned(), source })
}
