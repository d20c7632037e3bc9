//! Which line means what: a row, or several, of names above the axes, where they can hide nothing.

use super::axes::NUMBER;
use super::canvas::{Align, Canvas, width};
use super::colour::{INK, Rgb};

/// One line or sort of points and its name.
pub(super) struct Entry {
    pub name: String,
    pub colour: Rgb,
    /// Drawn as points, not as a line.
    pub points: bool,
}

const SAMPLE: f64 = 46.0;
const GAP: f64 = 40.0;
/// The height of a row.
pub(super) const ROW: f64 = 42.0;

/// The entries in rows no wider than `room`.
fn rows<'a>(entries: &[&'a Entry], room: f64) -> Vec<Vec<(&'a Entry, f64)>> {
    let mut rows: Vec<Vec<(&'a Entry, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    for &entry in entries {
        let size = SAMPLE + 10.0 + width(&entry.name, NUMBER);
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
pub(super) fn height(entries: &[&Entry], room: f64) -> f64 {
    rows(entries, room).len() as f64 * ROW
}

/// Draws the legend, centred between `left` and `left + room`, its first row just below `top`.
pub(super) fn draw(canvas: &mut Canvas, entries: &[&Entry], left: f64, top: f64, room: f64) {
    for (index, row) in rows(entries, room).iter().enumerate() {
        let whole: f64 = row.iter().map(|(_, size)| size).sum::<f64>() + GAP * (row.len() - 1) as f64;
        let y = top + ROW * (index as f64 + 0.5);
        let mut x = left + (room - whole) / 2.0;
        for (entry, size) in row {
            if entry.points {
                canvas.disc((x + SAMPLE / 2.0, y), 6.0, entry.colour);
            } else {
                canvas.line([(x, y), (x + SAMPLE, y)], 4.0, entry.colour);
            }
            canvas.text(&entry.name, (x + SAMPLE + 10.0, y), NUMBER, Align::Left, INK);
            x += size + GAP;
        }
    }
}
