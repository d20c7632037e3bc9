//! `bsmpm fos`: factor of safety by strength reduction, or critical seismic coefficient, theory-manual equations (T9.5)
//! to (T9.7).
//!
//! `search` chooses factors, `trial` runs the case with each factor, and `curve` decides from the displacement whether
//! the ground failed.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use crate::launch::{self, RunCost, SolverProgram, command};
use crate::report::save;
use crate::{Error, case};

mod conditions;
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

pub use refusal::refusals;
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
The search runs trials: the case with its strength divided by a factor F, loaded from zero. A trial is judged by
the displacement that all material of a block of two cells along each axis exceeds, so that a single material
point does not decide. A trial without equilibrium counts as failed. Trial 0 has elastic soil and gives the
elastic displacement.

The factor of safety is at the kink of the curve of displacement against factor: the branch after failure (5 to
20 times the elastic displacement) is extended back to the branch before it. A rough check is the factor at
which the elastic displacement doubles. Both are printed as bands [last stable, first failed]. --region judges
the material in a box only.

With --seismic DIRECTION the strength stays as it is. Trials differ in a horizontal acceleration of k times the
vertical gravity, which pushes the ground to that side. The critical seismic coefficient is the k at which the
ground fails. Displacements are compared with those of elastic soil under the same acceleration. Pore pressures
are those of vertical gravity.

The factor does not depend on the stiffness: where the load would strain the soil by more than 0.2 %, the trials
use larger Young's moduli, and the displacements are scaled back. Loads that act at once increase over the whole
run instead, and initial stresses ([initial]) are left out. The notes of the result say so.

With --stage every trial continues from the state at the end of that stage, which is computed once with full
strength and [initial]. After one step the strength decreases to 1/F in 10 steps. The factor is the one by which
the strength may decrease after that stage. A case with pore-water flow needs --stage. Its pore
pressures of that time stay constant (drained failure). With --undrained, or if no soil is permeable, its pore
water does not flow and its pressure follows the strain (undrained failure).

DIR gets fos.json, fos.csv, fos.png (displacement against factor), fos_plastic-strain.png and
fos_displacement.png (the first failed trial), and trials/. Complete trials of the same case and solver are
reused.

Rigid bodies support the soil as in the case; their friction is reduced as the strength is. Rigid bodies with a
prescribed path and footings are fixed at the end of the stage.

With --jobs above 1, trials that may be needed next start in advance. They count only if the search asks for
them, so the result is the same for any N. A trial that is no longer needed gets SIGTERM, which COMMAND must
pass on, as mpirun and srun do.

Exit codes: 0 found, or stable up to TO (it says so); 2 command line; 65 the case has errors or no factor of
safety; 66 no such case; 80 no stable state was found, or a rigid body slipped in a trial that only friction
holds; the solver's code for a trial that failed otherwise, as 70, 71, 73, 74.

Examples:
  bsmpm fos cases/slope_stability.toml
  bsmpm fos cases/excavation.toml --stage \"pit 1\" --to 4
  bsmpm fos cases/slope_stability.toml --seismic right
  bsmpm fos case.toml --width 0.01 --set grid.cell=\"0.5 m\" -o fine -- mpirun -n 4 bsmpm-par")]
