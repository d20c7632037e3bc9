//! `bsmpm plot`: the pictures of a run. The files of the run are read in `record`; every picture has a module; they
//! share a sheet of paper (`canvas`), axes (`layout`, `axes`, `ticks`), a legend (`legend`) and colours (`colour`).

use std::path::PathBuf;

use bsmpm_io::manifest::Status;
use clap::Args;

use crate::Error;

mod axes;
mod bar;
mod body;
mod canvas;
mod colour;
mod convergence;
mod curves;
mod field;
mod layout;
mod legend;
mod record;
mod reference;
mod splat;
mod surface;
mod ticks;

pub use field::FieldName;

/// What to draw.
#[derive(Clone, Debug, Args)]
pub struct Arguments {
    /// The output directory of a run; the pictures are written there
    pub directory: PathBuf,
    /// Times (in s, or pseudo-time) of the pictures of the body; the nearest frames are taken [default: those of the
    /// case, or three]
    #[arg(long, value_delimiter = ',', value_parser = time)]
    pub times: Vec<f64>,
    /// What colours the body
    #[arg(long, value_enum, default_value_t = FieldName::StressYy)]
    pub field: FieldName,
    /// Ends of the colours, in the unit of the picture, so that runs can be compared [default: from the values]
    #[arg(long, value_name = "MIN,MAX", value_parser = ends, allow_hyphen_values = true)]
    pub range: Option<(f64, f64)>,
    /// Points to compare with: a CSV file with columns `time,x,y` (free surface) or `time,<history>`
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
}

impl Arguments {
    /// All pictures of a run as its case wants them.
    pub fn of(directory: PathBuf) -> Self {
        Self { directory, times: Vec::new(), field: FieldName::StressYy, range: None, reference: None }
    }
}

fn time(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('s').trim_end();
    let time: f64 = number.parse().map_err(|_| "a time is a number of seconds".to_owned())?;
    if time.is_finite() { Ok(time) } else { Err("a time is finite".to_owned()) }
}

fn ends(text: &str) -> Result<(f64, f64), String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    let ends = text.split_once(',').and_then(|(lower, upper)| Some((number(lower)?, number(upper)?)));
    ends.filter(|(lower, upper)| lower < upper).ok_or_else(|| "two numbers MIN,MAX, the smaller one first".to_owned())
}

/// Draws the pictures and, unless the run still goes on, names them in its `run.json`, so that `--force` knows them.
///
/// # Errors
/// Those of [`draw`]; a `run.json` that cannot be written.
pub fn run(arguments: &Arguments) -> Result<Vec<PathBuf>, Error> {
    let (mut record, names) = pictures(arguments)?;
    if record.manifest.status != Status::Running {
        names.iter().for_each(|name| record.manifest.name_output(name));
        record.manifest.write(&record.directory)?;
    }
    Ok(names.iter().map(|name| record.directory.join(name)).collect())
}

/// Draws the pictures of a run and returns their files' names, in the run's directory.
///
/// # Errors
/// [`Error::NoRun`] without a `run.json`, [`Error::Empty`] if there is nothing to draw yet, [`Error::File`] for files that
/// are damaged or cannot be written.
pub fn draw(arguments: &Arguments) -> Result<Vec<String>, Error> {
    pictures(arguments).map(|(_, names)| names)
}

fn pictures(arguments: &Arguments) -> Result<(record::Record, Vec<String>), Error> {
    let record = record::Record::read(&arguments.directory)?;
    let reference = arguments.reference.as_deref().map(reference::read).transpose()?;
    let frames = record.frames(&arguments.times)?;
    let mut names = Vec::new();
    if !frames.is_empty() {
        names.extend(body::draw(&record, &frames, arguments.field, arguments.range)?);
        names.push(surface::draw(&record, &frames, reference.as_ref())?);
    }
    names.extend(curves::draw(&record, reference.as_ref())?);
    names.extend(convergence::draw(&record)?);
    if names.is_empty() { Err(Error::Empty { directory: record.directory }) } else { Ok((record, names)) }
}
