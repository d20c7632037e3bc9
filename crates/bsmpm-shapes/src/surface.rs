//! A 3-D body bounded by triangles. Computes which intervals of vertical lines are inside the body.

use crate::error::SurfaceError;
use std::collections::{BTreeMap, HashMap};

/// Parts of its size by which a surface may overlap itself: rounding of where its lines are cut.
const ROUNDING: f64 = 1e-9;
/// Parts of its width by which a line that is tried passes the edges at a corner or a crossing: what single precision,
/// in which files often are, makes touching parts overlap by is less.
const BESIDE: f64 = 1e-5;

/// A closed surface of triangles. Corners of a triangle are counter-clockwise seen from outside. Bins of the horizontal
/// plane show which triangles a vertical line can meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    triangles: Vec<[[f64; 3]; 3]>,
    /// lower and upper corner of the cuboid around it
    bounds: [[f64; 3]; 2],
    /// places between the bins along x and y, so that as many corners lie in each
    cuts: [Vec<f64>; 2],
    /// triangles whose rectangle reaches a bin, x running fastest
    bins: Vec<Vec<u32>>,
}

impl Surface {
    /// Places of all corners along an axis, m.
    pub(super) fn corners(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.triangles.iter().flatten().map(move |corner| corner[axis])
    }

    /// Returns the surface of triangles, each given by the nine coordinates of its corners (m). All triangles may be
    /// oriented inwards.
    ///
    /// # Errors
    /// If the surface is not closed, intersects itself or encloses no volume.
    pub fn new(rows: impl Iterator<Item = [f64; 9]>) -> Result<Self, SurfaceError> {
        // -0 and 0 are one place.
        let mut triangles: Vec<[[f64; 3]; 3]> = rows
            .map(|row| [0, 1, 2].map(|k| [0, 1, 2].map(|axis| row[3 * k + axis] + 0.0)))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        if triangles.is_empty() {
            return Err(SurfaceError::NoTriangle);
        }
        closed(&triangles)?;
        let bounds = bounds(&triangles);
        let volume = volume(&triangles, bounds[0]);
        let size: f64 = (0..3).map(|axis| bounds[1][axis] - bounds[0][axis]).product();
        if volume.abs() <= ROUNDING * size {
            return Err(SurfaceError::NoVolume);
        }
        if volume < 0.0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let made = Self::binned(triangles);
        made.simple()?;
        Ok(made)
    }

    fn binned(triangles: Vec<[[f64; 3]; 3]>) -> Self {
        let side = (triangles.len() as f64).sqrt().ceil() as usize;
        let bounds = bounds(&triangles);
        let cuts = [0, 1].map(|axis| {
            let mut places: Vec<f64> = triangles.iter().flatten().map(|corner| corner[axis]).collect();
            places.sort_by(f64::total_cmp);
            let mut cuts: Vec<f64> = (1..side).map(|k| places[k * places.len() / side]).collect();
            cuts.dedup();
            cuts
        });
        let made = Self {
            triangles,
            bounds,
            cuts,
            bins: Vec::new(),
        };
        let [along, across] = made.cuts.each_ref().map(|cuts| cuts.len() + 1);
        let mut bins = vec![Vec::new(); along * across];
        for (number, triangle) in (0_u32..).zip(&made.triangles) {
            let [columns, rows] = [0, 1].map(|axis| {
                let ends = triangle.map(|corner| made.bin(axis, corner[axis]));
                ends.iter().min().copied().unwrap_or(0)..=ends.iter().max().copied().unwrap_or(0)
            });
            for y in rows {
                columns.clone().for_each(|x| bins[y * along + x].push(number));
            }
        }
        Self { bins, ..made }
    }

    /// The bin of a place along an axis.
    fn bin(&self, axis: usize, at: f64) -> usize {
        self.cuts[axis].partition_point(|cut| *cut <= at)
    }

    pub(crate) fn moved(mut self, by: [f64; 3]) -> Self {
        for corner in self.triangles.iter_mut().flatten() {
            (0..3).for_each(|axis| corner[axis] += by[axis]);
        }
        Self::binned(self.triangles)
    }

