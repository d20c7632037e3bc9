//! Draws the colour bar.

use super::axes::{self, ChartAxes, LABEL, Label, NUMBER, THIN, TICK};
use super::canvas::{Canvas, TextAlign, fitting, width};
use super::colour::{self, INK};
use super::ticks::{Ticks, ValueRange};

/// Room for an upright bar right of the axes, with its numbers and label.
pub(crate) const BESIDE: f64 = 240.0;
/// Room for a lying bar below the axes' own labels.
pub(crate) const BELOW: f64 = 120.0;
/// Below this height of the axes over their width a bar lies: an upright one has no room for its numbers and label.
pub(crate) const LYING: f64 = 0.5;
const THICK: f64 = 30.0;
/// Length of a pointed end.
const POINT: f64 = 26.0;
const SHADES: usize = 512;

/// The ends of a bar beyond which there are values; such an end is pointed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PointedEnds {
    pub lower: bool,
    pub upper: bool,
}

/// A range of numbers that colours stand for.
pub(crate) struct Bar<'a> {
    pub range: ValueRange,
    pub label: Label<'a>,
    pub pointed: PointedEnds,
}

impl Bar<'_> {
    /// Draws the bar lying below the axes, its label on the left.
    pub fn lying(&self, canvas: &mut Canvas, axes: &ChartAxes) {
        let ticks = Ticks::between(self.range.low, self.range.high, 8.0);
        let label = ticks.label(self.label.quantity, self.label.unit);
        let size = fitting(&label, LABEL, 0.5 * (axes.right - axes.left));
        let left = axes.left + width(&label, size) + 28.0 + POINT * f64::from(self.pointed.lower);
        let right = axes.right - POINT * f64::from(self.pointed.upper);
        let top = axes.bottom + axes::BELOW + 20.0;
        let bottom = top + THICK;
        for (from, to, shade) in shades(left, right) {
            canvas.fill([from, top], [to, bottom], shade);
        }
        canvas.frame([left, top], [right, bottom], THIN, INK);
        let middle = f64::midpoint(top, bottom);
        if self.pointed.lower {
            point(canvas, [[left, top], [left, bottom]], [left - POINT, middle], 0.0);
        }
        if self.pointed.upper {
            point(canvas, [[right, top], [right, bottom]], [right + POINT, middle], 1.0);
        }
        for &value in &ticks.values {
            let at = left + (right - left) * self.share(value);
            canvas.fill([at - THIN / 2.0, bottom], [at + THIN / 2.0, bottom + TICK], INK);
            canvas.text(
                &ticks.text(value),
                [at, bottom + TICK + 22.0],
                NUMBER,
                TextAlign::Centre,
                INK,
            );
        }
        canvas.text(
            &label,
            [axes.left, f64::midpoint(top, bottom)],
            size,
            TextAlign::Left,
            INK,
        );
    }

    /// Draws the bar standing right of the axes, its label reading upward.
    pub fn upright(&self, canvas: &mut Canvas, axes: &ChartAxes) {
        let top = axes.top + POINT * f64::from(self.pointed.upper);
        let bottom = axes.bottom - POINT * f64::from(self.pointed.lower);
        let ticks = Ticks::between(self.range.low, self.range.high, (bottom - top) / 90.0);
        let left = axes.right + 50.0;
        let right = left + THICK;
        for (from, to, shade) in shades(bottom, top) {
            canvas.fill([left, to], [right, from], shade);
        }
        canvas.frame([left, top], [right, bottom], THIN, INK);
        let middle = f64::midpoint(left, right);
        if self.pointed.lower {
            point(canvas, [[left, bottom], [right, bottom]], [middle, bottom + POINT], 0.0);
        }
        if self.pointed.upper {
            point(canvas, [[left, top], [right, top]], [middle, top - POINT], 1.0);
        }
        let mut widest: f64 = 0.0;
        for &value in &ticks.values {
            let at = bottom - (bottom - top) * self.share(value);
            let text = ticks.text(value);
            widest = widest.max(width(&text, NUMBER));
            canvas.fill([right, at - THIN / 2.0], [right + TICK, at + THIN / 2.0], INK);
            canvas.text(&text, [right + TICK + 8.0, at], NUMBER, TextAlign::Left, INK);
        }
        let label = ticks.label(self.label.quantity, self.label.unit);
        let size = fitting(&label, LABEL, bottom - top + 80.0);
        let at = [right + TICK + 8.0 + widest + 36.0, f64::midpoint(top, bottom)];
        canvas.upward(&label, at, size, INK);
    }

    /// Where a number lies in the range: 0 at its lower, 1 at its upper end.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.range.low) / self.range.length()
    }
}

/// Draws a pointed end from the edge of a bar to its tip, in the colour of this share of the range.
fn point(canvas: &mut Canvas, [first, second]: [[f64; 2]; 2], tip: [f64; 2], share: f64) {
    canvas.triangle([first, tip, second], colour::map(share));
    canvas.line([first, tip, second], THIN, INK);
}

/// The colours in strips along the way between two edges.
fn shades(from: f64, to: f64) -> impl Iterator<Item = (f64, f64, colour::Rgb)> {
    (0..SHADES).map(move |i| {
        let [from, to] = [i, i + 1].map(|edge| from + (to - from) * edge as f64 / SHADES as f64);
        (from, to, colour::map(i as f64 / (SHADES - 1) as f64))
    })
}
