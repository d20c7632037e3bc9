//! `bsmpm plot`: draws the pictures of a run.

use std::path::PathBuf;

use bsmpm_io::frame::Frame;
use bsmpm_io::manifest::Status;
use bsmpm_io::table::Columns;
use bsmpm_scene::Regime;
use clap::Args;

use crate::compare::number;
use crate::record::RunRecord;
use crate::{Error, reference};

mod above;
mod body;
mod convergence;
mod curves;
mod field;
mod rigid;
mod section;
mod space;
mod surface;

pub use crate::picture::ticks::ValueRange;
pub use field::FieldName;
pub use section::Section;

/// What to draw.
#[derive(Clone, Debug, Args)]
pub struct PlotArguments {
    /// The output directory of a run; the pictures are written there
    pub directory: PathBuf,
    /// Times (s, or pseudo-time) of the pictures; the nearest frames are drawn [default: the times of the case, or
    /// three]
    #[arg(long, value_delimiter = ',', value_parser = time)]
    pub times: Vec<f64>,
    /// Field that is drawn in colours [default: stress-yy, in 3-D stress-zz; in quasi-static analyses also
    /// plastic-strain if there is any]
    #[arg(long, value_enum)]
    pub field: Option<FieldName>,
    /// Range of the colours in the unit of the picture, so that runs can be compared [default: the range of the values]
    #[arg(long, value_name = "MIN,MAX", value_parser = ends, allow_hyphen_values = true)]
    pub range: Option<ValueRange>,
    /// Section of a 3-D run, normal to an axis at a coordinate in m, such as y=0.5 [default: normal to y, in the middle
    /// of the grid]
    #[arg(long, value_name = "AXIS=PLACE", value_parser = Section::read)]
    pub section: Option<Section>,
    /// Reference points: a CSV file with columns `time,x,y` (free surface), `time,<history>` or
    /// `penetration,<history>`
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
}

impl PlotArguments {
    /// All pictures of a run as its case wants them.
    pub fn of(directory: PathBuf) -> Self {
        Self {
            directory,
            times: Vec::new(),
            field: None,
            range: None,
            section: None,
            reference: None,
        }
    }
}

/// A time, as `0.607 s` or a number.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('s').trim_end();
    let time: f64 = number.parse().map_err(|_| "expected a time in seconds".to_owned())?;
    if time.is_finite() {
        Ok(time)
    } else {
        Err("expected a finite time".to_owned())
    }
}

fn ends(text: &str) -> Result<ValueRange, String> {
    let ends = text
        .split_once(',')
        .and_then(|(low, high)| Some(ValueRange::of(number(low).ok()?, number(high).ok()?)));
    ends.filter(|ends| ends.low < ends.high)
        .ok_or_else(|| "expected two numbers MIN,MAX with MIN below MAX".to_owned())
}

/// Draws the pictures and, unless the run still goes on, names them in its `run.json`, so that `--force` knows them.
///
/// # Errors
/// Those of [`draw`]; a `run.json` that cannot be written.
pub fn run(arguments: &PlotArguments) -> Result<Vec<PathBuf>, Error> {
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
/// [`Error::Missing`] without a `run.json`, or if there is nothing to draw yet, [`Error::File`] for files that
/// are damaged or cannot be written.
pub fn draw(arguments: &PlotArguments) -> Result<Vec<String>, Error> {
    pictures(arguments).map(|(_, names)| names)
}

fn pictures(arguments: &PlotArguments) -> Result<(RunRecord, Vec<String>), Error> {
    let mut record = RunRecord::read(&arguments.directory)?;
    let reference = arguments.reference.as_deref().map(reference::columns).transpose()?;
    let frames = record.frames(&arguments.times)?;
    let mut names = above::draw(&record, &frames)?;
    // Given ends of the colours are those of the first field.
    let ranges = [arguments.range].into_iter().chain(std::iter::repeat(None));
    let coloured: Vec<_> = fields(&record, &frames, arguments.field)
        .into_iter()
        .zip(ranges)
        .collect();
    for &(field, range) in &coloured {
        names.extend(space::draw(&record, &frames, field, range)?);
    }
    record.across = arguments.section.map_or(record.across, |section| section.axis);
    let (frames, section) = section::of(&record, frames, arguments.section)?;
    if !frames.is_empty() {
        for (field, range) in coloured {
            names.extend(body::draw(&record, &frames, field, range, section)?);
        }
        let is_upright = section.is_none_or(|section| section.axis < 2);
        if is_upright && has_surface(&record, reference.as_ref()) {
            names.push(surface::draw(&record, &frames, section, reference.as_ref())?);
        }
    }
    names.extend(curves::draw(&record, reference.as_ref())?);
    names.extend(convergence::draw(&record)?);
    if names.is_empty() {
        let reason = format!(
            "E0846: the run in {} has no frame, history or step yet, so there is nothing to draw. Wait for its \
             first output.",
            record.directory.display()
        );
        return Err(Error::Missing { reason });
    }
    Ok((record, names))
}

/// The wanted field, or those that show how a scene of this kind stands; the plastic strain only if there is any.
fn fields(record: &RunRecord, frames: &[Frame], wanted: Option<FieldName>) -> Vec<FieldName> {
    let vertical = if record.is_solid() {
        FieldName::StressZz
    } else {
        FieldName::StressYy
    };
    match (wanted, record.regime()) {
        (Some(field), _) => vec![field],
        (None, Regime::Dynamic) => vec![vertical],
        (None, Regime::QuasiStatic) => {
            let strains: Option<Vec<_>> = frames
                .iter()
                .map(|frame| FieldName::PlasticStrain.values(frame))
                .collect();
            let has_strain = strains.is_some_and(|strains| strains.iter().flatten().any(|&strain| strain != 0.0));
            let strain = has_strain.then_some(FieldName::PlasticStrain);
            [vertical].into_iter().chain(strain).collect()
        }
    }
}

/// Whether the free surface shows something: where a body runs out, or there is one to compare with.
fn has_surface(record: &RunRecord, reference: Option<&Columns>) -> bool {
    let is_measured = reference.is_some_and(|table| ["time", "x", "y"].iter().all(|name| table.get(name).is_some()));
    record.regime() == Regime::Dynamic || !record.columns("runout").is_empty() || is_measured
}
