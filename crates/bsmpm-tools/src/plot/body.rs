//! The body at chosen times, coloured by a quantity of its points; one range of colours for all times.

use bsmpm_io::frame::Frame;

use super::axes::{Axes, BELOW, LABEL, LEFT, NUMBER, title};
use super::canvas::{Align, Canvas, fitting};
use super::colour::{self, INK, OUTLINE};
use super::field::FieldName;
use super::record::{Record, short};
use super::splat;
use super::ticks::{Ticks, padded, range};
use crate::Error;

const SHEET: f64 = 1600.0;
const ABOVE: f64 = 130.0;
const RIGHT: f64 = 60.0;
/// Room for an upright colour bar with its numbers and label.
const UPRIGHT_BAR: f64 = 240.0;
/// Room for a lying one.
const LYING_BAR: f64 = 130.0;
const BAR: f64 = 30.0;
/// The share of points whose values lie beyond each end of the range of colours, so that a few wild ones do not set it.
const BEYOND: f64 = 0.005;

/// Draws a picture for every frame; returns their names.
pub(super) fn draw(record: &Record, frames: &[Frame], field: FieldName) -> Result<Vec<String>, Error> {
    let values: Option<Vec<_>> = frames.iter().map(|frame| field.values(frame)).collect();
    let missing = || Error::NoField { directory: record.directory.clone(), field: field.field() };
    let values = values.ok_or_else(missing)?;
    let colours = colour_range(&values);
    let region = region(record, frames);
    let mut names = Vec::new();
    for (frame, values) in frames.iter().zip(&values) {
        let name = format!("{}_{}.png", field.name(), short(frame.time));
        let layout = Layout::of(region);
        let mut canvas = Canvas::new(layout.width, layout.height);
        title(&mut canvas, layout.width, &record.manifest.case.title, &record.moment(frame.time));
        let shade = |value: &f64| colour::map((value - colours.0) / (colours.1 - colours.0));
        let shades: Vec<_> = values.iter().map(shade).collect();
        let sizes = splat::sizes(frame, &record.manifest.case.geometry);
        splat::draw(&mut canvas, &layout.axes, &frame.position, &sizes, &shades);
        outline(&mut canvas, &layout.axes, record);
        layout.axes.draw(&mut canvas, Some(("x", "m")), ("y", "m"));
        layout.bar(&mut canvas, colours, field);
        canvas.save(&record.directory.join(&name))?;
        names.push(name);
    }
    Ok(names)
}

