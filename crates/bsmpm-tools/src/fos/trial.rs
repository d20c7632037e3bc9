//! Makes trial runs with reduced strength.

use std::path::{Path, PathBuf};

use bsmpm_io::frame::Frame;
use bsmpm_io::manifest::Manifest;
use serde::Serialize;

use super::curve::CurveState;
use super::jobs::JobSource;
use super::moved::{Mechanism, MovedGround};
use super::sought::ELASTIC;
use super::subject::Subject;
use crate::Error;
use crate::launch::{self, LaunchTask, Outcome, RunCost, RunState, SolverProgram, Stop};
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
pub(super) struct FosTrial {
    pub factor: f64,
    #[serde(flatten)]
    pub end: End,
    /// the one that decides: what the material of a block of cells has moved at least, in the unit of the case's
    /// history, as of its own stiffness; at the end of the load that was reached; of a stage the one since, and the
    /// elastic one
    pub displacement: f64,
    /// the same, less what the inertia of this trial adds to the displacement of the elastic body
    #[serde(skip)]
    pub comparable: f64,
    /// the largest one of any point
    pub largest_displacement: f64,
    /// m  where the point is that has moved most
    pub farthest: [f64; 3],
    /// indicators beyond their limits, which would end a run with a code of its own
    pub failed_indicators: Vec<String>,
    /// where the ground moves by more than half of the displacement that decides
    #[serde(skip)]
    pub mechanism: Mechanism,
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
    /// what they go on from; none: from zero
    pub stage: Option<StageState>,
    /// what they are compared with where inertia is sought
    pub pushed: Option<PushedBody>,
}

/// The state at the end of a stage.
pub(super) struct StageState {
    checkpoint: PathBuf,
    cost: RunCost,
    /// the displacement of the elastic body, as of its own stiffness
    elastic: f64,
}

/// The elastic body under its weight, and under some inertia in addition: displacements under any other inertia follow
/// by superposition.
pub(super) struct PushedBody {
    still: MovedGround,
    pushed: MovedGround,
    coefficient: f64, // of `pushed`
}

impl FosTrial {
    /// What the judge sees of it.
    pub fn state(&self) -> CurveState {
        CurveState {
            factor: self.factor,
            displacement: self.comparable,
            whole: self.end == End::Equilibrium,
        }
    }

    pub fn cost(&self) -> RunCost {
        let Self {
            cpu_seconds,
            seconds,
            steps,
            iterations,
            cuts,
            ..
        } = *self;
        RunCost {
            cpu_seconds,
            wall_seconds: seconds,
            peak_memory: 0,
            steps,
            iterations,
            cuts,
        }
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

impl JobSource for Trials<'_> {
    type Trial = FosTrial;

    fn kept(&self, factor: f64) -> Result<Option<FosTrial>, Error> {
        let set = self.subject.overrides(factor);
        let text = self.subject.text(factor)?;
        let task = self.task(factor, &set, &text);
        if !task.is_there(|manifest| manifest.case.text == text) {
            return Ok(None);
        }
        self.read(factor, &task.directory, &task.left(None)).map(Some)
    }

    /// # Errors
    /// [`Error::Run`] for one that ended neither in equilibrium nor for the want of it; [`Error::Launch`], and the
    /// errors of files.
    fn make(&self, factor: f64, stop: &Stop) -> Result<FosTrial, Error> {
        let set = self.subject.overrides(factor);
        let text = self.subject.text(factor)?;
        let task = self.task(factor, &set, &text);
        self.read(factor, &task.directory, &self.solver.make(&task, stop)?)
    }

    fn state(trial: &FosTrial) -> CurveState {
        trial.state()
    }
}

impl Trials<'_> {
    /// The state that the trials go on from, if they are of a stage: found now, unless it is there.
    ///
    /// # Errors
    /// [`Error::NoStableState`] if the case does not stand until then.
    pub fn stage(&self, report: &mut dyn FnMut(&str)) -> Result<Option<StageState>, Error> {
        let Some((name, until)) = self.subject.stage() else {
            return Ok(None);
        };
        let (set, text) = self.subject.until_the_stage()?;
        let origin = self.solver.stamp().map(|stamp| format!("{stamp}\n\n{text}"));
        let directory = self.output.join("trials").join("stage.out");
        let task = LaunchTask {
            directory: directory.clone(),
            origin,
            ..self.task(1.0, &set, &text)
        };
        let checkpoint = |manifest: &Manifest| Some(directory.join(manifest.checkpoint.as_ref()?));
        let outcome = self.solver.outcome(&task, |manifest| {
            manifest.case.text == text && checkpoint(manifest).is_some_and(|path| path.exists())
        })?;
        let what = format!("the run to the end of the stage \"{name}\"");
        if [RunState::NoConvergence, RunState::Left].contains(&outcome.state) {
            let at = outcome
                .manifest
                .as_ref()
                .and_then(|manifest| manifest.failure.as_ref())
                .map_or(0.0, |it| it.time);
            let reason = format!(
                "E0829: with its full strength the soil fails at t = {at}, before the end of stage \"{name}\" (t = \
                 {until}). Choose an earlier stage, or correct the case. See {}: {}",
                directory.display(),
                outcome.reason
            );
            return Err(Error::NoStableState { reason });
        }
        let from = outcome
            .manifest
            .as_ref()
            .and_then(checkpoint)
            .filter(|_| outcome.state == RunState::Done);
        let Some(checkpoint) = from else {
            return Err(outcome.error(what));
        };
        let kept = if outcome.kept { ", kept" } else { "" };
        report(&format!(
            "{what}: {} iterations, {:.1} s{kept}",
            outcome.cost.iterations, outcome.cost.wall_seconds
        ));
        let elastic = self.elastic_trial()?;
        Ok(Some(StageState {
            checkpoint,
            cost: outcome.cost,
            elastic: elastic.displacement,
        }))
    }

