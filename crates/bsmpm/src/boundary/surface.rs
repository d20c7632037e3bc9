//! Surface points of footings, loads and drains, and their shape functions at nodes, theory-manual equation (T6.3). All
//! ranks store all surface points; the rank of the cell computes forces.

use crate::grid::shape::with_width;
use crate::grid::{Contributions, Grid, KnotVector, digit};
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::tensor::Vector;

/// Least sum of the shape functions of the admissible nodes at a surface point; below it, no material is near enough.
/// It sets the reach beyond occupied cells: 0.75, 1.29 and 1.85 cells for degrees 1, 2 and 3. With a much shorter
/// reach, a footing would lose contact when the row of cells at its base has emptied although material points just
/// below still touch it.
const NEAR: f64 = 0.25;
/// Distance, in mean cell edges, by which a surface point may lie outside the grid because of round-off in its
/// displacement.
const ROUNDING: f64 = 1e-6;

/// A quadrature point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    /// Initial position (m), from the grid's lower corner.
    pub x: Vector<D>,
    /// Share of the area (m^(D-1)).
    pub area: f64,
    /// Corners of its piece of the surface (m), in cyclic order. A segment has each end twice, a triangle one corner
    /// twice. All equal `x` if the extent is unknown.
    pub corners: [Vector<D>; CORNERS],
}

/// Number of corners of a piece of a surface.
pub const CORNERS: usize = 4;

impl<const D: usize> SurfacePoint<D> {
    /// Creates a surface point without extent.
    pub fn at(x: Vector<D>, area: f64) -> Self {
        Self {
            x,
            area,
            corners: [x; CORNERS],
        }
    }

    /// Creates the surface point at the centroid of a triangle. The order of the corners sets the direction of the
    /// normal.
    pub fn of_triangle([a, b, c]: [Vector<D>; 3]) -> Self {
        let corners = [a, b, c, c];
        Self {
            x: (a + b + c) / 3.0,
            area: area(&corners).norm(),
            corners,
        }
    }
}

/// Returns the area vector of a piece (m^(D-1)), along its normal; in 3-D half the cross product of the diagonals.
pub(crate) fn area<const D: usize>(corners: &[Vector<D>; CORNERS]) -> Vector<D> {
    let [along, across] = [corners[2] - corners[0], corners[3] - corners[1]];
    match D {
        2 => Vector::from_fn(|axis, _| if axis == 0 { -along[1] } else { along[0] }),
        _ => Vector::from_fn(|axis, _| {
            let [i, j] = [(axis + 1) % D, (axis + 2) % D];
            0.5 * (along[i] * across[j] - along[j] * across[i])
        }),
    }
}

/// Divides a straight segment at the grid lines, divides each part into `count` equal pieces, and returns the
/// midpoints. `from` and `to` are in m from the grid's lower corner. If `count` is the number of material points across
/// a cell, both quadrature rules agree (also near an axis of symmetry), and a load balances uniform stress exactly.
pub fn along<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    from: &Vector<D>,
    to: &Vector<D>,
    count: usize,
) -> Vec<SurfacePoint<D>> {
    let length = (to - from).norm();
    let mut points = Vec::new();
    for part in cuts(grid, from, to).windows(2) {
        let share = (part[1] - part[0]) / count as f64;
        let spread = spread::<K, D>(from, to, part, count);
        for k in 0..count {
            let middle = part[0] + (k as f64 + 0.5) * share;
            let off = middle - 0.5 * (part[0] + part[1]);
            let x = from + (to - from) * (middle + off * (spread - 1.0));
            let [a, b] = [0.0, 1.0].map(|end| from + (to - from) * (part[0] + (k as f64 + end) * share));
            points.push(SurfacePoint {
                x,
                area: share * length * K::weight(&x),
                corners: [a, a, b, b],
            });
        }
    }
    points
}

/// Returns [`Kinematics::spread`] of the points of `part` of a segment; 1 if the midpoints of equal pieces are correct.
fn spread<K: Kinematics<D>, const D: usize>(from: &Vector<D>, to: &Vector<D>, part: &[f64], count: usize) -> f64 {
    let mut spread = 1.0;
    for axis in 0..D {
        let [a, b] = [part[0], part[1]].map(|share| from[axis] + (to[axis] - from[axis]) * share);
        if a != b {
            spread *= K::spread(axis, [a.min(b), a.max(b)], count);
        }
    }
    spread
}

