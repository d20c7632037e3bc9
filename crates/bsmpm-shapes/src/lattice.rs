//! Places the material points of a 3-D body, and integrates their volumes along vertical lines.

use crate::axis::{GridAxis, reached};
use crate::cells::{CellPlace, SLIVER, part, place};
use std::ops::Range;

/// Vertical lines along each axis of the part of a cell that belongs to a point; each carries its share of that part,
/// and along the line all is exact.
pub(super) const LINES: usize = 4;

/// A shape by its vertical lines.
pub(super) struct Lines<'a> {
    /// what it covers of the line at a place
    pub(super) covers: &'a dyn Fn([f64; 2]) -> Vec<[f64; 2]>,
    /// places along axes 0 and 1, ascending, at which it may begin or end: a part of a cell is split there, so that
    /// what is flat there is exact
    pub(super) ends: &'a [Vec<f64>; 2],
}

/// A cell with its points.
pub(super) struct LatticeCell {
    /// its number along axis 2
    pub(super) row: usize,
    /// whether it is covered as a whole
    pub(super) whole: bool,
    /// whether one point stands for all as no lattice point is inside
    pub(super) alone: bool,
    pub(super) places: Vec<CellPlace<3>>,
}

/// A vertical line with the area that it stands for, m².
struct VerticalLine {
    x: [f64; 2],
    area: f64,
    covered: Vec<[f64; 2]>,
}

/// The cells with points of the column of cells above a rectangle.
///
/// A point has the covered volume of its own n-th of the cell along each axis; what is left of the others goes to the
/// nearest points of the cell, in equal shares to those that are equally near. Their volumes then are tilted so that
/// the centroid is that of what is covered, as far as none loses more than half. A cell without a lattice point inside
/// has one point, at that place of its lines that is nearest to the centroid.
pub(super) fn column(lines: &Lines<'_>, sides: [[f64; 2]; 2], up: &GridAxis, n: usize) -> Vec<LatticeCell> {
    let parts = (0..n * n).map(|k| lines.of([part(sides[0], k / n, n), part(sides[1], k % n, n)]));
    let parts: Vec<Vec<VerticalLine>> = parts.collect();
    let centres = (0..n * n).map(|k| {
        let at = [place(sides[0], k / n, n), place(sides[1], k % n, n)];
        (at, (lines.covers)(at))
    });
    let centres: Vec<Centre> = centres.collect();
    let rows = rows(&parts, up);
    let cells = rows.map(|row| cell(&parts, &centres, [up.breakpoint(row), up.breakpoint(row + 1)], n, row));
    cells.filter(|cell| !cell.places.is_empty()).collect()
}

impl Lines<'_> {
    /// Those of a part of a cell.
    fn of(&self, sides: [[f64; 2]; 2]) -> Vec<VerticalLine> {
        let [along_x, along_y] = [0, 1].map(|axis| shares(sides[axis], &self.ends[axis], LINES));
        let mut lines = Vec::with_capacity(along_x.len() * along_y.len());
        for (x, width) in along_x {
            for (y, depth) in &along_y {
                lines.push(VerticalLine {
                    x: [x, *y],
                    area: width * depth,
                    covered: (self.covers)([x, *y]),
                });
            }
        }
        lines
    }
}

/// Places of lines in an interval with the lengths that they stand for, so many in each piece between ends.
pub(super) fn shares([lower, upper]: [f64; 2], ends: &[f64], lines: usize) -> Vec<(f64, f64)> {
    let mut pieces = vec![lower];
    pieces.extend(ends.iter().filter(|end| lower < **end && **end < upper));
    pieces.push(upper);
    let places = pieces.windows(2).flat_map(|piece| {
        let [from, to] = [piece[0], piece[1]];
        (0..lines).map(move |k| (place([from, to], k, lines), (to - from) / lines as f64))
    });
    places.collect()
}

/// Rows of cells that the lines reach.
fn rows(parts: &[Vec<VerticalLine>], up: &GridAxis) -> Range<usize> {
    let covered = parts.iter().flatten().flat_map(|line| &line.covered);
    let lower = covered.clone().map(|line| line[0]).fold(f64::INFINITY, f64::min);
    let upper = covered.map(|line| line[1]).fold(f64::NEG_INFINITY, f64::max);
    if lower < upper {
        reached(up, [lower, upper])
    } else {
        0..0
    }
}

type Centre = ([f64; 2], Vec<[f64; 2]>);

