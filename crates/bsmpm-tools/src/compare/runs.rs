//! Reads the compared curves, with names and axes.

use std::path::Path;

use bsmpm_io::manifest::Status;
use bsmpm_scene::words::Word;

use super::CompareArguments;
use crate::Error;
use crate::picture::axes::Label;
use crate::record::{Recorded, RunRecord};

/// The curves in the order of the command line.
pub(super) struct Runs {
    pub title: String,
    /// Label and unit of the axes.
    pub x: (String, String),
    pub y: (String, String),
    /// The label and the places of every curve.
    pub curves: Vec<(String, Vec<[f64; 2]>)>,
    /// Whether every place is a run of its own.
    pub last: bool,
    /// Which runs have not come to their end.
    pub notes: Vec<String>,
}

impl Runs {
    pub fn read(arguments: &CompareArguments) -> Result<Self, Error> {
        fits("--x-value", arguments.x_values.len(), arguments.directories.len())?;
        let records = records(arguments)?;
        let up = columns(&records, arguments.y.as_deref().unwrap_or_default())?;
        let y = axis(&records, &up, arguments.y_label.as_deref(), arguments.y_scale)?;
        let labels = labels(arguments, &records);
        let (x, across) = if arguments.x_values.is_empty() {
            let across = columns(&records, &arguments.x)?;
            (
                axis(&records, &across, arguments.x_label.as_deref(), arguments.x_scale)?,
                Some(across),
            )
        } else {
            ((arguments.x_label.clone().unwrap_or_default(), String::new()), None)
        };
        let mut curves: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
        for (index, label) in labels.into_iter().enumerate() {
            let up: Vec<f64> = up[index].values.iter().map(|y| y * arguments.y_scale).collect();
            let across = match &across {
                Some(columns) => columns[index].values.iter().map(|x| x * arguments.x_scale).collect(),
                None => vec![arguments.x_values[index]; up.len()],
            };
            let places: Vec<[f64; 2]> = across.into_iter().zip(up).map(<[f64; 2]>::from).collect();
            if !arguments.last {
                curves.push((label, places));
                continue;
            }
            let last = places.last().copied();
            match curves.iter_mut().find(|curve| curve.0 == label) {
                Some(curve) => curve.1.extend(last),
                None => curves.push((label, last.into_iter().collect())),
            }
        }
        if arguments.last {
            curves
                .iter_mut()
                .for_each(|curve| curve.1.sort_by(|a, b| a[0].total_cmp(&b[0])));
        }
        let notes = records.iter().filter_map(note).collect();
        Ok(Self {
            title: title(arguments, &records),
            x,
            y,
            curves,
            last: arguments.last,
            notes,
        })
    }

    /// The labels without repetition.
    pub fn labels(&self) -> Vec<&String> {
        let mut labels: Vec<&String> = Vec::new();
        for (label, _) in &self.curves {
            if !labels.contains(&label) {
                labels.push(label);
            }
        }
        labels
    }
}

/// The runs, for each of which there is a name or for none.
pub(super) fn records(arguments: &CompareArguments) -> Result<Vec<RunRecord>, Error> {
    fits("--label", arguments.labels.len(), arguments.directories.len())?;
    arguments
        .directories
        .iter()
        .map(|directory| RunRecord::read(directory))
        .collect()
}

/// An option that is given for all runs or not at all.
fn fits(option: &str, given: usize, runs: usize) -> Result<(), Error> {
    if given == 0 || given == runs {
        return Ok(());
    }
    let reason = format!(
        "E0805: {option} is given {given} times for {runs} runs. Give {option} once for each run, or not at \
            all."
    );
    Err(Error::Usage { reason })
}

/// The column of each run, as [`column`].
fn columns<'a>(records: &'a [RunRecord], name: &str) -> Result<Vec<Recorded<'a>>, Error> {
    records.iter().map(|record| column(record, name)).collect()
}

