//! Trials: runs of the case with reduced strength, several at the same time, and what each of them gave.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use serde::Serialize;

use super::curve::State;
use super::subject::Subject;
use crate::Error;
use crate::launch::{self, CHECK, DONE, Ending, LEFT, NO_CONVERGENCE, Solver, Task};
use crate::plot::FieldName;
use crate::record::Record;

/// How a trial ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub(super) enum End {
    /// In equilibrium under the whole load.
    Equilibrium,
    /// Without.
    NoEquilibrium { load: f64, reason: String },
    /// Material has left the grid or the physical range.
    Left { load: f64, reason: String },
}

/// What a trial gave.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Trial {
    pub factor: f64,
    #[serde(flatten)]
    pub end: End,
    /// the largest one, in the unit of the case's history; at the end of the load that was reached
    pub displacement: f64,
    /// the largest accumulated one of any point; none where no frame holds it
    pub plastic_strain: Option<f64>,
    pub steps: u64,
    pub iterations: u64,
    pub cuts: u64,
    pub cpu_seconds: f64,
    /// by the clock
    pub seconds: f64,
    /// whether it was there before
    pub kept: bool,
    /// relative to the output directory
    pub directory: PathBuf,
}

/// How trials are made.
pub(super) struct Trials<'a> {
    pub solver: Solver<'a>,
    pub subject: &'a Subject,
    pub output: &'a Path,
    pub force: bool,
}

impl Trial {
    /// What the judge sees of it.
    pub fn state(&self) -> State {
        State { factor: self.factor, displacement: self.displacement, whole: self.end == End::Equilibrium }
    }
}

impl End {
    /// The share of the load that was carried, and why not more; none where all was.
    pub fn early(&self) -> Option<(f64, &str)> {
        match self {
            Self::Equilibrium => None,
            Self::NoEquilibrium { load, reason } | Self::Left { load, reason } => Some((*load, reason)),
        }
    }
}

impl Trials<'_> {
    /// The trials of some factors, in their order.
    ///
    /// # Errors
    /// [`Error::Trial`] for one that ended neither in equilibrium nor for the want of it, once those that had begun are done;
    /// [`Error::Launch`], and the errors of files.
    pub fn make(&self, factors: &[f64]) -> Result<Vec<Trial>, Error> {
        let next = AtomicUsize::new(0);
        let made: Mutex<Vec<(usize, Result<Trial, Error>)>> = Mutex::new(Vec::new());
        let work = || {
            while let Some((index, &factor)) =
                Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|index| Some((index, factors.get(index)?)))
            {
                let trial = self.trial(factor);
                if trial.is_err() {
                    next.store(factors.len(), Ordering::Relaxed);
                }
                made.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((index, trial));
            }
        };
        thread::scope(|scope| {
            for _ in 0..self.solver.jobs.min(factors.len()) {
                scope.spawn(work);
            }
        });
        let mut made = made.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        made.sort_by_key(|(index, _)| *index);
        made.into_iter().map(|(_, trial)| trial).collect()
    }

    fn trial(&self, factor: f64) -> Result<Trial, Error> {
        let within = Path::new("trials").join(format!("{factor}.out"));
        let directory = self.output.join(&within);
        let mut arguments = vec![self.subject.path().display().to_string()];
        for set in self.subject.overrides(factor) {
            arguments.extend(["--set".to_owned(), set]);
        }
        arguments.extend(["--quiet", "--force", "--output"].map(str::to_owned));
        arguments.push(directory.display().to_string());
        let text = self.subject.text(factor)?;
        // The same text is the same trial, on whatever ranks; but not of another solver.
        let origin = self.solver.stamp().map(|stamp| format!("{stamp}\n\n{text}"));
        let task = Task { arguments: &arguments, directory: &directory, origin: origin.as_deref(), force: self.force };
        let code = self.solver.perform(&task, |manifest| manifest.case.text == text)?;
        self.read(factor, &directory, within, code)
    }

    fn read(&self, factor: f64, directory: &Path, within: PathBuf, code: Option<u8>) -> Result<Trial, Error> {
        let ending = Ending::of(directory, code);
        let broken =
            |reason: String| Error::Trial { factor, code: ending.code, reason, log: launch::beside(directory, "log") };
        let manifest = match (&ending.manifest, ending.code) {
            (Some(manifest), DONE | CHECK | NO_CONVERGENCE | LEFT) => manifest,
            _ => return Err(broken(ending.reason.clone())),
        };
        let record = Record::read(directory)?;
        let last = record.column(&self.subject.column).and_then(|column| column.values.last().copied());
        let displacement = last.ok_or_else(|| broken("it left no displacement".to_owned()))?;
        let load = manifest.failure.as_ref().map_or(0.0, |failure| failure.time / self.subject.end);
        let end = match ending.code {
            NO_CONVERGENCE => End::NoEquilibrium { load, reason: ending.reason.clone() },
            LEFT => End::Left { load, reason: ending.reason.clone() },
            _ => End::Equilibrium,
        };
        let frames = record.frames(&[self.subject.end])?;
        let strains = frames.last().and_then(|frame| FieldName::PlasticStrain.values(frame));
        Ok(Trial {
            factor,
            end,
            displacement,
            plastic_strain: strains.and_then(|strains| strains.into_iter().reduce(f64::max)),
            steps: manifest.summary.steps,
            iterations: manifest.summary.iterations,
            cuts: manifest.summary.cutbacks,
            cpu_seconds: manifest.summary.cpu_seconds,
            seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
            kept: code.is_none(),
            directory: within,
        })
    }
}
