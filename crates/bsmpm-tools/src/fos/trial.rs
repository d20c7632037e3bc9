//! Trials: runs of the case with reduced strength, and what each of them gave.

use bsmpm_io::exit::{CHECK, DONE, LEFT, NO_CONVERGENCE};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::curve::CurveState;
use super::jobs::JobSource;
use super::subject::Subject;
use crate::Error;
use crate::launch::{self, Ending, LaunchTask, SolverProgram, Stop};
use crate::plot::FieldName;
use crate::record::RunRecord;

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
    /// the largest one, in the unit of the case's history, as of its own stiffness; at the end of the load that was reached
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
    pub solver: SolverProgram<'a>,
    pub subject: &'a Subject,
    pub output: &'a Path,
    pub force: bool,
}

impl Trial {
    /// What the judge sees of it.
    pub fn state(&self) -> CurveState {
        CurveState { factor: self.factor, displacement: self.displacement, whole: self.end == End::Equilibrium }
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

/// What a trial is made from.
struct TrialOrder {
    arguments: Vec<String>,
    /// relative to the output directory
    within: PathBuf,
    directory: PathBuf,
    /// of the case as its `run.json` has it
    text: String,
    origin: Option<String>,
}

impl TrialOrder {
    fn task(&self, force: bool) -> LaunchTask<'_> {
        LaunchTask { arguments: &self.arguments, directory: &self.directory, origin: self.origin.as_deref(), force }
    }
}

impl JobSource for Trials<'_> {
    type Trial = Trial;

    fn kept(&self, factor: f64) -> Result<Option<Trial>, Error> {
        let order = self.order(factor)?;
        if !order.task(self.force).is_there(|manifest| manifest.case.text == order.text) {
            return Ok(None);
        }
        self.read(factor, &order.directory, order.within, None).map(Some)
    }

    /// # Errors
    /// [`Error::Trial`] for one that ended neither in equilibrium nor for the want of it; [`Error::Launch`], and the errors of
    /// files.
    fn make(&self, factor: f64, stop: &Stop) -> Result<Trial, Error> {
        let order = self.order(factor)?;
        let code = self.solver.make(&order.task(self.force), stop)?;
        self.read(factor, &order.directory, order.within, Some(code))
    }

    fn state(trial: &Trial) -> CurveState {
        trial.state()
    }
}

impl Trials<'_> {
    fn order(&self, factor: f64) -> Result<TrialOrder, Error> {
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
        Ok(TrialOrder { arguments, within, directory, text, origin })
    }

    fn read(&self, factor: f64, directory: &Path, within: PathBuf, code: Option<u8>) -> Result<Trial, Error> {
        let ending = Ending::of(directory, code);
        let broken =
            |reason: String| Error::Trial { factor, code: ending.code, reason, log: launch::beside(directory, "log") };
        let manifest = match (&ending.manifest, ending.code) {
            (Some(manifest), DONE | CHECK | NO_CONVERGENCE | LEFT) => manifest,
            _ => return Err(broken(ending.reason.clone())),
        };
        let record = RunRecord::read(directory)?;
        let last = record.column(&self.subject.column).and_then(|column| column.values.last().copied());
        let displacement = last.ok_or_else(|| broken("it left no displacement".to_owned()))?;
        let displacement = displacement * self.subject.conditions.stiffness;
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