/// Divides an axis-parallel rectangle at the grid lines, divides each part into `count` by `count` equal pieces, and
/// returns their midpoints. The box from `lower` to `upper` (m from the grid's lower corner) has no extent along one
/// axis.
pub fn over<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    lower: &Vector<D>,
    upper: &Vector<D>,
    count: usize,
) -> Vec<SurfacePoint<D>> {
    let pieces = pieces(grid, lower, upper, count).into_iter();
    let weighed = pieces.map(|(point, edges)| SurfacePoint {
        area: point.area * K::weight(&point.x),
        corners: corners(&point.x, &edges),
        ..point
    });
    weighed.collect()
}

/// Returns the corners of an axis-parallel rectangle (m).
fn corners<const D: usize>(middle: &Vector<D>, edges: &Vector<D>) -> [Vector<D>; CORNERS] {
    let [a, b] = [-0.5, 0.5].map(|end| middle + edges * end);
    let mut corners = [a, a, b, b];
    if let Some(axis) = (0..D).find(|&axis| a[axis] != b[axis]).filter(|_| D == 3) {
        (corners[1][axis], corners[3][axis]) = (b[axis], a[axis]);
    }
    corners
}

/// Returns the pieces of [`over`] without geometry weight, and their edges (m).
fn pieces<const D: usize>(
    grid: &Grid<D>,
    lower: &Vector<D>,
    upper: &Vector<D>,
    count: usize,
) -> Vec<(SurfacePoint<D>, Vector<D>)> {
    let mut pieces = vec![(SurfacePoint::at(*lower, 1.0), Vector::zeros())];
    for axis in (0..D).filter(|&axis| upper[axis] > lower[axis]) {
        let mut end = *lower;
        end[axis] = upper[axis];
        let line = along_axis(grid, lower, &end, axis, count);
        let mut finer = Vec::with_capacity(pieces.len() * line.len());
        for (point, edges) in pieces {
            for &(at, length) in &line {
                let mut x: Vector<D> = point.x;
                let mut edges: Vector<D> = edges;
                x[axis] = at;
                edges[axis] = length;
                finer.push((SurfacePoint::at(x, point.area * length), edges));
            }
        }
        pieces = finer;
    }
    pieces
}

/// Number of parallel strips by which the area of a piece inside a disc is integrated.
const STRIPS: usize = 64;

/// Returns the surface points of the part of a rectangle inside a disc about `center` (m) with `radius` (m); see
/// [`over`]. A piece that the rim cuts counts with its area inside the disc, at the centroid of that area.
pub fn within<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    lower: &Vector<D>,
    upper: &Vector<D>,
    center: &Vector<D>,
    radius: f64,
    count: usize,
) -> Vec<SurfacePoint<D>> {
    let mut plane = (0..D).filter(|axis| lower[*axis] < upper[*axis]);
    let Some(a) = plane.next() else { return Vec::new() };
    let Some(b) = plane.next() else { return Vec::new() };
    let mut points = Vec::new();
    for (piece, edges) in pieces(grid, lower, upper, count) {
        // The mean of both directions keeps the symmetry of the disc.
        let [one, other] = [[a, b], [b, a]].map(|axes| inside_disc(&piece, &edges, center, radius, axes));
        let area = 0.5 * (one.area + other.area);
        if area > 0.0 {
            let moment = 0.5 * (one.moment + other.moment);
            let mut x = piece.x;
            x[a] = moment[a] / area;
            x[b] = moment[b] / area;
            points.push(SurfacePoint {
                x,
                area: area * K::weight(&x),
                corners: corners(&piece.x, &edges),
            });
        }
    }
    points
}

/// Area and first moment of the part of a piece inside a disc.
struct DiscPart<const D: usize> {
    area: f64,         // m2
    moment: Vector<D>, // m3
}

