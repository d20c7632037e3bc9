//! Displacement between adjacent footings that move differently.

use bsmpm::boundary::SurfacePoint;
use bsmpm::boundary::surface::Attachment;
use bsmpm::grid::Grid;
use bsmpm::interactions::strip::{MotionShare, Strip};
use bsmpm::tensor::Vector;
use std::collections::BTreeMap;

/// Distance in cells below which two strips meet.
const NEAR: f64 = 1.0 - 1e-6;
/// Part of the sum of two distances below which they are equal.
const EQUAL: f64 = 1e-6;
/// Parts of the shortest cell by which strips may miss a common plane, and motions differ, by rounding.
pub(crate) const ROUNDING: f64 = 1e-6;
/// The same of the cosine between two normals.
const PARALLEL: f64 = 1e-9;

/// A strip as those that it may meet see it.
pub(crate) struct Neighbour<const D: usize> {
    /// unit normal of its surface
    pub normal: Vector<D>,
    /// since when it acts, s; `None` if it does not
    pub since: Option<f64>,
}

/// Lets the points of strips that meet and move differently follow the motions of both.
pub(super) fn connect<const D: usize>(strips: &mut [Strip<D>], neighbours: &[Neighbour<D>], grid: &Grid<D>) {
    let transitions: Vec<BTreeMap<usize, Vec<MotionShare<D>>>> = (0..strips.len())
        .map(|number| transitions(number, strips, neighbours, grid))
        .collect();
    strips
        .iter_mut()
        .zip(transitions)
        .for_each(|(strip, transitions)| strip.transitions = transitions);
}

/// Points of strip `number` near others that it meets and that move differently, with the parts of these.
fn transitions<const D: usize>(
    number: usize,
    strips: &[Strip<D>],
    neighbours: &[Neighbour<D>],
    grid: &Grid<D>,
) -> BTreeMap<usize, Vec<MotionShare<D>>> {
    let strip = &strips[number];
    let own = &neighbours[number];
    let others = (0..strips.len()).filter(|other| {
        let is_alike = neighbours[*other].since == own.since && own.since.is_some();
        *other != number && is_alike && meet(strip, &strips[*other], [own, &neighbours[*other]], grid)
    });
    let others: Vec<usize> = others.collect();
    let mut transitions = BTreeMap::new();
    let reach = grid.order() as f64 + 1.0;
    for (point, SurfacePoint { x, .. }) in strip.points.iter().enumerate() {
        if others
            .iter()
            .all(|other| distance_in_cells(x, &strips[*other], grid) >= reach)
        {
            continue;
        }
        let mut shares = shares_at(x, number, &others, strips, grid);
        for share in &mut shares {
            let holds_all = [strip, &strips[share.strip]].iter().all(|strip| holds_all(strip));
            share.normal = (!holds_all).then_some(own.normal);
        }
        if !shares.is_empty() {
            transitions.insert(point, shares);
        }
    }
    transitions
}

/// m  largest difference between the motions of two strips at an angle in a component that both hold; `None` where they
/// do not share a corner.
pub(crate) fn apart_at_corner<const D: usize>(
    strip: &Strip<D>,
    other: &Strip<D>,
    neighbours: [&Neighbour<D>; 2],
    grid: &Grid<D>,
) -> Option<f64> {
    let [own_normal, other_normal] = neighbours.map(|neighbour| neighbour.normal);
    let is_at_angle = own_normal.dot(&other_normal).abs() <= 1.0 - PARALLEL;
    let edge = grid.smallest_edge();
    let mut corners = corners(strip);
    if !is_at_angle || !corners.any(|corner| distance_in_cells(&corner, other, grid) < ROUNDING) {
        return None;
    }
    let mut apart = 0.0_f64;
    for (t, _) in strip.path.rows.iter().chain(&other.path.rows) {
        let difference = strip.path.at(*t) - other.path.at(*t);
        apart = apart.max(match (holds_all(strip), holds_all(other)) {
            (true, true) => difference.norm(),
            (true, false) => difference.dot(&other_normal).abs(),
            (false, true) => difference.dot(&own_normal).abs(),
            (false, false) => 0.0,
        });
    }
    (apart > ROUNDING * edge).then_some(apart)
}