pub struct FosArguments {
    /// The case file: quasi-static or, with --stage, a consolidation, with a plastic material and a load
    pub case: PathBuf,
    /// Smallest factor, or seismic coefficient [default: 0.5; with --seismic 0.02]
    #[arg(long, value_name = "FACTOR")]
    pub from: Option<f64>,
    /// Largest factor, or seismic coefficient [default: 3; with --seismic 1]
    #[arg(long, value_name = "FACTOR")]
    pub to: Option<f64>,
    /// Find the critical seismic coefficient instead, for ground that is pushed to this side
    #[arg(long, value_name = "DIRECTION", conflicts_with = "stage")]
    pub seismic: Option<PushedSide>,
    /// Judge only the material that starts in a box: its lower, then its upper coordinates in m, such as 10,0,30,8
    #[arg(long, value_name = "BOX", value_delimiter = ',', allow_hyphen_values = true)]
    pub region: Vec<f64>,
    /// Reduce the strength at the end of the stage with this name; "start": before the first stage; "end": at the end
    /// of the run. Factors are then at least 1
    #[arg(long, value_name = "NAME")]
    pub stage: Option<String>,
    /// Undrained failure: pore pressures follow the strain while the strength decreases. Without it they stay constant,
    /// as in a slow failure, unless no soil is permeable
    #[arg(long, requires = "stage")]
    pub undrained: bool,
    /// Width of the bands [default: 0.02; with --seismic 0.01]
    #[arg(long, value_name = "WIDTH")]
    pub width: Option<f64>,
    /// Number of trials at the same time; the result is the same for any N [default: the cores, divided by the ranks]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Output directory [default: name of the case with .fos, in the working directory]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Repeat trials that are complete already
    #[arg(long)]
    pub force: bool,
    /// Command that starts the solver, with a launcher if there is one [default: bsmpm-par next to this program or in
    /// PATH, on one rank]
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
    let finding = report.finding;
    let band = finding.last_stable.zip(finding.first_failed);
    let mut trials = report.trials.iter().map(|row| &row.trial);
    Ok(FoundFactor {
        factor: finding.estimate.or(band.map(|(low, high)| f64::midpoint(low, high))),
        cost: RunCost {
            wall_seconds: report.seconds,
            ..trials.clone().map(FosTrial::cost).sum()
        },
        kept: trials.all(|trial| trial.kept),
    })
}

/// The search, written as tables.
fn found(arguments: &FosArguments, mut report: impl FnMut(&str)) -> Result<(FosReport, Subject), Error> {
    let start = Instant::now();
    let command = command::words(&arguments.command, 1);
    let plan = arguments.plan()?;
    let jobs = command::jobs(arguments.jobs, &command)?;
    // Whatever the number of jobs: threads in BLAS would sum in another order.
    let solver = SolverProgram {
        command: &command,
        side_by_side: true,
    };
    let question = FosQuestion {
        sought: plan.sought,
        from: plan.from,
        stage: arguments.stage.as_deref(),
        undrained: arguments.undrained,
        region: &arguments.region,
    };
    let subject = Subject::read(&arguments.case, &arguments.set, &question)?;
    let plan = SearchPlan {
        softens: subject.softens,
        ..plan
    };
    solver.check()?;
    let output = arguments.directory();
    launch::make(&output)?;
    // Results of an older search must not pass for this one's, should it not come to its end.
    for path in ["fos.json", "fos.csv"]
        .iter()
        .chain(&picture::NAMES)
        .map(|name| output.join(name))
        .filter(|path| path.exists())
    {
        fs::remove_file(&path).map_err(bsmpm_io::Error::file("delete", &path))?;
    }
    let force = arguments.force;
    let mut trials = Trials {
        solver,
        subject: &subject,
        output: &output,
        force,
        stage: None,
        pushed: None,
    };
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
        let from = self.from.unwrap_or(from);
        let to = self.to.unwrap_or(to);
        let width = self.width.unwrap_or(width);
        // A stage that came to its end stands.
        let from = if self.stage.is_some() { from.max(1.0) } else { from };
        let least = if sought.is_seismic() { 0.0 } else { LEAST };
        // Written so that what is no number is refused, too.
        if !(least < from && from < to && to <= GREATEST) {
            return usage(format!(
                "E0831: --from {from} and --to {to} are not a valid range. Give {least} < FROM < TO <= {GREATEST}."
            ));
        }
        if !(NARROWEST <= width && width <= to - from) {
            return usage(format!(
                "E0831: --width {width} is out of range. Give {NARROWEST} <= WIDTH <= TO - FROM."
            ));
        }
        Ok(SearchPlan {
            from,
            to,
            width,
            softens: false,
            sought,
        })
    }

    fn directory(&self) -> PathBuf {
        self.output
            .clone()
            .unwrap_or_else(|| case::directory(&self.case, ".fos"))
    }
}

fn line(trial: &FosTrial, sought: Sought) -> String {
    let kept = if trial.kept { ", kept" } else { "" };
    let early = trial
        .end
        .early()
        .map(|(load, reason)| format!(", stopped at {load:.3} of the load: {reason}"));
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
