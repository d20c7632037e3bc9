//! Surface points of footings, loads and drains, and their shape functions at nodes, theory-manual equation (T6.3). All
//! ranks store all surface points; the rank of the cell computes forces.

use super::rigid::RigidState;
use crate::grid::shape::with_width;
use crate::grid::{Contributions, Grid, KnotVector, digit};
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::tensor::Vector;
use crate::water::crossed::{CumulativeFlux, PreviousFlow};

/// Share of a surface point's shape functions that the nodes that count must have: below it no material is near enough.
/// It sets the reach beyond the cells that hold points: 0.75, 1.29 and 1.85 cells for the orders 1, 2 and 3. With a
/// much shorter one a strip would let go where the row of cells at it has emptied while the points below are still at
/// its base.
const NEAR: f64 = 0.25;
/// Parts of a mean cell by which a surface point may lie outside the grid and still be on its face: rounding of what
/// it has moved.
const ROUNDING: f64 = 1e-6;

/// A point of a surface with its share of the area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    /// m  position at the start, from the grid's lower corner
    pub x: Vector<D>,
    /// m^(D-1)  share of the area
    pub area: f64,
    /// m  corners of the piece that it stands for, in turn: of a segment each end twice, of a triangle one of them; all
    /// the point itself where nothing is reported
    pub corners: [Vector<D>; CORNERS],
}

/// Corners of a piece of a surface.
pub const CORNERS: usize = 4;

impl<const D: usize> SurfacePoint<D> {
    /// A point of a surface whose extent is of no concern.
    pub fn at(x: Vector<D>, area: f64) -> Self {
        Self {
            x,
            area,
            corners: [x; CORNERS],
        }
    }

    /// In the middle of a triangle, whose turn its corners have.
    pub fn of_triangle([a, b, c]: [Vector<D>; 3]) -> Self {
        let corners = [a, b, c, c];
        Self {
            x: (a + b + c) / 3.0,
            area: area(&corners).norm(),
            corners,
        }
    }
}

/// m^(D-1)  area of a piece, a vector along its normal: of a segment, or in space by its diagonals.
pub(super) fn area<const D: usize>(corners: &[Vector<D>; CORNERS]) -> Vector<D> {
    let [along, across] = [corners[2] - corners[0], corners[3] - corners[1]];
    match D {
        2 => Vector::from_fn(|axis, _| if axis == 0 { -along[1] } else { along[0] }),
        _ => Vector::from_fn(|axis, _| {
            let [i, j] = [(axis + 1) % D, (axis + 2) % D];
            0.5 * (along[i] * across[j] - along[j] * across[i])
        }),
    }
}

/// Points in the middles of `count` equal pieces of every part of a straight segment that the grid's lines cut off;
/// `from` and `to` in m from the grid's lower corner. With as many pieces as a cell has points across, a load is in
/// exact balance with uniform stress: the points' quadrature is the same rule, near an axis too.
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

/// [`Kinematics::spread`] of the points of a part of a segment: that along the axis along which they are others than
/// the middles of equal pieces, if there is one.
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

/// Points in the middles of `count` by `count` equal pieces of every part of a rectangle along the axes that the grid's
/// lines cut off: a box from `lower` to `upper`, m from the grid's lower corner, without extent along one axis.
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

/// Corners of a rectangle along the axes, m.
fn corners<const D: usize>(middle: &Vector<D>, edges: &Vector<D>) -> [Vector<D>; CORNERS] {
    let [a, b] = [-0.5, 0.5].map(|end| middle + edges * end);
    let mut corners = [a, a, b, b];
    if let Some(axis) = (0..D).find(|&axis| a[axis] != b[axis]).filter(|_| D == 3) {
        (corners[1][axis], corners[3][axis]) = (b[axis], a[axis]);
    }
    corners
}

/// The pieces of [`over`], and their edges, m.
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

/// Strips of a piece whose lengths inside a disc are added up.
const STRIPS: usize = 64;

/// As [`over`] of what of a rectangle is nearer to `center` than `radius`, m: pieces across the rim count with what of
/// them is, at its middle.
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
        // Both ways, so that a disc keeps its symmetry.
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

/// What of a piece is inside a disc.
struct DiscPart<const D: usize> {
    area: f64,         // m2
    moment: Vector<D>, // m3
}

/// What of a piece with these edges is inside a disc, in strips across the first of two axes.
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

/// Middles and lengths of the pieces of an edge along an axis, m.
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