    fn elastic_trial(&self) -> Result<FosTrial, Error> {
        match self.kept(ELASTIC)? {
            Some(trial) => Ok(trial),
            None => self.make(ELASTIC, &Stop::default()),
        }
    }

    /// The elastic body with and without inertia, if that is sought: found now, unless it is there.
    ///
    /// # Errors
    /// [`Error::Run`] if it has no equilibrium under the least inertia that is tried.
    pub fn pushed(&self) -> Result<Option<PushedBody>, Error> {
        let Some((set, text)) = self.subject.pushed_elastic()? else {
            return Ok(None);
        };
        let still = self.output.join(self.elastic_trial()?.directory);
        let directory = self.output.join("trials").join("pushed.out");
        let origin = self.solver.stamp().map(|stamp| format!("{stamp}\n\n{text}"));
        let task = LaunchTask {
            directory: directory.clone(),
            origin,
            ..self.task(ELASTIC, &set, &text)
        };
        let outcome = self.solver.outcome(&task, |manifest| manifest.case.text == text)?;
        if outcome.state != RunState::Done {
            return Err(outcome.error("the elastic body under the least inertia".to_owned()));
        }
        let [still, pushed] = [self.ground_of_elastic(&still)?, self.ground_of_elastic(&directory)?];
        Ok(Some(PushedBody {
            still,
            pushed,
            coefficient: self.subject.from,
        }))
    }

    fn ground_of_elastic(&self, directory: &Path) -> Result<MovedGround, Error> {
        let frame = self.last_frame(directory, ELASTIC)?;
        self.ground(frame.as_ref(), directory)
    }

    /// The frame at the end of the trial of a value, or the last one before.
    fn last_frame(&self, directory: &Path, value: f64) -> Result<Option<Frame>, Error> {
        let [_, end] = self.subject.times(value);
        Ok(RunRecord::read(directory)?.frames(&[end])?.pop())
    }

    /// How far the ground has moved by the last frame of the run in a directory.
    fn ground(&self, frame: Option<&Frame>, directory: &Path) -> Result<MovedGround, Error> {
        let ground = frame.and_then(|frame| MovedGround::of(frame, &self.subject.counted));
        ground.ok_or_else(|| Error::Usage {
            reason: format!(
                "E0832: no material point of the last frame of {} lies in the region. Give a --region that \
                 contains soil.",
                directory.display()
            ),
        })
    }