/// Integrates the area and the first moment of the part of a piece inside a disc, with strips across the first of two
/// axes.
fn inside_disc<const D: usize>(
    piece: &SurfacePoint<D>,
    edges: &Vector<D>,
    center: &Vector<D>,
    radius: f64,
    [across, along]: [usize; 2],
) -> DiscPart<D> {
    let width = edges[across] / STRIPS as f64;
    let mut area = 0.0;
    let mut moment = Vector::<D>::zeros();
    for strip in 0..STRIPS {
        let x = piece.x[across] - 0.5 * edges[across] + (strip as f64 + 0.5) * width;
        let half = (radius.powi(2) - (x - center[across]).powi(2)).max(0.0).sqrt();
        let [from, to] = [-1.0, 1.0]
            .map(|side| (center[along] + side * half - piece.x[along]).clamp(-0.5 * edges[along], 0.5 * edges[along]));
        let part = width * (to - from);
        area += part;
        moment[across] += part * x;
        moment[along] += part * (piece.x[along] + 0.5 * (from + to));
    }
    DiscPart { area, moment }
}

/// Returns the midpoints and lengths of the pieces of an axis-parallel edge (m).
fn along_axis<const D: usize>(
    grid: &Grid<D>,
    from: &Vector<D>,
    to: &Vector<D>,
    axis: usize,
    count: usize,
) -> Vec<(f64, f64)> {
    let start = from[axis];
    let length = to[axis] - from[axis];
    let mut pieces = Vec::new();
    for part in cuts(grid, from, to).windows(2) {
        let share = (part[1] - part[0]) / count as f64;
        for k in 0..count {
            let middle = start + length * (part[0] + (k as f64 + 0.5) * share);
            pieces.push((middle, length * share));
        }
    }
    pieces
}

/// Returns the parameters (0 to 1) at which the grid lines cut a straight segment, including its ends.
fn cuts<const D: usize>(grid: &Grid<D>, from: &Vector<D>, to: &Vector<D>) -> Vec<f64> {
    let mut cuts = vec![0.0, 1.0];
    for (axis, knots) in grid.axes().iter().enumerate() {
        let reach = to[axis] - from[axis];
        if reach != 0.0 {
            let places = (0..=knots.cells()).map(|i| (knots.breakpoint(i) - from[axis]) / reach);
            cuts.extend(places.filter(|s| *s > 0.0 && *s < 1.0));
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < 1e-9);
    cuts
}

/// Ids of the material points that anchor all surface points; the same on every rank, empty before the first step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Anchors {
    /// Per strip and surface point.
    pub strips: Vec<Vec<u64>>,
    /// Per load and surface point.
    pub loads: Vec<Vec<u64>>,
    /// Per drain, then per inflow, and surface point.
    pub water: Vec<Vec<u64>>,
}

/// Interpolation of nodal values at a surface point by the admissible nodes of its cell.
#[derive(Clone, Debug)]
pub struct Attachment {
    first_node: usize,
    N: Vec<f64>, // shape functions, zero at other nodes, sum 1
}

impl Attachment {
    /// Attaches the surface point at `x` (m) to the nodes for which `counts` is true. Returns `None` if another rank
    /// owns its cell, or too few such nodes are near.
    pub fn at<const D: usize>(
        grid: &Grid<D>,
        offsets: &[usize],
        counts: impl Fn(usize) -> bool,
        x: &Vector<D>,
    ) -> Option<Self> {
        Self::by(grid, grid.order() + 1, offsets, counts, x)
    }

    /// As [`Self::at`], with the functions of degree q - 1 and their own `offsets` ([`Grid::lowered_offsets`]).
    pub fn lowered_at<const D: usize>(
        grid: &Grid<D>,
        offsets: &[usize],
        counts: impl Fn(usize) -> bool,
        x: &Vector<D>,
    ) -> Option<Self> {
        Self::by(grid, grid.order(), offsets, counts, x)
    }

    /// Returns the nodes and their weights. `offsets` must be those used at creation.
    pub fn weights<'a>(&'a self, offsets: &'a [usize]) -> impl Iterator<Item = (usize, f64)> + 'a {
        offsets
            .iter()
            .zip(&self.N)
            .filter(|(_, N)| **N != 0.0)
            .map(|(offset, N)| (self.first_node + offset, *N))
    }

