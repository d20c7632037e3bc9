//! Draws histories against time, and footing pressure against penetration.

use bsmpm_io::table::Columns;

use crate::Error;
use crate::picture::axes::Label;
use crate::picture::chart::{Chart, ChartCurve};
use crate::picture::colour::{self, INK};
use crate::picture::legend::{LegendEntry, Mark};
use crate::picture::ticks::range;
use crate::record::{Recorded, RunRecord};

/// A picture that is drawn if the history has columns for it; those of another unit or scale get one of their
/// own, the scaled ones last.
struct Picture {
    /// The file's name without its ending.
    file: &'static str,
    title: &'static str,
    across: Across,
    /// The quantities along the vertical axis that it is about.
    up: &'static [&'static str],
    /// Those that are drawn with them.
    beside: &'static [&'static str],
    /// The endings of the columns that it is about, those that are zero throughout left out; empty: all columns.
    parts: &'static [&'static str],
    /// What they are together.
    together: &'static str,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Across {
    Time,
    Penetration,
}
use Across::{Penetration, Time};

const PICTURES: [Picture; 11] = [
    Picture {
        beside: &["height"],
        together: "Length",
        ..Picture::of("runout", "Run-out", Time, &["runout", "front"])
    },
    Picture::of("height", "Height", Time, &["height"]),
    Picture {
        together: "Displacement",
        ..Picture::of(
            "displacement",
            "Displacements",
            Time,
            &["max-displacement", "heave", "penetration", "displacement"],
        )
    },
    Picture::of("stress-noise", "Noise of the stress", Time, &["stress-noise"]),
    Picture::of("pressure-noise", "Noise of the pressure", Time, &["pressure-noise"]),
    Picture::of(
        "footing-pressure",
        "Pressure on the footing",
        Penetration,
        &["footing-pressure"],
    ),
    Picture::of(
        "footing-pressure-time",
        "Pressure on the footing",
        Time,
        &["footing-pressure"],
    ),
    Picture::of("footing-force", "Force on the footing", Time, &["footing-force"]),
    Picture::of("slip", "Slip at the footing", Time, &["slip"]),
    Picture {
        parts: &["-kinetic", "-elastic", "-plastic", "-external", "-numerical"],
        ..Picture::of("energy", "Energy", Time, &["energy"])
    },
    Picture {
        parts: &[
            "-numerical",
            "-transfer",
            "-integration",
            "-smoothing",
            "-background",
            "-penalty",
            "-closure",
        ],
        together: "Energy",
        ..Picture::of("energy-numerical", "Loss of the algorithm", Time, &["energy"])
    },
];

/// The horizontal axis of a picture.
struct Axis<'a> {
    /// The name of the column.
    column: &'a str,
    values: &'a [f64],
    /// What the column's numbers are multiplied by.
    factor: f64,
    label: String,
    unit: &'a str,
    /// What the reader of the title should know of it.
    note: String,
}

/// Draws every picture for which the history has columns, none of them twice over one axis; returns their names.
pub(super) fn draw(record: &RunRecord, reference: Option<&Columns>) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    let mut drawn: Vec<(&str, &str)> = Vec::new();
    for picture in &PICTURES {
        let Some(axis) = picture.across.axis(record) else {
            continue;
        };
        for (index, columns) in picture.groups(record).iter().enumerate() {
            let name = match index {
                0 => format!("{}.png", picture.file),
                _ => format!("{}-{}.png", picture.file, columns[0].name),
            };
            if columns
                .iter()
                .any(|column| !drawn.contains(&(axis.column, column.name)))
            {
                picture.draw(record, &axis, columns, reference, &name)?;
                drawn.extend(columns.iter().map(|column| (axis.column, column.name)));
                names.push(name);
            }
        }
    }
    Ok(names)
}

