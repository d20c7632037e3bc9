//! Draws diagrams of laboratory tests.

use std::path::{Path, PathBuf};

use super::course::{PathRow, StressPath};
use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour;
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{Scale, padded, range};

const SHEET: (f64, f64) = (1600.0, 1500.0);
const ABOVE: f64 = 75.0;
const RIGHT: f64 = 40.0;
const LINE: f64 = 3.0;

/// A number of a row.
type Of = fn(&PathRow) -> f64;

/// A quantity along an axis: its name, its unit, and what it is of a row.
type AxisQuantity = (&'static str, &'static str, Of);

const COMPRESSION: AxisQuantity = ("Compression along y", "-", |row| -row.strain[1]);
const SHEAR: AxisQuantity = ("Shear", "-", |row| row.strain[3]);
const DEVIATOR: AxisQuantity = ("q", "Pa", |row| row.deviator);
const PRESSURE: AxisQuantity = ("p", "Pa", |row| row.pressure);
const VOLUME: AxisQuantity = ("Volume strain", "-", PathRow::volume_strain);
const PORE: AxisQuantity = ("Pore pressure", "Pa", |row| row.pore_pressure);

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
    let (half, high) = (SHEET.0 / 2.0, (SHEET.1 - top) / 2.0);
    let undrained = courses.iter().all(|course| course.is_undrained);
    let fourth = if undrained { (along, PORE) } else { (PRESSURE, VOLUME) };
    let panels = [(along, DEVIATOR), (PRESSURE, DEVIATOR), (along, VOLUME), fourth];
    for (number, (x, y)) in panels.into_iter().enumerate() {
        let (column, row) = (number % 2, number / 2);
        let logarithmic = number == 3 && !undrained && decade(courses);
        let places = |course: &StressPath| -> Vec<(f64, f64)> {
            let places = course.rows.iter().map(|row| ((x.2)(row), (y.2)(row)));
            places
                .map(|(x, y)| if logarithmic && x <= 0.0 { (f64::NAN, y) } else { (x, y) })
                .collect()
        };
        let all: Vec<(f64, f64)> = courses.iter().flat_map(|course| places(course)).collect();
        let of = |numbers: &mut dyn Iterator<Item = f64>| range(numbers).unwrap_or((0.0, 1.0));
        let (from, to) = of(&mut all.iter().map(|place| place.0));
        let axes = ChartAxes {
            left: half * column as f64 + LEFT,
            top: top + high * row as f64 + 10.0,
            right: half * (column as f64 + 1.0) - RIGHT,
            bottom: top + high * (row as f64 + 1.0) - BELOW,
            x: if logarithmic {
                (from / 1.2, to * 1.2)
            } else {
                padded(from, to, 0.03)
            },
            y: spread(of(&mut all.iter().map(|place| place.1))),
            scales: [
                if logarithmic { Scale::Logarithmic } else { Scale::Linear },
                Scale::Linear,
            ],
        };
        axes.rules(&mut canvas);
        for (course, entry) in courses.iter().zip(&entries) {
            axes.line(&mut canvas, &places(course), LINE, entry.colour);
        }
        axes.draw(&mut canvas, Some((x.0, x.1)), (y.0, y.1));
    }
    canvas
}

/// A range with room; numbers that are zero but for rounding have no scale of their own.
fn spread((low, high): (f64, f64)) -> (f64, f64) {
    if high.abs().max(low.abs()) < 1e-12 {
        (-1e-3, 1e-3)
    } else {
        padded(low, high, 0.06)
    }
}

/// Whether pressures are positive and span so much that their logarithm is the better scale.
fn decade(courses: &[&StressPath]) -> bool {
    let pressures = courses
        .iter()
        .flat_map(|course| course.rows.iter().map(|row| row.pressure));
    range(pressures).is_some_and(|(low, high)| low > 0.0 && high > 10.0 * low)
}
