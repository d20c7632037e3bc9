//! `bsmpm sweep`: error, theory-manual equation (T11.6), against cost for many settings of a case.

use std::io::Write;
use std::path::{Path, PathBuf};

use bsmpm_io::atomic;
use bsmpm_scene::Case;
use clap::Args;

use crate::batch::{Batch, Options, RunOrder};
use crate::launch::{Outcome, RunState, command};
use crate::report::{mebibytes, save};
use crate::{Error, case};

mod axes;
mod front;
mod picture;
mod plan;
mod quantity;
mod reference;
mod report;
mod safety;
mod study;
mod write;

pub(crate) use axes::split;
use plan::SweepPlan;
pub(crate) use quantity::QuantityPart;
use quantity::SweepQuantity;
use reference::ReferenceValues;
use report::{ReportParts, SweepReport};
use study::Point;

/// Of the files of its tables.
const NAME: &str = "sweep";

/// What to vary, and what to compare.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Every combination of the values is a run; with --one-at-a-time, each value alone. The case itself, or
--baseline, is always among the runs. Invalid settings, failed runs and runs that need too much memory are
reported in the table, and the others continue. Complete runs of the same case, solver and launcher are reused.
Stopped runs continue from their checkpoint.

A quantity is a column of history.csv at a time (interpolated between steps), or at the end of the run. Several
names count together by the root mean square of their relative errors; a name without a time takes that of the
next one. The quantity factor-of-safety runs `bsmpm fos` in place of each run. The cost is the CPU time of all
ranks.

DIR gets sweep.csv, sweep.json, sweep.md (the table for a page), a picture of error against cost for each quantity, and runs/.

Exit codes: 0 done, whatever the runs gave; 2 command line; 65 the case as it is has errors; 66 no such case; 80
no run was completed.

Examples:
  bsmpm sweep case.toml --vary grid.cell=20mm,10mm,5mm --vary body.*.points_per_cell=2,3,4 --quantity runout@0.607
  bsmpm sweep slope.toml --vary grid.cell=2m,1m,0.5m --quantity factor-of-safety --within 1% --write best.toml")]
pub struct SweepArguments {
    /// The case file
    pub case: PathBuf,
    /// Key of the case with its values, as for --set; `*` stands for every item of a list; repeatable
    #[arg(long, value_name = "KEY=V1,V2,...", required = true)]
    pub vary: Vec<String>,
    /// Vary one value at a time, instead of all combinations
    #[arg(long)]
    pub one_at_a_time: bool,
    /// Columns of history.csv to compare; repeatable
    #[arg(long, value_name = "NAME[@TIME],...", required = true)]
    pub quantity: Vec<String>,
    /// Reference for the errors: finest, baseline, extrapolated (over the cell sizes), the directory of a run, or
    /// numbers
    #[arg(long, value_name = "REFERENCE", default_value = "finest")]
    pub reference: String,
    /// Acceptable relative error
    #[arg(long, value_name = "SHARE", default_value = "2%", value_parser = share)]
    pub within: f64,
    /// Overrides that define the baseline for the costs [default: the case itself]
    #[arg(long, value_name = "KEY=VALUE,...")]
    pub baseline: Option<String>,
    /// Write the cheapest setting with acceptable errors as a case file
    #[arg(long, value_name = "FILE")]
    pub write: Option<PathBuf>,
    /// How the runs are made.
    #[command(flatten)]
    pub options: Options,
}

/// A share, as `2%` or `0.02`.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = text
        .trim()
        .strip_suffix('%')
        .map_or((text, 1.0), |number| (number, 0.01));
    let share = number.trim().parse().map(|number: f64| unit * number);
    share
        .ok()
        .filter(|share| *share > 0.0 && share.is_finite())
        .ok_or_else(|| "expected a share such as 2% or 0.02".to_owned())
}

/// Sweeps; `report` gets a line for every run as soon as it is there. Returns the text for the screen, and the files.
///
/// # Errors
/// Those of the command line and the case before anything runs; [`Error::NoResult`] if no run came to its end; those of
/// files.
pub fn run(arguments: &SweepArguments, mut report: impl FnMut(&str)) -> Result<(String, Vec<PathBuf>), Error> {
    let plan = arguments.plan()?;
    let options = &arguments.options;
    let path = &*arguments.case;
    let command = options.words();
    let output = options.directory(path, ".sweep");
    let batch = options.batch(&command, path, &output)?;
    let outcomes = outcomes(&batch, &plan, command::ranks(&command), &mut report);
    let (values, outcomes) = measured(&plan.quantities, outcomes);
    let reference = plan.reference.find(&plan.quantities, &plan.points, &values)?;
    let parts = ReportParts {
        case: path.display().to_string(),
        title: plan.own.title.clone(),
        command: &command,
        axes: plan.axes.iter().map(|axis| axis.key.clone()).collect(),
        quantities: &plan.quantities,
        histories: &plan.own.histories,
        points: &plan.points,
        outcomes: &outcomes,
        within: arguments.within,
    };
    let report = SweepReport::of(parts, &values, reference);
    let mut files = save(&output, NAME, &report.csv(), &report)?;
    let page = output.join("sweep.md");
    atomic::replace(&page, |file| file.write_all(report.markdown().as_bytes()))?;
    files.push(page);
    files.extend(pictures(&report, &output)?);
    if !report.has_result() {
        return Err(Error::NoResult {
            table: output.join("sweep.csv"),
        });
    }
    let mut text = report.text();
    if let Some(file) = &arguments.write {
        match report.best() {
            Some(row) => {
                written_back(&plan.bytes, &row.set, file)?;
                files.push(file.clone());
            }
            None => {
                text += &format!(
                    "{} is not written, because no setting is accurate enough\n",
                    file.display()
                )
            }
        }
    }
    Ok((text, files))
}

