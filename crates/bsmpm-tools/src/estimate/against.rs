//! Reads the cost of a completed run.

use std::path::Path;

use bsmpm_io::manifest::{Manifest, Status};
use serde::Serialize;

use crate::Error;
use crate::record::present;

/// A run that has ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Actual {
    /// Whether it came to the case's end.
    pub complete: bool,
    pub ranks: u32,
    pub points: u64,
    pub unknowns: u64,
    /// bytes  on the largest rank
    pub memory: u64,
    /// bytes
    pub disk: u64,
    pub steps: u64,
    pub evaluations: u64,
    /// s  of processor time, all ranks together
    pub cpu_seconds: f64,
    /// s  by the clock
    pub seconds: f64,
    /// The case's.
    #[serde(skip)]
    pub text: String,
}

/// The run in a directory.
///
/// # Errors
/// [`Error::Missing`] if there is none, [`Error::Usage`] if it has not ended; those of its manifest.
pub(super) fn read(directory: &Path) -> Result<Actual, Error> {
    let manifest = present(Manifest::read(directory))?.ok_or_else(|| Error::no_run(directory))?;
    if manifest.status == Status::Running {
        let reason = format!(
            "E0857: the run in {} has not ended, so there is nothing to compare with. Wait until this run ends.",
            directory.display()
        );
        return Err(Error::Usage { reason });
    }
    let size = |name: &str| manifest.sizes.get(name).copied().unwrap_or(0);
    let bytes = manifest.outputs.iter().filter_map(|output| output.bytes).sum();
    Ok(Actual {
        complete: manifest.failure.is_none() && manifest.status != Status::Stopped,
        ranks: manifest.ranks,
        points: size("points"),
        unknowns: size("unknowns"),
        memory: manifest.summary.peak_memory.iter().copied().max().unwrap_or(0),
        disk: bytes,
        steps: manifest.summary.steps,
        evaluations: manifest.summary.residual_evaluations,
        cpu_seconds: manifest.summary.cpu_seconds,
        seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
        text: manifest.case.text,
    })
}
