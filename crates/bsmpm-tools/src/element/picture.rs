//! Draws diagrams of laboratory tests.

use std::path::{Path, PathBuf};

use super::course::{PathRow, StressPath};
use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, Label, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour;
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{Scale, ValueRange, range};

const SHEET: (f64, f64) = (1600.0, 1500.0);
const ABOVE: f64 = 75.0;
const RIGHT: f64 = 40.0;
const LINE: f64 = 3.0;

/// A quantity along an axis, and its number of a row.
#[derive(Clone, Copy)]
struct AxisQuantity {
    label: Label<'static>,
    of: fn(&PathRow) -> f64,
}

impl AxisQuantity {
    const fn new(name: &'static str, unit: &'static str, of: fn(&PathRow) -> f64) -> Self {
        let label = Label::of(name, unit);
        Self { label, of }
    }
}

const COMPRESSION: AxisQuantity = AxisQuantity::new("Compression along y", "-", |row| -row.strain[1]);
const SHEAR: AxisQuantity = AxisQuantity::new("Shear", "-", |row| row.strain[3]);
const DEVIATOR: AxisQuantity = AxisQuantity::new("q", "Pa", |row| row.deviator);
const PRESSURE: AxisQuantity = AxisQuantity::new("p", "Pa", |row| row.pressure);
const VOLUME: AxisQuantity = AxisQuantity::new("Volume strain", "-", PathRow::volume_strain);
const PORE: AxisQuantity = AxisQuantity::new("Pore pressure", "Pa", |row| row.pore_pressure);

/// Draws the tests along y, and those in shear, in a picture each.
pub(super) fn draw(case: &str, courses: &[StressPath], output: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for (name, is_sheared, along) in [("compression.png", false, COMPRESSION), ("shear.png", true, SHEAR)] {
        let drawn: Vec<&StressPath> = courses
            .iter()
            .filter(|course| course.is_sheared == is_sheared)
            .collect();
        if !drawn.is_empty() {
            let file = output.join(name);
            sheet(case, &drawn, along).save(&file)?;
            files.push(file);
        }
    }
    Ok(files)
}

fn sheet(case: &str, courses: &[&StressPath], along: AxisQuantity) -> Canvas {
    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    let entries: Vec<LegendEntry> = (courses.iter().enumerate())
        .map(|(k, course)| LegendEntry {
            name: format!("{} ({})", course.name, course.material),
            colour: colour::line(k, courses.len()),
            mark: Mark::Line,
        })
        .collect();
    let legend: Vec<&LegendEntry> = entries.iter().collect();
    title(&mut canvas, SHEET.0, case, "");
    legend::draw(&mut canvas, &legend, 40.0, ABOVE, SHEET.0 - 80.0);
    let top = ABOVE + legend::height(&legend, SHEET.0 - 80.0) + 20.0;
    let half = SHEET.0 / 2.0;
    let high = (SHEET.1 - top) / 2.0;
    let undrained = courses.iter().all(|course| course.is_undrained);
    let fourth = if undrained { (along, PORE) } else { (PRESSURE, VOLUME) };
    let panels = [(along, DEVIATOR), (PRESSURE, DEVIATOR), (along, VOLUME), fourth];
    for (number, (x, y)) in panels.into_iter().enumerate() {
        let column = number % 2;
        let row = number / 2;
        let logarithmic = number == 3 && !undrained && decade(courses);
        let mut curves: Vec<Vec<[f64; 2]>> = Vec::new();
        for course in courses {
            let places = course.rows.iter().map(|row| [(x.of)(row), (y.of)(row)]);
            let shown = places.map(|[x, y]| [if logarithmic && x <= 0.0 { f64::NAN } else { x }, y]);
            curves.push(shown.collect());
        }
        let [across, up] = [0, 1].map(|axis| {
            let numbers = curves.iter().flatten().map(|place| place[axis]);
            range(numbers).unwrap_or(ValueRange::UNIT)
        });
        let axes = ChartAxes {
            left: half * column as f64 + LEFT,
            top: top + high * row as f64 + 10.0,
            right: half * (column as f64 + 1.0) - RIGHT,
            bottom: top + high * (row as f64 + 1.0) - BELOW,
            x: if logarithmic {
                ValueRange::of(across.low / 1.2, across.high * 1.2)
            } else {
                across.padded(0.03)
            },
            y: spread(up),
            scales: [
                if logarithmic { Scale::Logarithmic } else { Scale::Linear },
                Scale::Linear,
            ],
        };
        axes.rules(&mut canvas);
        for (places, entry) in curves.iter().zip(&entries) {
            axes.line(&mut canvas, places, LINE, entry.colour);
        }
        axes.draw(&mut canvas, Some(x.label), y.label);
    }
    canvas
}

/// A range with room; numbers that are zero but for rounding have no scale of their own.
fn spread(range: ValueRange) -> ValueRange {
    if range.high.abs().max(range.low.abs()) < 1e-12 {
        ValueRange::of(-1e-3, 1e-3)
    } else {
        range.padded(0.06)
    }
}

/// Whether pressures are positive and span so much that their logarithm is the better scale.
fn decade(courses: &[&StressPath]) -> bool {
    let pressures = courses
        .iter()
        .flat_map(|course| course.rows.iter().map(|row| row.pressure));
    range(pressures).is_some_and(|range| range.low > 0.0 && range.high > 10.0 * range.low)
}
