//! `bsmpm verify-case`: grid convergence of a case on three grids.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::batch::Options;
use crate::launch::{Outcome, RunState, command};
use crate::report::save;
use crate::{Error, case, plot};

pub(crate) mod grids;
mod report;

use grids::Grids;
use report::VerifyReport;

/// What becomes of the time step on other grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TimeStep {
    /// It stays: what differs between the grids is their error alone, and that of time is the same in all.
    Kept,
    /// It shrinks as the cells do: the order is that of both errors together.
    Refined,
}

/// Which case, and which grids.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The points of a cell stay as they are, so that they are refined with the grid. The time step stays, too, unless --time-step
refined: the difference between the grids is then the error of the grid alone, and the step's error is in none of the
figures. With modified-f-bar results belong to the number of steps, so keep it. Cells of several sizes, by [grid.knots] or a
preset, are divided: the case's own grid is the coarsest, and the ratio a whole number.

For every column of history.csv at each time: the course of the three values, the observed order, Richardson's extrapolated
value and the grid convergence index with the safety factor 1.25 (Roache, 1994; Celik et al., 2008), also where the ratios of
the cells differ. Values that oscillate, diverge, or show an order that the method does not have are called so: then the band
says little, and a finer grid is needed.

DIR gets verify.csv, verify.json and runs/. Finished runs are kept, as by `bsmpm sweep`.

Exit codes: 0 done, whatever the figures say; 2 command line; 65 the case has errors, or not on one of the grids; 66 no such
case; that of a run that did not come to its end.

Examples:
  bsmpm verify-case case.toml --at 0.235 --at 0.607
  bsmpm verify-case case.toml --refine-only --ratio 1.5 --time-step refined -- mpirun -n 2 bsmpm-par")]
pub struct VerifyArguments {
    /// The case file
    pub case: PathBuf,
    /// Each grid's cells over those of the next finer one
    #[arg(long, value_name = "R", default_value_t = 2.0)]
    pub ratio: f64,
    /// The case's own grid is the coarsest of the three, not the middle one
    #[arg(long)]
    pub refine_only: bool,
    /// The cells of the three grids instead, in any order, e.g. "10 mm,7.5 mm,5 mm"; lengths
    #[arg(long, value_name = "H1,H2,H3", conflicts_with_all = ["ratio", "refine_only"])]
    pub cells: Option<String>,
    /// What becomes of the time step
    #[arg(long, value_enum, default_value_t = TimeStep::Kept)]
    pub time_step: TimeStep,
    /// Times besides the end; repeatable
    #[arg(long, value_name = "TIME", value_delimiter = ',', value_parser = plot::time)]
    pub at: Vec<f64>,
    /// How the runs are made.
    #[command(flatten)]
    pub options: Options,
}

/// Verifies; `report` gets a line for every run as soon as it is there. Returns the text for the screen, and the files.
///
/// # Errors
/// Those of the command line and of the case on each grid before anything runs; [`Error::Run`] for a run that did not
/// come to its end; those of files.
pub fn run(arguments: &VerifyArguments, mut report: impl FnMut(&str)) -> Result<(String, Vec<PathBuf>), Error> {
    let options = &arguments.options;
    let path = &*arguments.case;
    let command = options.words();
    let output = options.directory(path, ".verify");
    let bytes = case::load(path)?;
    let grids = Grids::of(arguments, &bytes)?;
    let batch = options.batch(&command, path, &output)?;
    let outcomes = batch.run(&grids.orders, command::ranks(&command), |index, outcome| {
        let h = grids.sizes[index];
        let cpu = outcome.cost.cpu_seconds;
        report(format!("cells of {h} m: {}, {cpu:.1} CPU s {}", outcome.words(), outcome.reason).trim_end());
    });
    for (outcome, h) in outcomes.iter().zip(grids.sizes) {
        ended(outcome, h)?;
    }
    let report = VerifyReport::of(arguments, &grids, &outcomes)?;
    Ok((report.text(), save(&output, "verify", &report.csv(), &report)?))
}

/// Three grids are needed; two show no order.
fn ended(outcome: &Outcome, h: f64) -> Result<(), Error> {
    match outcome.state {
        RunState::Done => Ok(()),
        _ => Err(outcome.error(format!("the run with cells of {h} m"))),
    }
}
