//! Warns of bodies less than a cell apart, because they act on each other through shared nodes.

use crate::case::{Body, Case};
use crate::connected::{near_pairs, pieces_of_pairs};
use crate::grid::GridSpec;
use crate::report::Report;
use crate::rounding::brief;
use bsmpm_shapes::{Edge, Region};

/// Parts of the shortest cell by which bodies that share a boundary may miss each other: rounding.
const ROUNDING: f64 = 1e-6;
/// Places along half of a circle from which distances are measured.
const SAMPLES: usize = 65;
/// Pairs of edges that are measured at most.
const MOST_WORK: usize = 10_000_000;

/// A gap between two bodies.
#[derive(Clone, Copy, Debug)]
struct Gap {
    bodies: [usize; 2],
    distance: f64, // m
    cell: f64,     // m  edge of the cells there
}

/// Warns of separate bodies with a gap that is less than a cell, in one line with the narrowest of them. Bodies are
/// separate unless they share a boundary, or a third one fills the gap.
pub(super) fn check(case: &Case, report: &mut Report<'_>) {
    let bounds: Vec<[[f64; 3]; 2]> = case.bodies.iter().map(|body| body.region.corners()).collect();
    let reach = case.grid.axes.iter().map(|axis| axis.longest()).fold(0.0, f64::max);
    let mut work = 0;
    let near = near_pairs(&bounds, reach).filter(|&(i, j)| is_near(&bounds[i], &bounds[j], reach));
    let measured = near.filter_map(|(i, j)| gap(case, [i, j], &mut work));
    let (apart, touching): (Vec<Gap>, Vec<Gap>) =
        measured.partition(|gap| gap.distance > ROUNDING * case.grid.shortest());
    let pieces = pieces_of_pairs(case.bodies.len(), touching.iter().map(|gap| gap.bodies));
    let mut piece_of = vec![0; case.bodies.len()];
    for (number, piece) in pieces.iter().enumerate() {
        piece.iter().for_each(|&body| piece_of[body] = number);
    }
    let narrow = apart.iter().filter(|gap| gap.distance < gap.cell);
    let narrow: Vec<&Gap> = narrow
        .filter(|gap| piece_of[gap.bodies[0]] != piece_of[gap.bodies[1]] && are_together(case, gap.bodies))
        .collect();
    let Some(gap) = narrow.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) else {
        return;
    };
    let more = if narrow.len() > 1 {
        format!(" (and {} more pairs)", narrow.len() - 1)
    } else {
        String::new()
    };
    let [one, other] = gap.bodies;
    report.warn(format!(
        "W0228: body.{} and body.{}{more} are {} m apart ({:.2} cells), so the bodies push on each other before they \
         touch. Use cells smaller than the gap, or close the gap.",
        one.min(other),
        one.max(other),
        brief(gap.distance),
        gap.distance / gap.cell
    ));
}

/// Whether two bodies are there at the same time.
pub(super) fn are_together(case: &Case, [i, j]: [usize; 2]) -> bool {
    let mut times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
    times.any(|t| case.is_there(i, t) && case.is_there(j, t))
}

/// Whether bounds are nowhere farther apart than `reach`, m.
fn is_near(a: &[[f64; 3]; 2], b: &[[f64; 3]; 2], reach: f64) -> bool {
    (0..3).all(|axis| a[0][axis].max(b[0][axis]) - a[1][axis].min(b[1][axis]) <= reach)
}

/// Whether two bodies near each other are apart by a cell or more, as far as that is known.
pub(super) fn are_apart(case: &Case, bodies: [usize; 2], work: &mut usize) -> bool {
    gap(case, bodies, work).is_some_and(|gap| gap.distance >= gap.cell)
}

