//! `bsmpm estimate`: predicts the cost of a run, theory-manual equation (T11.3), by stored coefficients or trial runs
//! (the first steps, and the case with coarser cells).

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use bsmpm_messages::headed;
use clap::Args;

use crate::launch::command;
use crate::{Error, case};

mod against;
mod coarse;
mod growth;
mod kernel;
mod probe;
mod report;
mod sizes;
mod stored;
mod work;

use report::EstimateReport;

/// What to estimate, and how.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The case's first steps are run to learn what a unit of work costs; coarse forms of it (cells of 16, 8, 4 and 2 times the size, as
far as bodies have two of them and the time for probes allows) are run over all its time to learn how much work there is. A case
that seems to take a quarter of that time at most is then run whole: whether its steps need Newton's method no coarse form can
tell. Nothing is left of these runs; while they go on, frames (at most a gigabyte) and a checkpoint of the case lie in the folder
for temporary files (TMPDIR). Seconds are processor seconds, and by the clock those of a machine that nobody else uses.

--against DIR sets what a run of the case in DIR has taken beside the estimate, made for as many ranks unless --ranks is given.

Exit codes: 0 estimated; 2 command line; 65 the case has errors; 66 no such case, or no run in DIR; 74 the solver does not start;
that of the first steps if they fail, as 71, 80, 81.

Examples:
  bsmpm estimate cases/column_collapse.toml --ranks 2
  bsmpm estimate case.toml --no-probe --json
  bsmpm estimate case.toml --against case.out")]
pub struct EstimateArguments {
    /// The case file
    pub case: PathBuf,
    /// Ranks of the run [default: 1]
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub ranks: Option<u32>,
    /// Run nothing: take what runs took elsewhere, scaled by the speed of this machine
    #[arg(long, conflicts_with = "budget")]
    pub no_probe: bool,
    /// Never run the whole case, however little it seems to take
    #[arg(long, conflicts_with = "no_probe")]
    pub no_whole: bool,
    /// Seconds by the clock that probes may take, about
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    pub budget: f64,
    /// The directory of a run that has ended, to compare with
    #[arg(long, value_name = "DIR")]
    pub against: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The solver on one rank: the word or words that bsmpm-par's arguments follow [default: the bsmpm-par beside this
    /// program, or that of PATH; on several ranks after mpirun -n N]
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// Estimates; `announce` gets a line for every probe. Returns what is to be printed.
///
/// # Errors
/// Those of the command line and the case before anything runs; [`Error::Run`] if the first steps fail; those of files.
pub fn run(arguments: &EstimateArguments, mut announce: impl FnMut(&str)) -> Result<String, Error> {
    if !(arguments.budget.is_finite() && arguments.budget > 0.0) {
        let reason = format!(
            "E0856: --budget {} is not a positive time. Give the time for trial runs in seconds.",
            arguments.budget
        );
        return Err(Error::Usage { reason });
    }
    let case = case::parsed(&arguments.case, &case::load(&arguments.case)?, &arguments.set)?;
    let actual = arguments.against.as_deref().map(against::read).transpose()?;
    let ranks = arguments
        .ranks
        .or(actual.as_ref().map(|actual| actual.ranks))
        .unwrap_or(1) as usize;
    if case.parts(ranks, [1; 2]).is_none() {
        return Err(Error::Usage {
            reason: case.too_many(ranks),
        });
    }
    let speed = kernel::speed();
    let guess = stored::guess(&case, ranks, speed);
    let found = if arguments.no_probe {
        guess
    } else {
        let plan = probe::ProbePlan {
            case: &case,
            ranks: arguments.probed(ranks),
            command: &arguments.command(),
            may_be_whole: !arguments.no_whole,
        };
        probe::estimate(&plan, &guess, deadline(arguments.budget), &mut announce)?
    };
    let mut report = EstimateReport::of(&arguments.case, &case, ranks, speed, &found);
    if let Some(actual) = actual {
        if actual.text != case.text {
            let warning = "W0854: the run given by --against has another case or other --set options, so the \
                 difference includes more than the error of the estimate. Use the case and the --set options of that \
                 run.";
            announce(&headed(warning, "warning"));
        }
        report.compare(&actual);
    }
    Ok(if arguments.json { report.json() } else { report.text() })
}

fn deadline(budget: f64) -> Instant {
    // More than a year is no limit, and may be more than a clock can tell.
    Instant::now() + Duration::from_secs_f64(budget.min(3e7))
}

impl EstimateArguments {
    fn command(&self) -> Vec<String> {
        if self.command.is_empty() {
            vec![command::own_solver()]
        } else {
            self.command.clone()
        }
    }

    /// Ranks on which the first steps are run: as many as wanted, if this machine has the cores and starts them itself.
    fn probed(&self, ranks: usize) -> usize {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        if self.command.is_empty() && ranks <= cores {
            ranks
        } else {
            1
        }
    }
}