    fn by<const D: usize>(
        grid: &Grid<D>,
        width: usize,
        offsets: &[usize],
        counts: impl Fn(usize) -> bool,
        x: &Vector<D>,
    ) -> Option<Self> {
        let x = on_grid(grid, x);
        let cell = grid.locate(&x).filter(|cell| grid.holds(cell))?;
        let first_node = grid.first_node(&cell);
        let rows = (0..D).map(|axis| values(&grid.axes()[axis], width, x[axis], cell[axis]));
        let rows: Vec<Vec<f64>> = rows.collect();
        let mut N = vec![0.0; offsets.len()];
        for (k, (value, offset)) in N.iter_mut().zip(offsets).enumerate() {
            if counts(first_node + offset) {
                *value = (0..D).map(|axis| rows[axis][digit::<D>(k, axis, width)]).product();
            }
        }
        let sum: f64 = N.iter().sum();
        if sum < NEAR {
            return None;
        }
        N.iter_mut().for_each(|value| *value /= sum);
        Some(Self { first_node, N })
    }

    /// Returns the first node of the cell, to which the grid's offsets are added.
    pub fn first_node(&self) -> usize {
        self.first_node
    }

    /// Returns N_I of the cell's nodes.
    pub fn N(&self) -> &[f64] {
        &self.N
    }

    /// Interpolates a nodal array with one number per node: sum_I N_I p_I.
    pub fn value(&self, offsets: &[usize], nodal: &[f64]) -> f64 {
        self.N
            .iter()
            .zip(offsets)
            .map(|(N, offset)| N * nodal[self.first_node + offset])
            .sum()
    }

    /// Adds N_I `value` to the last number of every node.
    pub fn scatter_value(&self, offsets: &[usize], value: f64, out: &mut Contributions) {
        let width = out.width();
        let out = out.patch(self.first_node);
        for (N, offset) in self.N.iter().zip(offsets) {
            out[offset * width + width - 1] += N * value;
        }
    }

    /// Interpolates the nodal displacement: sum_I N_I u_I (m).
    pub fn displacement<const D: usize>(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mut sum = Vector::zeros();
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                sum[component] += N * u[Nodal::<D>::at(self.first_node + offset, component)];
            }
        }
        sum
    }

    /// Adds N_I `force` to the nodes.
    pub fn scatter<const D: usize>(&self, offsets: &[usize], force: &Vector<D>, out: &mut Contributions) {
        let out = out.patch(self.first_node);
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                out[Nodal::<D>::at(*offset, component)] += N * force[component];
            }
        }
    }
}

/// Returns `x`, or its projection onto a face if it lies outside by round-off.
pub(crate) fn on_grid<const D: usize>(grid: &Grid<D>, x: &Vector<D>) -> Vector<D> {
    let mut inside = *x;
    for (x, knots) in inside.iter_mut().zip(grid.axes()) {
        let nearest = x.clamp(0.0, knots.length());
        let slack = ROUNDING * knots.length() / knots.cells() as f64;
        if (*x - nearest).abs() <= slack {
            *x = nearest;
        }
    }
    inside
}

/// Returns the values of the `width` functions of a cell of one axis.
fn values(axis: &KnotVector, width: usize, x: f64, cell: usize) -> Vec<f64> {
    with_width!(lowered width, W => axis.basis::<W>(x, cell).0.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::KnotVector;
    use crate::kinematics::Solid;

    /// Between lines, across them, and within a piece of a cell.
    #[test]
    fn the_points_of_a_disc_have_its_area_and_its_middle() {
        let grid = Grid::<3>::new([0; 3].map(|_| KnotVector::uniform(0.5, 8, 2).unwrap())).unwrap();
        for (center, radius) in [
            ([2.0, 2.0], 1.0),
            ([2.1, 1.9], 0.4),
            ([2.1, 1.9], 0.12),
            ([2.03, 1.95], 0.02),
        ] {
            let center = Vector::<3>::new(center[0], center[1], 1.0);
            let [lower, upper] = [-radius, radius].map(|by| center + Vector::<3>::new(by, by, 0.0));
            let points = within::<Solid, 3>(&grid, &lower, &upper, &center, radius, 4);
            let area: f64 = points.iter().map(|point| point.area).sum();
            let middle = points.iter().map(|point| point.x * point.area).sum::<Vector<3>>() / area;
            assert!(
                (area / (std::f64::consts::PI * radius.powi(2)) - 1.0).abs() < 3e-4,
                "{area}"
            );
            assert!((middle - center).norm() < 1e-3 * radius, "{middle}");
        }
    }
}