/// What became of every point: those that could be begun were.
fn outcomes(batch: &Batch, plan: &SweepPlan, ranks: usize, report: &mut dyn FnMut(&str)) -> Vec<Outcome> {
    let mut outcomes: Vec<Option<Outcome>> = plan.points.iter().map(|point| refused(point, batch, ranks)).collect();
    let wanted: Vec<usize> = (0..outcomes.len()).filter(|&index| outcomes[index].is_none()).collect();
    let orders: Vec<RunOrder> = wanted
        .iter()
        .filter_map(|&index| plan.points[index].order.as_ref().ok())
        .cloned()
        .collect();
    let is_search = plan.quantities.iter().any(SweepQuantity::is_factor);
    let count = orders.len();
    let mut ended = 0;
    let made = batch.with(
        &orders,
        ranks,
        |order| match is_search {
            true => safety::outcome(batch, order),
            false => batch.outcome(order),
        },
        |index, outcome| {
            ended += 1;
            let point = &plan.points[wanted[index]];
            report(format!("{ended}/{count}  {}", line(point, outcome)).trim_end());
        },
    );
    wanted
        .iter()
        .zip(made)
        .for_each(|(&index, outcome)| outcomes[index] = Some(outcome));
    outcomes.into_iter().flatten().collect()
}

/// What became of a point, for the screen.
fn line(point: &Point, outcome: &Outcome) -> String {
    let kept = if outcome.kept { ", kept" } else { "" };
    format!(
        "{}: {}, {:.1} CPU s{kept} {}",
        point.name(),
        outcome.words(),
        outcome.cost.cpu_seconds,
        outcome.reason
    )
}

/// Why a point is not begun, if it is not.
fn refused(point: &Point, batch: &Batch, ranks: usize) -> Option<Outcome> {
    match &point.order {
        Err(errors) => Some(Outcome::never(RunState::Invalid, errors.join("\n"))),
        Ok(order) => {
            let needed = order.load(ranks).memory;
            let allowed = batch.limits.memory;
            let reason = format!(
                "it needs about {:.0} MiB, and {:.0} MiB are available",
                mebibytes(needed),
                mebibytes(allowed)
            );
            (needed > allowed).then(|| Outcome::never(RunState::Memory, reason))
        }
    }
}

/// The quantities of the runs that came to their end; where one is missing, the outcome says why.
fn measured(quantities: &[SweepQuantity], mut outcomes: Vec<Outcome>) -> (Vec<Option<ReferenceValues>>, Vec<Outcome>) {
    let mut values = Vec::new();
    for outcome in &mut outcomes {
        let history = outcome.history.as_ref().filter(|_| outcome.state == RunState::Done);
        let Some(history) = history else {
            values.push(None);
            continue;
        };
        let found: Vec<Result<Vec<f64>, String>> = quantities.iter().map(|quantity| quantity.values(history)).collect();
        let missing = found.iter().find_map(|found| found.as_ref().err().cloned());
        outcome.reason = missing.unwrap_or_default();
        values.push(Some(found.into_iter().map(Result::ok).collect()));
    }
    (values, outcomes)
}

/// A picture for each quantity that has errors.
fn pictures(report: &SweepReport, output: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut drawn = Vec::new();
    for (index, name) in report.quantities.iter().enumerate() {
        let name = if report.quantities.len() > 1 {
            format!("_{name}")
        } else {
            String::new()
        };
        let name = name.replace(|c: char| !(c.is_ascii_alphanumeric() || ".-_".contains(c)), "-");
        let path = output.join(format!("sweep{name}.png"));
        if picture::draw(report, index, &path)? {
            drawn.push(path);
        }
    }
    Ok(drawn)
}

/// Writes the case with overrides; it is the case that was run, or it is not written.
fn written_back(bytes: &[u8], set: &[String], file: &Path) -> Result<(), Error> {
    let original = String::from_utf8_lossy(bytes);
    let text = write::text(&original, set).map_err(|reason| unwritable(file, &reason))?;
    let name = file.display().to_string();
    Case::from_text(&name, &text, &[]).map_err(|errors| Error::bad_case(file, &errors))?;
    let run = case::parsed(file, bytes, set)?;
    let differences = bsmpm_scene::differences(&run.text, &text).map_err(|errors| Error::bad_case(file, &errors))?;
    if let Some(difference) = differences.first() {
        let reason = format!("the written case would differ from the run: {difference}");
        return Err(unwritable(file, &reason));
    }
    Ok(atomic::replace(file, |file| file.write_all(text.as_bytes()))?)
}

/// The error of a case that cannot be written with overrides.
fn unwritable(file: &Path, reason: &str) -> Error {
    let reason = format!(
        "E0841: the best parameter values cannot be written to the file {}: {reason}. Copy the case, and enter \
         the printed values by hand.",
        file.display()
    );
    Error::Usage { reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_read() {
        assert_eq!(
            (share("2%"), share("0.05"), share(" 2.5 %")),
            (Ok(0.02), Ok(0.05), Ok(0.025))
        );
        assert!(
            ["", "x", "-1%", "0", "inf", "nan"]
                .iter()
                .all(|text| share(text).is_err())
        );
    }
}
