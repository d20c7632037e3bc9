//! Fills a body from its points: a dot of the sheet takes the colour of the nearest point, if one is near enough. So a
//! body of few points or of many, stretched or not, looks filled, and no point hides its neighbours.

use std::collections::HashSet;

use bsmpm_io::frame::Frame;

use super::axes::Axes;
use super::canvas::{Canvas, FINE};
use super::colour::Rgb;

/// How far a point's colour reaches, in its own size: more than half the diagonal of a square, to close a body that sheared.
const REACH: f64 = 0.85;

/// The side of each point's share of the body, in m: from its volume in a plane of 1 m thickness, else the mean one.
pub(super) fn sizes(frame: &Frame, geometry: &str) -> Vec<f64> {
    match frame.real("volume", 1) {
        Some(volumes) if geometry == "plane-strain" => volumes.iter().map(|volume| volume.abs().sqrt()).collect(),
        _ => vec![spacing(&frame.position); frame.position.len()],
    }
}

/// The side of the square that each of the points would have of the area which they cover: that of all the squares of a
/// coarse net in which there are any.
fn spacing(points: &[[f64; 3]]) -> f64 {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    let count = points.len() as f64;
    let first = ((high[0] - low[0]) * (high[1] - low[1]) / count).sqrt();
    if !(first > 0.0) {
        return (high[0] - low[0]).max(high[1] - low[1]).max(0.0) / count.max(1.0);
    }
    let net = 4.0 * first;
    let square = |point: &[f64; 3]| [0, 1].map(|axis| ((point[axis] - low[axis]) / net) as u32);
    let covered: HashSet<_> = points.iter().map(square).collect();
    net * (covered.len() as f64 / count).sqrt()
}

/// The dots of the box of some axes, with the nearest point of each.
struct Nearest {
    left: i32,
    top: i32,
    width: usize,
    /// The squared distance in dots, and the point.
    dots: Vec<(f32, u32)>,
}

const NOBODY: u32 = u32::MAX;

/// Draws the points inside the box of `axes`, each in its colour.
pub(super) fn draw(canvas: &mut Canvas, axes: &Axes, points: &[[f64; 3]], sizes: &[f64], colours: &[Rgb]) {
    let mut nearest = Nearest::of(axes);
    let dots_per_metre = FINE as f64 * (axes.right - axes.left) / (axes.x.1 - axes.x.0);
    for (index, (point, size)) in points.iter().zip(sizes).enumerate() {
        let (x, y) = axes.place((point[0], point[1]));
        nearest.add(index as u32, FINE as f64 * x, FINE as f64 * y, (REACH * size * dots_per_metre).max(1.0));
    }
    for (at, &(_, point)) in nearest.dots.iter().enumerate() {
        if point != NOBODY {
            let place = (nearest.left + (at % nearest.width) as i32, nearest.top + (at / nearest.width) as i32);
            canvas.dot(place, colours[point as usize]);
        }
    }
}

impl Nearest {
    fn of(axes: &Axes) -> Self {
        let fine = |pixels: f64| (FINE as f64 * pixels).round();
        let (width, height) = (fine(axes.right - axes.left) as usize, fine(axes.bottom - axes.top) as usize);
        let dots = vec![(f32::INFINITY, NOBODY); width.max(1) * height];
        Self { left: fine(axes.left) as i32, top: fine(axes.top) as i32, width: width.max(1), dots }
    }

    /// A point at `(x, y)` whose colour reaches `reach`, all in dots of the sheet.
    fn add(&mut self, point: u32, x: f64, y: f64, reach: f64) {
        let (x, y) = (x - f64::from(self.left), y - f64::from(self.top));
        let height = self.dots.len() / self.width;
        let span = |centre: f64, end: usize| {
            let first = (centre - reach).ceil().max(0.0) as usize;
            first..((centre + reach).floor() + 1.0).clamp(0.0, end as f64) as usize
        };
        for row in span(y, height) {
            for column in span(x, self.width) {
                let distance = ((column as f64 - x).powi(2) + (row as f64 - y).powi(2)) as f32;
                let dot = &mut self.dots[row * self.width + column];
                if distance <= (reach * reach) as f32 && distance < dot.0 {
                    *dot = (distance, point);
                }
            }
        }
    }
}
