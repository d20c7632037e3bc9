//! Draws error against cost, with the Pareto front.

use std::path::Path;

use super::report::{SweepReport, SweepRow};
use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, NUMBER, title};
use crate::picture::canvas::{Canvas, TextAlign, fitting};
use crate::picture::colour::{self, INK, OUTLINE};
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{Scale, range};

const SHEET: (f64, f64) = (1900.0, 1000.0);
const ABOVE: f64 = 115.0;
/// Room for the names of the front at the right.
const NAMES: f64 = 640.0;
const LINE: f64 = 3.0;
/// Between two names.
const GAP: f64 = 1.9 * NUMBER;
/// The least error that is drawn: what is smaller is rounding.
const SMALLEST: f64 = 1e-12;

/// Draws the errors of one quantity; nothing where no run has one.
pub(super) fn draw(report: &SweepReport, quantity: usize, path: &Path) -> Result<bool, Error> {
    let place = |row: &SweepRow| {
        row.place(&[quantity])
            .filter(|(cost, error)| *cost > 0.0 && *error > SMALLEST)
    };
    let front: Vec<(&SweepRow, (f64, f64))> = sorted(report, |row| place(row).filter(|_| row.on_front[quantity]));
    let others: Vec<(&SweepRow, (f64, f64))> = sorted(report, |row| {
        place(row).filter(|_| !row.on_front[quantity] && !row.is_reference)
    });
    let all = || front.iter().chain(&others).map(|(_, place)| *place);
    let (Some(x), Some(y)) = (
        range(all().map(|place| place.0)),
        range(all().map(|place| 100.0 * place.1)),
    ) else {
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
    let own: Vec<(f64, f64)> = sorted(report, |row| {
        place(row).filter(|_| row.is_baseline && !row.is_reference)
    })
    .into_iter()
    .map(|(_, place)| place)
    .collect();
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
        y: decades((y.0.min(100.0 * report.within), y.1.max(100.0 * report.within))),
        scales: [Scale::Logarithmic; 2],
    };
    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    let below = format!("{}: error against {}", report.quantities[quantity], against(report));
    title(&mut canvas, SHEET.0, &report.title, &below);
    legend::draw(&mut canvas, &entries, 40.0, ABOVE, room);
    axes.rules(&mut canvas);
    let level = axes.level(&mut canvas, 100.0 * report.within);
    let good = format!("{} %", 100.0 * report.within);
    canvas.text(
        &good,
        (axes.left + 12.0, level - 20.0),
        NUMBER,
        TextAlign::Left,
        OUTLINE,
    );
    let on_sheet = |(cost, error): (f64, f64)| axes.place((cost, 100.0 * error));
    let marked = |canvas: &mut Canvas, entry: &LegendEntry, places: Vec<(f64, f64)>| {
        let places: Vec<_> = places.into_iter().map(on_sheet).collect();
        entry.mark.draw(canvas, &places, LINE, entry.colour);
    };
    marked(
        &mut canvas,
        &elsewhere,
        others.iter().map(|(_, place)| *place).collect(),
    );
    marked(&mut canvas, &on_front, front.iter().map(|(_, place)| *place).collect());
    marked(&mut canvas, &baseline, own);
    names(&mut canvas, &axes, &front, &on_sheet);
    axes.draw(&mut canvas, Some(("Cost", "CPU s")), ("Error", "%"));
    canvas.save(path)?;
    Ok(true)
}

/// Runs that have a place, the cheapest first.
fn sorted(report: &SweepReport, place: impl Fn(&SweepRow) -> Option<(f64, f64)>) -> Vec<(&SweepRow, (f64, f64))> {
    let mut found: Vec<_> = report.runs.iter().filter_map(|row| Some((row, place(row)?))).collect();
    found.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    found
}

fn against(report: &SweepReport) -> &str {
    report.reference.what.split(':').next().unwrap_or_default()
}

/// Numbers at the points of the front, lower left where nothing else can be, and what they mean beside the axes.
fn names(
    canvas: &mut Canvas,
    axes: &ChartAxes,
    front: &[(&SweepRow, (f64, f64))],
    on_sheet: &dyn Fn((f64, f64)) -> (f64, f64),
) {
    let (left, wide) = (axes.right + 24.0, NAMES - 44.0);
    let gap = GAP.min((axes.bottom - axes.top) / front.len().max(1) as f64);
    for (index, (row, place)) in front.iter().enumerate() {
        let number = (index + 1).to_string();
        let (x, y) = on_sheet(*place);
        canvas.text(&number, (x - 14.0, y + 22.0), NUMBER, TextAlign::Right, INK);
        let text = format!("{number}  {}", row.name);
        let cost = format!("     {:.3} %, {} CPU s", 100.0 * place.1, crate::record::short(place.0));
        let top = axes.top + gap * (index as f64 + 0.3);
        let size = (0.42 * gap).min(NUMBER * 0.85);
        canvas.text(&text, (left, top), fitting(&text, size, wide), TextAlign::Left, INK);
        canvas.text(
            &cost,
            (left, top + 0.42 * gap),
            fitting(&cost, size, wide),
            TextAlign::Left,
            OUTLINE,
        );
    }
}

/// A range with room at its ends, and with two powers of ten in it at least, so that the axis has a scale.
fn decades((low, high): (f64, f64)) -> (f64, f64) {
    let (mut low, mut high) = (low / 1.6, high * 1.6);
    let powers = |low: f64, high: f64| (high.log10() + 1e-9).floor() - (low.log10() - 1e-9).ceil();
    while powers(low, high) < 1.0 {
        // Towards the nearer power.
        let (down, up) = (low.log10() - low.log10().floor(), high.log10().ceil() - high.log10());
        if (down > 1e-9 && down <= up) || up <= 1e-9 {
            low = 10_f64.powf(low.log10().floor() - if down <= 1e-9 { 1.0 } else { 0.0 });
        } else {
            high = 10_f64.powf(high.log10().ceil());
        }
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::decades;

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
            let (from, to) = decades((low, high));
            assert!(from < low && high < to, "{low} {high}: {from} {to}");
            let powers = (-9..9)
                .filter(|power| (from..=to).contains(&10_f64.powi(*power)))
                .count();
            assert!(powers >= 2, "{low} {high}: {from} {to}");
        }
        assert!((decades((0.02, 40.0)).1 - 64.0).abs() < 1e-9);
    }
}