/// The range of colours: all values but the most extreme.
fn colour_range(values: &[Vec<f64>]) -> (f64, f64) {
    let mut all: Vec<f64> = values.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    all.sort_unstable_by(f64::total_cmp);
    let at =
        |share: f64| all.get((share * all.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(0.0);
    let (low, high) = (at(BEYOND), at(1.0 - BEYOND));
    if high > low { (low, high) } else { padded(low, high, 0.0) }
}

/// The region that is shown: the grid's box, or without one that of all points, and a little more.
pub(super) fn region(record: &Record, frames: &[Frame]) -> [(f64, f64); 2] {
    let extent = record.manifest.grid.as_ref();
    let axis = |axis: usize| {
        let grid = extent.and_then(|grid| Some((*grid.lower.get(axis)?, *grid.upper.get(axis)?)));
        let points = || range(frames.iter().flat_map(|frame| &frame.position).map(|point| point[axis]));
        grid.or_else(points).unwrap_or((0.0, 1.0))
    };
    let (x, y) = (axis(0), axis(1));
    let room = 0.02 * (x.1 - x.0).min(y.1 - y.0).max(0.1 * (x.1 - x.0).max(y.1 - y.0));
    let room = if room > 0.0 { room } else { 0.5 };
    [(x.0 - room, x.1 + room), (y.0 - room, y.1 + room)]
}

/// The box of the grid, if the manifest tells it.
pub(super) fn outline(canvas: &mut Canvas, axes: &Axes, record: &Record) {
    let Some(grid) = &record.manifest.grid else { return };
    if let ([left, bottom, ..], [right, top, ..]) = (&grid.lower[..], &grid.upper[..]) {
        canvas.frame(axes.place((*left, *top)), axes.place((*right, *bottom)), 1.5, OUTLINE);
    }
}

/// Where things are on a sheet whose axes have one scale.
struct Layout {
    width: f64,
    height: f64,
    axes: Axes,
    /// A low and long body has its colour bar lying below it.
    lying: bool,
}

impl Layout {
    fn of([x, y]: [(f64, f64); 2]) -> Self {
        let aspect = (y.1 - y.0) / (x.1 - x.0);
        let lying = aspect < 0.5;
        let beside = if lying { RIGHT } else { UPRIGHT_BAR };
        let wide = (SHEET - LEFT - beside).min(1300.0 / aspect);
        let high = wide * aspect;
        let content = LEFT + wide + beside;
        let width = content.max(1000.0);
        let left = LEFT + (width - content) / 2.0;
        let (right, bottom) = (left + wide, ABOVE + high);
        let height = bottom + BELOW + if lying { LYING_BAR } else { 0.0 };
        Self { width, height, axes: Axes { left, top: ABOVE, right, bottom, x, y }, lying }
    }

    fn bar(&self, canvas: &mut Canvas, range: (f64, f64), field: FieldName) {
        let (quantity, unit) = field.label();
        if self.lying {
            self.lying_bar(canvas, range, quantity, unit);
        } else {
            self.upright_bar(canvas, range, quantity, unit);
        }
    }

    fn lying_bar(&self, canvas: &mut Canvas, (low, high): (f64, f64), quantity: &str, unit: &str) {
        let axes = &self.axes;
        let ticks = Ticks::between(low, high, 7.0);
        let label = ticks.label(quantity, unit);
        let middle = f64::midpoint(axes.left, axes.right);
        let (left, right) = (middle, axes.right - 20.0);
        let top = axes.bottom + BELOW + 20.0;
        let steps = 512;
        for i in 0..steps {
            let edge = |i: usize| left + (right - left) * i as f64 / steps as f64;
            canvas.fill((edge(i), top), (edge(i + 1), top + BAR), colour::map(i as f64 / (steps - 1) as f64));
        }
        canvas.frame((left, top), (right, top + BAR), 1.7, INK);
        for &value in &ticks.values {
            let at = left + (right - left) * (value - low) / (high - low);
            canvas.fill((at - 0.85, top + BAR), (at + 0.85, top + BAR + 9.0), INK);
            canvas.text(&ticks.text(value), (at, top + BAR + 31.0), NUMBER, Align::Centre, INK);
        }
        let size = fitting(&label, LABEL, middle - axes.left);
        canvas.text(&label, (left - 28.0, top + BAR / 2.0), size, Align::Right, INK);
    }

    fn upright_bar(&self, canvas: &mut Canvas, (low, high): (f64, f64), quantity: &str, unit: &str) {
        let axes = &self.axes;
        let ticks = Ticks::between(low, high, (axes.bottom - axes.top) / 90.0);
        let left = axes.right + 50.0;
        let steps = 512;
        for i in 0..steps {
            let edge = |i: usize| axes.bottom - (axes.bottom - axes.top) * i as f64 / steps as f64;
            canvas.fill((left, edge(i + 1)), (left + BAR, edge(i)), colour::map(i as f64 / (steps - 1) as f64));
        }
        canvas.frame((left, axes.top), (left + BAR, axes.bottom), 1.7, INK);
        for &value in &ticks.values {
            let at = axes.bottom - (axes.bottom - axes.top) * (value - low) / (high - low);
            canvas.fill((left + BAR, at - 0.85), (left + BAR + 9.0, at + 0.85), INK);
            canvas.text(&ticks.text(value), (left + BAR + 17.0, at), NUMBER, Align::Left, INK);
        }
        let label = ticks.label(quantity, unit);
        let size = fitting(&label, LABEL, axes.bottom - axes.top + 80.0);
        canvas.upward(&label, (left + BAR + 125.0, f64::midpoint(axes.top, axes.bottom)), size, INK);
    }
}
