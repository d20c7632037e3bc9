//! `bsmpm compare`: draws and tabulates one quantity of several runs.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::picture::axes::Label;
use crate::picture::chart::{Chart, ChartCurve};
use crate::picture::colour::{self, INK};
use crate::picture::legend::{LegendEntry, Mark};
use crate::{Error, reference};

mod residuals;
mod runs;
mod table;

pub use crate::picture::chart::ChartLevel;
use runs::Runs;

/// Options that have no meaning for residuals.
const OF_QUANTITIES: [&str; 11] = [
    "x",
    "y",
    "x_scale",
    "y_scale",
    "x_label",
    "y_label",
    "lines",
    "references",
    "last",
    "x_values",
    "at",
];

/// What to compare.
#[derive(Clone, Debug, Args)]
pub struct CompareArguments {
    /// Output directories of the runs, which may be running or stopped
    #[arg(required = true, value_name = "DIR")]
    pub directories: Vec<PathBuf>,
    /// Column of history.csv along the horizontal axis, or its quantity
    #[arg(long, value_name = "COLUMN", default_value = "time")]
    pub x: String,
    /// Column of history.csv along the vertical axis, or its quantity
    #[arg(long, value_name = "COLUMN", required_unless_present = "residuals")]
    pub y: Option<String>,
    /// Instead of a quantity: the residuals (energy and force) of every iteration of this step, on logarithmic axes;
    /// from residuals.csv, which `output.residuals = true` writes
    #[arg(long, value_name = "STEP", conflicts_with_all = OF_QUANTITIES)]
    pub residuals: Option<u64>,
    /// Multiplies the column along the horizontal axis
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = number, allow_hyphen_values = true)]
    pub x_scale: f64,
    /// Multiplies the column along the vertical axis
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = number, allow_hyphen_values = true)]
    pub y_scale: f64,
    /// Label of the horizontal axis [default: the column and its unit]
    #[arg(long, value_name = "TEXT")]
    pub x_label: Option<String>,
    /// Label of the vertical axis [default: the column and its unit]
    #[arg(long, value_name = "TEXT")]
    pub y_label: Option<String>,
    /// Title of the picture [default: the title of the cases, if it is the same]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Name of a run, once for every DIR [default: its stabilisation if that differs, else DIR]
    #[arg(long = "label", value_name = "NAME")]
    pub labels: Vec<String>,
    /// Horizontal line in the picture; repeatable
    #[arg(long = "line", value_name = "VALUE[=TEXT]", value_parser = level, allow_hyphen_values = true)]
    pub lines: Vec<ChartLevel>,
    /// Reference points in the units of the picture: a CSV file with columns x,y below a line with their names;
    /// repeatable
    #[arg(long = "reference", value_name = "FILE")]
    pub references: Vec<PathBuf>,
    /// Only the last row of every run; runs with the same label form one curve
    #[arg(long)]
    pub last: bool,
    /// Value of a run along the horizontal axis, once for every DIR, instead of a column
    #[arg(
        long = "x-value",
        value_name = "V",
        requires = "last",
        conflicts_with = "x",
        value_parser = number,
        allow_hyphen_values = true
    )]
    pub x_values: Vec<f64>,
    /// File of the picture [default: compare.png, or with --table none]
    #[arg(short, long, value_name = "FILE.png")]
    pub output: Option<PathBuf>,
    /// Print the curves as a table
    #[arg(long)]
    pub table: bool,
    /// Values of x for the rows of the table; the runs are interpolated [default: round numbers; with --last all]
    #[arg(
        long,
        value_name = "X,...",
        requires = "table",
        value_delimiter = ',',
        value_parser = number,
        allow_hyphen_values = true
    )]
    pub at: Vec<f64>,
}

impl CompareArguments {
    /// Where the picture goes, if one is wanted.
    fn picture(&self) -> Option<PathBuf> {
        match (&self.output, self.table) {
            (Some(path), _) => Some(path.clone()),
            (None, false) => Some(PathBuf::from("compare.png")),
            (None, true) => None,
        }
    }
}

/// Reads a finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| "expected a finite number".to_owned())
}

fn level(text: &str) -> Result<ChartLevel, String> {
    let (value, text) = text.split_once('=').unwrap_or((text, ""));
    Ok(ChartLevel {
        value: number(value)?,
        text: text.trim().trim_matches('"').to_owned(),
    })
}

/// What was made of a comparison.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ComparedFiles {
    /// The picture.
    pub picture: Option<PathBuf>,
    /// The table, a line a row.
    pub table: Option<String>,
    /// What its reader should know: which runs have not come to their end.
    pub notes: Vec<String>,
}

/// Draws the picture and sets the table, as far as they are wanted.
///
/// # Errors
/// [`Error::Missing`] for what a directory does not hold, [`Error::Usage`] for options that do not fit the runs or each
/// other, the errors of references and files.
pub fn run(arguments: &CompareArguments) -> Result<ComparedFiles, Error> {
    if let Some(step) = arguments.residuals {
        return residuals::run(arguments, step);
    }
    let runs = Runs::read(arguments)?;
    let picture = arguments.picture();
    if let Some(path) = &picture {
        draw(arguments, &runs, path)?;
    }
    let table = arguments.table.then(|| table::text(&runs, &arguments.at));
    Ok(ComparedFiles {
        picture,
        table,
        notes: runs.notes,
    })
}

fn draw(arguments: &CompareArguments, runs: &Runs, path: &Path) -> Result<(), Error> {
    let names = runs.labels();
    let count = names.len() + arguments.references.len().saturating_sub(1);
    let mark = if arguments.last { Mark::Both } else { Mark::Line };
    let mut curves = Vec::new();
    for (name, places) in &runs.curves {
        let index = names.iter().position(|other| *other == name).unwrap_or(0);
        let entry = LegendEntry {
            name: name.clone(),
            colour: colour::line(index, count),
            mark,
        };
        curves.push(ChartCurve {
            entry,
            places: places.clone(),
        });
    }
    for (index, path) in arguments.references.iter().enumerate() {
        let colour = if index == 0 {
            INK
        } else {
            colour::line(names.len() + index - 1, count)
        };
        let (name, places) = reference::places(path)?;
        curves.push(ChartCurve {
            entry: LegendEntry {
                name,
                colour,
                mark: Mark::Points,
            },
            places,
        });
    }
    let mut legend: Vec<&LegendEntry> = Vec::new();
    for ChartCurve { entry, .. } in &curves {
        if !legend
            .iter()
            .any(|other| (&other.name, other.colour) == (&entry.name, entry.colour))
        {
            legend.push(entry);
        }
    }
    let chart = Chart {
        title: &runs.title,
        below: "",
        x: Label::of(&runs.x.0, &runs.x.1),
        y: Label::of(&runs.y.0, &runs.y.1),
        curves: &curves,
        levels: &arguments.lines,
        legend,
    };
    chart.draw().save(path)
}