impl Across {
    fn axis(self, record: &RunRecord) -> Option<Axis<'_>> {
        if self == Time {
            let Label { quantity, unit } = record.time_label();
            let values = record.history.as_ref()?.get("time")?;
            return Some(Axis {
                column: "time",
                values,
                factor: 1.0,
                label: quantity.to_owned(),
                unit,
                note: String::new(),
            });
        }
        let column = *record.columns("penetration").first()?;
        // A strip that stays where it is has no such curve.
        range(column.values.iter().copied()).filter(|range| range.high > range.low)?;
        let width = record.footing_width().filter(|_| column.unit == "m");
        let (label, unit) = match width {
            Some(_) => ("Penetration z/B".to_owned(), "-"),
            None => (column.label(), column.shown_unit()),
        };
        let note = width.map_or_else(String::new, |width| format!(", B = {width} m"));
        let factor = width.map_or(1.0, |width| 1.0 / width);
        Some(Axis {
            column: column.name,
            values: column.values,
            factor,
            label,
            unit,
            note,
        })
    }
}

impl Picture {
    const fn of(file: &'static str, title: &'static str, across: Across, up: &'static [&'static str]) -> Self {
        Self {
            file,
            title,
            across,
            up,
            beside: &[],
            parts: &[],
            together: title,
        }
    }

    /// The columns that there are, those of one unit and scale together.
    fn groups<'a>(&self, record: &'a RunRecord) -> Vec<Vec<Recorded<'a>>> {
        let mut columns = self.recorded(record, self.up);
        if !columns.is_empty() {
            columns.extend(self.recorded(record, self.beside));
        }
        let mut groups: Vec<Vec<Recorded>> = Vec::new();
        for column in columns {
            let mut known = groups.iter_mut();
            match known.find(|group| (group[0].unit, group[0].scale) == (column.unit, column.scale)) {
                Some(group) => group.push(column),
                None => groups.push(vec![column]),
            }
        }
        groups.sort_by_key(|group| group[0].scale != 1.0);
        groups
    }

    /// The columns of these quantities that have rows and that the picture is about.
    fn recorded<'a>(&self, record: &'a RunRecord, quantities: &[&str]) -> Vec<Recorded<'a>> {
        let columns = quantities.iter().flat_map(|quantity| record.columns(quantity));
        columns
            .filter(|column| !column.values.is_empty() && self.is_about(column))
            .collect()
    }

    fn is_about(&self, column: &Recorded) -> bool {
        let named = self.parts.iter().any(|part| column.name.ends_with(part));
        self.parts.is_empty() || (named && column.values.iter().any(|value| *value != 0.0))
    }

    fn draw(
        &self,
        record: &RunRecord,
        axis: &Axis,
        columns: &[Recorded],
        reference: Option<&Columns>,
        name: &str,
    ) -> Result<(), Error> {
        let mut curves = Vec::new();
        for (index, column) in columns.iter().enumerate() {
            let entry = LegendEntry {
                name: column.name.to_owned(),
                colour: colour::line(index, columns.len()),
                mark: Mark::Line,
            };
            curves.push(ChartCurve {
                entry,
                places: axis.places(axis.values, column.values),
            });
        }
        // The points of a reference whose columns bear the names of ours.
        for column in columns {
            let referred = reference.and_then(|table| Some((table.get(axis.column)?, table.get(column.name)?)));
            if let Some((across, values)) = referred {
                let name = format!("reference, {}", column.name);
                let entry = LegendEntry {
                    name,
                    colour: INK,
                    mark: Mark::Points,
                };
                curves.push(ChartCurve {
                    entry,
                    places: axis.places(across, values),
                });
            }
        }
        let label = if let [only] = columns {
            only.label()
        } else {
            self.together.to_owned()
        };
        // The axis says what a lonely line is.
        let legend = if curves.len() == 1 {
            Vec::new()
        } else {
            curves.iter().map(|curve| &curve.entry).collect()
        };
        let below = format!("{}{}", self.title, axis.note);
        let title = &record.manifest.case.title;
        let chart = Chart {
            title,
            below: &below,
            x: Label::of(&axis.label, axis.unit),
            y: Label::of(&label, columns[0].shown_unit()),
            curves: &curves,
            levels: &[],
            legend,
        };
        chart.draw().save(&record.directory.join(name))
    }
}

impl Axis<'_> {
    fn places(&self, across: &[f64], up: &[f64]) -> Vec<[f64; 2]> {
        across.iter().zip(up).map(|(x, &y)| [x * self.factor, y]).collect()
    }
}
