//! Draws displacement against factor, and the failure mechanism.

use std::fs;
use std::path::Path;

use super::curve::DOUBLED;
use super::report::{FosReport, FosRow, Verdict};
use super::subject::Subject;
use crate::Error;
use crate::line::FALLEN;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, LINEAR, Label, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, INK, OUTLINE, Rgb};
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{ValueRange, range};
use crate::plot::{self, FieldName, PlotArguments};
use crate::record::RunRecord;

const SHEET: (f64, f64) = (1600.0, 1000.0);
const ABOVE: f64 = 115.0;
const RIGHT: f64 = 60.0;
const LINE: f64 = 3.0;
/// The vertical axis where the case has no scale.
const RELATIVE: &str = "Displacement / elastic displacement";
/// What lies behind everything.
const SHADE: Rgb = [253, 226, 190];
/// All pictures: the chart, and those of the fields that show the mechanism.
pub(super) const NAMES: [&str; 3] = ["fos.png", "fos_plastic-strain.png", "fos_displacement.png"];
const MECHANISM: [(FieldName, &str, &str); 2] = [
    (FieldName::PlasticStrain, "plastic-strain_", NAMES[1]),
    (FieldName::Displacement, "displacement_", NAMES[2]),
];

/// Draws `fos.png` and, where a trial has failed, the mechanism; returns their names in the output directory.
pub(super) fn draw(report: &FosReport, subject: &Subject, output: &Path) -> Result<Vec<&'static str>, Error> {
    let mut names = vec![NAMES[0]];
    FactorChart::of(report, label(report, subject, output)?)
        .draw()
        .save(&output.join(NAMES[0]))?;
    let failed = report.finding.first_failed.and_then(|factor| report.at(factor));
    if let Some(row) = failed {
        names.extend(mechanism(&output.join(&row.trial.directory), subject.end, output)?);
    }
    Ok(names)
}

/// The bodies of a trial at its end, copied beside the other results.
fn mechanism(directory: &Path, end: f64, output: &Path) -> Result<Vec<&'static str>, Error> {
    let mut names = Vec::new();
    for (field, beginning, name) in MECHANISM {
        let arguments = PlotArguments {
            times: vec![end],
            field: Some(field),
            ..PlotArguments::of(directory.to_owned())
        };
        let drawn = plot::run(&arguments)?;
        let body = drawn.iter().find(|path| {
            path.file_name()
                .is_some_and(|name| name.to_string_lossy().starts_with(beginning))
        });
        if let Some(from) = body {
            fs::copy(from, output.join(name)).map_err(bsmpm_io::Error::file("copy", from))?;
            names.push(name);
        }
    }
    Ok(names)
}

/// What the vertical axis shows: the case's own quantity if it has a scale, else parts of the elastic displacement.
fn label(report: &FosReport, subject: &Subject, output: &Path) -> Result<Option<String>, Error> {
    let Some(row) = report.trials.first().filter(|_| subject.scale != 1.0) else {
        return Ok(None);
    };
    let record = RunRecord::read(&output.join(&row.trial.directory))?;
    Ok(record.column(&subject.column).map(|column| column.label()))
}

/// The chart before it has axes.
struct FactorChart<'a> {
    report: &'a FosReport,
    /// by which displacements are multiplied
    scale: f64,
    /// of the vertical axis
    label: String,
    /// the trials that are seen, in groups
    groups: Vec<(LegendEntry, Vec<[f64; 2]>)>,
    /// the greatest factor that must be seen
    farthest: f64,
}

impl<'a> FactorChart<'a> {
    fn of(report: &'a FosReport, label: Option<String>) -> Self {
        let scale = if label.is_some() {
            1.0
        } else {
            1.0 / report.elastic_displacement
        };
        let ends = [
            report.finding.first_failed,
            report.kink.map(|kink| kink.after.reaches(fallen(report))),
        ];
        let farthest = ends.into_iter().flatten().fold(0.0, f64::max);
        let mut groups = Vec::new();
        for (name, verdict, colour) in [
            ("stable", Verdict::Stable, colour::line(0, 3)),
            ("failed", Verdict::Failed, colour::line(1, 3)),
            (
                "no equilibrium: the last one that was found",
                Verdict::NoEquilibrium,
                INK,
            ),
        ] {
            let rows = report.trials.iter().filter(|row| row.verdict == verdict);
            let places: Vec<[f64; 2]> = rows
                .filter(|row| is_seen(row, farthest))
                .map(|row| [row.trial.factor, scale * row.growth * report.elastic_displacement])
                .collect();
            let entry = LegendEntry {
                name: name.to_owned(),
                colour,
                mark: Mark::Points,
            };
            if !places.is_empty() {
                groups.push((entry, places));
            }
        }
        Self {
            report,
            scale,
            label: label.unwrap_or_else(|| RELATIVE.to_owned()),
            groups,
            farthest,
        }
    }

