//! A 3-D body bounded by triangles. Computes which intervals of vertical lines are inside the body.

use std::collections::{BTreeMap, HashMap};

/// Parts of its size by which a surface may overlap itself: rounding of where its lines are cut.
const ROUNDING: f64 = 1e-9;
/// Parts of its width by which a line that is tried passes the edges at a corner or a crossing: what single precision,
/// in which files often are, makes touching parts overlap by is less.
const BESIDE: f64 = 1e-5;

/// Triangles, counter-clockwise seen from outside, and the bins of the plane by which a vertical line finds its own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Surface {
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

    /// Of rows of nine numbers, the corners of a triangle each; which way all of them turn does not matter. Says what
    /// is wrong with them.
    pub(crate) fn new(rows: impl Iterator<Item = [f64; 9]>) -> Result<Self, String> {
        // -0 and 0 are one place.
        let mut triangles: Vec<[[f64; 3]; 3]> = rows
            .map(|row| [0, 1, 2].map(|k| [0, 1, 2].map(|axis| row[3 * k + axis] + 0.0)))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        if triangles.is_empty() {
            return Err(
                "E0034: no triangle of the surface has three different corners, so the surface has no area. Correct \
                 the triangles or their file."
                    .into(),
            );
        }
        closed(&triangles)?;
        let bounds = bounds(&triangles);
        let volume = volume(&triangles, bounds[0]);
        let size: f64 = (0..3).map(|axis| bounds[1][axis] - bounds[0][axis]).product();
        if volume.abs() <= ROUNDING * size {
            return Err("E0034: the surface encloses no volume. Export a closed surface.".into());
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

    /// Lower and upper corner of the cuboid around it.
    pub(crate) fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    /// m³  that it encloses
    pub(crate) fn volume(&self) -> f64 {
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
    fn simple(&self) -> Result<(), String> {
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
                let Some((at, [u, v])) = crossing(one, other) else {
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
    fn is_simple(&self, at: [f64; 2]) -> Result<(), String> {
        let height = self.bounds[1][2] - self.bounds[0][2];
        let mut depth = 0;
        let mut last = f64::NEG_INFINITY;
        for (z, crossing) in self.crossings(at) {
            if !(0..=1).contains(&depth) && z - last > ROUNDING * height {
                let [x, y] = at;
                return Err(format!(
                    "E0035: the surface intersects itself, or has normals that point inwards, near [{x:.6}, {y:.6}, \
                     {z:.6}] m. Repair the surface with a mesh tool."
                ));
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

/// Where two edges cross between their ends, and the ways from there to the ends of both.
#[allow(clippy::type_complexity)]
fn crossing(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> Option<([f64; 2], [[[f64; 2]; 2]; 2])> {
    let u = way(one[0], one[1]);
    let v = way(other[0], other[1]);
    let apart = way(one[0], other[0]);
    let sine = cross(u, v);
    let parts = [cross(apart, v) / sine, cross(apart, u) / sine];
    let at = [0, 1].map(|axis| one[0][axis] + parts[0] * u[axis]);
    let are_inside = parts.iter().all(|part| ROUNDING < *part && *part < 1.0 - ROUNDING);
    are_inside.then(|| (at, [one, other].map(|edge| edge.map(|end| way(at, end)))))
}

/// The vector from a place to another one.
fn way(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Whether every edge has as many triangles on one side as on the other.
fn closed(triangles: &[[[f64; 3]; 3]]) -> Result<(), String> {
    let edges = edges_of(triangles);
    let open = edges.values().filter(|sides| {
        let signs = sides.iter().map(|side| if side.upwards { 1 } else { -1 });
        signs.sum::<i64>() != 0
    });
    let open: Vec<&Vec<EdgeSide>> = open.collect();
    let Some(sides) = open.first() else { return Ok(()) };
    let open = open.len();
    Err(format!(
        "E0034: the surface is not closed at {open} edges, first at the edge from {:?} to {:?} m. Weld vertices, \
         fill holes and make normals consistent with a mesh tool.",
        sides[0].ends[0], sides[0].ends[1]
    ))
}

/// A triangle at an edge.
pub(crate) struct EdgeSide {
    /// its number
    pub(crate) triangle: usize,
    /// whether it turns from the edge's first corner to its second, in the order of corners in the file
    pub(crate) upwards: bool,
    /// m  the edge's ends, as the triangle turns
    pub(crate) ends: [[f64; 3]; 2],
}

/// Edges by the numbers of their corners, with the triangles at them.
pub(crate) fn edges_of(triangles: &[[[f64; 3]; 3]]) -> BTreeMap<[usize; 2], Vec<EdgeSide>> {
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
mod tests {
    use super::*;

    /// A cuboid's twelve triangles, outwards.
    fn cuboid(lower: [f64; 3], upper: [f64; 3]) -> Vec<[f64; 9]> {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { lower[axis] } else { upper[axis] });
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        halves
            .map(|half| half.map(corner).concat().try_into().unwrap())
            .collect()
    }

    fn turned(rows: Vec<[f64; 9]>) -> Vec<[f64; 9]> {
        rows.into_iter()
            .map(|[a, b, c, d, e, f, g, h, i]| [a, b, c, g, h, i, d, e, f])
            .collect()
    }

    fn surface(rows: Vec<[f64; 9]>) -> Result<Surface, String> {
        Surface::new(rows.into_iter())
    }

    #[test]
    fn what_a_cuboid_with_a_cavity_encloses_is_exact() {
        let shell = cuboid([1.0, 2.0, 3.0], [4.0, 4.0, 7.0]);
        let cavity = turned(cuboid([2.0, 2.5, 4.0], [3.0, 3.5, 5.0]));
        for rows in [
            [shell.clone(), cavity.clone()].concat(),
            turned([shell, cavity].concat()),
        ] {
            let found = surface(rows).unwrap();
            assert!((found.volume() - 23.0).abs() < 1e-12);
            assert_eq!(found.bounds(), [[1.0, 2.0, 3.0], [4.0, 4.0, 7.0]]);
            // On the diagonals of the faces, on edges below (inside) and above (outside), and beside.
            assert_eq!(found.vertical([2.5, 3.0]), [[3.0, 4.0], [5.0, 7.0]]);
            assert_eq!(found.vertical([1.5, 3.9]), [[3.0, 7.0]]);
            assert_eq!(found.vertical([1.0, 2.0]), [[3.0, 7.0]]);
            assert!(found.vertical([4.0, 3.0]).is_empty() && found.vertical([0.9, 3.0]).is_empty());
            let moved = found.moved([1.0, -1.0, 0.5]);
            assert_eq!(moved.vertical([3.5, 2.0]), [[3.5, 4.5], [5.5, 7.5]]);
        }
    }

    #[test]
    fn lines_through_corners_and_edges_of_any_surface_enter_as_often_as_they_leave() {
        // A bumpy sphere whose corners have no round numbers.
        let around_it = 24;
        let up = 12;
        let at = |i: usize, j: usize| {
            let phi = std::f64::consts::TAU * (i % around_it) as f64 / around_it as f64;
            let theta = std::f64::consts::PI * j as f64 / up as f64;
            let r = if j.is_multiple_of(up) {
                1.3
            } else {
                1.0 + 0.3 * (3.0 * phi).sin() * theta.sin().powi(2)
            };
            let flat = if j.is_multiple_of(up) { 0.0 } else { r * theta.sin() };
            [flat * phi.cos(), flat * phi.sin(), r * theta.cos()]
        };
        let quads = (0..around_it).flat_map(|i| (0..up).map(move |j| [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]));
        let halves = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let rows = halves
            .map(|half| half.map(|(i, j)| at(i, j)).concat().try_into().unwrap())
            .collect();
        let found = surface(rows).unwrap();
        let corners: Vec<[f64; 3]> = found.triangles.iter().flatten().copied().collect();
        let middles = found.triangles.iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
        let middles = middles.map(|[a, b]| [0, 1].map(|axis| 0.5 * (a[axis] + b[axis])));
        for place in corners.iter().map(|at| [at[0], at[1]]).chain(middles) {
            let crossings = found.crossings(place);
            assert_eq!(crossings.iter().map(|(_, turns)| turns).sum::<i32>(), 0, "{place:?}");
            assert!(crossings.len().is_multiple_of(2));
        }
    }

    /// Two cuboids, turned about a vertical, of which one stands at a part of the other's wall, in single precision.
    #[test]
    fn shells_that_touch_but_for_rounding_are_one_body_and_those_that_overlap_are_none() {
        for (k, overlap) in (0..400).flat_map(|k| [0.0, 1e-3].map(|overlap| (k, overlap))) {
            let angle = 0.0157 * f64::from(k) + 0.01;
            let thick = if k % 2 == 0 { 0.05 } else { 0.5 };
            let (sin, cos) = angle.sin_cos();
            let placed = |row: [f64; 9]| {
                let corner = |k: usize| {
                    let [x, y, z] = [row[3 * k], row[3 * k + 1], row[3 * k + 2]];
                    [10.3 + cos * x - sin * y, 7.7 + sin * x + cos * y, z].map(|at| f64::from(at as f32))
                };
                [0, 1, 2].map(corner).concat().try_into().unwrap()
            };
            let wall = cuboid([0.0; 3], [3.0, thick, 1.0]);
            let beside = cuboid([0.7, thick - overlap, 0.0], [1.9, thick + 0.3, 1.0]);
            let found = surface([wall, beside].concat().into_iter().map(placed).collect());
            assert_eq!(found.is_ok(), overlap == 0.0, "{k}: {:?}", found.err());
        }
    }

    #[test]
    fn two_cuboids_that_share_lines_are_reported_apart_from_two_that_overlap() {
        let spans =
            [[0.0, 1.0], [0.0, 2.0], [0.0, 3.0], [1.0, 2.0], [1.0, 3.0], [2.0, 3.0]].map(|ends| ends.map(|x| x / 3.0));
        let one = [[1.0, 2.0], [0.0, 2.0], [1.0, 3.0]].map(|ends: [f64; 2]| ends.map(|x| x / 3.0));
        for number in 0..216 {
            let other = [number % 6, number / 6 % 6, number / 36].map(|k| spans[k]);
            let overlap = (0..3).all(|axis| one[axis][0] < other[axis][1] && other[axis][0] < one[axis][1]);
            let rows = [one, other]
                .map(|spans| cuboid(spans.map(|ends| ends[0]), spans.map(|ends| ends[1])))
                .concat();
            assert_eq!(surface(rows).is_err(), overlap, "{other:?}");
        }
    }

    #[test]
    fn what_is_no_closed_surface_is_refused() {
        let says = |rows: Vec<[f64; 9]>, what: &str| {
            let message = surface(rows).unwrap_err();
            assert!(message.contains(what), "{message}");
        };
        let block = cuboid([0.0; 3], [1.0; 3]);
        says(Vec::new(), "no triangle");
        says(block[1..].to_vec(), "not closed at 3 edges");
        let mut one_turned = block.clone();
        one_turned[..1].clone_from_slice(&turned(block[..1].to_vec()));
        says(one_turned, "not closed at 3 edges");
        says([block.clone(), turned(block.clone())].concat(), "encloses no volume");
        says(
            [block.clone(), cuboid([0.5; 3], [1.5; 3])].concat(),
            "intersects itself",
        );
        says(
            [block.clone(), turned(cuboid([2.0; 3], [2.5; 3]))].concat(),
            "normals that point inwards",
        );
        // Blocks with sides in common that overlap by little, and bars across each other, with sides in common and not.
        says(
            [block.clone(), cuboid([0.99, 0.0, 0.0], [1.99, 1.0, 1.0])].concat(),
            "intersects itself",
        );
        says(
            [block.clone(), cuboid([0.3, 0.2, 0.99], [0.4, 0.5, 2.0])].concat(),
            "intersects itself",
        );
        let bar = cuboid([0.0, 1.45, 0.0], [30.0, 1.5, 1.0]);
        for top in [1.0, 2.0] {
            says(
                [bar.clone(), cuboid([14.9, 0.0, 0.0], [15.1, 3.0, top])].concat(),
                "intersects itself",
            );
        }
        says(
            [bar, cuboid([14.9, 0.0, 0.4], [15.1, 3.0, 0.6])].concat(),
            "intersects itself",
        );
        // Blocks that only touch are fine.
        let both = surface([block, cuboid([0.0, 0.0, 1.0], [1.0, 1.0, 2.0])].concat()).unwrap();
        assert!((both.volume() - 2.0).abs() < 1e-12);
    }
}
