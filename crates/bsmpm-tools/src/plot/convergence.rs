//! Draws iterations and length of each step.

use bsmpm_io::table::Columns;

use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, LINEAR, Label, title};
use crate::picture::canvas::Canvas;
use crate::picture::colour;
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{ValueRange, range};
use crate::record::RunRecord;

const SHEET: (f64, f64) = (1600.0, 1100.0);
const ABOVE: f64 = 115.0;
const RIGHT: f64 = 60.0;
const BETWEEN: f64 = 40.0;
const NAME: &str = "convergence.png";

/// Draws `convergence.png` if there is a row in `steps.csv`; returns its name.
pub(super) fn draw(record: &RunRecord) -> Result<Option<String>, Error> {
    let column = |name| record.steps.as_ref().and_then(|steps: &Columns| steps.get(name));
    let columns = (column("time"), column("iterations"), column("dt"));
    let (Some(time), Some(iterations), Some(dt)) = columns else {
        return Ok(None);
    };
    let Some(x) = range(time.iter().copied()) else {
        return Ok(None);
    };
    // The first row is the end of a step, whose start is where the picture begins.
    let x = ValueRange::of(x.low - dt.first().copied().unwrap_or(0.0), x.high);
    let x = if x.high > x.low { x } else { x.padded(0.0) };
    let mut cut: Vec<[f64; 2]> = Vec::new();
    for ((&time, &dt), &cutbacks) in time.iter().zip(dt).zip(column("cutbacks").unwrap_or_default()) {
        if cutbacks > 0.0 {
            cut.push([time, dt]);
        }
    }

    let legend = LegendEntry {
        name: "step that was cut back".to_owned(),
        colour: colour::line(1, 2),
        mark: Mark::Points,
    };
    let legend: &[&LegendEntry] = if cut.is_empty() { &[] } else { &[&legend] };
    let top = ABOVE + legend::height(legend, SHEET.0 - 80.0) + 20.0;
    let bottom = SHEET.1 - BELOW;
    let middle = f64::midpoint(top, bottom);
    let upper = ChartAxes {
        left: LEFT,
        top,
        right: SHEET.0 - RIGHT,
        bottom: middle - BETWEEN / 2.0,
        x,
        y: from_zero(iterations),
        scales: LINEAR,
    };
    let lower = ChartAxes {
        top: middle + BETWEEN / 2.0,
        bottom,
        y: from_zero(dt),
        ..upper
    };

    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    title(
        &mut canvas,
        SHEET.0,
        &record.manifest.case.title,
        "Convergence of the steps",
    );
    legend::draw(&mut canvas, legend, 40.0, ABOVE, SHEET.0 - 80.0);
    for (axes, values) in [(&upper, iterations), (&lower, dt)] {
        axes.rules(&mut canvas);
        let places: Vec<_> = time.iter().zip(values).map(|(&time, &value)| [time, value]).collect();
        axes.line(&mut canvas, &places, 2.5, colour::line(0, 2));
    }
    cut.iter()
        .for_each(|&place| canvas.disc(lower.place(place), 6.0, colour::line(1, 2)));
    upper.draw(&mut canvas, None, Label::of("Iterations per step", "-"));
    let time = record.time_label();
    lower.draw(&mut canvas, Some(time), Label::of("Length of step", time.unit));
    canvas.save(&record.directory.join(NAME))?;
    Ok(Some(NAME.to_owned()))
}

/// From zero to the largest number, with room above it.
fn from_zero(values: &[f64]) -> ValueRange {
    let high = range(values.iter().copied()).map_or(1.0, |range| range.high.max(1e-300));
    ValueRange::of(0.0, 1.08 * high)
}
