//! `bsmpm fos`: the factor of safety of a case by strength reduction, or its critical seismic coefficient. What is
//! sought stands in `sought`; the case is read in `subject` and refused in `refusal`, factors are chosen in `search`,
//! trials are made in `trial`, measured in `moved` and judged in `curve`, results are set in `report` and drawn in
//! `picture`.
//!
//! Loading soil is path dependent, so every trial carries its load from zero, or goes on from the end of a stage that
//! was made with the whole strength: a state of another strength is no state on the way. What could be saved that way
//! is taken from trials that run at the same time instead: `guess` says which ones the search may ask for next, `jobs`
//! runs them. They shorten the search and change nothing else in it.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use crate::launch::{self, RunCost, SolverProgram, command};
use crate::report::save;
use crate::{Error, case};

mod curve;
mod guess;
mod jobs;
mod moved;
mod picture;
mod refusal;
mod report;
mod search;
mod sought;
mod subject;
mod trial;

use report::FosReport;
use search::{GREATEST, SearchPlan};
pub use sought::PushedSide;
use sought::{LEAST, Sought};
use subject::{FosQuestion, Subject};
use trial::{FosTrial, Trials};

/// Of the files of its tables.
const NAME: &str = "fos";
/// Narrower bands would show the rounding of displacements.
const NARROWEST: f64 = 1e-4;

/// What to search, and how.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Every trial is the case with [strength_reduction] factor = F, loaded from zero, and is judged by its displacement: what the
material of a block of two cells along each axis has moved at least, so that a single point does not decide. The factor
of safety is where the branch after failure (5 to 20 times the elastic displacement), continued back, meets the branch
before it; coarsely, where the elastic displacement has doubled. Both are printed as bands [last stable, first failed]. A
trial without equilibrium counts as failed. The elastic displacement is that of the trial 0: every material by its elastic
law, without strength that could limit the stress. --region restricts all this to the material of a box.

With --seismic DIRECTION the strength stays as it is. Trials differ by a horizontal acceleration of k times the vertical
gravity that pushes the ground to that side; the critical seismic coefficient is the k at which it fails, found in the
same manner. Displacements are compared with those of the elastic body under the same inertia. Pore pressures are those
of vertical gravity.

The factor belongs to the body as it is drawn, and does not depend on its stiffness: where the load would strain it by more
than 0.2 %, the trials' Young's moduli are multiplied until it does not, and displacements reported as if they had not been.
Loads that act at once grow over the whole run, and a stress at the start ([initial]) is left out. The notes say so.

With --stage every trial goes on from the state at the end of that stage instead, which is found once, with the whole
strength and [initial]: one step more, and then the strength falls to 1/F in 10 equal parts of the factor, a nominal step
each. Displacements are those since, added to the elastic one of what is there and acts then, loaded from zero; so the
factor is the one by which the strength may fall after that stage, with the stress that the stages have left. A case in
which water flows has a factor so only: of that time, whose pore pressures stay; with --undrained the water stays instead.

DIR gets fos.json, fos.csv, fos.png (displacement against factor), fos_plastic-strain.png and fos_displacement.png (the first
failed trial), and trials/. Trials that are there and were made from the same case by the same solver are kept.

Rigid bodies hold the soil as they do in the case, and their friction is divided, too; those that move on a way, and
strips, are held where they are at the end of the stage.

The factors follow from the trials alone, as if each were made after the other. With --jobs above 1 those that may be asked
for next are begun in advance; they count only if they are asked for, so the result is the same for any N. One that cannot
be asked for any more gets TERM, which COMMAND must pass on, as mpirun and srun do; trials/ may hold more than the table.

Exit codes: 0 found, or stable up to TO (it says so); 2 command line; 65 the case has errors or no factor of safety; 66 no
such case; 80 no stable state was found, or a trial failed because a rigid body slipped that nothing else holds; that of a
trial that broke, as 70, 71, 73, 74.