/// Whether a strip holds all components of the soil's motion.
pub(crate) fn holds_all<const D: usize>(strip: &Strip<D>) -> bool {
    strip.normal.is_none() && strip.contact.is_none()
}

/// Whether two strips lie in one plane, less than a cell apart, and hold one component to different motions.
pub(crate) fn meet<const D: usize>(
    strip: &Strip<D>,
    other: &Strip<D>,
    neighbours: [&Neighbour<D>; 2],
    grid: &Grid<D>,
) -> bool {
    let normal = neighbours[0].normal;
    let is_parallel = normal.dot(&neighbours[1].normal).abs() > 1.0 - PARALLEL;
    let edge = grid.smallest_edge();
    let is_one_plane = is_parallel && (strip.points[0].x - other.points[0].x).dot(&normal).abs() < ROUNDING * edge;
    let all = holds_all(strip) && holds_all(other);
    let times = strip.path.rows.iter().chain(&other.path.rows).map(|(t, _)| *t);
    let mut differences = times.map(|t| strip.path.at(t) - other.path.at(t));
    is_one_plane
        && differences.any(|by| if all { by.norm() } else { by.dot(&normal).abs() } > ROUNDING * edge)
        && corners(strip).any(|corner| distance_in_cells(&corner, other, grid) < NEAR)
}

/// Parts of the motions of `others` at a place of strip `number`: sums of the functions there, each of which belongs to
/// the strip that is nearest to its node, or in equal parts to those that are equally near.
fn shares_at<const D: usize>(
    x: &Vector<D>,
    number: usize,
    others: &[usize],
    strips: &[Strip<D>],
    grid: &Grid<D>,
) -> Vec<MotionShare<D>> {
    let offsets = grid.offsets();
    let Some(attachment) = Attachment::at(grid, &offsets, |_| true, x) else {
        return Vec::new();
    };
    let mut sums = vec![0.0; others.len()];
    for (value, offset) in attachment.N().iter().zip(&offsets) {
        let node = node_place(grid, attachment.first_node() + offset);
        let own = distance(&node, &strips[number]);
        let distances: Vec<f64> = others.iter().map(|other| distance(&node, &strips[*other])).collect();
        let nearest = distances.iter().copied().fold(own, f64::min);
        let is_nearest = |distance: f64| distance - nearest <= EQUAL * (distance + nearest);
        let count = usize::from(is_nearest(own)) + distances.iter().filter(|distance| is_nearest(**distance)).count();
        for (sum, distance) in sums.iter_mut().zip(distances) {
            *sum += if is_nearest(distance) {
                value / count as f64
            } else {
                0.0
            };
        }
    }
    let shares = others.iter().zip(sums).filter(|(_, share)| *share > 0.0);
    shares
        .map(|(strip, share)| MotionShare {
            strip: *strip,
            share,
            normal: None,
        })
        .collect()
}

/// m  where a node's function has its Greville point
fn node_place<const D: usize>(grid: &Grid<D>, node: usize) -> Vector<D> {
    let place = grid.node_at(node);
    Vector::from_fn(|axis, _| grid.axes()[axis].greville(place[axis]))
}

/// m  distance of a place from a strip
fn distance<const D: usize>(x: &Vector<D>, strip: &Strip<D>) -> f64 {
    corners(strip)
        .map(|corner| (corner - x).norm())
        .fold(f64::INFINITY, f64::min)
}

/// Distance of a place from a strip along the axis where it is largest, in edges of the place's cell.
fn distance_in_cells<const D: usize>(x: &Vector<D>, strip: &Strip<D>, grid: &Grid<D>) -> f64 {
    let edges = grid
        .locate(x)
        .map_or_else(|| Vector::repeat(grid.smallest_edge()), |cell| grid.cell_box(&cell).1);
    corners(strip)
        .map(|corner| (corner - x).component_div(&edges).amax())
        .fold(f64::INFINITY, f64::min)
}

/// Corners of the pieces that a strip's points stand for.
fn corners<const D: usize>(strip: &Strip<D>) -> impl Iterator<Item = Vector<D>> + '_ {
    strip.points.iter().flat_map(|point| point.corners)
}
