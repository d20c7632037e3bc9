//! Draws the free surface at chosen times.

use bsmpm_io::frame::Frame;
use bsmpm_io::table::Columns;

use super::body::{outline, region};
use super::section::{self, Section};
use crate::Error;
use crate::picture::axes::{BELOW, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, INK, WHITE};
use crate::picture::layout::Layout;
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::splat;
use crate::picture::ticks::{ValueRange, range};
use crate::record::RunRecord;

const ABOVE: f64 = 115.0;
const RIGHT: f64 = 60.0;
const NAME: &str = "surface.png";
/// A picture lower than this share of its width is stretched upward.
const LOWEST: f64 = 0.16;

/// Draws the surfaces of all frames, with the points of a reference that has columns `time,x,y`; returns the picture's
/// name.
pub(super) fn draw(
    record: &RunRecord,
    frames: &[Frame],
    section: Option<Section>,
    reference: Option<&Columns>,
) -> Result<String, Error> {
    let reference = reference.map(|table| places(record, frames, table)).unwrap_or_default();
    let entries = entries(record, frames, &reference);
    let entries: Vec<&LegendEntry> = entries.iter().collect();
    let layout = Layout::of(region(record, frames), RIGHT, LOWEST);
    let room = layout.width - 80.0;
    let axes = layout.axes(ABOVE + legend::height(&entries, room) + 20.0);
    let mut canvas = Canvas::new(layout.width, axes.bottom + BELOW);
    let mut below = "Free surface".to_owned() + &section::named(section);
    if layout.stretch > 1.0 {
        below += &format!(", heights enlarged {:.1} times", layout.stretch);
    }
    title(&mut canvas, layout.width, &record.manifest.case.title, &below);
    legend::draw(&mut canvas, &entries, 40.0, ABOVE, room);
    axes.rules(&mut canvas);
    outline(&mut canvas, &axes, record);
    for (index, frame) in frames.iter().enumerate() {
        axes.line(
            &mut canvas,
            &surface(record, frame),
            3.5,
            colour::line(index, frames.len()),
        );
    }
    for (place, colour) in reference
        .iter()
        .flat_map(|group| group.places.iter().map(|place| (place, group.colour)))
    {
        canvas.disc(axes.place(*place), 8.0, WHITE);
        canvas.disc(axes.place(*place), 6.0, colour);
    }
    let [across, up] = record.axes();
    axes.draw(&mut canvas, Some(across), up);
    canvas.save(&record.directory.join(NAME))?;
    Ok(NAME.to_owned())
}

/// The highest point, of a solid the top of its material, of every column of cells from left to right; an empty column
/// breaks the line.
fn surface(record: &RunRecord, frame: &Frame) -> Vec<[f64; 2]> {
    let Some(ValueRange { low, high }) = range(frame.position.iter().map(|point| point[0])) else {
        return Vec::new();
    };
    let grid = record.manifest.grid.as_ref();
    let cell = grid.and_then(|grid| Some((*grid.lower.first()?, *grid.cell.first()?)));
    let (origin, width) = cell.unwrap_or_else(|| {
        let sizes = splat::sizes(frame, &record.manifest.case.geometry);
        (low, 2.0 * range(sizes).map_or(1.0, |sizes| sizes.high))
    });
    // A hundred thousand columns are more than a picture can show, and bound the memory whatever the numbers are.
    let width = if width > 0.0 { width } else { high - low }.max((high - low) / 1e5);
    let first = column(low, origin, width);
    let mut highest = vec![[f64::NAN; 2]; (column(high, origin, width) - first) as usize + 1];
    for &[x, y, _] in &frame.position {
        let top = &mut highest[(column(x, origin, width) - first) as usize];
        if top[1].is_nan() || top[1] < y {
            *top = [x, y];
        }
    }
    let above = section::above(record, frame);
    highest.iter_mut().for_each(|top| top[1] += above);
    highest
}

/// The number of the column of cells of this width, counted from `origin`, that a place lies in.
fn column(x: f64, origin: f64, width: f64) -> f64 {
    if width > 0.0 {
        ((x - origin) / width).floor()
    } else {
        0.0
    }
}

/// Reference points of one time.
struct SurfaceGroup {
    time: f64,
    places: Vec<[f64; 2]>,
    colour: colour::Rgb,
}

/// The reference's points by time, in the colour of the frame of the same time, if there is one.
fn places(record: &RunRecord, frames: &[Frame], table: &Columns) -> Vec<SurfaceGroup> {
    let columns = (table.get("time"), table.get("x"), table.get("y"));
    let (Some(times), Some(x), Some(y)) = columns else {
        return Vec::new();
    };
    let mut groups: Vec<SurfaceGroup> = Vec::new();
    for ((&time, &x), &y) in times.iter().zip(x).zip(y) {
        if let Some(group) = groups.iter_mut().find(|group| group.time == time) {
            group.places.push([x, y]);
        } else {
            let moment = record.moment(time);
            let same = frames.iter().position(|frame| record.moment(frame.time) == moment);
            groups.push(SurfaceGroup {
                time,
                places: vec![[x, y]],
                colour: same.map_or(INK, |index| colour::line(index, frames.len())),
            });
        }
    }
    groups
}

fn entries(record: &RunRecord, frames: &[Frame], reference: &[SurfaceGroup]) -> Vec<LegendEntry> {
    let mut entries = Vec::new();
    for (index, frame) in frames.iter().enumerate() {
        entries.push(LegendEntry {
            name: record.moment(frame.time),
            colour: colour::line(index, frames.len()),
            mark: Mark::Line,
        });
    }
    for group in reference {
        entries.push(LegendEntry {
            name: format!("reference, {}", record.moment(group.time)),
            colour: group.colour,
            mark: Mark::Points,
        });
    }
    entries
}
