//! Points of a shape in space by the vertical lines of a lattice, in whatever way it cuts the cells.

use super::cells::{CellPlace, SLIVER, give, part, place};
use super::reached;
use crate::grid::GridAxis;
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
    pub(super) places: Vec<CellPlace<3>>,
}

/// A vertical line with the area that it stands for.
struct Line {
    x: [f64; 2],
    area: f64,
    covered: Vec<[f64; 2]>,
}

/// The cells with points of the column of cells above a rectangle.
///
/// A point has the covered volume of its own n-th of the cell along each axis; what is left of the others goes to the
/// nearest point of the cell. A cell without a lattice point inside has one point, in the largest piece.
pub(super) fn column(lines: &Lines<'_>, sides: [[f64; 2]; 2], up: &GridAxis, n: usize) -> Vec<LatticeCell> {
    let parts = (0..n * n).map(|k| lines.of([part(sides[0], k / n, n), part(sides[1], k % n, n)]));
    let parts: Vec<Vec<Line>> = parts.collect();
    let centre = |k: usize| [place(sides[0], k / n, n), place(sides[1], k % n, n)];
    let centres: Vec<Centre> = (0..n * n).map(|k| (centre(k), (lines.covers)(centre(k)))).collect();
    let rows = rows(&parts, up);
    let cells = rows.map(|row| cell((&parts, &centres), [up.breakpoint(row), up.breakpoint(row + 1)], n, row));
    cells.filter(|cell| !cell.places.is_empty()).collect()
}

impl Lines<'_> {
    /// Those of a part of a cell.
    fn of(&self, sides: [[f64; 2]; 2]) -> Vec<Line> {
        let [along_x, along_y] = [0, 1].map(|axis| shares(sides[axis], &self.ends[axis]));
        let at = |x: f64, y: f64, area: f64| Line { x: [x, y], area, covered: (self.covers)([x, y]) };
        along_x.iter().flat_map(|&(x, width)| along_y.iter().map(move |&(y, depth)| at(x, y, width * depth))).collect()
    }
}

/// Places of lines in an interval with the lengths that they stand for.
fn shares([lower, upper]: [f64; 2], ends: &[f64]) -> Vec<(f64, f64)> {
    let mut pieces = vec![lower];
    pieces.extend(ends.iter().filter(|end| lower < **end && **end < upper));
    pieces.push(upper);
    let of = |piece: &[f64]| {
        let [from, to] = [piece[0], piece[1]];
        (0..LINES).map(move |k| (place([from, to], k, LINES), (to - from) / LINES as f64))
    };
    pieces.windows(2).flat_map(of).collect()
}

/// Rows of cells that the lines reach.
fn rows(parts: &[Vec<Line>], up: &GridAxis) -> Range<usize> {
    let covered = || parts.iter().flatten().flat_map(|line| &line.covered);
    let lower = covered().map(|line| line[0]).fold(f64::INFINITY, f64::min);
    let upper = covered().map(|line| line[1]).fold(f64::NEG_INFINITY, f64::max);
    if lower < upper { reached(up, [lower, upper]) } else { 0..0 }
}

type Centre = ([f64; 2], Vec<[f64; 2]>);

fn cell((parts, centres): (&[Vec<Line>], &[Centre]), z: [f64; 2], n: usize, row: usize) -> LatticeCell {
    let (mut places, mut left) = (Vec::new(), Vec::new());
    let (mut sum, mut largest, mut whole) = (0.0, (0.0, [0.0; 3]), true);
    for (lines, ([x, y], middle)) in parts.iter().zip(centres) {
        for c in 0..n {
            let height = part(z, c, n);
            let (mut volume, mut full) = (0.0, 0.0);
            for line in lines {
                full += line.area * (height[1] - height[0]);
                for ends in &line.covered {
                    let (lower, upper) = (ends[0].max(height[0]), ends[1].min(height[1]));
                    let piece = line.area * (upper - lower).max(0.0);
                    volume += piece;
                    if piece > largest.0 {
                        largest = (piece, [line.x[0], line.x[1], 0.5 * (lower + upper)]);
                    }
                }
            }
            whole &= volume >= (1.0 - SLIVER) * full;
            sum += volume;
            let at = [*x, *y, place(z, c, n)];
            let inside = middle.iter().any(|[lower, upper]| *lower < at[2] && at[2] < *upper);
            let list = if inside && volume > SLIVER * full { &mut places } else { &mut left };
            if volume > 0.0 {
                list.push(CellPlace { x: at, area: volume });
            }
        }
    }
    if places.is_empty() && sum > 0.0 {
        places.push(CellPlace { x: largest.1, area: sum });
    } else {
        left.iter().for_each(|left| give(&mut places, left));
    }
    LatticeCell { row, whole, places }
}
