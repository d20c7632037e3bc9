//! Draws the body, coloured by a field.

use bsmpm_io::frame::Frame;
use bsmpm_scene::{Case, Regime};

use super::field::FieldName;
use super::section::Section;
use super::{rigid, section};
use crate::Error;
use crate::picture::axes::{self, ChartAxes, title};
use crate::picture::bar::{self, Bar};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, OUTLINE};
use crate::picture::layout::{Layout, aspect};
use crate::picture::splat;
use crate::picture::ticks::{ValueRange, range};
use crate::record::{RunRecord, short};

const ABOVE: f64 = 130.0;
const RIGHT: f64 = 60.0;

/// What the pictures of all frames share.
struct BodyPicture<'a> {
    record: &'a RunRecord,
    /// None of a case of another version, of which there is none today: such a case has no rigid bodies either.
    case: Option<Case>,
    section: Option<Section>,
    /// m  the ranges of x and y that are shown
    region: [ValueRange; 2],
}

/// Draws a picture for every frame, with the `wanted` range of colours or one from the values, of the `section` of a
/// solid; returns their names.
pub(super) fn draw(
    record: &RunRecord,
    frames: &[Frame],
    field: FieldName,
    wanted: Option<ValueRange>,
    section: Option<Section>,
) -> Result<Vec<String>, Error> {
    let values: Option<Vec<_>> = frames.iter().map(|frame| field.values(frame)).collect();
    let Some(values) = values else {
        let reason = format!(
            "E0847: the frames of {} have no field `{}`. Choose another --field, or add this field to output.fields \
             and run the case again.",
            record.directory.display(),
            field.field()
        );
        return Err(Error::Missing { reason });
    };
    let colours = wanted.unwrap_or_else(|| field.range(&values));
    let picture = BodyPicture {
        record,
        case: Case::from_text("case", &record.manifest.case.text, &[]).ok(),
        section,
        region: region(record, frames),
    };
    let mut names = Vec::new();
    for (frame, values) in frames.iter().zip(&values) {
        let name = format!("{}_{}.png", field.name(), short(frame.time));
        let bar = Bar {
            range: colours,
            label: field.label(section.map(|section| section.axis)),
            pointed: FieldName::exceeded(values, colours),
        };
        let beyond = field.beyond(values, colours);
        picture
            .draw(frame, values, &beyond, bar)
            .save(&record.directory.join(&name))?;
        names.push(name);
    }
    Ok(names)
}

impl BodyPicture<'_> {
    /// Draws a frame in the colours of its values; `beyond` is said below the title.
    fn draw(&self, frame: &Frame, values: &[f64], beyond: &str, bar: Bar) -> Canvas {
        let &Self {
            record,
            section,
            region,
            ..
        } = self;
        // A low and long body has its bar of colours lying below it.
        let lying = aspect(region) < bar::LYING;
        let layout = Layout::of(region, if lying { RIGHT } else { bar::BESIDE }, 0.0);
        let axes = layout.axes(ABOVE);
        let mut canvas = Canvas::new(
            layout.width,
            axes.bottom + axes::BELOW + if lying { bar::BELOW } else { 0.0 },
        );
        let divided = record.case.strength_reduction.filter(|factor| *factor != 1.0);
        let reduction = divided.map(|factor| format!(", strength divided by {factor}"));
        let below = record.moment(frame.time) + &reduction.unwrap_or_default() + &section::named(section) + beyond;
        title(&mut canvas, layout.width, &record.manifest.case.title, &below);
        let shades: Vec<_> = values.iter().map(|&value| colour::map(bar.share(value))).collect();
        let sizes = splat::sizes(frame, &record.manifest.case.geometry);
        let ranges = if record.manifest.grid.is_some() {
            window(record, &[])
        } else {
            region
        };
        // What is thrown may leave the walls; what is pushed does not.
        let walls = match record.regime() {
            Regime::QuasiStatic if record.manifest.grid.is_some() => record.walls(),
            _ => Default::default(),
        };
        let inside = splat::SplatWindow {
            ranges,
            walls,
            reach: splat::REACH,
        };
        splat::draw(&mut canvas, &axes, &inside, &frame.position, &sizes, &shades);
        if let Some(case) = &self.case {
            rigid::draw(&mut canvas, &axes, region, record, case, frame);
        }
        outline(&mut canvas, &axes, record);
        let [across, up] = record.axes();
        axes.draw(&mut canvas, Some(across), up);
        if lying {
            bar.lying(&mut canvas, &axes);
        } else {
            bar.upright(&mut canvas, &axes);
        }
        canvas
    }
}

/// The ranges along the axes of the picture where points can be: the grid's box, or without one that of all points.
fn window(record: &RunRecord, frames: &[Frame]) -> [ValueRange; 2] {
    window_of(record, frames, record.plane())
}

/// As [`window`] and [`region`], of the plane of these axes of the case.
pub(super) fn region_of(record: &RunRecord, frames: &[Frame], plane: [usize; 2]) -> [[ValueRange; 2]; 2] {
    let window = window_of(record, frames, plane);
    [window, around(window)]
}

fn window_of(record: &RunRecord, frames: &[Frame], plane: [usize; 2]) -> [ValueRange; 2] {
    let grid = record.manifest.grid.as_ref();
    [0, 1].map(|shown| {
        let axis = plane[shown];
        let extent = grid.and_then(|grid| Some(ValueRange::of(*grid.lower.get(axis)?, *grid.upper.get(axis)?)));
        let points = frames.iter().flat_map(|frame| &frame.position);
        let extent = extent.or_else(|| range(points.map(|point| point[shown])));
        extent.unwrap_or(ValueRange::UNIT)
    })
}

/// The region that is shown: where points can be and a little more.
pub(super) fn region(record: &RunRecord, frames: &[Frame]) -> [ValueRange; 2] {
    around(window(record, frames))
}

fn around(window: [ValueRange; 2]) -> [ValueRange; 2] {
    let [wide, high] = window.map(ValueRange::length);
    let room = 0.02 * wide.min(high).max(0.1 * wide.max(high));
    let room = if room > 0.0 { room } else { 0.5 };
    window.map(|range| ValueRange::of(range.low - room, range.high + room))
}

/// The box of the grid, if the manifest reports it.
pub(super) fn outline(canvas: &mut Canvas, axes: &ChartAxes, record: &RunRecord) {
    let Some(grid) = &record.manifest.grid else { return };
    let corners = [&grid.lower, &grid.upper].map(|corner| record.plane().map(|axis| corner.get(axis).copied()));
    if let [[Some(left), Some(bottom)], [Some(right), Some(top)]] = corners {
        canvas.frame(axes.place([left, top]), axes.place([right, bottom]), 1.5, OUTLINE);
    }
}
