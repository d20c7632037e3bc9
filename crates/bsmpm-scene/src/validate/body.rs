//! Validates bodies: material, position and material points.

use super::gap::are_together;
use super::shape;
use crate::case::{Body, Case};
use crate::estimate::MOST_POINTS;
use crate::grid::GridSpec;
use crate::nearest::nearest;
use crate::record::{CaseTable, KeyPlace};
use crate::report::{Report, listed, shortened};
use crate::schema::{BodyTable, Draft, ShapeKey, SpinTable};
use crate::words::Geometry;
use bsmpm::model::Regime;
use bsmpm_shapes::{AxisExtent, Region, Volume, Window, is_filled, sweep};

/// Part of a body in cells of one point each above which there is a warning: a face just beyond a grid line has a
/// fifth, a tube with a wall of four fifths of the points' distance too, of a fifth all.
const ALONE: f64 = 0.3;
/// Parts of the distance of points by which a box may be thinner: rounding.
const ROUNDING: f64 = 1e-9;
/// Bodies at most; every pair is tried for overlap.
const MOST: usize = 10_000;
/// Pairs of edges that are tried for overlap at most.
const MOST_WORK: usize = 10_000_000;

/// All bodies in the order of the file; place and points are checked only if the grid is valid.
pub(super) fn read_all(
    draft: &Draft,
    grid: Option<&GridSpec>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Vec<Body>> {
    let records = draft.body.items();
    if draft.body.is_given() && records.is_empty() {
        draft.body.consequence(
            "E0213: the case has no body. Add a [[body]] with a material and a shape.",
            &["body"],
            report,
        );
    }
    if records.len() > MOST {
        let message = format!(
            "E0214: the case has {} bodies (at most {MOST}). Merge some of them.",
            records.len()
        );
        draft.body.error(message, report);
        return None;
    }
    let read: Vec<_> = records
        .iter()
        .map(|record| read(record, draft, grid, regime, report))
        .collect();
    let bodies: Vec<Body> = read.into_iter().collect::<Option<_>>()?;
    let points: u128 = grid.map_or(0, |grid| bodies.iter().map(|body| body.points(grid)).sum());
    if points > MOST_POINTS {
        let message = format!(
            "E0215: the bodies have {points} material points (at most {MOST_POINTS}). Use larger cells, or reduce \
             points_per_cell."
        );
        draft.body.error(message, report);
        return None;
    }
    if let Some(grid) = grid {
        warn_of_coarse(records, &bodies, grid, report);
    }
    Some(bodies)
}

/// rad/s along the axis, and the place about which, m.
fn turning(spin: &SpinTable, geometry: Geometry, report: &mut Report<'_>) -> Option<[[f64; 3]; 2]> {
    let rate = spin.rate.get()?;
    let about = spin.about.vector()?;
    let axis = if spin.axis.is_given() {
        spin.axis.vector()?
    } else {
        [0.0, 0.0, 1.0]
    };
    let length = axis.iter().map(|along| along * along).sum::<f64>().sqrt();
    if spin.axis.is_given() && (geometry != Geometry::Solid || length == 0.0) {
        let message = match geometry {
            Geometry::Solid => {
                "E0217: all components of the axis of rotation are zero, so it has no direction. Give a vector along \
                 the axis."
            }
            _ => {
                "E0207: a body in a 2-D case always rotates about the normal of the plane, so an axis of rotation is \
                 not allowed. Delete `axis`, or use geometry = \"3d\"."
            }
        };
        spin.axis.error(message, report);
        return None;
    }
    Some([axis.map(|along| rate * along / length), about])
}

fn read(
    record: &BodyTable,
    draft: &Draft,
    grid: Option<&GridSpec>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Body> {
    let material = material(record, draft, report);
    let moving: [&KeyPlace; 2] = [&record.velocity, &record.spin];
    for key in moving.into_iter().filter(|key| key.is_given()) {
        if regime == Some(Regime::QuasiStatic) {
            key.error(super::NO_INERTIA, report);
        }
    }
    let points_per_cell = record.points_per_cell.get().map(|count| count as usize);
    if points_per_cell == Some(2) && grid.is_some_and(|grid| grid.order == 3) {
        report.warn(format!(
            "W0209: {}: points_per_cell = 2 is too small for cubic splines. Stresses are off by several per cent. Use \
             points_per_cell = 3, or grid.degree = \"quadratic\".",
            record.location().path
        ));
    }
    let boundary = super::boundary(draft);
    let region = shape::region(record, draft.geometry.get()?, grid, points_per_cell, boundary, report);
    let velocity = record.velocity.vector();
    let spin = match record.spin.value() {
        Some(spin) => Some(turning(spin, draft.geometry.get()?, report)?),
        None => None,
    };
    let name = record.name.text().map(str::to_owned);
    let body = Body {
        name,
        material: material?,
        region: region?,
        points_per_cell: points_per_cell?,
        velocity,
        spin,
    };
    if grid.is_some_and(|grid| body.points(grid) == 0) {
        let message = "E0219: the body is thinner than 1e-9 of a cell, so it has no material points. Make the body \
                       thicker, or use smaller cells.";
        match record.shape() {
            ShapeKey::Box(key) => key
                .value()
                .map_or(&**key, |corners| &*corners.upper)
                .error(message, report),
            shape => shape.place().error(message, report),
        }
    }
    Some(body)
}

/// Warns of bodies whose points integrate too coarsely, each cause in one line.
fn warn_of_coarse(records: &[BodyTable], bodies: &[Body], grid: &GridSpec, report: &mut Report<'_>) {
    let single = paths(records, bodies, |body| {
        body.points_per_cell == 1 && is_coarse(body, grid)
    });
    if !single.is_empty() {
        report.warn(format!(
            "W0210: {}: points_per_cell = 1 is too small for accurate stresses. Increase points_per_cell to 2 or more.",
            listed(&single)
        ));
    }
    if let Some(most) = bodies.iter().filter_map(alone).reduce(f64::max) {
        let paths = paths(records, bodies, |body| alone(body).is_some());
        let up_to = if paths.len() > 1 { "up to " } else { "" };
        report.warn(format!(
            "W0211: {}: {up_to}{:.0} % of the body is thinner than the spacing of its material points. The bending of \
             these thin parts is unreliable. Use smaller cells, or increase points_per_cell.",
            listed(&paths),
            1e2 * most
        ));
    }
    let thinnest_of = bodies.iter().filter_map(|body| thinnest(body, grid));
    if let Some((axis, part)) = thinnest_of.min_by(|a, b| a.1.total_cmp(&b.1)) {
        let paths = paths(records, bodies, |body| thinnest(body, grid).is_some());
        report.warn(format!(
            "W0212: {}: the body is only {part:.2} cells thick along {}, less than the spacing of material points. \
             Bending and strains there are unreliable. Use smaller cells at the body.",
            listed(&paths),
            ["x", "y", "z"][axis]
        ));
    }
}

/// Paths of the bodies that are meant, in the order of the file.
fn paths(records: &[BodyTable], bodies: &[Body], is_meant: impl Fn(&Body) -> bool) -> Vec<String> {
    let meant = records.iter().zip(bodies).filter(|(_, body)| is_meant(body));
    meant.map(|(record, _)| record.location().path.clone()).collect()
}

/// Part of a body of several points per cell that is thinner than their spacing, if it is more than [`ALONE`].
fn alone(body: &Body) -> Option<f64> {
    let part = (body.points_per_cell > 1).then(|| body.region.alone());
    part.filter(|part| *part > ALONE)
}

/// Whether points lie farther apart than half a cell if the body has one of them per cell: its bounds contain more than
/// half of a cell along some axis. Bodies of half a cell, side by side, have as many points as others with two.
fn is_coarse(body: &Body, grid: &GridSpec) -> bool {
    let [lower, upper] = body.region.corners();
    for (axis, along) in grid.axes.iter().enumerate() {
        let extent = AxisExtent::new(along, lower[axis], upper[axis]);
        let mut lengths = extent.cells.clone().map(|cell| (cell, extent.part(cell)));
        if extent.cells.len() > 2 || lengths.any(|(cell, [from, to])| to - from > (0.5 + ROUNDING) * along.cell(cell)) {
            return true;
        }
    }
    false
}

/// The axis along which a box of several points per cell is thinner than they lie apart in a cell, and the part of a
/// cell that it has there: its own points stand as close as it is thin, so that none is alone.
fn thinnest(body: &Body, grid: &GridSpec) -> Option<(usize, f64)> {
    if body.points_per_cell <= 1 {
        return None;
    }
    let [lower, upper] = match &body.region {
        Region::Box { lower, upper } => [*lower, *upper].map(|[x, y]| [x, y, 0.0]),
        Region::Solid(volume) if volume.is_box() => volume.bounds(),
        Region::Solid(_) | Region::Outline(_) => return None,
    };
    let parts = (0..grid.dims()).map(|axis| {
        let along = &grid.axes[axis];
        let cell = along.first_cell(|cell| along.lower() + along.breakpoint(cell + 1) > lower[axis]);
        let length = along.cell(cell.min(along.cells() - 1));
        (axis, (upper[axis] - lower[axis]) / length)
    });
    let least = parts.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (least.1 < (1.0 - ROUNDING) / body.points_per_cell as f64).then_some(least)
}

fn material(record: &BodyTable, draft: &Draft, report: &mut Report<'_>) -> Option<usize> {
    let name = record.material.text()?;
    let named = draft.material.items();
    let found = named.iter().position(|(known, _)| known == name);
    if found.is_none() {
        let name_as_given = shortened(name);
        let message = match nearest(name, named.iter().map(|(known, _)| known.as_str())) {
            Some(known) => format!("E0220: [material.{name_as_given}] is not defined. Did you mean `{known}`?"),
            None => format!("E0220: [material.{name_as_given}] is not defined. Add this table, or correct the name."),
        };
        record.material.consequence(message, &["material"], report);
    }
    found
}

/// Warns of the first pair of bodies that have an area in common, and are there at the same time.
pub(super) fn warn_of_overlap(case: &Case, report: &mut Report<'_>) {
    let bodies = &case.bodies;
    let mut work = 0;
    let mut pairs = (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| [i, j]));
    let found =
        pairs.find(|&[i, j]| overlap(&bodies[i], &bodies[j], &case.grid, &mut work) && are_together(case, [i, j]));
    if let Some([i, j]) = found {
        let [lower, upper] = common_box(&bodies[i], &bodies[j], case.grid.dims());
        report.warn(format!(
            "W0213: body.{i} and body.{j} overlap between {lower:.3?} and {upper:.3?} m, so this soil is counted \
             twice. Correct the corners of one body, or `subtract` its shape from the other body."
        ));
    }
}

/// m  Lower and upper corner of the box that the boxes around two bodies have in common.
fn common_box(a: &Body, b: &Body, dims: usize) -> [Vec<f64>; 2] {
    let a = a.region.corners();
    let b = b.region.corners();
    let lower = (0..dims).map(|axis| common(&a, &b, axis)[0]).collect();
    let upper = (0..dims).map(|axis| common(&a, &b, axis)[1]).collect();
    [lower, upper]
}

/// Lower and upper end (m) of what two boxes have in common along an axis.
fn common<const D: usize>(a: &[[f64; D]; 2], b: &[[f64; D]; 2], axis: usize) -> [f64; 2] {
    [a[0][axis].max(b[0][axis]), a[1][axis].min(b[1][axis])]
}

/// Whether two boxes have nothing but rounding in common along an axis.
fn are_apart<const D: usize>(a: &[[f64; D]; 2], b: &[[f64; D]; 2], axis: usize) -> bool {
    let [from, to] = common(a, b, axis);
    let smaller = (a[1][axis] - a[0][axis]).min(b[1][axis] - b[0][axis]);
    to - from <= 1e-9 * smaller
}

/// Whether two bodies overlap by more than rounding; for shapes only as long as the `work` so far is bearable.
fn overlap(a: &Body, b: &Body, grid: &GridSpec, work: &mut usize) -> bool {
    if let (Region::Solid(a), Region::Solid(b)) = (&a.region, &b.region) {
        return overlap_in_space(a, b);
    }
    let a_bounds = a.bounds();
    let b_bounds = b.bounds();
    if are_apart(&a_bounds, &b_bounds, 0) || are_apart(&a_bounds, &b_bounds, 1) {
        return false;
    }
    if matches!((&a.region, &b.region), (Region::Box { .. }, Region::Box { .. })) {
        return true;
    }
    let (mut edges, of_a) = a.region.edges(&grid.axes);
    let (others, of_b) = b.region.edges(&grid.axes);
    edges.extend(others.into_iter().map(|edge| edge.of(edge.shape + of_a)));
    *work += edges.len() * edges.len();
    if *work > MOST_WORK {
        return false;
    }
    let origin = grid.lower();
    let [x, y] = [0, 1].map(|axis| common(&a_bounds, &b_bounds, axis).map(|end| end - origin[axis]));
    let mut area = 0.0;
    sweep(
        &edges,
        of_a + of_b,
        &Window { x, y },
        &|inside| is_filled(&inside[..of_a]) && is_filled(&inside[of_a..]),
        &mut |slice| area += slice.area(),
    );
    area > 1e-9 * a.area().min(b.area())
}

/// Places along an axis at which it is tried whether two shapes in space overlap.
const SAMPLES: usize = 16;

/// Whether two shapes in space have more than a sixteenth of the extent of the smaller in common.
fn overlap_in_space(a: &Volume, b: &Volume) -> bool {
    let a_bounds = a.bounds();
    let b_bounds = b.bounds();
    let is_apart = (0..3).any(|axis| are_apart(&a_bounds, &b_bounds, axis));
    if is_apart || a.is_box() && b.is_box() {
        return !is_apart;
    }
    let common = [0, 1, 2].map(|axis| common(&a_bounds, &b_bounds, axis));
    (0..SAMPLES.pow(3)).any(|k| {
        let number = [k / (SAMPLES * SAMPLES), k / SAMPLES % SAMPLES, k % SAMPLES];
        let at = [0, 1, 2].map(|axis| sample(common[axis], number[axis]));
        a.contains(at) && b.contains(at)
    })
}

/// Middle (m) of the `k`-th of [`SAMPLES`] pieces of an interval.
fn sample([lower, upper]: [f64; 2], k: usize) -> f64 {
    lower + (upper - lower) * (k as f64 + 0.5) / SAMPLES as f64
}
