//! Places the material points of a 2-D body in one column of cells.

use crate::axis::{GridAxis, reached};
use crate::edge::Edge;
use crate::sweep::{Slice, Window, intervals, is_filled, sweep};
use std::ops::Range;

/// Parts of a cell: less area makes no point, and a lattice point is not so near to an edge.
pub(super) const SLIVER: f64 = 1e-9;

/// What an outline has in a column of cells.
#[derive(Clone, Debug)]
pub(crate) struct CellColumn {
    /// rows, upwards
    pub(crate) parts: Vec<RegionPart>,
    /// m²
    pub(crate) area: f64,
    /// m²  of cells where one point stands for all as no lattice point is inside
    pub(crate) alone: f64,
}

/// Some rows of a column.
#[derive(Clone, Debug)]
pub(crate) enum RegionPart {
    /// Cells that are covered as a whole.
    Whole(Range<usize>),
    /// A cell that the outline cuts, with its points.
    Cut(usize, Vec<CellPlace>),
}

/// The position of a material point, with its share of the body.
#[derive(Clone, Copy, Debug)]
pub struct CellPlace<const D: usize = 2> {
    /// Position (m from the lower corner of the grid).
    pub x: [f64; D],
    /// Area (m²), or in space volume (m³).
    pub area: f64,
}

impl CellColumn {
    /// From the first to the last row with points.
    pub(crate) fn rows(&self) -> Option<Range<usize>> {
        let first = self.parts.first()?;
        let last = self.parts.last()?;
        Some(first.rows().start..last.rows().end)
    }
}

impl RegionPart {
    pub(crate) fn rows(&self) -> Range<usize> {
        match self {
            Self::Whole(rows) => rows.clone(),
            Self::Cut(row, _) => *row..row + 1,
        }
    }

    /// Number of its points.
    pub(crate) fn points(&self, points_per_cell: usize) -> u64 {
        match self {
            Self::Whole(rows) => (rows.len() * points_per_cell * points_per_cell) as u64,
            Self::Cut(_, places) => places.len() as u64,
        }
    }
}

/// The regular lattice of the material points of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Number of points along each axis of a cell.
    pub n: usize,
    /// Returns the factor by which the points lie farther from the middle along axis 0 than at (i + 1/2)/n of the cell:
    /// of the ends of the cell (m from the lower end of the grid) and `n`.
    pub spread: fn([f64; 2], usize) -> f64,
}

impl Lattice {
    /// Returns the lattice of `n` points at (i + 1/2)/n of the cell along each axis.
    pub fn even(n: usize) -> Self {
        Self { n, spread: |_, _| 1.0 }
    }

    /// Place of point `k` between two ends along axis 0.
    fn across(self, [lower, upper]: [f64; 2], k: usize) -> f64 {
        let middle = (k as f64 + 0.5) / self.n as f64;
        let off = (middle - 0.5) * ((self.spread)([lower, upper], self.n) - 1.0);
        lower + (upper - lower) * (middle + off)
    }
}

/// Points of a rectangle that lies in one cell.
pub(crate) fn of_cell(lattice: Lattice, [across, up]: [[f64; 2]; 2]) -> impl Iterator<Item = CellPlace> {
    let n = lattice.n;
    let count = n * n;
    let area = (across[1] - across[0]) * (up[1] - up[0]) / count as f64;
    (0..count).map(move |k| CellPlace {
        x: [lattice.across(across, k / n), place(up, k % n, n)],
        area,
    })
}

/// Place of lattice point `k` of `n` between two ends.
pub(crate) fn place([lower, upper]: [f64; 2], k: usize, n: usize) -> f64 {
    lower + (upper - lower) * ((k as f64 + 0.5) / n as f64)
}

/// What shape 0 less the others has in column `i` of the grid.
pub(crate) fn column(edges: &[Edge], shapes: usize, axes: &[GridAxis], lattice: Lattice, i: usize) -> CellColumn {
    let across = &axes[0];
    let up = &axes[1];
    let x = [across.breakpoint(i), across.breakpoint(i + 1)];
    let near: Vec<Near> = edges
        .iter()
        .filter_map(|edge| {
            Some(Near {
                edge: *edge,
                span: edge.span(x)?,
            })
        })
        .collect();
    let mut column = CellColumn {
        parts: Vec::new(),
        area: 0.0,
        alone: 0.0,
    };
    if near.is_empty() {
        return column;
    }
    let strip = CellStrip::new(x, near, shapes, lattice);
    let mut cut: Vec<Range<usize>> = strip.near.iter().map(|near| reached(up, near.span)).collect();
    cut.sort_by_key(|rows| rows.start);
    let mut next = 0;
    for rows in cut {
        if next < rows.start {
            let y = [up.breakpoint(next), up.breakpoint(next + 1)];
            if covers(&strip.middle, 0.5 * (y[0] + y[1])) {
                column.area += (x[1] - x[0]) * (up.breakpoint(rows.start) - y[0]);
                column.parts.push(RegionPart::Whole(next..rows.start));
            }
        }
        for row in rows.start.max(next)..rows.end {
            let (places, area, alone) = strip.cell([up.breakpoint(row), up.breakpoint(row + 1)]);
            column.area += area;
            column.alone += if alone { area } else { 0.0 };
            if !places.is_empty() {
                column.parts.push(RegionPart::Cut(row, places));
            }
        }
        next = next.max(rows.end);
    }
    column
}

fn covers(intervals: &[[f64; 2]], y: f64) -> bool {
    intervals.iter().any(|[lower, upper]| *lower < y && y < *upper)
}

/// An edge and its heights in the column.
#[derive(Clone, Copy, Debug)]
struct Near {
    edge: Edge,
    span: [f64; 2],
}