    /// Returns the lower and upper corner of the cuboid around the surface (m).
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    /// Returns the volume inside the surface (m³).
    pub fn volume(&self) -> f64 {
        volume(&self.triangles, self.bounds[0])
    }

    /// Triangles that a vertical line is held against, in the mean.
    pub(crate) fn in_bin(&self) -> usize {
        self.bins.iter().map(Vec::len).sum::<usize>().div_ceil(self.bins.len())
    }

    /// What it encloses of the vertical line at a place, upwards: where the line has entered more often than left.
    pub(crate) fn vertical(&self, at: [f64; 2]) -> Vec<[f64; 2]> {
        let mut inside = Vec::new();
        let mut depth = 0;
        let mut from = 0.0;
        for (z, crossing) in self.crossings(at) {
            let before = depth;
            depth -= crossing;
            match (before > 0, depth > 0) {
                (false, true) => from = z,
                (true, false) if from < z => inside.push([from, z]),
                _ => {}
            }
        }
        inside
    }

    /// Heights at which the line at a place is cut, upwards, with how often it leaves there: -1 where it enters.
    fn crossings(&self, at: [f64; 2]) -> Vec<(f64, i32)> {
        if (0..2).any(|axis| !(self.bounds[0][axis] <= at[axis] && at[axis] <= self.bounds[1][axis])) {
            return Vec::new();
        }
        let bin = &self.bins[self.bin(1, at[1]) * (self.cuts[0].len() + 1) + self.bin(0, at[0])];
        let cut = bin.iter().filter_map(|number| {
            let triangle = &self.triangles[*number as usize];
            let turns = around(triangle, at);
            (turns != 0).then(|| (height(triangle, at), turns))
        });
        let mut cut: Vec<(f64, i32)> = cut.collect();
        // Shells that touch: what ends there ends first.
        cut.sort_by(|one, other| one.0.total_cmp(&other.0).then(other.1.cmp(&one.1)));
        cut
    }

    /// Whether vertical lines enter and leave in turns.
    ///
    /// Seen from above the edges cut the plane into parts; within one a line meets the same triangles, in one order
    /// unless two of them cross there. Wherever the order is wrong it is so beside a corner or beside a place where
    /// two edges cross, which are the places that are tried, `BESIDE` from the edges that meet there; what is thinner
    /// may stay.
    fn simple(&self) -> Result<(), SurfaceError> {
        let width = (0..2)
            .map(|axis| self.bounds[1][axis] - self.bounds[0][axis])
            .fold(0.0, f64::max);
        for triangle in self.triangles.iter().filter(|triangle| !is_wall(triangle)) {
            let [a, b, c] = triangle.map(|[x, y, _]| [x, y]);
            for [at, one, other] in [[a, b, c], [b, c, a], [c, a, b]] {
                let ways = [one, other].map(|end| [end[0] - at[0], end[1] - at[1]]);
                between(at, ways, BESIDE * width).map_or(Ok(()), |at| self.is_simple(at))?;
            }
        }
        for bin in &self.bins {
            let edges = bin.iter().flat_map(|&k| edges(&self.triangles[k as usize])).collect();
            for (one, other) in near(edges) {
                let Some(EdgeCrossing { at, to_ends: [u, v] }) = crossing(one, other) else {
                    continue;
                };
                for ways in [[u[0], v[0]], [u[0], v[1]], [u[1], v[0]], [u[1], v[1]]] {
                    between(at, ways, BESIDE * width).map_or(Ok(()), |at| self.is_simple(at))?;
                }
            }
        }
        Ok(())
    }

    /// Whether the line at a place enters and leaves in turns.
    fn is_simple(&self, at: [f64; 2]) -> Result<(), SurfaceError> {
        let height = self.bounds[1][2] - self.bounds[0][2];
        let mut depth = 0;
        let mut last = f64::NEG_INFINITY;
        for (z, crossing) in self.crossings(at) {
            if !(0..=1).contains(&depth) && z - last > ROUNDING * height {
                return Err(SurfaceError::SelfIntersection { at: [at[0], at[1], z] });
            }
            (depth, last) = (depth - crossing, z);
        }
        Ok(())
    }
}

