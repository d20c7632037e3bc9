//! `bsmpm validate`: runs the cases of a validation matrix (a TOML file of studies), and compares their histories with
//! references.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::Error;
use crate::launch::{self, SolverProgram};
use crate::plot::{FieldName, ValueRange};

mod check;
mod course;
mod expand;
mod figure;
mod kink;
mod matrix;
mod measure;
mod measured;
mod runs;
mod table;

pub use matrix::Depth;
use matrix::{MatrixRun, MatrixStudy, ValidationMatrix};
use measured::{Lack, MeasuredNumber};
use runs::{Launcher, MatrixOutcome};
use table::{RowVerdict, TableFigure, TableRow};

/// What to validate.
#[derive(Clone, Debug, Args)]
pub struct ValidateArguments {
    /// The matrix: a TOML file of studies with their runs, rows and figures
    pub matrix: PathBuf,
    /// Only runs and rows that are marked as short
    #[arg(long)]
    pub short: bool,
    /// Only studies whose title contains TEXT
    #[arg(long, value_name = "TEXT")]
    pub only: Option<String>,
    /// Output directory
    #[arg(short, long, value_name = "DIR", default_value = "target/validation")]
    pub output: PathBuf,
    /// Repeat runs that are complete already
    #[arg(long)]
    pub force: bool,
    /// Command that starts the solver, with a launcher if there is one
    #[arg(last = true, required = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// Rows that passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MatrixCounts {
    /// Judged rows within their bounds.
    pub passed: usize,
    /// Judged rows outside of them, or without a result; figures that could not be drawn.
    pub failed: usize,
    /// Those of which the matrix says that they fail, and why.
    pub known: usize,
}

/// A study as far as it is asked for.
struct MatrixPart<'a> {
    study: &'a MatrixStudy,
    runs: Vec<&'a MatrixRun>,
    rows: Vec<&'a matrix::MatrixRow>,
}

/// Runs and judges the matrix; `report` gets each study's part of the table as soon as it is there.
///
/// # Errors
/// A matrix that cannot be read, or of which nothing that is asked for can fail; a solver that is not there; files that
/// cannot be written. Runs that fail are rows that fail.
pub fn run(arguments: &ValidateArguments, mut report: impl FnMut(&str)) -> Result<MatrixCounts, Error> {
    let matrix = ValidationMatrix::read(&arguments.matrix)?;
    let parts = parts(&matrix, arguments)?;
    let solver = SolverProgram {
        command: &arguments.command,
        side_by_side: false,
    };
    solver.check()?; // before former runs are deleted for new ones that cannot be
    let base = arguments.matrix.parent().unwrap_or(Path::new(""));
    launch::make(&arguments.output)?;
    let launcher = Launcher {
        solver,
        base,
        output: &arguments.output,
        force: arguments.force,
    };
    let mut rows: Vec<TableRow> = Vec::new();
    let mut figures: Vec<TableFigure> = Vec::new();
    let mut undrawn = 0;
    for MatrixPart {
        study,
        runs,
        rows: wanted,
    } in parts
    {
        let mut outcomes = BTreeMap::new();
        for run in runs {
            outcomes.insert(run.name.clone(), launcher.outcome(study, run)?);
        }
        let begin = rows.len();
        rows.extend(wanted.into_iter().map(|row| {
            let case = path_between(&arguments.output, &base.join(case_of(study, row)));
            judged(study, row, &outcomes, case)
        }));
        report(&table::text(&study.title, &rows[begin..]));
        for reason in draw(study, &outcomes, base, &arguments.output, &mut figures) {
            undrawn += 1;
            report(&format!("  {reason}"));
        }
        write(&arguments.output.join("table.md"), &table::markdown(&rows, &figures))?;
        write(&arguments.output.join("table.csv"), &table::csv(&rows))?;
    }
    let count = |is: fn(RowVerdict) -> bool| rows.iter().filter(|row| is(row.verdict)).count();
    Ok(MatrixCounts {
        passed: count(|verdict| verdict == RowVerdict::Passed),
        failed: count(RowVerdict::is_failure) + undrawn,
        known: count(|verdict| verdict == RowVerdict::Known),
    })
}