    /// What a trial goes on from.
    fn beginning(&self, factor: f64) -> Option<&StageState> {
        self.stage.as_ref().filter(|_| factor != ELASTIC)
    }

    /// The run of a factor, which makes a case of the text.
    fn task<'b>(&'b self, factor: f64, set: &'b [String], text: &str) -> LaunchTask<'b> {
        LaunchTask {
            case: self.subject.path(),
            set,
            further: Vec::new(),
            directory: self.output.join(within(factor)),
            // The same text is the same trial, on whatever ranks; but not of another solver.
            origin: self.solver.stamp().map(|stamp| format!("{stamp}\n\n{text}")),
            force: self.force,
            from: self.beginning(factor).map(|state| state.checkpoint.clone()),
            resume: false,
        }
    }

    fn read(&self, factor: f64, directory: &Path, outcome: &Outcome) -> Result<FosTrial, Error> {
        let [begin, whole] = self.subject.times(factor);
        let load = outcome.manifest.as_ref().map(|manifest| match &manifest.failure {
            Some(failure) => (failure.time - begin).max(0.0) / (whole - begin),
            None => 0.0,
        });
        let reason = outcome.reason.clone();
        let end = match (outcome.state, load) {
            (RunState::Done, Some(_)) => End::Equilibrium,
            (RunState::NoConvergence, Some(load)) => End::NoEquilibrium { load, reason },
            (RunState::Left, Some(load)) => End::Left { load, reason },
            _ => {
                return Err(Error::Run {
                    what: format!("the trial of the factor {factor}"),
                    code: outcome.code.unwrap_or(u8::MAX),
                    reason: format!("{reason} (whole in {})", launch::beside(directory, "log").display()),
                });
            }
        };
        let loose = outcome
            .manifest
            .as_ref()
            .and_then(|manifest| manifest.failure.as_ref()?.loose.clone());
        if let Some(name) = loose {
            return Err(Error::LooseBody {
                value: self.subject.sought.value(),
                trial: factor,
                name,
            });
        }
        let indicators = outcome.manifest.iter().flat_map(|manifest| &manifest.indicators);
        let failed = indicators.filter(|(_, indicator)| indicator.ends_run());
        let failed_indicators = failed.map(|(name, _)| name.clone()).collect();
        let frame = self.last_frame(directory, factor)?;
        let ground = self.ground(frame.as_ref(), directory)?;
        let strains = frame.as_ref().and_then(|frame| FieldName::PlasticStrain.values(frame));
        let RunCost {
            cpu_seconds,
            wall_seconds,
            steps,
            iterations,
            cuts,
            ..
        } = outcome.cost;
        let before = self.beginning(factor).map_or(RunCost::default(), |state| state.cost);
        let elastic = self.beginning(factor).map_or(0.0, |state| state.elastic);
        let unit = self.subject.scale * self.subject.conditions.stiffness;
        let displacement = elastic + ground.displacement() * unit;
        let (largest, farthest) = ground.farthest();
        Ok(FosTrial {
            factor,
            end,
            displacement,
            comparable: displacement * self.pushed.as_ref().map_or(1.0, |body| body.share(factor)),
            failed_indicators,
            largest_displacement: elastic + largest * unit,
            farthest,
            mechanism: ground.mechanism(self.subject.counted.dims, &self.subject.sides),
            plastic_strain: strains.and_then(|strains| strains.into_iter().reduce(f64::max)),
            steps: steps - before.steps,
            iterations: iterations - before.iterations,
            cuts: cuts - before.cuts,
            cpu_seconds: cpu_seconds - before.cpu_seconds,
            seconds: (wall_seconds - before.wall_seconds).max(0.0),
            kept: outcome.kept,
            directory: within(factor),
        })
    }
}

impl PushedBody {
    /// What part of its displacement under the inertia of a coefficient the body has without inertia.
    fn share(&self, coefficient: f64) -> f64 {
        let pushed = self.still.superposed(&self.pushed, coefficient / self.coefficient);
        self.still.displacement() / pushed.displacement()
    }
}

/// Where a trial is, relative to the output directory.
fn within(factor: f64) -> PathBuf {
    Path::new("trials").join(format!("{factor}.out"))
}
