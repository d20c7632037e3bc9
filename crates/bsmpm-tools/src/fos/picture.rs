//! Pictures of a search: displacement against the factor, with the band and the branches that meet in the kink; and the
//! mechanism, as the first failed trial shows it.

use std::fs;
use std::path::Path;

use super::curve::{BENT, DOUBLED, FALLEN};
use super::report::{Report, Verdict};
use super::subject::Subject;
use crate::Error;
use crate::picture::axes::{Axes, BELOW, LEFT, Label, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, INK, OUTLINE, Rgb};
use crate::picture::legend::{self, Entry, Mark};
use crate::picture::ticks::{padded, range};
use crate::plot::{self, Arguments, FieldName};
use crate::record::Record;

const SHEET: (f64, f64) = (1600.0, 1000.0);
const ABOVE: f64 = 115.0;
const RIGHT: f64 = 60.0;
const LINE: f64 = 3.0;
/// What lies behind everything.
const SHADE: Rgb = [253, 226, 190];
/// Of the fields that show the mechanism.
const MECHANISM: [(FieldName, &str); 2] =
    [(FieldName::PlasticStrain, "plastic-strain"), (FieldName::Displacement, "displacement")];

/// Draws `fos.png` and, where a trial has failed, the mechanism; returns their names in the output directory.
pub(super) fn draw(report: &Report, subject: &Subject, output: &Path) -> Result<Vec<String>, Error> {
    let name = "fos.png".to_owned();
    chart(report, &label(report, subject, output)?).save(&output.join(&name))?;
    let mut names = vec![name];
    let failed = report.factor_of_safety.first_failed.and_then(|factor| report.at(factor));
    if let Some(row) = failed {
        names.extend(mechanism(&output.join(&row.trial.directory), subject.end, output)?);
    }
    Ok(names)
}

/// The bodies of a trial at its end, copied beside the other results.
fn mechanism(directory: &Path, end: f64, output: &Path) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    for (field, word) in MECHANISM {
        let arguments =
            Arguments { times: vec![end], field: Some(field), ..Arguments::of(directory.to_owned()) };
        let drawn = plot::run(&arguments)?;
        let is_body = |path: &&std::path::PathBuf| {
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&format!("{word}_")))
        };
        if let Some(from) = drawn.iter().find(is_body) {
            let name = format!("fos_{word}.png");
            fs::copy(from, output.join(&name))
                .map_err(|source| Error::File(bsmpm_io::Error::file("copy", from)(source)))?;
            names.push(name);
        }
    }
    Ok(names)
}

/// What the vertical axis shows: the case's own quantity if it has a scale, else parts of the elastic displacement.
fn label(report: &Report, subject: &Subject, output: &Path) -> Result<Option<String>, Error> {
    let Some(row) = report.trials.first().filter(|_| subject.is_scaled) else { return Ok(None) };
    let record = Record::read(&output.join(&row.trial.directory))?;
    Ok(record.column(&subject.column).map(|column| column.label()))
}

fn chart(report: &Report, label: &Option<String>) -> Canvas {
    // Far beyond failure the displacements would leave no room for those before it.
    let scale = if label.is_some() { 1.0 } else { 1.0 / report.elastic_displacement };
    let unit = report.elastic_displacement * scale;
    let band = report.factor_of_safety;
    let beyond = [band.first_failed, report.kink.map(|kink| kink.after.reaches(FALLEN * report.elastic_displacement))];
    let farthest = beyond.into_iter().flatten().fold(0.0, f64::max);
    let is_shown = |row: &&super::report::Row| {
        row.verdict != Verdict::Elastic
            && (row.growth <= FALLEN * 1.05 || farthest == 0.0)
            && (row.verdict == Verdict::Stable || row.trial.factor <= farthest)
    };
    let shown: Vec<_> = report.trials.iter().filter(is_shown).collect();
    let place = |row: &super::report::Row| (row.trial.factor, row.trial.displacement * scale);
    let groups = [
        ("stable", Verdict::Stable, colour::line(0, 3)),
        ("failed", Verdict::Failed, colour::line(1, 3)),
        ("no equilibrium: the last one that was found", Verdict::NoEquilibrium, INK),
    ];
    let points: Vec<(Entry, Vec<(f64, f64)>)> = groups
        .into_iter()
        .map(|(name, verdict, colour)| {
            let places = shown.iter().filter(|row| row.verdict == verdict).map(|row| place(row)).collect();
            (Entry { name: name.to_owned(), colour, mark: Mark::Points }, places)
        })
        .filter(|(_, places): &(Entry, Vec<_>)| !places.is_empty())
        .collect();
    let line = Entry { name: "branches".to_owned(), colour: OUTLINE, mark: Mark::Line };
    let mut entries: Vec<&Entry> = points.iter().map(|(entry, _)| entry).collect();
    if report.kink.is_some() {
        entries.push(&line);
    }

    let x = range(shown.iter().map(|row| row.trial.factor).chain([farthest].into_iter().filter(|at| *at > 0.0)));
    let x = x.map_or((0.0, 1.0), |(low, high)| padded(low, high, 0.03));
    let highest = shown.iter().map(|row| place(row).1).fold(1.1 * DOUBLED * unit, f64::max);
    let top = ABOVE + legend::height(&entries, SHEET.0 - 80.0) + 20.0;
    let axes = Axes { left: LEFT, top, right: SHEET.0 - RIGHT, bottom: SHEET.1 - BELOW, x, y: (0.0, 1.06 * highest) };
    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    let below = format!("Factor of safety {}; {}", band.words(), report.conditions.lines()[0]);
    title(&mut canvas, SHEET.0, &report.title, &below);
    legend::draw(&mut canvas, &entries, 40.0, ABOVE, SHEET.0 - 80.0);
    if let (Some(low), Some(high)) = (band.last_stable, band.first_failed) {
        canvas.fill((axes.place((low, 0.0)).0, axes.top), (axes.place((high, 0.0)).0, axes.bottom), SHADE);
    }
    axes.rules(&mut canvas);
    axes.line(&mut canvas, &[(x.0, DOUBLED * unit), (x.1, DOUBLED * unit)], 1.5, OUTLINE);
    if let Some(kink) = &report.kink {
        let meet = (kink.factor, kink.before.at(kink.factor) * scale);
        let begin = (x.0, kink.before.at(x.0) * scale);
        let end_at = kink.after.reaches((highest / scale).max(BENT * report.elastic_displacement));
        axes.line(&mut canvas, &[begin, meet, (end_at, kink.after.at(end_at) * scale)], LINE, OUTLINE);
    }
    for (entry, places) in &points {
        let places: Vec<_> = places.iter().map(|&place| axes.place(place)).collect();
        entry.mark.draw(&mut canvas, &places, LINE, entry.colour);
    }
    let y: Label = (label.as_deref().unwrap_or("Displacement / elastic displacement"), "-");
    axes.draw(&mut canvas, Some(("Strength reduction factor", "-")), y);
    canvas
}