/// A column of cells with the edges in it.
struct CellStrip {
    x: [f64; 2],
    near: Vec<Near>,
    shapes: usize,
    n: usize,
    across: Vec<f64>,          // m  the lattice's vertical lines
    lines: Vec<Vec<[f64; 2]>>, // covered parts of the lattice's vertical lines
    middle: Vec<[f64; 2]>,     // of the line in the middle
}

/// Sums over the slices of a cell.
#[derive(Clone, Copy, Debug, Default)]
struct SliceSum {
    area: f64,
    moment: [f64; 2],
    largest: f64,
    within: [f64; 2], // middle of the largest slice
}

impl SliceSum {
    fn add(&mut self, slice: &Slice) {
        let area = slice.area();
        let moment = slice.moment();
        self.area += area;
        self.moment = [self.moment[0] + moment[0], self.moment[1] + moment[1]];
        if area > self.largest {
            (self.largest, self.within) = (area, slice.middle);
        }
    }
}

impl CellStrip {
    fn new(x: [f64; 2], near: Vec<Near>, shapes: usize, lattice: Lattice) -> Self {
        let at = |x: f64| intervals(near.iter().map(|near| &near.edge), shapes, x);
        let across: Vec<f64> = (0..lattice.n).map(|k| lattice.across(x, k)).collect();
        let lines = across.iter().map(|&x| at(x)).collect();
        let middle = at(0.5 * (x[0] + x[1]));
        Self {
            x,
            near,
            shapes,
            n: lattice.n,
            across,
            lines,
            middle,
        }
    }

    /// Points of the cell between two heights, the area that is covered of it, and whether one point stands for all.
    ///
    /// A point has the covered area of its own n-th of the cell along each axis; what is left of the others goes to the
    /// nearest point of the cell. A cell without a lattice point inside has one point, at the centroid if that is
    /// inside.
    fn cell(&self, y: [f64; 2]) -> (Vec<CellPlace>, f64, bool) {
        let size = (self.x[1] - self.x[0]).min(y[1] - y[0]);
        let sub = (self.x[1] - self.x[0]) * (y[1] - y[0]) / (self.n * self.n) as f64;
        let mut places = Vec::new();
        let mut left = Vec::new();
        let mut sum = SliceSum::default();
        for a in 0..self.n {
            let edges = self.edges(part(self.x, a, self.n), y[1]);
            for b in 0..self.n {
                let window = Window {
                    x: part(self.x, a, self.n),
                    y: part(y, b, self.n),
                };
                let x = [self.across[a], place(y, b, self.n)];
                let mut area = self.covered(&edges, &window, &mut sum);
                let covered = covers(&self.lines[a], x[1]);
                if area.is_none() {
                    area = covered.then_some(sub);
                    sum.area += area.unwrap_or(0.0);
                }
                let Some(area) = area.filter(|area| *area > 0.0) else {
                    continue;
                };
                let inside = covered && area > SLIVER * sub;
                let mut near = edges.iter();
                if inside && near.all(|near| near.span[1] < y[0] || near.edge.distance(x) > SLIVER * size) {
                    &mut places
                } else {
                    &mut left
                }
                .push(CellPlace { x, area });
            }
        }
        if places.is_empty() && sum.area > SLIVER * sub * (self.n * self.n) as f64 {
            places.push(CellPlace {
                x: self.within(&sum),
                area: sum.area,
            });
            return (places, sum.area, true);
        }
        left.iter().for_each(|left| give(&mut places, left));
        (places, sum.area, false)
    }

    /// Edges at some x and not above a height.
    fn edges(&self, x: [f64; 2], top: f64) -> Vec<Near> {
        let here = self
            .near
            .iter()
            .filter(|near| near.span[0] <= top && near.edge.b[0] >= x[0] && near.edge.a[0] <= x[1]);
        here.copied().collect()
    }

    /// Covered area of a window that an edge touches, added to the cell's; none if no edge does.
    fn covered(&self, near: &[Near], window: &Window, sum: &mut SliceSum) -> Option<f64> {
        let mut level = near
            .iter()
            .filter(|near| near.span[0] <= window.y[1] && near.span[1] >= window.y[0]);
        let is_touched = level.any(|near| {
            let span = near.edge.span(window.x);
            span.is_some_and(|[low, high]| low <= window.y[1] && high >= window.y[0])
        });
        if !is_touched {
            return None;
        }
        let edges: Vec<Edge> = near.iter().map(|near| near.edge).collect();
        let before = sum.area;
        sweep(&edges, self.shapes, window, &is_filled, &mut |slice| sum.add(&slice));
        Some((sum.area - before).min(window.area()))
    }

    /// A place inside what the sums are about.
    fn within(&self, sum: &SliceSum) -> [f64; 2] {
        let centroid = sum.moment.map(|moment| moment / sum.area);
        let line = intervals(self.near.iter().map(|near| &near.edge), self.shapes, centroid[0]);
        if covers(&line, centroid[1]) {
            centroid
        } else {
            sum.within
        }
    }
}

/// Part `k` of `n` equal ones of an interval.
pub(super) fn part([lower, upper]: [f64; 2], k: usize, n: usize) -> [f64; 2] {
    [k, k + 1].map(|k| {
        if k == n {
            upper
        } else {
            lower + (upper - lower) * (k as f64 / n as f64)
        }
    })
}

/// Gives the area of a place to the nearest of others, the first of several: planes keep the points that they had, for
/// the equal shares of a [solid](crate::lattice) would move those of every slope.
fn give(places: &mut [CellPlace], left: &CellPlace) {
    let distance = |place: &CellPlace| (0..2).fold(0.0_f64, |sum, k| sum.hypot(place.x[k] - left.x[k]));
    if let Some(nearest) = places.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        nearest.area += left.area;
    }
}
