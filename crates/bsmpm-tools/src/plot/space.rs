//! Draws a 3-D run in perspective.

use bsmpm::interactions::rigid::Outline;
use bsmpm_io::frame::Frame;
use bsmpm_scene::{Case, surfaces};
use std::iter::repeat;
use std::ops::Range;

use super::field::FieldName;
use crate::Error;
use crate::picture::axes::{self, ChartAxes, LABEL, THIN, title};
use crate::picture::bar::{self, Bar};
use crate::picture::canvas::{Canvas, FINE, TextAlign, fine, width};
use crate::picture::colour::{self, INK, OUTLINE, Rgb};
use crate::picture::layout::{Layout, aspect};
use crate::picture::splat;
use crate::picture::ticks::ValueRange;
use crate::record::{RunRecord, short};

const ABOVE: f64 = 130.0;
const RIGHT: f64 = 60.0;
/// Pixels from the edges of the grid to what they are called.
const BESIDE: f64 = 30.0;
/// Where it is looked from: degrees from the front towards the right, and above the ground.
const VIEW: [f64; 2] = [30.0, 28.0];
/// The sun, towards it, on the sheet and out of it.
const LIGHT: [f64; 3] = [-0.45, 0.55, 0.7];
/// Share of the light that comes from everywhere.
const AMBIENT: f64 = 0.4;
/// Rigid terrain, and the number of its places among the points.
const STONE: Rgb = [200, 196, 188];
const RIGID: u32 = u32::MAX - 1;
/// Places of terrain along an axis at most.
const MOST_PLACES: f64 = 1500.0;
/// Radius of a point's ball in its size: the balls of a lattice overlap.
const RADIUS: f64 = 0.8;

/// What shows from afar: places on the sheet and towards the eye, all in m.
struct View {
    right: [f64; 3],
    up: [f64; 3],
    eye: [f64; 3],
}

impl View {
    fn new(angles: [f64; 2]) -> Self {
        let [turned, raised] = angles.map(f64::to_radians);
        let [sin, cos] = [turned.sin(), turned.cos()];
        let [low, high] = [raised.sin(), raised.cos()];
        Self {
            right: [cos, sin, 0.0],
            up: [-sin * low, cos * low, high],
            eye: [sin * high, -cos * high, low],
        }
    }

    fn place(&self, at: [f64; 3]) -> [f64; 3] {
        [self.right, self.up, self.eye].map(|axis| product(axis, at))
    }
}