Examples:
  bsmpm fos cases/slope_stability.toml
  bsmpm fos cases/excavation.toml --stage \"pit 1\" --to 4
  bsmpm fos cases/slope_stability.toml --seismic right
  bsmpm fos case.toml --width 0.01 --set grid.cell=\"0.5 m\" -o fine -- mpirun -n 4 bsmpm-par")]
pub struct FosArguments {
    /// The case file: quasi-static or, with --stage, a consolidation, with a plastic material and a load
    pub case: PathBuf,
    /// The least factor, or coefficient [default: 0.5; with --seismic 0.02]
    #[arg(long, value_name = "FACTOR")]
    pub from: Option<f64>,
    /// The greatest factor, or coefficient [default: 3; with --seismic 1]
    #[arg(long, value_name = "FACTOR")]
    pub to: Option<f64>,
    /// Find the critical seismic coefficient of ground that is pushed to this side instead
    #[arg(long, value_name = "DIRECTION", conflicts_with = "stage")]
    pub seismic: Option<PushedSide>,
    /// Judge the material alone that lies in a box before it moves: its lower, then its upper coordinates in m, as
    /// 10,0,30,8
    #[arg(long, value_name = "BOX", value_delimiter = ',', allow_hyphen_values = true)]
    pub region: Vec<f64>,
    /// At the end of the stage of this name, in the state that it leaves; "start": of what is before the first stage;
    /// "end": of the run, as for a case that begins with `[initial]`. Factors are at least 1 then
    #[arg(long, value_name = "NAME")]
    pub stage: Option<String>,
    /// The water that has flowed until then stays where it is while the strength falls, and its pressure follows the
    /// strain, as in a sudden failure; without it every point keeps its pore pressure, as in a slow one
    #[arg(long, requires = "stage")]
    pub undrained: bool,
    /// The width of the bands [default: 0.02; with --seismic 0.01]
    #[arg(long, value_name = "WIDTH")]
    pub width: Option<f64>,
    /// Trials at the same time; the result is the same for any N [default: the cores, divided by the launcher's ranks]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Where everything is written [default: the case's stem with .fos, in the working directory]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Repeat trials that are there already
    #[arg(long)]
    pub force: bool,
    /// The solver, with the launcher before it: words that bsmpm-par's arguments follow [default: the bsmpm-par beside
    /// this program, or that of PATH, on one rank]
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// What a search found, for other commands.
pub(crate) struct FoundFactor {
    /// By the kink: the estimate, or where there is none the middle of the band.
    pub factor: Option<f64>,
    /// Of all trials together; by the clock those that were there are left out.
    pub cost: RunCost,
    /// Whether every trial was there.
    pub kept: bool,
}

/// Searches; `report` gets a line for every trial as soon as it is there. Returns the table and the written pictures.
///
/// # Errors
/// Those of the command line and the case before anything runs; [`Error::NoStableState`]; [`Error::Run`] for a trial
/// that broke; the errors of files.
pub fn run(arguments: &FosArguments, report: impl FnMut(&str)) -> Result<(String, Vec<PathBuf>), Error> {
    let (report, subject) = found(arguments, report)?;
    let output = arguments.directory();
    let pictures = picture::draw(&report, &subject, &output)?;
    Ok((report.text(), pictures.iter().map(|name| output.join(name)).collect()))
}

/// The same without words and pictures.
pub(crate) fn factor(arguments: &FosArguments) -> Result<FoundFactor, Error> {
    let (report, _) = found(arguments, |_| ())?;
    let trials = || report.trials.iter().map(|row| &row.trial);
    let finding = report.finding;
    let middle = || Some(f64::midpoint(finding.last_stable?, finding.first_failed?));
    Ok(FoundFactor {
        factor: finding.estimate.or_else(middle),
        cost: RunCost { wall_seconds: report.seconds, ..trials().map(FosTrial::cost).sum() },
        kept: trials().all(|trial| trial.kept),
    })
}

/// The search, written as tables.
fn found(arguments: &FosArguments, mut report: impl FnMut(&str)) -> Result<(FosReport, Subject), Error> {
    let start = Instant::now();
    let command = command::words(&arguments.command, 1);
    let (plan, jobs) = (arguments.plan()?, command::jobs(arguments.jobs, &command)?);
    // Whatever the number of jobs: threads in BLAS would sum in another order.
    let solver = SolverProgram { command: &command, side_by_side: true };
    let question = FosQuestion {
        sought: plan.sought,
        from: plan.from,
        stage: arguments.stage.as_deref(),
        undrained: arguments.undrained,
        region: &arguments.region,
    };
    let subject = Subject::read(&arguments.case, &arguments.set, &question)?;
    let plan = SearchPlan { softens: subject.softens, ..plan };
    solver.check()?;
    let output = arguments.directory();
    launch::make(&output)?;
    // Results of an older search must not pass for this one's, should it not come to its end.
    for path in
        ["fos.json", "fos.csv"].iter().chain(&picture::NAMES).map(|name| output.join(name)).filter(|path| path.exists())
    {
        fs::remove_file(&path).map_err(bsmpm_io::Error::file("delete", &path))?;
    }
    let force = arguments.force;
    let mut trials = Trials { solver, subject: &subject, output: &output, force, stage: None, pushed: None };
    trials.stage = trials.stage(&mut report)?;
    trials.pushed = trials.pushed()?;
    let (curve, made) = jobs::find(plan, jobs, &trials, |trial| report(&line(trial, plan.sought)))?;
    let mut report = FosReport::of(&subject, plan, &command, &curve, made);
    report.jobs = jobs;
    report.seconds = start.elapsed().as_secs_f64();
    save(&output, NAME, &report.csv(), &report)?;
    Ok((report, subject))
}

impl FosArguments {
    /// Those of a case, without options.
    pub fn of(case: PathBuf) -> Self {
        Self {
            case,
            from: None,
            to: None,
            seismic: None,
            region: Vec::new(),
            stage: None,
            undrained: false,
            width: None,
            jobs: None,
            set: Vec::new(),
            output: None,
            force: false,
            command: Vec::new(),
        }
    }

