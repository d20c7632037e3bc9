//! Draws a body: each pixel has the colour of the nearest material point.

use std::collections::HashSet;
use std::ops::Range;

use bsmpm_io::frame::Frame;

use super::axes::ChartAxes;
use super::canvas::{Canvas, FINE, fine};
use super::colour::Rgb;
use super::ticks::ValueRange;

/// How far a point's colour reaches, in its own size: enough to close a body that is stretched to four times its
/// length.
pub(crate) const REACH: f64 = 2.0;
/// How far the body reaches beyond its outer points, in their size.
const SKIN: f64 = 0.5;
/// dots  The most that is looked at beyond the window, which bounds the memory for huge points.
const MARGIN: f64 = 600.0;

/// The side of each point's share of the body, in m: from its volume in a plane of 1 m thickness, of a radian about
/// x = 0 or in space, else the mean one.
pub(crate) fn sizes(frame: &Frame, geometry: &str) -> Vec<f64> {
    match frame.real("volume", 1) {
        Some(volumes) if geometry == "plane-strain" => volumes.iter().map(|volume| volume.abs().sqrt()).collect(),
        Some(volumes) if ["3d", "solid"].contains(&geometry) => {
            volumes.iter().map(|volume| volume.abs().cbrt()).collect()
        }
        Some(volumes) if geometry == "axisymmetric" => {
            let volumes = volumes.iter().zip(&frame.position);
            let areas = volumes.map(|(volume, x)| if x[0] > 0.0 { volume.abs() / x[0] } else { 0.0 });
            areas.map(f64::sqrt).collect()
        }
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
    if !first.is_finite() || first <= 0.0 {
        return (high[0] - low[0]).max(high[1] - low[1]).max(0.0) / count.max(1.0);
    }
    let net = 4.0 * first;
    let covered: HashSet<_> = points
        .iter()
        .map(|point| [0, 1].map(|axis| ((point[axis] - low[axis]) / net) as u32))
        .collect();
    net * (covered.len() as f64 / count).sqrt()
}

/// The dots of a window and a margin about it, with the nearest point of each.
struct NearestPoints {
    left: i32,
    top: i32,
    width: usize,
    /// The squared distance in dots, and the point.
    dots: Vec<(f32, u32)>,
}

const NOBODY: u32 = u32::MAX;

/// The part of the plane where a body is drawn.
pub(crate) struct SplatWindow {
    /// m  the ranges of x and y
    pub ranges: [ValueRange; 2],
    /// Whether the body is held at the lower and upper ends of the ranges: what comes near to such an end goes up to
    /// it.
    pub walls: [[bool; 2]; 2],
    /// How far a point's colour reaches, in its own size: [`REACH`] closes gaps between points of nearly four sizes.
    pub reach: f64,
}

/// Draws the part of a body that lies in `window`, each point in its colour.
pub(crate) fn draw(
    canvas: &mut Canvas,
    axes: &ChartAxes,
    window: &SplatWindow,
    points: &[[f64; 3]],
    sizes: &[f64],
    colours: &[Rgb],
) {
    for (place, point) in covered(axes, window, points, sizes) {
        canvas.dot(place, colours[point]);
    }
}

/// The dots of the sheet that a body covers, each with the point whose colour it takes.
fn covered(axes: &ChartAxes, window: &SplatWindow, points: &[[f64; 3]], sizes: &[f64]) -> Vec<([i32; 2], usize)> {
    let [x, y] = window.ranges;
    let dots_per_metre = FINE as f64 * (axes.right - axes.left) / axes.x.length();
    let dots: Vec<f64> = sizes.iter().map(|size| (size * dots_per_metre).max(1.0)).collect();
    // Where the body is cut its points are small, but not their distances.
    let usual = (median(sizes) * dots_per_metre).max(1.0);
    let reaches: Vec<f64> = dots.iter().map(|size| window.reach * size.max(usual)).collect();
    let largest = reaches.iter().copied().fold(0.0, f64::max);
    let upper_left = fine(axes.place([x.low, y.high]));
    let lower_right = fine(axes.place([x.high, y.low]));
    let mut nearest = NearestPoints::about(upper_left, lower_right, largest.min(MARGIN));
    for (index, (point, &reach)) in points.iter().zip(&reaches).enumerate() {
        for place in window.images([point[0], point[1]], reach / dots_per_metre) {
            let [x, y] = axes.place(place);
            nearest.add(index as u32, FINE as f64 * x, FINE as f64 * y, reach);
        }
    }
    let outside = nearest.distance_to_nobody();
    let mut found = Vec::new();
    for (at, (&(_, point), outside)) in nearest.dots.iter().zip(outside).enumerate() {
        let point = point as usize;
        if point < sizes.len() && f64::from(outside) > reaches[point] - SKIN * dots[point] {
            let place = [
                nearest.left + (at % nearest.width) as i32,
                nearest.top + (at / nearest.width) as i32,
            ];
            if (0..2).all(|axis| (upper_left[axis]..lower_right[axis]).contains(&place[axis])) {
                found.push((place, point));
            }
        }
    }
    found
}

/// The middle one of the sizes.
pub(crate) fn median(sizes: &[f64]) -> f64 {
    let mut sorted = sizes.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

impl SplatWindow {
    /// A place and its mirror images behind the walls that it is nearer to than `reach`, m.
    fn images(&self, place: [f64; 2], reach: f64) -> impl Iterator<Item = [f64; 2]> {
        let [columns, rows] = [0, 1].map(|axis| self.images_along(axis, place[axis], reach));
        columns.flat_map(move |x| rows.clone().map(move |y| [x, y]))
    }

    /// A coordinate along an axis and its mirror images, as [`SplatWindow::images`].
    fn images_along(&self, axis: usize, at: f64, reach: f64) -> impl Iterator<Item = f64> + Clone {
        let ValueRange { low, high } = self.ranges[axis];
        let walls = self.walls[axis];
        let lower = (walls[0] && at - low < reach).then_some(2.0 * low - at);
        let upper = (walls[1] && high - at < reach).then_some(2.0 * high - at);
        [Some(at), lower, upper].into_iter().flatten()
    }
}

impl NearestPoints {
    /// The dots between two corners and `margin` more on each side: a body that goes on beyond the window does not
    /// end there.
    fn about(upper_left: [i32; 2], lower_right: [i32; 2], margin: f64) -> Self {
        let margin = margin.ceil() as i32;
        let [width, height] = [0, 1].map(|axis| (lower_right[axis] - upper_left[axis] + 2 * margin).max(1) as usize);
        let dots = vec![(f32::INFINITY, NOBODY); width * height];
        Self {
            left: upper_left[0] - margin,
            top: upper_left[1] - margin,
            width,
            dots,
        }
    }

    /// A point at `(x, y)` whose colour reaches `reach`, all in dots of the sheet.
    fn add(&mut self, point: u32, x: f64, y: f64, reach: f64) {
        let x = x - f64::from(self.left);
        let y = y - f64::from(self.top);
        let height = self.dots.len() / self.width;
        for row in dots_within(y, reach, height) {
            for column in dots_within(x, reach, self.width) {
                let distance = ((column as f64 - x).powi(2) + (row as f64 - y).powi(2)) as f32;
                let dot = &mut self.dots[row * self.width + column];
                if distance <= (reach * reach) as f32 && distance < dot.0 {
                    *dot = (distance, point);
                }
            }
        }
    }

    /// How far each dot is from the next one that no point reaches, in dots (up to 8 % too long): the way over
    /// neighbours, found in one sweep down and one up.
    fn distance_to_nobody(&self) -> Vec<f32> {
        let mut way: Vec<f32> = self
            .dots
            .iter()
            .map(|&(_, point)| if point == NOBODY { 0.0 } else { f32::INFINITY })
            .collect();
        let width = self.width;
        let count = way.len();
        let diagonal = std::f32::consts::SQRT_2;
        for at in 0..count {
            let column = at % width;
            let above = at.checked_sub(width);
            let left = (column > 0).then(|| way[at - 1] + 1.0);
            let up = above.map(|above| way[above] + 1.0);
            let up_left = above.filter(|_| column > 0).map(|above| way[above - 1] + diagonal);
            let up_right = above
                .filter(|_| column + 1 < width)
                .map(|above| way[above + 1] + diagonal);
            way[at] = [left, up, up_left, up_right]
                .into_iter()
                .flatten()
                .fold(way[at], f32::min);
        }
        for at in (0..count).rev() {
            let column = at % width;
            let below = Some(at + width).filter(|&below| below < count);
            let right = (column + 1 < width).then(|| way[at + 1] + 1.0);
            let down = below.map(|below| way[below] + 1.0);
            let down_left = below.filter(|_| column > 0).map(|below| way[below - 1] + diagonal);
            let down_right = below
                .filter(|_| column + 1 < width)
                .map(|below| way[below + 1] + diagonal);
            way[at] = [right, down, down_left, down_right]
                .into_iter()
                .flatten()
                .fold(way[at], f32::min);
        }
        way
    }
}

/// The dots, of `count` along an axis, that are no farther than `reach` from a centre.
fn dots_within(centre: f64, reach: f64, count: usize) -> Range<usize> {
    let first = (centre - reach).ceil().max(0.0) as usize;
    first..((centre + reach).floor() + 1.0).clamp(0.0, count as f64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::axes::LINEAR;

    #[test]
    fn a_shorter_reach_leaves_gaps_open_and_fills_a_lattice() {
        let points: Vec<[f64; 3]> = [0.5, 1.5, 4.5, 5.5]
            .into_iter()
            .flat_map(|x| (0..6).map(move |y| [x, f64::from(y) + 0.5, 0.0]))
            .collect();
        let axes = ChartAxes {
            left: 0.0,
            top: 0.0,
            right: 60.0,
            bottom: 60.0,
            x: ValueRange::of(0.0, 6.0),
            y: ValueRange::of(0.0, 6.0),
            scales: LINEAR,
        };
        let at = |reach: f64, x: f64| {
            let window = SplatWindow {
                ranges: [ValueRange::of(0.0, 6.0); 2],
                walls: Default::default(),
                reach,
            };
            let wanted = fine(axes.place([x, 3.0]));
            covered(&axes, &window, &points, &vec![1.0; points.len()])
                .iter()
                .any(|(place, _)| *place == wanted)
        };
        assert!(at(REACH, 1.0) && at(REACH, 3.0) && at(1.4, 1.0) && !at(1.4, 3.0));
        assert!(at(1.4, 1.9) && !at(1.4, 2.2));
    }
}