/// Parts of the way along a straight segment at which the grid's lines cut it, its ends among them.
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

/// What the surfaces carry from step to step; the same on every rank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface<const D: usize> {
    /// Pa  traction of every strip on the body at its points, in the last converged state; of points that are off the
    /// material the penalty times what they are ahead of it (see [`strip`](super::strip))
    pub traction: Vec<Vec<Vector<D>>>,
    /// m  position of every load's points, which move with the material that they are anchored to
    pub position: Vec<Vec<Vector<D>>>,
    /// Pa  of every load that follows the surface its traction when fully applied, per area of the start, turned and
    /// stretched with the material (see [`follower`](super::load::follower)); empty for the others
    pub pressure: Vec<Vec<Vector<D>>>,
    /// that material
    pub anchors: Anchors,
    /// N  of every node of every absorbing face (numbered on the face of the whole grid) what holds the state of the
    /// start; empty without such a state
    pub held: Vec<Vec<Vector<D>>>,
    /// motions of every rigid body
    pub bodies: Vec<RigidState>,
    /// water that has gone through drains and inflows since the start
    pub crossed: CumulativeFlux,
    /// what flowed in the last step, where the next one goes on with it
    pub flowed: Option<PreviousFlow>,
}

/// Ids of the points that the points of all surfaces are anchored to; the same on every rank, and empty before the
/// first step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Anchors {
    /// per strip and point of it
    pub strips: Vec<Vec<u64>>,
    /// per load and point of it
    pub loads: Vec<Vec<u64>>,
    /// per drain and then per inflow, and point of it
    pub water: Vec<Vec<u64>>,
}

/// A surface point as some nodes of its cell see it.
#[derive(Clone, Debug)]
pub struct Attachment {
    first_node: usize,
    N: Vec<f64>, // of the cell's functions, zero at those that do not count, sum 1
}

impl Attachment {
    /// The point at `x`, by the nodes that count; `None` where another rank has its cell, or none of them is near.
    pub fn at<const D: usize>(
        grid: &Grid<D>,
        offsets: &[usize],
        counts: impl Fn(usize) -> bool,
        x: &Vector<D>,
    ) -> Option<Self> {
        Self::by(grid, grid.order() + 1, offsets, counts, x)
    }

    /// The same by the functions of degree q - 1, which have their own `offsets` ([`Grid::lowered_offsets`]).
    pub fn lowered_at<const D: usize>(
        grid: &Grid<D>,
        offsets: &[usize],
        counts: impl Fn(usize) -> bool,
        x: &Vector<D>,
    ) -> Option<Self> {
        Self::by(grid, grid.order(), offsets, counts, x)
    }

    /// The nodes with their shares, by the `offsets` that it was made with.
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

    /// First node of the cell, from which the grid's offsets count.
    pub fn first_node(&self) -> usize {
        self.first_node
    }

    /// N_I of the cell's nodes.
    pub fn N(&self) -> &[f64] {
        &self.N
    }

    /// sum_I N_I p_I of a nodal array of one number a node.
    pub fn value(&self, offsets: &[usize], nodal: &[f64]) -> f64 {
        self.N
            .iter()
            .zip(offsets)
            .map(|(N, offset)| N * nodal[self.first_node + offset])
            .sum()
    }

    /// out_I += N_I value, the last of the numbers of every node.
    pub fn scatter_value(&self, offsets: &[usize], value: f64, out: &mut Contributions) {
        let width = out.width();
        let out = out.patch(self.first_node);
        for (N, offset) in self.N.iter().zip(offsets) {
            out[offset * width + width - 1] += N * value;
        }
    }

    /// sum_I N_I u_I, m.
    pub fn displacement<const D: usize>(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let mut sum = Vector::zeros();
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                sum[component] += N * u[Nodal::<D>::at(self.first_node + offset, component)];
            }
        }
        sum
    }

    /// out_I += N_I force.
    pub fn scatter<const D: usize>(&self, offsets: &[usize], force: &Vector<D>, out: &mut Contributions) {
        let out = out.patch(self.first_node);
        for (N, offset) in self.N.iter().zip(offsets) {
            for component in 0..D {
                out[Nodal::<D>::at(*offset, component)] += N * force[component];
            }
        }
    }
}

/// The place itself, or the place on the face that it has left by rounding.
pub(super) fn on_grid<const D: usize>(grid: &Grid<D>, x: &Vector<D>) -> Vector<D> {
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

/// Values of the `width` functions of a cell of one axis.
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