    fn plan(&self) -> Result<SearchPlan, Error> {
        let usage = |reason: String| Err(Error::Usage { reason });
        let sought = self.seismic.map_or(Sought::FactorOfSafety, Sought::SeismicCoefficient);
        let ([from, to], width) = sought.range();
        let (from, to, width) = (self.from.unwrap_or(from), self.to.unwrap_or(to), self.width.unwrap_or(width));
        // A stage that came to its end stands.
        let from = if self.stage.is_some() { from.max(1.0) } else { from };
        let least = if sought.is_seismic() { 0.0 } else { LEAST };
        // Written so that what is no number is refused, too.
        if !(least < from && from < to && to <= GREATEST) {
            return usage(format!("--from {from} --to {to}: allowed is {least} < FROM < TO <= {GREATEST}"));
        }
        if !(NARROWEST <= width && width <= to - from) {
            return usage(format!("--width {width}: allowed is {NARROWEST} <= WIDTH <= TO - FROM"));
        }
        Ok(SearchPlan { from, to, width, softens: false, sought })
    }

    fn directory(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| case::directory(&self.case, ".fos"))
    }
}

fn line(trial: &FosTrial, sought: Sought) -> String {
    let kept = if trial.kept { ", kept" } else { "" };
    let early = trial.end.early().map(|(load, reason)| format!(", ended at {load:.3} of the load: {reason}"));
    format!(
        "{} {}: displacement {:.4e} after {} iterations, {:.1} s{kept}{}",
        sought.value(),
        trial.factor,
        trial.displacement,
        trial.iterations,
        trial.seconds,
        early.unwrap_or_default()
    )
}