/// What is asked for; a validation that judges nothing would pass whatever the program does.
fn parts<'a>(matrix: &'a ValidationMatrix, arguments: &ValidateArguments) -> Result<Vec<MatrixPart<'a>>, Error> {
    let asked = |depth: Depth| !arguments.short || depth == Depth::Short;
    let mut parts: Vec<MatrixPart<'a>> = Vec::new();
    for study in &matrix.study {
        let only = arguments.only.as_deref().unwrap_or_default().to_lowercase();
        if !study.title.to_lowercase().contains(&only) {
            continue;
        }
        let runs: Vec<&MatrixRun> = study.run.iter().filter(|run| asked(study.depth_of(run))).collect();
        let mut rows: Vec<&matrix::MatrixRow> = study.row.iter().filter(|row| row.depth.is_none_or(asked)).collect();
        rows.retain(|row| row.runs().iter().all(|name| runs.iter().any(|run| run.name == *name)));
        parts.push(MatrixPart { study, runs, rows });
    }
    if parts.iter().flat_map(|part| &part.rows).any(|row| row.is_judged()) {
        return Ok(parts.into_iter().filter(|part| !part.runs.is_empty()).collect());
    }
    let titles: Vec<&str> = matrix.study.iter().map(|study| study.title.as_str()).collect();
    let reason = format!(
        "E0807: no chosen row of the validation matrix has a reference value, so nothing would be checked. Change \
         --only, or leave out --short. The studies are: {}",
        titles.join("; ")
    );
    Err(Error::Usage { reason })
}

/// Draws what a study wants and adds its curves to `figures`; returns what could not be drawn, and why, which is no
/// reason to leave the other studies.
fn draw(
    study: &MatrixStudy,
    outcomes: &BTreeMap<String, MatrixOutcome>,
    base: &Path,
    output: &Path,
    figures: &mut Vec<TableFigure>,
) -> Vec<String> {
    let mut undrawn = Vec::new();
    for figure in &study.figure {
        match figure::draw(figure, &study.title, outcomes, base, output) {
            Ok(true) => {
                let caption = format!("{}: {}", study.title, figure.axes());
                figures.push(TableFigure {
                    theme: study.theme.clone(),
                    caption,
                    file: figure.file.clone(),
                });
            }
            Ok(false) => {}
            Err(error) => undrawn.push(format!("{} is not drawn: {error}", figure.file)),
        }
    }
    let bodies = study.plot.iter().filter_map(|plot| {
        let drawn = draw_body(plot, outcomes, output);
        drawn
            .err()
            .map(|error| format!("{} of {} is not drawn: {error}", plot.field, plot.run))
    });
    undrawn.extend(bodies);
    undrawn
}

/// The case file of the last run of a row, relative to the matrix.
fn case_of<'a>(study: &'a MatrixStudy, row: &matrix::MatrixRow) -> &'a str {
    let run = study.run.iter().find(|run| Some(&*run.name) == row.last_run());
    run.and_then(|run| run.case.as_ref()).unwrap_or(&study.case)
}

/// The path of a file from a directory, with `/` between its parts. Links are not resolved.
fn path_between(directory: &Path, file: &Path) -> String {
    let from = names(directory);
    let to = names(file);
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = vec!["..".to_owned(); from.len() - shared];
    [&up, &to[shared..]].concat().join("/")
}

/// The names along a path from the root.
fn names(path: &Path) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    for part in path.components() {
        match part {
            Component::ParentDir => _ = names.pop(),
            Component::Normal(name) => names.push(name.to_string_lossy().into_owned()),
            Component::Prefix(_) | Component::RootDir | Component::CurDir => {}
        }
    }
    names
}

