//! Draws axes with ticks and labels.

use super::canvas::{Canvas, TextAlign, fitting, width};
use super::colour::{INK, OUTLINE, RULE, Rgb};
use super::ticks::{Scale, Ticks, ValueRange};

/// Sizes of letters in pixels, for a picture 1600 wide.
pub(crate) const TITLE: f64 = 34.0;
pub(crate) const LABEL: f64 = 30.0;
pub(crate) const NUMBER: f64 = 26.0;
/// Room for the numbers and label left of, and below, the axes.
pub(crate) const LEFT: f64 = 170.0;
pub(crate) const BELOW: f64 = 105.0;
pub(crate) const TICK: f64 = 9.0;
pub(crate) const THIN: f64 = 1.7;
/// A dash and the gap after it.
const DASH: (f64, f64) = (16.0, 10.0);

/// Radius of the disc of a place alone, over the width of its line.
const DOT: f64 = 2.5;

/// A quantity and its unit.
#[derive(Clone, Copy)]
pub(crate) struct Label<'a> {
    pub quantity: &'a str,
    pub unit: &'a str,
}

impl<'a> Label<'a> {
    /// The label of a quantity in a unit, which is `-` if it has none.
    pub const fn of(quantity: &'a str, unit: &'a str) -> Self {
        Self { quantity, unit }
    }
}

/// A box of the sheet and the region of the plane that it shows.
#[derive(Clone, Copy)]
pub(crate) struct ChartAxes {
    /// Left, top, right and bottom edge in pixels.
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
    pub x: ValueRange,
    pub y: ValueRange,
    /// Of x and y.
    pub scales: [Scale; 2],
}

/// Both axes linear.
pub(crate) const LINEAR: [Scale; 2] = [Scale::Linear; 2];

impl ChartAxes {
    /// Where a place of the region lies on the sheet.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.across(x), self.upward(y)]
    }

    /// Where a number of the horizontal axis lies on the sheet.
    pub fn across(&self, x: f64) -> f64 {
        self.left + self.scales[0].share(x, self.x) * (self.right - self.left)
    }

    /// Where a number of the vertical axis lies on the sheet.
    pub fn upward(&self, y: f64) -> f64 {
        self.bottom - self.scales[1].share(y, self.y) * (self.bottom - self.top)
    }

    fn x_ticks(&self) -> Ticks {
        self.scales[0].ticks(self.x, (self.right - self.left) / 150.0)
    }

    fn y_ticks(&self) -> Ticks {
        self.scales[1].ticks(self.y, (self.bottom - self.top) / 70.0)
    }

    /// Faint lines across the box at each tick, to be drawn first.
    pub fn rules(&self, canvas: &mut Canvas) {
        for x in self.x_ticks().values {
            let x = self.across(x);
            canvas.fill([x - THIN / 2.0, self.top], [x + THIN / 2.0, self.bottom], RULE);
        }
        for y in self.y_ticks().values {
            let y = self.upward(y);
            canvas.fill([self.left, y - THIN / 2.0], [self.right, y + THIN / 2.0], RULE);
        }
    }

    /// The box, ticks outside of it, their numbers and the labels.
    ///
    /// Without a label for `x` its ticks have no numbers: for axes above others that share it.
    pub fn draw(&self, canvas: &mut Canvas, x: Option<Label>, y: Label) {
        canvas.frame([self.left, self.top], [self.right, self.bottom], THIN, INK);
        self.draw_x(canvas, x);
        let ticks = self.y_ticks();
        let mut widest: f64 = 0.0;
        for &value in &ticks.values {
            let at = self.upward(value);
            let text = ticks.text(value);
            widest = widest.max(width(&text, NUMBER));
            canvas.fill([self.left - TICK, at - THIN / 2.0], [self.left, at + THIN / 2.0], INK);
            canvas.text(&text, [self.left - TICK - 8.0, at], NUMBER, TextAlign::Right, INK);
        }
        let label = ticks.label(y.quantity, y.unit);
        let size = fitting(&label, LABEL, self.bottom - self.top + 90.0);
        let at = [
            self.left - TICK - 8.0 - widest - 36.0,
            f64::midpoint(self.top, self.bottom),
        ];
        canvas.upward(&label, at, size, INK);
    }

    /// The ticks below the box, with their numbers and label if there is a label.
    fn draw_x(&self, canvas: &mut Canvas, label: Option<Label>) {
        let ticks = self.x_ticks();
        for &value in &ticks.values {
            let at = self.across(value);
            canvas.fill(
                [at - THIN / 2.0, self.bottom],
                [at + THIN / 2.0, self.bottom + TICK],
                INK,
            );
            if label.is_some() {
                canvas.text(
                    &ticks.text(value),
                    [at, self.bottom + TICK + 22.0],
                    NUMBER,
                    TextAlign::Centre,
                    INK,
                );
            }
        }
        if let Some(label) = label {
            let centre = f64::midpoint(self.left, self.right);
            canvas.text(
                &ticks.label(label.quantity, label.unit),
                [centre, self.bottom + 72.0],
                LABEL,
                TextAlign::Centre,
                INK,
            );
        }
    }

    /// A dashed line across the box; returns its height on the sheet.
    pub fn level(&self, canvas: &mut Canvas, value: f64) -> f64 {
        let at = self.upward(value);
        let mut x = self.left;
        while x < self.right {
            canvas.fill([x, at - 1.3], [(x + DASH.0).min(self.right), at + 1.3], OUTLINE);
            x += DASH.0 + DASH.1;
        }
        at
    }

    /// A line through places of the region; a place that is not finite breaks it, and a place alone is a disc.
    pub fn line(&self, canvas: &mut Canvas, places: &[[f64; 2]], width: f64, colour: Rgb) {
        for run in places.split(|[x, y]| !(x.is_finite() && y.is_finite())) {
            match run {
                &[alone] => canvas.disc(self.place(alone), DOT * width, colour),
                _ => canvas.line(run.iter().map(|&place| self.place(place)), width, colour),
            }
        }
    }
}

/// A label in one piece: the quantity, and its unit if it has one.
pub(crate) fn label(quantity: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "-" {
        quantity.to_owned()
    } else {
        format!("{quantity} ({unit})")
    }
}

/// The title of a picture: what was solved and, smaller, what is seen.
pub(crate) fn title(canvas: &mut Canvas, sheet: f64, text: &str, below: &str) {
    let size = fitting(text, TITLE, sheet - 60.0);
    canvas.text(text, [sheet / 2.0, 42.0], size, TextAlign::Centre, INK);
    let size = fitting(below, LABEL, sheet - 60.0);
    canvas.text(below, [sheet / 2.0, 88.0], size, TextAlign::Centre, INK);
}