fn cell(parts: &[Vec<VerticalLine>], centres: &[Centre], z: [f64; 2], n: usize, row: usize) -> LatticeCell {
    let mut places = Vec::new();
    let mut left = Vec::new();
    let mut sum = VolumeMoments::default();
    let mut whole = true;
    for (lines, ([x, y], middle)) in parts.iter().zip(centres) {
        for c in 0..n {
            let height = part(z, c, n);
            let mut volume = 0.0;
            let mut full = 0.0;
            for line in lines {
                full += line.area * (height[1] - height[0]);
                volume += line.within(height).map(|ends| sum.add(line, ends)).sum::<f64>();
            }
            whole &= volume >= (1.0 - SLIVER) * full;
            let at = [*x, *y, place(z, c, n)];
            let inside = middle.iter().any(|[lower, upper]| *lower < at[2] && at[2] < *upper);
            let list = if inside && volume > SLIVER * full {
                &mut places
            } else {
                &mut left
            };
            if volume > 0.0 {
                list.push(CellPlace { x: at, area: volume });
            }
        }
    }
    let alone = places.is_empty() && sum.volume > 0.0;
    if alone {
        let x = nearest_inside(parts, z, sum.centroid());
        places.push(CellPlace { x, area: sum.volume });
    } else {
        share(&mut places, &left);
        if !whole {
            balance(&mut places, sum.centroid(), SLIVER * (z[1] - z[0]));
        }
    }
    LatticeCell {
        row,
        whole,
        alone,
        places,
    }
}

impl VerticalLine {
    /// What is covered of it between two heights.
    fn within(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let within = self
            .covered
            .iter()
            .map(move |[lower, upper]| [lower.max(from), upper.min(to)]);
        within.filter(|[lower, upper]| lower < upper)
    }
}

/// Volume, m³, and first moments, m⁴, of pieces of lines.
#[derive(Clone, Copy, Debug, Default)]
struct VolumeMoments {
    volume: f64,
    moment: [f64; 3],
}

impl VolumeMoments {
    /// Adds a piece of a line and gives its volume.
    fn add(&mut self, line: &VerticalLine, [lower, upper]: [f64; 2]) -> f64 {
        let volume = line.area * (upper - lower);
        let at = [line.x[0], line.x[1], 0.5 * (lower + upper)];
        self.volume += volume;
        self.moment = [0, 1, 2].map(|axis| self.moment[axis] + volume * at[axis]);
        volume
    }

    fn centroid(&self) -> [f64; 3] {
        self.moment.map(|moment| moment / self.volume)
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).fold(0.0_f64, |sum, k| sum.hypot(a[k] - b[k]))
}

/// The place inside, on a line of a cell between two heights, that is nearest to `to`, the first of several: at its
/// height or in the middle of what a line has.
fn nearest_inside(parts: &[Vec<VerticalLine>], z: [f64; 2], to: [f64; 3]) -> [f64; 3] {
    let places = parts.iter().flatten().flat_map(|line| {
        line.within(z).map(move |[lower, upper]| {
            let is_within = lower < to[2] && to[2] < upper;
            let height = if is_within { to[2] } else { 0.5 * (lower + upper) };
            [line.x[0], line.x[1], height]
        })
    });
    places
        .min_by(|a, b| distance(*a, to).total_cmp(&distance(*b, to)))
        .unwrap_or(to)
}

/// Shares out what is left among places: each to the nearest, in equal parts to those that are equally near, so that
/// what is symmetric stays so.
fn share(places: &mut [CellPlace<3>], left: &[CellPlace<3>]) {
    for of in left {
        let nearest = places
            .iter()
            .map(|place| distance(place.x, of.x))
            .fold(f64::INFINITY, f64::min);
        let near = places
            .iter_mut()
            .filter(|place| distance(place.x, of.x) <= nearest * (1.0 + SLIVER));
        let near: Vec<&mut CellPlace<3>> = near.collect();
        let share = of.area / near.len() as f64;
        near.into_iter().for_each(|place| place.area += share);
    }
}

/// Rounds over the axes by which a cell's points come to balance: where they are skew to the axes, each is off again by
/// the next.
const ROUNDS: usize = 4;

/// Tilts the volumes of places so that their centroid comes to lie at `to`, as far as none loses more than half, nor
/// gains more than that in a round along an axis; their sum stays. Nothing is tilted along an axis where they lie
/// within `least`, m.
fn balance(places: &mut [CellPlace<3>], to: [f64; 3], least: f64) {
    let volume: f64 = places.iter().map(|place| place.area).sum();
    let halves: Vec<f64> = places.iter().map(|place| 0.5 * place.area).collect();
    for axis in (0..ROUNDS).flat_map(|_| 0..3) {
        let mean = places.iter().map(|place| place.area * place.x[axis]).sum::<f64>() / volume;
        let squares = places.iter().map(|place| place.area * (place.x[axis] - mean).powi(2));
        let variance = squares.sum::<f64>() / volume;
        let reach = places
            .iter()
            .map(|place| (place.x[axis] - mean).abs())
            .fold(0.0, f64::max);
        if reach <= least {
            continue;
        }
        let mut slope = ((to[axis] - mean) / variance).clamp(-0.5 / reach, 0.5 / reach);
        for (place, half) in places.iter().zip(&halves) {
            let arm = place.x[axis] - mean;
            let most = (1.0 - half / place.area).max(0.0);
            if slope * arm < -most {
                slope = -most / arm;
            }
        }
        places
            .iter_mut()
            .for_each(|place| place.area *= 1.0 + slope * (place.x[axis] - mean));
    }
}