/// The number of a row and what it is worth; `case` is the path of its case file for the table.
fn judged(
    study: &MatrixStudy,
    row: &matrix::MatrixRow,
    outcomes: &BTreeMap<String, MatrixOutcome>,
    case: String,
) -> TableRow {
    let found = measure::value(row, outcomes);
    let of_row: Vec<&MatrixOutcome> = row.runs().iter().filter_map(|name| outcomes.get(*name)).collect();
    let failed = of_row.iter().find_map(|outcome| outcome.failure.clone());
    let verdict = verdict(row, &found, failed.is_some());
    let (value, remark) = match found {
        Ok(measured) => (Some(measured.value), measured.remark),
        Err(Lack::NotReached(reason) | Lack::Other(reason)) => (None, Some(reason)),
    };
    let mut remarks: Vec<String> = remark.into_iter().collect();
    remarks.extend(
        row.known
            .iter()
            .map(|known| format!("known to be {} to {}: {}", known.min, known.max, known.why)),
    );
    remarks.extend(failed);
    remarks.extend(of_row.iter().filter_map(|outcome| outcome.stopped.clone()));
    remarks.dedup();
    let last = row
        .last_run()
        .and_then(|name| outcomes.get(name))
        .map(|outcome| &outcome.run);
    let sizes = last
        .and_then(|run| run.manifest.as_ref())
        .map(|manifest| &manifest.sizes);
    TableRow {
        theme: study.theme.clone(),
        study: study.title.clone(),
        quantity: row.quantity.clone(),
        case,
        published: row.reference,
        source: row.source.clone(),
        value,
        scale: row.difference_scale(),
        tolerance: row.wanted(),
        verdict,
        reason: row.known.as_ref().map(|known| known.why.clone()),
        remark: remarks.join("; "),
        codes: runs::codes(&of_row),
        cells: sizes.and_then(|sizes| sizes.get("cells")).copied(),
        cost: last.map(|run| run.cost).unwrap_or_default(),
    }
}

/// How a row stands. A run that broke, or did not come so far, or a number elsewhere is another failure than the known
/// one; and what is known to fail and does not has changed without the matrix.
fn verdict(row: &matrix::MatrixRow, found: &Result<MeasuredNumber, Lack>, is_broken: bool) -> RowVerdict {
    match (found, &row.known) {
        (Err(Lack::NotReached(_)), _) if !row.is_judged() => RowVerdict::NotReached,
        _ if !row.is_judged() => RowVerdict::Warned,
        _ if is_broken => RowVerdict::Failed,
        (Err(Lack::NotReached(_)), _) => RowVerdict::Missed,
        (Ok(ours), known) if row.holds(ours.value) => known.as_ref().map_or(RowVerdict::Passed, |_| RowVerdict::Mended),
        (Ok(ours), Some(known)) if (known.min..=known.max).contains(&ours.value) => RowVerdict::Known,
        _ => RowVerdict::Failed,
    }
}

/// The pictures of the body of a run, copied beside the table.
fn draw_body(plot: &matrix::Plot, outcomes: &BTreeMap<String, MatrixOutcome>, output: &Path) -> Result<(), Error> {
    let Some(outcome) = outcomes.get(&plot.run).filter(|outcome| outcome.run.has_rows()) else {
        return Ok(());
    };
    let Some(directory) = &outcome.run.directory else {
        return Ok(());
    };
    let arguments = crate::plot::PlotArguments {
        times: plot.times.clone(),
        field: FieldName::from_str(&plot.field, true).ok(),
        range: plot.range.map(|(low, high)| ValueRange { low, high }),
        ..crate::plot::PlotArguments::of(directory.clone())
    };
    for name in crate::plot::draw(&arguments)?
        .iter()
        .filter(|name| name.starts_with(&plot.field))
    {
        let to = output.join(format!("{}_{name}", plot.run));
        let from = directory.join(name);
        fs::copy(&from, &to).map_err(bsmpm_io::Error::file("copy", &from))?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    Ok(fs::write(path, text).map_err(bsmpm_io::Error::file("write", path))?)
}

#[cfg(test)]
mod plausible;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_from_the_table_to_the_case() {
        let between = |directory: &str, file: &str| path_between(Path::new(directory), Path::new(file));
        assert_eq!(
            between("target/validation", "cases/validation/../footing.toml"),
            "../../cases/footing.toml"
        );
        assert_eq!(between("/a/b", "/a/c/d.toml"), "../c/d.toml");
        assert_eq!(between(".", "./d.toml"), "d.toml");
    }
}