/// Edges of a triangle seen from above, of two triangles that share one those of one of them.
fn edges(triangle: &[[f64; 3]; 3]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let ends = (0..3).map(|k| [triangle[k], triangle[(k + 1) % 3]]);
    let once = ends.filter(|[from, to]| from < to);
    once.map(|ends| ends.map(|[x, y, _]| [x, y]))
        .filter(|[from, to]| from != to)
}

/// Pairs of edges whose rectangles meet, swept along the axis along which they lie farther apart.
fn near(mut edges: Vec<[[f64; 2]; 2]>) -> impl Iterator<Item = ([[f64; 2]; 2], [[f64; 2]; 2])> {
    let [along, across] = [0, 1].map(|axis| {
        let first = edges.iter().map(|edge| least(edge, axis)).fold(f64::INFINITY, f64::min);
        let off = edges.iter().map(|edge| least(edge, axis) - first);
        off.fold(0.0, f64::max)
    });
    let axis = usize::from(across > along);
    let other = 1 - axis;
    edges.sort_by(|a, b| least(a, axis).total_cmp(&least(b, axis)));
    (0..edges.len()).flat_map(move |k| {
        let a = edges[k];
        let after = edges[k + 1..].iter().take_while(|b| least(b, axis) <= most(&a, axis));
        let near = after.filter(|b| least(b, other) <= most(&a, other) && least(&a, other) <= most(b, other));
        near.map(|b| (a, *b)).collect::<Vec<_>>()
    })
}

/// The lower end of an edge along an axis.
fn least(edge: &[[f64; 2]; 2], axis: usize) -> f64 {
    edge[0][axis].min(edge[1][axis])
}

/// The upper end of an edge along an axis.
fn most(edge: &[[f64; 2]; 2], axis: usize) -> f64 {
    edge[0][axis].max(edge[1][axis])
}

/// The place in the middle of the angle of two ways from another, so far from both; none where it is beyond their ends.
fn between(at: [f64; 2], ways: [[f64; 2]; 2], far: f64) -> Option<[f64; 2]> {
    let lengths = ways.map(|[x, y]| x.hypot(y));
    let middle = [0, 1].map(|axis| 0.5 * (ways[0][axis] / lengths[0] + ways[1][axis] / lengths[1]));
    let cosine = middle[0].hypot(middle[1]);
    let along = far * cosine / (1.0 - cosine * cosine).max(0.0).sqrt();
    let by = along / (cosine * cosine);
    (2.0 * along < lengths[0].min(lengths[1])).then(|| [0, 1].map(|axis| at[axis] + by * middle[axis]))
}

/// A position where two edges cross, and the vectors from there to the ends of both.
struct EdgeCrossing {
    at: [f64; 2],
    to_ends: [[[f64; 2]; 2]; 2],
}