    fn draw(&self) -> Canvas {
        let level = LegendEntry {
            name: "twice the elastic".to_owned(),
            colour: colour::line(2, 3),
            mark: Mark::Line,
        };
        let branches = LegendEntry {
            name: "branches".to_owned(),
            colour: OUTLINE,
            mark: Mark::Line,
        };
        let lines = [Some(&level), self.report.kink.as_ref().map(|_| &branches)];
        let entries: Vec<&LegendEntry> = self
            .groups
            .iter()
            .map(|(entry, _)| entry)
            .chain(lines.into_iter().flatten())
            .collect();
        let axes = self.axes(ABOVE + legend::height(&entries, SHEET.0 - 80.0) + 20.0);
        let mut canvas = Canvas::new(SHEET.0, SHEET.1);
        let FosReport {
            finding: band,
            conditions,
            ..
        } = self.report;
        let below = format!(
            "{} {}; {}",
            self.report.plan.sought.title(),
            band.words(),
            conditions.lines()[0]
        );
        title(&mut canvas, SHEET.0, &self.report.title, &below);
        legend::draw(&mut canvas, &entries, 40.0, ABOVE, SHEET.0 - 80.0);
        if let (Some(low), Some(high)) = (band.last_stable, band.first_failed) {
            canvas.fill([axes.across(low), axes.top], [axes.across(high), axes.bottom], SHADE);
        }
        axes.rules(&mut canvas);
        let doubled = DOUBLED * self.elastic();
        axes.line(
            &mut canvas,
            &[[axes.x.low, doubled], [axes.x.high, doubled]],
            LINE / 2.0,
            level.colour,
        );
        self.draw_branches(&mut canvas, &axes);
        for (entry, places) in &self.groups {
            let places: Vec<_> = places.iter().map(|&place| axes.place(place)).collect();
            entry.mark.draw(&mut canvas, &places, LINE, entry.colour);
        }
        axes.draw(
            &mut canvas,
            Some(Label::of(self.report.plan.sought.label(), "-")),
            Label::of(&self.label, "-"),
        );
        canvas
    }

    /// The elastic displacement as it is seen.
    fn elastic(&self) -> f64 {
        self.scale * self.report.elastic_displacement
    }

    fn axes(&self, top: f64) -> ChartAxes {
        let places = self.groups.iter().flat_map(|(_, places)| places);
        let farthest = Some(self.farthest).filter(|factor| *factor > 0.0);
        let x = range(places.clone().map(|place| place[0]).chain(farthest)).unwrap_or(ValueRange::UNIT);
        let high = places.map(|place| place[1]).fold(DOUBLED * self.elastic(), f64::max);
        ChartAxes {
            left: LEFT,
            top,
            right: SHEET.0 - RIGHT,
            bottom: SHEET.1 - BELOW,
            x: x.padded(0.03),
            y: ValueRange::of(0.0, 1.06 * high),
            scales: LINEAR,
        }
    }

    /// Both branches, from the left to where they meet, and up to the end of what is seen.
    fn draw_branches(&self, canvas: &mut Canvas, axes: &ChartAxes) {
        let Some(kink) = &self.report.kink else { return };
        let end = kink.after.reaches(fallen(self.report).min(axes.y.high / self.scale));
        let before = [axes.x.low, kink.factor].map(|factor| [factor, self.scale * kink.before.at(factor)]);
        let after = [end, self.scale * kink.after.at(end)];
        axes.line(canvas, &[before[0], before[1], after], LINE, OUTLINE);
    }
}

/// Whether a trial is seen; far beyond failure the displacements would leave no room for those before it.
fn is_seen(row: &FosRow, farthest: f64) -> bool {
    farthest == 0.0 || (row.growth <= 1.05 * FALLEN && (row.verdict == Verdict::Stable || row.trial.factor <= farthest))
}

/// The displacement at the end of the branch after failure.
fn fallen(report: &FosReport) -> f64 {
    FALLEN * report.elastic_displacement
}
