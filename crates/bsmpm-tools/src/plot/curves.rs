//! Pictures of the histories: quantities against time, or against each other.

use bsmpm_io::table::Columns;

use super::axes::{Axes, BELOW, LEFT, title};
use super::canvas::Canvas;
use super::colour::{self, INK};
use super::legend::{self, Entry};
use super::record::Record;
use super::ticks::{padded, range};
use crate::Error;

/// A picture that is drawn if the history has the columns for it.
struct Picture {
    file: &'static str,
    title: &'static str,
    /// The column along the horizontal axis.
    across: &'static str,
    /// The columns along the vertical axis; each also as `name-...`, as a case may call a second one.
    up: &'static [&'static str],
}

const PICTURES: [Picture; 3] = [
    Picture { file: "runout.png", title: "Run-out", across: "time", up: &["runout", "front", "height"] },
    Picture { file: "stress-noise.png", title: "Noise of the stress", across: "time", up: &["stress-noise"] },
    Picture {
        file: "footing-pressure.png",
        title: "Pressure on the footing",
        across: "penetration",
        up: &["footing-pressure"],
    },
];

const SHEET: (f64, f64) = (1600.0, 1000.0);
const ABOVE: f64 = 115.0;
const RIGHT: f64 = 60.0;

/// One line of a picture, or the points of a reference.
struct Curve {
    entry: Entry,
    unit: String,
    places: Vec<(f64, f64)>,
}

/// Draws every picture for which the history has columns; returns their names.
pub(super) fn draw(record: &Record, reference: Option<&Columns>) -> Result<Vec<String>, Error> {
    let Some(history) = &record.history else { return Ok(Vec::new()) };
    let mut names = Vec::new();
    for picture in &PICTURES {
        let mut curves = picture.curves(history);
        if curves.is_empty() {
            continue;
        }
        if let Some(reference) = reference {
            picture.add_reference(&mut curves, reference);
        }
        picture.draw(record, history, &curves)?;
        names.push(picture.file.to_owned());
    }
    Ok(names)
}

impl Picture {
    fn curves(&self, history: &Columns) -> Vec<Curve> {
        let Some(across) = history.get(self.across) else { return Vec::new() };
        let is_wanted = |name: &str| {
            let begins =
                |wanted: &&str| name.strip_prefix(*wanted).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'));
            self.up.iter().any(begins)
        };
        let columns = || history.headings.iter().zip(&history.values).filter(|(heading, _)| is_wanted(&heading.name));
        let count = columns().count();
        let curve = |(index, (heading, values)): (usize, (&bsmpm_io::table::Column, &Vec<f64>))| Curve {
            entry: Entry { name: heading.name.clone(), colour: colour::line(index, count), points: false },
            unit: heading.unit.clone(),
            places: across.iter().copied().zip(values.iter().copied()).collect(),
        };
        columns().enumerate().map(curve).filter(|curve| !curve.places.is_empty()).collect()
    }

    /// Adds the points of a reference whose columns bear the names of curves.
    fn add_reference(&self, curves: &mut Vec<Curve>, reference: &Columns) {
        let Some(across) = reference.get(self.across) else { return };
        let mut points = Vec::new();
        for curve in curves.iter() {
            let Some(values) = reference.get(&curve.entry.name) else { continue };
            points.push(Curve {
                entry: Entry { name: format!("reference, {}", curve.entry.name), colour: INK, points: true },
                unit: curve.unit.clone(),
                places: across.iter().copied().zip(values.iter().copied()).collect(),
            });
        }
        curves.extend(points);
    }

    fn draw(&self, record: &Record, history: &Columns, curves: &[Curve]) -> Result<(), Error> {
        let mut entries: Vec<&Entry> = curves.iter().map(|curve| &curve.entry).collect();
        if entries.len() == 1 {
            // The axis says what a lonely line is.
            entries.clear();
        }
        let top = ABOVE + legend::height(&entries, SHEET.0 - 80.0) + 20.0;
        let places = || curves.iter().flat_map(|curve| &curve.places);
        let x = range(places().map(|place| place.0)).unwrap_or((0.0, 1.0));
        // Lengths and pressures are read from zero, which is drawn in unless it is far from all values.
        let y = range(places().map(|place| place.1).chain([0.0])).unwrap_or((0.0, 1.0));
        let y = padded(y.0, y.1, 0.06);
        let y = if y.1 > 0.0 && places().all(|place| place.1 >= 0.0) { (0.0, y.1) } else { y };
        let x = if x.1 > x.0 { x } else { padded(x.0, x.1, 0.0) };
        let axes = Axes { left: LEFT, top, right: SHEET.0 - RIGHT, bottom: SHEET.1 - BELOW, x, y };
        let mut canvas = Canvas::new(SHEET.0, SHEET.1);
        title(&mut canvas, SHEET.0, &record.manifest.case.title, self.title);
        legend::draw(&mut canvas, &entries, 40.0, ABOVE, SHEET.0 - 80.0);
        axes.rules(&mut canvas);
        for curve in curves {
            if curve.entry.points {
                curve.places.iter().for_each(|&place| canvas.disc(axes.place(place), 7.0, curve.entry.colour));
            } else {
                axes.line(&mut canvas, &curve.places, 3.5, curve.entry.colour);
            }
        }
        let heading = capitalised(self.across);
        let across = match self.across {
            "time" => record.time_label(),
            name => (heading.as_str(), history.unit(name).unwrap_or("-")),
        };
        axes.draw(&mut canvas, Some(across), (&vertical(curves), &curves[0].unit));
        canvas.save(&record.directory.join(self.file))
    }
}

/// The label of the vertical axis: the quantity if it is one, else what lengths share.
fn vertical(curves: &[Curve]) -> String {
    let lines = curves.iter().filter(|curve| !curve.entry.points).count();
    let name = if lines == 1 { curves[0].entry.name.as_str() } else { "length" };
    capitalised(name)
}

/// A column's name as a heading: `stress-noise` becomes `Stress noise`.
fn capitalised(name: &str) -> String {
    let name = name.replace('-', " ");
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