/// Where two edges cross between their ends.
fn crossing(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> Option<EdgeCrossing> {
    let u = way(one[0], one[1]);
    let v = way(other[0], other[1]);
    let apart = way(one[0], other[0]);
    let sine = cross(u, v);
    let parts = [cross(apart, v) / sine, cross(apart, u) / sine];
    let at = [0, 1].map(|axis| one[0][axis] + parts[0] * u[axis]);
    let are_inside = parts.iter().all(|part| ROUNDING < *part && *part < 1.0 - ROUNDING);
    are_inside.then(|| EdgeCrossing {
        at,
        to_ends: [one, other].map(|edge| edge.map(|end| way(at, end))),
    })
}

/// The vector from a place to another one.
fn way(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Whether every edge has as many triangles on one side as on the other.
fn closed(triangles: &[[[f64; 3]; 3]]) -> Result<(), SurfaceError> {
    let edges = edges_of(triangles);
    let open = edges.values().filter(|sides| {
        let signs = sides.iter().map(|side| if side.upwards { 1 } else { -1 });
        signs.sum::<i64>() != 0
    });
    let open: Vec<&Vec<EdgeSide>> = open.collect();
    let Some(sides) = open.first() else { return Ok(()) };
    Err(SurfaceError::Open {
        edges: open.len(),
        first: sides[0].ends,
    })
}

/// A triangle at an edge.
pub struct EdgeSide {
    /// Number of the triangle.
    pub triangle: usize,
    /// Whether the triangle goes from the first corner of the edge to the second one. Corners are numbered in the order
    /// in which the triangles name them.
    pub upwards: bool,
    /// Ends of the edge (m), in the order of the triangle.
    pub ends: [[f64; 3]; 2],
}

/// Returns the edges of triangles by the numbers of their corners, with the triangles at each edge.
pub fn edges_of(triangles: &[[[f64; 3]; 3]]) -> BTreeMap<[usize; 2], Vec<EdgeSide>> {
    let mut numbers = HashMap::new();
    let mut edges: BTreeMap<[usize; 2], Vec<EdgeSide>> = BTreeMap::new();
    for (triangle, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let ends = [corners[k], corners[(k + 1) % 3]];
            let [from, to] = ends.map(|at| {
                let next = numbers.len();
                *numbers.entry(at.map(f64::to_bits)).or_insert(next)
            });
            let sides = edges.entry([from.min(to), from.max(to)]).or_default();
            sides.push(EdgeSide {
                triangle,
                upwards: from < to,
                ends,
            });
        }
    }
    edges
}

fn bounds(triangles: &[[[f64; 3]; 3]]) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for corner in triangles.iter().flatten() {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(corner[axis]);
            bounds[1][axis] = bounds[1][axis].max(corner[axis]);
        }
    }
    bounds
}

/// The sum of the tetrahedra below the triangles, m³.
fn volume(triangles: &[[[f64; 3]; 3]], from: [f64; 3]) -> f64 {
    let six = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|corner| [0, 1, 2].map(|axis| corner[axis] - from[axis]));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    });
    six.sum::<f64>() / 6.0
}

/// How often a triangle turns around a place, seen from above. Which side of an edge a place lies on is computed alike
/// for both of its triangles, so that over a closed surface the turns sum to zero whatever the rounding.
fn around(triangle: &[[f64; 3]; 3], [x, y]: [f64; 2]) -> i32 {
    let mut turns = 0;
    for k in 0..3 {
        let [from, to] = [triangle[k], triangle[(k + 1) % 3]];
        let (low, high, sign) = if from[1] < to[1] { (from, to, 1) } else { (to, from, -1) };
        if !(low[1] <= y && y < high[1]) {
            continue;
        }
        let meets = low[0] + (y - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
        // Within the edge, so that no place is found whose bin the triangle does not reach.
        if x < meets.clamp(from[0].min(to[0]), from[0].max(to[0])) {
            turns += sign;
        }
    }
    turns
}

/// Whether a triangle stands upright but for rounding: where a line cuts it is arbitrary.
fn is_wall([a, b, c]: &[[f64; 3]; 3]) -> bool {
    let [u, v] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    normal[2].abs() <= ROUNDING * normal.iter().map(|part| part.abs()).sum::<f64>()
}

/// Height of a triangle's plane at a place, within the triangle's own.
fn height([a, b, c]: &[[f64; 3]; 3], at: [f64; 2]) -> f64 {
    let [u, v] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    let way = [at[0] - a[0], at[1] - a[1]];
    let twice = u[0] * v[1] - u[1] * v[0];
    let s = (way[0] * v[1] - way[1] * v[0]) / twice;
    let t = (u[0] * way[1] - u[1] * way[0]) / twice;
    let z = a[2] + s * u[2] + t * v[2];
    // Of a wall, whose plane has no height, the clamp is all.
    let ends = [a[2].min(b[2]).min(c[2]), a[2].max(b[2]).max(c[2])];
    if z.is_finite() {
        z.clamp(ends[0], ends[1])
    } else {
        0.5 * (ends[0] + ends[1])
    }
}

#[cfg(test)]
mod tests;
