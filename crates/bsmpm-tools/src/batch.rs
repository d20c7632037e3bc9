//! Runs one case with different settings, several runs at a time. Runs that are already complete are reused.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::launch::{LaunchTask, Outcome, RunState, SolverProgram};
use crate::record::short;
use crate::slurm::clock;

mod options;
mod order;
mod pool;

pub use options::Options;
pub(crate) use order::RunOrder;
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
    /// What the runs gave, in the order of the orders; `report` gets each as soon as it is there.
    pub fn run(&self, orders: &[RunOrder], ranks: usize, report: impl FnMut(usize, &Outcome)) -> Vec<Outcome> {
        self.with(orders, ranks, |order| self.outcome(order), report)
    }

    /// The same with something else in the place of each run.
    pub fn with(
        &self,
        orders: &[RunOrder],
        ranks: usize,
        made: impl Fn(&RunOrder) -> Outcome + Sync,
        report: impl FnMut(usize, &Outcome),
    ) -> Vec<Outcome> {
        let loads: Vec<PoolLoad> = orders.iter().map(|order| order.load(ranks)).collect();
        pool::all(&loads, self.limits, |index| made(&orders[index]), report)
    }

    /// Where a run is written.
    pub fn directory(&self, order: &RunOrder) -> PathBuf {
        self.output.join("runs").join(format!("{}.out", order.name))
    }

    /// The outcome of one run, made now unless it is there; its reason is that of a run that did not come to its end.
    pub fn outcome(&self, order: &RunOrder) -> Outcome {
        let limit = self
            .max_wall
            .map(|limit| ["--max-wall".to_owned(), clock(limit.as_secs())]);
        let stamp = self.solver.stamp();
        // Its launcher, too, for the cost depends on the ranks.
        let origin = stamp.map(|stamp| format!("{}\n{stamp}\n\n{}", self.solver.command.join(" "), order.case.text));
        let task = LaunchTask {
            case: self.path,
            set: &order.set,
            further: limit.into_iter().flatten().collect(),
            directory: self.directory(order),
            origin,
            from: None,
            force: self.force,
            resume: true,
        };
        let outcome = self
            .solver
            .outcome(&task, |manifest| manifest.case.text == order.case.text);
        let outcome = outcome.unwrap_or_else(|error| Outcome::broken(error.to_string()));
        let reason = match outcome.state {
            RunState::Done => String::new(),
            RunState::Stopped => format!("stopped at time {}", short(outcome.time())),
            _ => outcome.reason,
        };
        Outcome { reason, ..outcome }
    }
}

/// Bytes that runs side by side may take together: what is asked for, or what this machine has free, if it can be
/// determined.
fn memory(asked: Option<u64>) -> u64 {
    asked.or_else(free_memory).unwrap_or(u64::MAX)
}

/// Returns the free memory of this machine (bytes), if it can be determined.
fn free_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}
