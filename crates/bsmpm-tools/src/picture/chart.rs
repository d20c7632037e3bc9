//! Draws curves and points over axes.

use super::axes::{BELOW, ChartAxes, LEFT, LINEAR, Label, NUMBER, title};
use super::canvas::{Canvas, TextAlign, fitting, width};
use super::colour::INK;
use super::legend::{self, LegendEntry};
use super::ticks::{ValueRange, range};

const SHEET: (f64, f64) = (1600.0, 1000.0);
/// Room above the legend: without a title, with one, and with a line below it.
const ABOVE: [f64; 3] = [25.0, 75.0, 115.0];
const RIGHT: f64 = 60.0;
const LINE: f64 = 3.5;
/// The most room for the texts of levels, right of the axes.
const WIDEST: f64 = 420.0;

/// Places, and how they are drawn and named.
pub(crate) struct ChartCurve {
    pub entry: LegendEntry,
    pub places: Vec<[f64; 2]>,
}

/// A number on the vertical axis with a meaning of its own; the text may be empty.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartLevel {
    /// Where, in the unit of the picture.
    pub value: f64,
    /// Its meaning.
    pub text: String,
}

/// Everything that is seen.
pub(crate) struct Chart<'a> {
    pub title: &'a str,
    /// What stands smaller below the title; may be empty.
    pub below: &'a str,
    pub x: Label<'a>,
    pub y: Label<'a>,
    pub curves: &'a [ChartCurve],
    pub levels: &'a [ChartLevel],
    pub legend: Vec<&'a LegendEntry>,
}

impl Chart<'_> {
    /// The drawn picture.
    pub fn draw(&self) -> Canvas {
        let lines = if self.below.is_empty() {
            usize::from(!self.title.is_empty())
        } else {
            2
        };
        let above = ABOVE[lines];
        let room = SHEET.0 - 80.0;
        let texts = self
            .levels
            .iter()
            .map(|level| width(&level.text, NUMBER))
            .fold(0.0, f64::max)
            .min(WIDEST);
        let right = if texts > 0.0 { texts + 40.0 } else { RIGHT };
        let [x, y] = self.ranges();
        let top = above + legend::height(&self.legend, room) + 20.0;
        let axes = ChartAxes {
            left: LEFT,
            top,
            right: SHEET.0 - right,
            bottom: SHEET.1 - BELOW,
            x,
            y,
            scales: LINEAR,
        };
        let mut canvas = Canvas::new(SHEET.0, SHEET.1);
        title(&mut canvas, SHEET.0, self.title, self.below);
        legend::draw(&mut canvas, &self.legend, 40.0, above, room);
        axes.rules(&mut canvas);
        self.draw_levels(&mut canvas, &axes);
        for ChartCurve { entry, places } in self.curves {
            for run in places.split(|[x, y]| !(x.is_finite() && y.is_finite())) {
                let places: Vec<_> = run.iter().map(|&place| axes.place(place)).collect();
                entry.mark.draw(&mut canvas, &places, LINE, entry.colour);
            }
        }
        axes.draw(&mut canvas, Some(self.x), self.y);
        canvas
    }

    /// What the axes show: all places and levels, and zero upward, from which lengths and pressures are read.
    fn ranges(&self) -> [ValueRange; 2] {
        let places = self.curves.iter().flat_map(|curve| &curve.places);
        let (across, mut upward): (Vec<f64>, Vec<f64>) = places.map(|&[x, y]| (x, y)).unzip();
        upward.extend(self.levels.iter().map(|level| level.value));
        let x = range(across).unwrap_or(ValueRange::UNIT);
        // What is zero all the time is none of a billionth's parts.
        let y = range(upward.iter().copied().chain([0.0]))
            .filter(|y| y.high > y.low)
            .unwrap_or(ValueRange::UNIT);
        let mut y = y.padded(0.06);
        if y.high > 0.0 && upward.iter().all(|value| *value >= 0.0) {
            y.low = 0.0;
        }
        // Discs at the ends are whole.
        let discs = self.curves.iter().any(|curve| curve.entry.mark != legend::Mark::Line);
        let x = if x.high > x.low && !discs { x } else { x.padded(0.03) };
        [x, y]
    }

    /// Dashed lines with their texts right of the axes, moved apart where they are too close.
    fn draw_levels(&self, canvas: &mut Canvas, axes: &ChartAxes) {
        let mut texts: Vec<(f64, &str)> = Vec::new();
        for level in self.levels {
            texts.push((axes.level(canvas, level.value), &level.text));
        }
        texts.retain(|(_, text)| !text.is_empty());
        texts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let places: Vec<f64> = texts.iter().map(|text| text.0).collect();
        for (at, (_, text)) in apart(&places, 1.3 * NUMBER).into_iter().zip(texts) {
            canvas.text(
                text,
                [axes.right + 14.0, at],
                fitting(text, NUMBER, WIDEST),
                TextAlign::Left,
                INK,
            );
        }
    }
}

/// Neighbours that are too close: the sum of their places and their number.
struct PlaceGroup {
    sum: f64,
    count: usize,
}

impl PlaceGroup {
    /// Where the one at `index` goes, when they are centred about their mean with `gap` between them.
    fn place(&self, index: usize, gap: f64) -> f64 {
        self.sum / self.count as f64 - gap * (self.count - 1) as f64 / 2.0 + gap * index as f64
    }
}

/// Sorted places moved as little as it takes for each to be `gap` from the next: those that are too close are centred
/// about their mean.
fn apart(places: &[f64], gap: f64) -> Vec<f64> {
    let mut groups: Vec<PlaceGroup> = Vec::new();
    for &place in places {
        let mut group = PlaceGroup { sum: place, count: 1 };
        while let Some(above) = groups.pop_if(|above| above.place(above.count, gap) > group.place(0, gap)) {
            group.sum += above.sum;
            group.count += above.count;
        }
        groups.push(group);
    }
    groups
        .iter()
        .flat_map(|group| (0..group.count).map(|index| group.place(index, gap)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn texts_that_are_too_close_move_apart() {
        assert_eq!(apart(&[0.0, 100.0], 30.0), [0.0, 100.0]);
        assert_eq!(apart(&[50.0, 50.0], 30.0), [35.0, 65.0]);
        assert_eq!(apart(&[0.0, 50.0, 52.0, 70.0], 30.0), [-2.0, 28.0, 58.0, 88.0]);
        assert!(apart(&[], 30.0).is_empty());
    }
}
