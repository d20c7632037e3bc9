//! Draws error against cost, with the Pareto front.

use std::path::Path;

use super::front::CostError;
use super::report::{SweepReport, SweepRow};
use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, Label, NUMBER, title};
use crate::picture::canvas::{Canvas, TextAlign, fitting};
use crate::picture::colour::{self, INK, OUTLINE};
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{Scale, ValueRange, range};
use crate::record::short;

const SHEET: (f64, f64) = (1900.0, 1000.0);
const ABOVE: f64 = 115.0;
/// Room for the names of the front at the right.
const NAMES: f64 = 640.0;
const LINE: f64 = 3.0;
/// Between two names.
const GAP: f64 = 1.9 * NUMBER;
/// The least error that is drawn: what is smaller is rounding.
const SMALLEST: f64 = 1e-12;

/// A run that the picture shows.
#[derive(Clone, Copy)]
struct DrawnRun<'a> {
    row: &'a SweepRow,
    place: CostError,
}

/// Draws the errors of one quantity; nothing where no run has one.
pub(super) fn draw(report: &SweepReport, quantity: usize, path: &Path) -> Result<bool, Error> {
    let runs = sorted(report, quantity);
    let mut front = runs.clone();
    front.retain(|run| run.row.on_front[quantity]);
    let mut others = runs.clone();
    others.retain(|run| !run.row.on_front[quantity] && !run.row.is_reference);
    let mut own = runs;
    own.retain(|run| run.row.is_baseline && !run.row.is_reference);
    let all = front.iter().chain(&others);
    let costs = range(all.clone().map(|run| run.place.cost));
    let errors = range(all.map(|run| 100.0 * run.place.error));
    let Some((x, y)) = costs.zip(errors) else {
        return Ok(false);
    };
    let [on_front, elsewhere, baseline] = [
        ("front: none is cheaper and better", colour::line(0, 3), Mark::Both),
        ("other settings", OUTLINE, Mark::Points),
        ("baseline", colour::line(1, 3), Mark::Points),
    ]
    .map(|(name, colour, mark)| LegendEntry {
        name: name.to_owned(),
        colour,
        mark,
    });
    let mut entries = vec![&on_front];
    entries.extend((!others.is_empty()).then_some(&elsewhere));
    entries.extend((!own.is_empty()).then_some(&baseline));
    let room = SHEET.0 - 80.0;
    let axes = ChartAxes {
        left: LEFT,
        top: ABOVE + legend::height(&entries, room) + 20.0,
        right: SHEET.0 - NAMES,
        bottom: SHEET.1 - BELOW,
        x: decades(x),
        y: decades(ValueRange {
            low: y.low.min(100.0 * report.within),
            high: y.high.max(100.0 * report.within),
        }),
        scales: [Scale::Logarithmic; 2],
    };
    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    let below = format!("Error of {} against {}", report.subjects[quantity], against(report));
    title(&mut canvas, SHEET.0, &report.title, &below);
    legend::draw(&mut canvas, &entries, 40.0, ABOVE, room);
    axes.rules(&mut canvas);
    let level = axes.level(&mut canvas, 100.0 * report.within);
    let good = format!("{} %", 100.0 * report.within);
    canvas.text(
        &good,
        [axes.left + 12.0, level - 20.0],
        NUMBER,
        TextAlign::Left,
        OUTLINE,
    );
    for (entry, runs) in [(&elsewhere, &others), (&on_front, &front), (&baseline, &own)] {
        let places: Vec<_> = runs.iter().map(|run| on_sheet(&axes, run.place)).collect();
        entry.mark.draw(&mut canvas, &places, LINE, entry.colour);
    }
    names(&mut canvas, &axes, &front);
    axes.draw(&mut canvas, Some(Label::of("Cost", "CPU s")), Label::of("Error", "%"));
    canvas.save(path)?;
    Ok(true)
}

/// Runs that have a place on logarithmic axes, the cheapest first.
fn sorted(report: &SweepReport, quantity: usize) -> Vec<DrawnRun<'_>> {
    let mut found: Vec<DrawnRun> = Vec::new();
    for row in &report.runs {
        let place = row.place(&[quantity]);
        let shown = place.filter(|place| place.cost > 0.0 && place.error > SMALLEST);
        found.extend(shown.map(|place| DrawnRun { row, place }));
    }
    found.sort_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    found
}

/// Where a run lies on the sheet.
fn on_sheet(axes: &ChartAxes, place: CostError) -> [f64; 2] {
    axes.place([place.cost, 100.0 * place.error])
}

fn against(report: &SweepReport) -> &str {
    report.reference.what.split(':').next().unwrap_or_default()
}

/// Numbers at the points of the front, lower left where nothing else can be, and what they mean beside the axes.
fn names(canvas: &mut Canvas, axes: &ChartAxes, front: &[DrawnRun]) {
    let left = axes.right + 24.0;
    let wide = NAMES - 44.0;
    let gap = GAP.min((axes.bottom - axes.top) / front.len().max(1) as f64);
    for (index, &DrawnRun { row, place }) in front.iter().enumerate() {
        let number = (index + 1).to_string();
        let [x, y] = on_sheet(axes, place);
        canvas.text(&number, [x - 14.0, y + 22.0], NUMBER, TextAlign::Right, INK);
        let text = format!("{number}  {}", row.name);
        let cost = format!("     {:.3} %, {} CPU s", 100.0 * place.error, short(place.cost));
        let top = axes.top + gap * (index as f64 + 0.3);
        let size = (0.42 * gap).min(NUMBER * 0.85);
        canvas.text(&text, [left, top], fitting(&text, size, wide), TextAlign::Left, INK);
        canvas.text(
            &cost,
            [left, top + 0.42 * gap],
            fitting(&cost, size, wide),
            TextAlign::Left,
            OUTLINE,
        );
    }
}

/// A range with room at its ends, and with two powers of ten in it at least, so that the axis has a scale.
fn decades(range: ValueRange) -> ValueRange {
    let mut low = range.low / 1.6;
    let mut high = range.high * 1.6;
    while (high.log10() + 1e-9).floor() - (low.log10() - 1e-9).ceil() < 1.0 {
        // Towards the nearer power.
        let down = low.log10() - low.log10().floor();
        let up = high.log10().ceil() - high.log10();
        if (down > 1e-9 && down <= up) || up <= 1e-9 {
            low = 10_f64.powf(low.log10().floor() - if down <= 1e-9 { 1.0 } else { 0.0 });
        } else {
            high = 10_f64.powf(high.log10().ceil());
        }
    }
    ValueRange { low, high }
}

#[cfg(test)]
mod tests {
    use super::{ValueRange, decades};

    #[test]
    fn an_axis_shows_two_powers_of_ten() {
        for (low, high) in [
            (1.0, 1.0),
            (2.0, 3.0),
            (0.02, 40.0),
            (7.0, 12.0),
            (1e-6, 1e-6),
            (95.0, 99.0),
        ] {
            let ValueRange { low: from, high: to } = decades(ValueRange { low, high });
            assert!(from < low && high < to, "{low} {high}: {from} {to}");
            let powers = (-9..9)
                .filter(|power| (from..=to).contains(&10_f64.powi(*power)))
                .count();
            assert!(powers >= 2, "{low} {high}: {from} {to}");
        }
        assert!((decades(ValueRange::of(0.02, 40.0)).high - 64.0).abs() < 1e-9);
    }
}