/// The scalar product of two vectors.
fn product(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

/// The slope at a place between its neighbours at a distance of `length`, by those that there are.
pub(super) fn slope(before: Option<f64>, here: f64, after: Option<f64>, length: f64) -> f64 {
    match (before, after) {
        (Some(before), Some(after)) => (after - before) / (2.0 * length),
        (Some(before), None) => (here - before) / length,
        (None, Some(after)) => (after - here) / length,
        (None, None) => 0.0,
    }
}

/// The nearest ball of every dot of a sheet.
struct NearestBalls {
    width: usize,
    /// m, towards the eye, and the point
    dots: Vec<(f32, u32)>,
}

const NOBODY: (f32, u32) = (f32::NEG_INFINITY, u32::MAX);

impl NearestBalls {
    fn new([width, height]: [usize; 2]) -> Self {
        Self {
            width,
            dots: vec![NOBODY; width * height],
        }
    }

    /// A ball about `[x, y]`, dots, and `depth`, m, with so many dots a metre.
    fn add(&mut self, point: u32, [x, y]: [f64; 2], depth: f64, radius: f64, scale: f64) {
        let reach = (radius * scale).max(1.0);
        let height = self.dots.len() / self.width;
        for row in dots_within(y, reach, height) {
            for column in dots_within(x, reach, self.width) {
                let away = (column as f64 - x).powi(2) + (row as f64 - y).powi(2);
                let depth = (depth + (reach * reach - away).max(0.0).sqrt() / scale) as f32;
                let dot = &mut self.dots[row * self.width + column];
                if away <= reach * reach && depth > dot.0 {
                    *dot = (depth, point);
                }
            }
        }
    }

    /// Share of the light that falls on a dot, by the depths `step` dots around it that are no farther off than that.
    fn lit(&self, at: usize, step: usize, scale: f64) -> f64 {
        let row = at / self.width;
        let column = at % self.width;
        let here = self.dots[at].0;
        // Rows count downward.
        let around = [
            self.depth(Some(row), column.checked_sub(step)),
            self.depth(Some(row), Some(column + step)),
            self.depth(Some(row + step), Some(column)),
            self.depth(row.checked_sub(step), Some(column)),
        ];
        let farthest = 3.0 * step as f64;
        let [left, right, below, above] = around.map(|depth| {
            depth
                .filter(|depth| f64::from((depth - here).abs()) * scale <= farthest)
                .map(f64::from)
        });
        let length = step as f64 / scale;
        let across = slope(left, f64::from(here), right, length);
        let up = slope(below, f64::from(here), above, length);
        let normal = [-across, -up, 1.0];
        let falls = product(normal, LIGHT) / (product(normal, normal) * product(LIGHT, LIGHT)).sqrt();
        AMBIENT + (1.0 - AMBIENT) * falls.max(0.0)
    }

    /// Depth of a dot (m); none where there is no such row or column.
    fn depth(&self, row: Option<usize>, column: Option<usize>) -> Option<f32> {
        let row = row.filter(|row| *row < self.dots.len() / self.width)?;
        let column = column.filter(|column| *column < self.width)?;
        Some(self.dots[row * self.width + column].0)
    }
}

/// The dots, of `count` along an axis, that a ball covers.
fn dots_within(centre: f64, reach: f64, count: usize) -> Range<usize> {
    let first = (centre - reach).ceil().clamp(0.0, count as f64) as usize;
    first..(centre + reach + 1.0).clamp(0.0, count as f64) as usize
}

/// Draws a picture for every frame of a solid in the colours of a field, and returns their names; of a plane none.
pub(super) fn draw(
    record: &RunRecord,
    frames: &[Frame],
    field: FieldName,
    ends: Option<ValueRange>,
) -> Result<Vec<String>, Error> {
    let Some(grid) = record.manifest.grid.as_ref().filter(|_| record.is_solid()) else {
        return Ok(Vec::new());
    };
    let [Ok(lower), Ok(upper)] = [&grid.lower, &grid.upper].map(|corner| corner[..].try_into()) else {
        return Ok(Vec::new());
    };
    let Some(values) = frames
        .iter()
        .map(|frame| field.values(frame))
        .collect::<Option<Vec<_>>>()
    else {
        return Ok(Vec::new());
    };
    let range = ends.unwrap_or_else(|| field.range(&values));
    let mut names = Vec::new();
    for (frame, values) in frames.iter().zip(&values) {
        let name = format!("{}_space_{}.png", field.name(), short(frame.time));
        let bar = Bar {
            range,
            label: field.label(Some(2)),
            pointed: FieldName::exceeded(values, range),
        };
        let beyond = field.beyond(values, range);
        picture(record, [lower, upper], frame, values, &beyond, bar).save(&record.directory.join(&name))?;
        names.push(name);
    }
    Ok(names)
}

fn picture(record: &RunRecord, grid: [[f64; 3]; 2], frame: &Frame, values: &[f64], beyond: &str, bar: Bar) -> Canvas {
    let view = View::new(VIEW);
    let corners = std::array::from_fn::<_, 8, _>(|k| view.place(corner(grid, k)));
    let region = [0, 1].map(|axis| {
        let along = corners.iter().map(|corner| corner[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        let high = along.fold(f64::NEG_INFINITY, f64::max);
        let room = 0.06 * (high - low);
        ValueRange::of(low - room, high + room)
    });
    let lying = aspect(region) < bar::LYING;
    let layout = Layout::of(region, if lying { RIGHT } else { bar::BESIDE }, 0.0);
    let axes = layout.axes(ABOVE);
    let below = if lying { axes::BELOW + bar::BELOW } else { 20.0 };
    let mut canvas = Canvas::new(layout.width, axes.bottom + below);
    title(
        &mut canvas,
        layout.width,
        &record.manifest.case.title,
        &(record.moment(frame.time) + beyond),
    );
    let places = corners.map(|[x, y, _]| axes.place([x, y]));
    // The edges at the nearest corner would hide what is inside.
    for (from, to) in edges().filter(|(from, to)| *from != NEAREST && *to != NEAREST) {
        canvas.line([places[from], places[to]], THIN, OUTLINE);
    }
    let scale = FINE as f64 * (axes.right - axes.left) / region[0].length();
    let [left, top] = fine([axes.left, axes.top]);
    let [right, bottom] = fine([axes.right, axes.bottom]);
    let mut nearest = NearestBalls::new([(right - left).max(1) as usize, (bottom - top).max(1) as usize]);
    let sizes = splat::sizes(frame, &record.manifest.case.geometry);
    let usual = splat::median(&sizes);
    let ground = terrain(record, grid, usual, frame.time);
    let stones = ground.iter().zip(repeat(&usual)).zip(repeat(RIGID));
    for ((point, size), number) in frame.position.iter().zip(&sizes).zip(0_u32..).chain(stones) {
        let [across, up, depth] = view.place(*point);
        let [x, y] = axes.place([across, up]);
        let at = [FINE as f64 * x - f64::from(left), FINE as f64 * y - f64::from(top)];
        nearest.add(number, at, depth, RADIUS * size, scale);
    }
    let step = (0.7 * usual * scale).round().max(1.0) as usize;
    for (at, &(_, point)) in nearest.dots.iter().enumerate().filter(|(_, dot)| dot.1 != NOBODY.1) {
        let lit = nearest.lit(at, step, scale);
        let colour = values
            .get(point as usize)
            .map_or(STONE, |value| colour::map(bar.share(*value)));
        let shade = colour.map(|part| (f64::from(part) * lit).round() as u8);
        canvas.dot(
            [left + (at % nearest.width) as i32, top + (at / nearest.width) as i32],
            shade,
        );
    }
    name_edges(&mut canvas, &axes, grid, &places);
    if lying {
        bar.lying(&mut canvas, &axes);
    } else {
        bar.upright(&mut canvas, &axes);
    }
    canvas
}

/// Writes the names and ends of the axes beside three edges of the grid, whose corners lie at these places.
fn name_edges(canvas: &mut Canvas, axes: &ChartAxes, grid: [[f64; 3]; 2], places: &[[f64; 2]; 8]) {
    let [x, y, z] = [("x", 0), ("y", 1), ("z", 2)]
        .map(|(name, axis)| format!("{name} = {} to {} m", short(grid[0][axis]), short(grid[1][axis])));
    let [along_x, along_y, along_z] = [(0, 1), (1, 3), (0, 4)]
        .map(|(from, to): (usize, usize)| [0, 1].map(|axis| f64::midpoint(places[from][axis], places[to][axis])));
    let at = [along_x[0] - 14.0, along_x[1] + BESIDE];
    canvas.text(&x, at, LABEL, TextAlign::Right, INK);
    // Not into the bar beside the axes.
    let left = (along_y[0] + 14.0).min(axes.right + 40.0 - width(&y, LABEL));
    canvas.text(&y, [left, along_y[1] + BESIDE], LABEL, TextAlign::Left, INK);
    canvas.upward(&z, [along_z[0] - BESIDE, along_z[1]], LABEL, INK);
}

/// Places of rigid terrain inside the grid at a time, half of `apart` (m) from each other.
fn terrain(record: &RunRecord, [lower, upper]: [[f64; 3]; 2], apart: f64, time: f64) -> Vec<[f64; 3]> {
    let Ok(case) = Case::from_text("case", &record.manifest.case.text, &[]) else {
        return Vec::new();
    };
    let mut places = Vec::new();
    let counts = [0, 1].map(|axis| {
        let count = ((upper[axis] - lower[axis]) / (0.5 * apart)).ceil();
        count.clamp(1.0, MOST_PLACES) as usize
    });
    let bodies = surfaces::rigid::<3>(&case, case.just_before(time));
    for body in bodies.iter().filter(|body| body.acts) {
        let Outline::Terrain(terrain) = &body.outline else {
            continue;
        };
        let moved = body.on_path(time);
        for i in 0..=counts[0] {
            for j in 0..=counts[1] {
                let at = [(0, i), (1, j)]
                    .map(|(axis, k): (usize, usize)| k as f64 / counts[axis] as f64 * (upper[axis] - lower[axis]));
                let height = terrain.height([at[0] - moved[0], at[1] - moved[1]]) + moved[2];
                places.push([lower[0] + at[0], lower[1] + at[1], lower[2] + height]);
            }
        }
    }
    places
}

/// The corner that is nearest to the eye: bits are of x, y and z.
const NEAREST: usize = 5;

fn corner([lower, upper]: [[f64; 3]; 2], k: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { lower[axis] } else { upper[axis] })
}

/// Pairs of corners.
fn edges() -> impl Iterator<Item = (usize, usize)> {
    (0..8).flat_map(|k| {
        (0..3)
            .filter(move |axis| k >> axis & 1 == 0)
            .map(move |axis| (k, k | 1 << axis))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_is_orthonormal_and_looks_from_the_front_the_right_and_above() {
        let View { right, up, eye } = View::new(VIEW);
        for (a, b, expected) in [
            (right, right, 1.0),
            (up, up, 1.0),
            (eye, eye, 1.0),
            (right, up, 0.0),
            (up, eye, 0.0),
        ] {
            assert!((product(a, b) - expected).abs() < 1e-15);
        }
        assert!(eye[0] > 0.0 && eye[1] < 0.0 && eye[2] > 0.0 && up[2] > 0.0);
        let depths = (0..8).map(|k| View::new(VIEW).place(corner([[0.0; 3], [1.0; 3]], k))[2]);
        let nearest = depths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert_eq!(nearest.0, NEAREST);
    }

    #[test]
    fn near_balls_hide_far_ones_and_slopes_towards_the_light_are_brighter() {
        let mut nearest = NearestBalls::new([40, 40]);
        nearest.add(0, [20.0, 20.0], 0.0, 10.0, 1.0);
        nearest.add(1, [20.0, 20.0], -5.0, 12.0, 1.0);
        let at = |column: usize, row: usize| row * 40 + column;
        assert_eq!(
            (
                nearest.dots[at(20, 20)].1,
                nearest.dots[at(20, 9)].1,
                nearest.dots[at(1, 1)].1
            ),
            (0, 1, NOBODY.1)
        );
        let [upper_left, middle, lower_right] =
            [(15, 15), (20, 20), (25, 25)].map(|(column, row)| nearest.lit(at(column, row), 2, 1.0));
        assert!(upper_left > middle && middle > lower_right && lower_right >= AMBIENT);
    }
}