/// The column `name` of a run's history, or the only one that records the quantity of that name.
fn column<'a>(record: &'a RunRecord, name: &str) -> Result<Recorded<'a>, Error> {
    let directory = record.directory.display();
    let history = record
        .history
        .as_ref()
        .filter(|history| history.values.iter().any(|values| !values.is_empty()));
    let Some(history) = history else {
        let reason = format!("E0803: history.csv of {directory} has no rows yet. Wait for the run's first output.");
        return Err(Error::Missing { reason });
    };
    if let Some(column) = record.column(name) {
        return Ok(column);
    }
    if let [only] = record.columns(name)[..] {
        return Ok(only);
    }
    let known: Vec<_> = history.headings.iter().map(|heading| heading.name.as_str()).collect();
    let reason = format!(
        "E0803: history.csv of {directory} has no column `{name}`. Choose one of: {}.",
        known.join(", ")
    );
    Err(Error::Missing { reason })
}

/// The label and unit of an axis: as given, else those of the runs' columns, which must then share a unit.
fn axis(
    records: &[RunRecord],
    columns: &[Recorded],
    given: Option<&str>,
    factor: f64,
) -> Result<(String, String), Error> {
    if let Some(label) = given {
        return Ok((label.to_owned(), String::new()));
    }
    let first = columns[0];
    if let Some((record, other)) = records
        .iter()
        .zip(columns)
        .find(|(_, column)| column.unit != first.unit)
    {
        let Recorded { name, unit, .. } = first;
        let here = records[0].directory.display();
        let there = record.directory.display();
        let reason = format!(
            "E0804: `{name}` has the unit {unit} in {here}, but `{}` has the unit {} in {there}. Both share an axis. \
             Choose another column, or give an axis label (--x-label, --y-label).",
            other.name, other.unit
        );
        return Err(Error::Usage { reason });
    }
    let of_column = first.label();
    let Label { quantity, unit } = match first.name {
        "time" => records[0].time_label(),
        _ => Label::of(&of_column, first.shown_unit()),
    };
    let label = if factor == 1.0 {
        quantity.to_owned()
    } else {
        format!("{quantity} × {factor}").replace("× -", "× −")
    };
    Ok((label, unit.to_owned()))
}

/// The names of the runs: as given; else their stabilisation if it distinguishes them, or with `--last` groups them;
/// else their directories.
pub(super) fn labels(arguments: &CompareArguments, records: &[RunRecord]) -> Vec<String> {
    if !arguments.labels.is_empty() {
        return arguments.labels.clone();
    }
    let methods: Option<Vec<String>> = records
        .iter()
        .map(|record| Some(record.case.stabilisation?.word().to_owned()))
        .collect();
    if let Some(methods) = methods.filter(|methods| arguments.last || (methods.len() > 1 && are_distinct(methods))) {
        return methods;
    }
    let stems: Vec<String> = arguments.directories.iter().map(|directory| stem(directory)).collect();
    if are_distinct(&stems) {
        return stems;
    }
    arguments
        .directories
        .iter()
        .map(|directory| directory.display().to_string())
        .collect()
}

fn are_distinct(names: &[String]) -> bool {
    names
        .iter()
        .enumerate()
        .all(|(index, name)| !names[..index].contains(name))
}

/// The last part of a directory's path without the ending that runs have; other dots may be those of numbers.
fn stem(directory: &Path) -> String {
    let name = directory.file_name().map(|name| name.to_string_lossy().into_owned());
    let name = name.unwrap_or_else(|| directory.display().to_string());
    name.strip_suffix(".out")
        .filter(|stem| !stem.is_empty())
        .unwrap_or(&name)
        .to_owned()
}

/// How a run that has not come to its end stands.
fn note(record: &RunRecord) -> Option<String> {
    let stands = match record.manifest.status {
        Status::Finished => return None,
        Status::Running => "is running",
        Status::Stopped => "was stopped",
        Status::Failed => "failed",
    };
    let last = record.column("time").and_then(|column| column.values.last().copied())?;
    Some(format!(
        "note: {} {stands}; its last row is at {}",
        record.directory.display(),
        record.moment(last)
    ))
}

/// The title of the picture: as given, else that of the cases if they share one.
pub(super) fn title(arguments: &CompareArguments, records: &[RunRecord]) -> String {
    let titles: Vec<&String> = records.iter().map(|record| &record.manifest.case.title).collect();
    let shared = titles
        .first()
        .copied()
        .filter(|first| titles.iter().all(|title| title == first));
    arguments.title.clone().or(shared.cloned()).unwrap_or_default()
}
