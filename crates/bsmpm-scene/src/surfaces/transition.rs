//! Strips that meet and move differently: which part of each other's motion their points follow. See
//! [`bsmpm::boundary::strip`].

use bsmpm::boundary::surface::Attachment;
use bsmpm::boundary::{MotionShare, Strip, SurfacePoint};
use bsmpm::grid::Grid;
use bsmpm::tensor::Vector;
use std::collections::BTreeMap;

/// Distance in cells below which two strips meet.
const NEAR: f64 = 1.0 - 1e-6;
/// Part of the sum of two distances below which they are equal.
const EQUAL: f64 = 1e-6;

/// Lets the points of strips that meet and move differently follow the motions of both.
pub(super) fn connect<const D: usize>(strips: &mut [Strip<D>], grid: &Grid<D>) {
    let transitions: Vec<BTreeMap<usize, Vec<MotionShare>>> =
        (0..strips.len()).map(|number| transitions(number, strips, grid)).collect();
    strips.iter_mut().zip(transitions).for_each(|(strip, transitions)| strip.transitions = transitions);
}

/// Points of strip `number` near others that it meets and that move differently, with the parts of these.
fn transitions<const D: usize>(
    number: usize,
    strips: &[Strip<D>],
    grid: &Grid<D>,
) -> BTreeMap<usize, Vec<MotionShare>> {
    let strip = &strips[number];
    let is_met =
        |other: &usize| *other != number && contradict(strip, &strips[*other]) && meet(strip, &strips[*other], grid);
    let others: Vec<usize> = (0..strips.len()).filter(is_met).collect();
    let mut transitions = BTreeMap::new();
    let reach = grid.order() as f64 + 1.0;
    for (point, SurfacePoint { x, .. }) in strip.points.iter().enumerate() {
        if others.iter().all(|other| distance_in_cells(x, &strips[*other], grid) >= reach) {
            continue;
        }
        let shares = shares_at(x, number, &others, strips, grid);
        if !shares.is_empty() {
            transitions.insert(point, shares);
        }
    }
    transitions
}

/// Parts of the motions of `others` at a place of strip `number`: sums of the functions there, each of which belongs to
/// the strip that is nearest to its node, or in equal parts to those that are equally near.
fn shares_at<const D: usize>(
    x: &Vector<D>,
    number: usize,
    others: &[usize],
    strips: &[Strip<D>],
    grid: &Grid<D>,
) -> Vec<MotionShare> {
    let offsets = grid.offsets();
    let Some(attachment) = Attachment::at(grid, &offsets, |_| true, x) else { return Vec::new() };
    let mut sums = vec![0.0; others.len()];
    for (value, offset) in attachment.N().iter().zip(&offsets) {
        let node = node_place(grid, attachment.first_node() + offset);
        let own = distance(&node, &strips[number]);
        let distances: Vec<f64> = others.iter().map(|other| distance(&node, &strips[*other])).collect();
        let nearest = distances.iter().copied().fold(own, f64::min);
        let is_nearest = |distance: f64| distance - nearest <= EQUAL * (distance + nearest);
        let count = usize::from(is_nearest(own)) + distances.iter().filter(|distance| is_nearest(**distance)).count();
        for (sum, distance) in sums.iter_mut().zip(distances) {
            *sum += if is_nearest(distance) { value / count as f64 } else { 0.0 };
        }
    }
    let shares = others.iter().zip(sums).filter(|(_, share)| *share > 0.0);
    shares.map(|(strip, share)| MotionShare { strip: *strip, share }).collect()
}

/// Whether two strips that act hold one component of the displacement to different motions.
fn contradict<const D: usize>(a: &Strip<D>, b: &Strip<D>) -> bool {
    let [held_by_a, held_by_b] = [a, b].map(|strip| strip.normal.or(strip.contact.map(|contact| contact.inward)));
    let length_held_by_both = |difference: Vector<D>| match (held_by_a, held_by_b) {
        (None, None) => difference.norm(),
        (Some(normal), None) | (None, Some(normal)) => difference.dot(&normal).abs(),
        (Some(a), Some(b)) if a.dot(&b).abs() > 1.0 - 1e-9 => difference.dot(&a).abs(),
        (Some(_), Some(_)) => 0.0,
    };
    let mut times = a.path.rows.iter().chain(&b.path.rows).map(|(t, _)| *t);
    a.acts() && b.acts() && times.any(|t| length_held_by_both(a.path.at(t) - b.path.at(t)) > 0.0)
}

/// Whether two strips are less than a cell apart.
fn meet<const D: usize>(strip: &Strip<D>, other: &Strip<D>, grid: &Grid<D>) -> bool {
    corners(strip).any(|corner| distance_in_cells(&corner, other, grid) < NEAR)
}

/// m  where a node's function has its Greville point
fn node_place<const D: usize>(grid: &Grid<D>, node: usize) -> Vector<D> {
    let place = grid.node_at(node);
    Vector::from_fn(|axis, _| grid.axes()[axis].greville(place[axis]))
}

/// m  distance of a place from a strip
fn distance<const D: usize>(x: &Vector<D>, strip: &Strip<D>) -> f64 {
    corners(strip).map(|corner| (corner - x).norm()).fold(f64::INFINITY, f64::min)
}

/// Distance of a place from a strip along the axis where it is largest, in edges of the place's cell.
fn distance_in_cells<const D: usize>(x: &Vector<D>, strip: &Strip<D>, grid: &Grid<D>) -> f64 {
    let edges = grid.locate(x).map_or_else(|| Vector::repeat(grid.smallest_edge()), |cell| grid.cell_box(&cell).1);
    corners(strip).map(|corner| (corner - x).component_div(&edges).amax()).fold(f64::INFINITY, f64::min)
}

/// Corners of the pieces that a strip's points stand for.
fn corners<const D: usize>(strip: &Strip<D>) -> impl Iterator<Item = Vector<D>> + '_ {
    strip.points.iter().flat_map(|point| point.corners)
}
