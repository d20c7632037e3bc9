//! Draws the legend above the axes.

use super::axes::NUMBER;
use super::canvas::{Canvas, TextAlign, fitting, width};
use super::colour::{INK, Rgb, WHITE};

/// How places are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// As a line through them.
    Line,
    /// As a disc at each.
    Points,
    /// As a line with a disc at each.
    Both,
}

/// One line or sort of points and its name.
pub(crate) struct LegendEntry {
    pub name: String,
    pub colour: Rgb,
    pub mark: Mark,
}

const SAMPLE: f64 = 46.0;
const SPACE: f64 = 10.0;
const GAP: f64 = 40.0;
/// The height of a row.
const ROW: f64 = 42.0;
/// The radius of a disc.
const DISC: f64 = 7.0;

impl Mark {
    /// Draws places of the sheet in this way.
    pub fn draw(self, canvas: &mut Canvas, places: &[[f64; 2]], line: f64, colour: Rgb) {
        if self != Self::Points {
            canvas.line(places.iter().copied(), line, colour);
        }
        if self != Self::Line {
            places.iter().for_each(|&place| canvas.disc(place, DISC + 2.0, WHITE));
            places.iter().for_each(|&place| canvas.disc(place, DISC, colour));
        }
    }
}

/// The size of the letters of an entry and its whole width.
fn sizes(entry: &LegendEntry, room: f64) -> (f64, f64) {
    let letters = fitting(&entry.name, NUMBER, room - SAMPLE - SPACE);
    (letters, SAMPLE + SPACE + width(&entry.name, letters))
}

/// The entries in rows no wider than `room`, with their widths.
fn rows<'a>(entries: &[&'a LegendEntry], room: f64) -> Vec<Vec<(&'a LegendEntry, f64)>> {
    let mut rows: Vec<Vec<(&'a LegendEntry, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    for &entry in entries {
        let (_, size) = sizes(entry, room);
        if used + GAP + size > room {
            rows.push(Vec::new());
            used = -GAP;
        }
        used += GAP + size;
        if let Some(row) = rows.last_mut() {
            row.push((entry, size));
        }
    }
    rows
}

/// The height that the legend takes.
pub(crate) fn height(entries: &[&LegendEntry], room: f64) -> f64 {
    rows(entries, room).len() as f64 * ROW
}

/// Draws the legend, centred between `left` and `left + room`, its first row just below `top`.
pub(crate) fn draw(canvas: &mut Canvas, entries: &[&LegendEntry], left: f64, top: f64, room: f64) {
    for (index, row) in rows(entries, room).iter().enumerate() {
        let whole: f64 = row.iter().map(|(_, size)| size).sum::<f64>() + GAP * (row.len() - 1) as f64;
        let y = top + ROW * (index as f64 + 0.5);
        let mut x = left + (room - whole) / 2.0;
        for (entry, size) in row {
            let middle = [[x + SAMPLE / 2.0, y]];
            match entry.mark {
                Mark::Points => Mark::Points.draw(canvas, &middle, 0.0, entry.colour),
                mark => {
                    canvas.line([[x, y], [x + SAMPLE, y]], 4.0, entry.colour);
                    mark.draw(canvas, &middle, 0.0, entry.colour);
                }
            }
            canvas.text(
                &entry.name,
                [x + SAMPLE + SPACE, y],
                sizes(entry, room).0,
                TextAlign::Left,
                INK,
            );
            x += size + GAP;
        }
    }
}