/// The gap of two bodies near each other; of shapes in space that are no cuboids, and of shapes whose edges are too
/// many, none.
fn gap(case: &Case, bodies: [usize; 2], work: &mut usize) -> Option<Gap> {
    let [a, b] = bodies.map(|number| &case.bodies[number]);
    if let (Some(a_bounds), Some(b_bounds)) = (cuboid(a), cuboid(b)) {
        return Some(of_boxes(&case.grid, bodies, &a_bounds, &b_bounds));
    }
    let [a_edges, b_edges] = [a, b].map(|body| body.region.edges(&case.grid.axes).0);
    let lower = case.grid.lower();
    *work += SAMPLES * a_edges.len() * b_edges.len();
    if a_edges.is_empty() || b_edges.is_empty() || *work > MOST_WORK {
        return None;
    }
    let nearest = [nearest(&a_edges, &b_edges)?, nearest(&b_edges, &a_edges)?];
    let (distance, at) = if nearest[0].0 <= nearest[1].0 {
        nearest[0]
    } else {
        nearest[1]
    };
    // A place of one inside of the other: they overlap, of which there is another warning.
    let overlaps = has_place_in(&a_edges, b, lower) || has_place_in(&b_edges, a, lower);
    let cell = (0..2)
        .map(|axis| cell_at(&case.grid, axis, at[axis]))
        .fold(f64::INFINITY, f64::min);
    Some(Gap {
        bodies,
        distance: if overlaps { 0.0 } else { distance },
        cell,
    })
}

/// Distance (m) of the place on some edges that is nearest to others, and the place.
fn nearest(ones: &[Edge], others: &[Edge]) -> Option<(f64, [f64; 2])> {
    let places = ones.iter().flat_map(places);
    let distances = places.map(|at| {
        let distances = others.iter().map(|other| other.distance(at));
        (distances.fold(f64::INFINITY, f64::min), at)
    });
    distances.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether an end of some edges, which are in coordinates from `lower` (m), is inside a body.
fn has_place_in(edges: &[Edge], body: &Body, lower: [f64; 3]) -> bool {
    edges
        .iter()
        .any(|edge| body.region.contains([edge.a[0] + lower[0], edge.a[1] + lower[1]]))
}

/// Bounds of a body that is a box.
fn cuboid(body: &Body) -> Option<[[f64; 3]; 2]> {
    let is_box = match &body.region {
        Region::Box { .. } => true,
        Region::Solid(volume) => volume.is_box(),
        Region::Outline(_) => false,
    };
    is_box.then(|| body.region.corners())
}

/// The gap of two boxes: their distance along the axis along which it is most cells.
fn of_boxes(grid: &GridSpec, bodies: [usize; 2], a: &[[f64; 3]; 2], b: &[[f64; 3]; 2]) -> Gap {
    let lower = grid.lower();
    let along = (0..grid.dims()).map(|axis| {
        let ends = [a[1][axis].min(b[1][axis]), a[0][axis].max(b[0][axis])];
        let cell = cell_at(grid, axis, 0.5 * (ends[0] + ends[1]) - lower[axis]);
        (ends[1] - ends[0], cell)
    });
    let widest = along.max_by(|one, other| (one.0 / one.1).total_cmp(&(other.0 / other.1)));
    let (distance, cell) = widest.unwrap_or((0.0, 1.0));
    Gap {
        bodies,
        distance: distance.max(0.0),
        cell,
    }
}

/// Places along an edge from which the distance to another shape is measured: its ends, of an arc more.
fn places(edge: &Edge) -> Vec<[f64; 2]> {
    if edge.is_straight() {
        return vec![edge.a, edge.b];
    }
    let middle = 0.5 * (edge.a[0] + edge.b[0]);
    let half = 0.5 * (edge.b[0] - edge.a[0]);
    let angles = (0..SAMPLES).map(|k| std::f64::consts::PI * k as f64 / (SAMPLES - 1) as f64);
    let along = angles.map(|angle| middle - half * angle.cos());
    along.map(|x| [x, edge.y(x)]).collect()
}

/// Edge, m, of the cell at a place from the grid's lower corner along an axis.
pub(super) fn cell_at(grid: &GridSpec, axis: usize, at: f64) -> f64 {
    let along = &grid.axes[axis];
    along.cell(
        along
            .first_cell(|cell| along.breakpoint(cell + 1) > at)
            .min(along.cells() - 1),
    )
}
