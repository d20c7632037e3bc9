//! Checks rigid bodies that overlap or touch each other.

use super::place::is_in;
use crate::case::Case;
use crate::report::Report;
use crate::schema::Draft;
use crate::surfaces;
use crate::words::Geometry;
use bsmpm::interactions::rigid::Outline;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::tensor::Vector;

/// Places on a path between two of its rows at which an overlap is looked for.
const PLACES: usize = 32;
/// Cells across the smaller of two faces that meet in one plane and move differently, below which their forces are off
/// by 10 % and more: the factor of a trapdoor of two rigid bodies is 2.24, 2.13, 2.08 and 1.99 on 8, 12, 16 and 32
/// cells, where 1.95 to 2 is right.
const FEWEST_CELLS: f64 = 10.0;
/// Parts of a cell off a surface at which soil and the other body are looked for.
const BESIDE: f64 = 0.1;

/// Refuses overlaps that prescribed paths make certain, and warns of surfaces that meet and move differently.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let overlaps = match case.geometry {
        Geometry::PlaneStrain | Geometry::Axisymmetric => overlaps::<2>(case),
        Geometry::Solid => overlaps::<3>(case),
    };
    for Overlap { one, other, t } in &overlaps {
        let [name, of] = [one, other].map(|number| &case.rigid[*number].name);
        let message = format!(
            "E0249: rigid bodies `{name}` and `{of}` overlap at t = {t:.4} on their prescribed paths. Contact between \
             the two is not available. Change one of the paths, or reduce analysis.end."
        );
        if let Some(record) = draft.rigid.items().get(*other) {
            record.name.error(message, report);
        }
    }
    if case.geometry != Geometry::Solid && overlaps.is_empty() {
        check_meetings(case, draft, report);
    }
}

/// A pair of bodies, by number, and when they overlap first.
struct Overlap {
    one: usize,
    other: usize,
    t: f64,
}

/// Pairs of bodies without free motions that overlap at some time after they have moved against each other.
fn overlaps<const D: usize>(case: &Case) -> Vec<Overlap> {
    let mut found: Vec<Overlap> = Vec::new();
    let begins: Vec<f64> = std::iter::once(0.0)
        .chain(case.stages.iter().map(|stage| stage.at))
        .collect();
    for (number, &begin) in begins.iter().enumerate() {
        let end = begins.get(number + 1).copied().unwrap_or(case.analysis.end);
        let bodies = surfaces::rigid::<D>(case, begin);
        for other in 0..bodies.len() {
            for one in 0..other {
                let is_known = found.iter().any(|known| (known.one, known.other) == (one, other));
                let pair = [&bodies[one], &bodies[other]];
                let t = (!is_known).then(|| first_overlap(pair, begin, end)).flatten();
                found.extend(t.map(|t| Overlap { one, other, t }));
            }
        }
    }
    found
}

/// When two bodies overlap first between two times.
fn first_overlap<const D: usize>(pair: [&RigidBody<D>; 2], begin: f64, end: f64) -> Option<f64> {
    if pair.iter().any(|body| !body.acts || body.is_free()) {
        return None;
    }
    let rows = pair.iter().flat_map(|body| body.path.iter().map(|(t, _)| *t));
    let mut times: Vec<f64> = rows.filter(|t| (begin..end).contains(t)).chain([begin, end]).collect();
    times.sort_by(f64::total_cmp);
    let mut places = times.windows(2).flat_map(|ends| {
        let from = ends[0];
        let length = ends[1] - ends[0];
        (1..=PLACES).map(move |k| from + length * k as f64 / PLACES as f64)
    });
    places.find(|&t| {
        let [one, other] = pair.map(|body| (body, body.on_path(t)));
        let overlap = one.0.reaches_into(&one.1, other.0, &other.1) || other.0.reaches_into(&other.1, one.0, &one.1);
        one.1 != other.1 && overlap
    })
}

/// Refuses bodies whose surfaces lie in one plane, meet, and move differently along its normal where the error of their
/// forces is 10 % and more, and warns of them otherwise.
fn check_meetings(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let bodies = surfaces::rigid::<2>(case, 0.0);
    for other in 0..bodies.len() {
        for one in 0..other {
            let [a, b] = [&bodies[one], &bodies[other]];
            let widths = [meeting(case, a, b), meeting(case, b, a)];
            let width = widths.into_iter().flatten().fold(f64::INFINITY, f64::min);
            if width.is_infinite() {
                continue;
            }
            let cells = width / case.grid.shortest();
            let [name, of] = [one, other].map(|number| &case.rigid[number].name);
            let excess = 100.0 / cells;
            let warning = format!(
                "W0232: rigid bodies `{name}` and `{of}` touch and move differently. The smaller one is {cells:.0} cells \
                 wide, so the forces are about {excess:.0} % too large. Use smaller cells, or [[prescribed]] for both."
            );
            let error = format!(
                "E0250: rigid bodies `{name}` and `{of}` touch and move differently. Forces are {excess:.0} % too \
                 large ({cells:.0} cells across; needed: {FEWEST_CELLS:.0}). Use smaller cells, or [[prescribed]] for both."
            );
            match draft.rigid.items().get(other) {
                Some(record) if cells < FEWEST_CELLS => record.name.error(error, report),
                _ => report.warn(warning),
            }
        }
    }
}

/// m  width of a face of a body that another one continues with soil before both, if they move differently along its
/// normal.
fn meeting(case: &Case, body: &RigidBody<2>, other: &RigidBody<2>) -> Option<f64> {
    let Outline::Polygon(corners) = &body.outline else {
        return None;
    };
    let pose = body.pose(&Vector::zeros());
    let edge = case.grid.shortest();
    let places: Vec<Vector<2>> = corners.iter().map(|corner| pose.place(corner)).collect();
    for (number, &from) in places.iter().enumerate() {
        let to = places[(number + 1) % places.len()];
        for [end, far] in [[from, to], [to, from]] {
            let along = (end - far).normalize();
            let across = Vector::from([-along[1], along[0]]);
            let is_outward = distance(body, &((end + far) * 0.5 + across * (BESIDE * edge))) > 0.0;
            let normal = if is_outward { across } else { -across };
            let [behind, before] = [-BESIDE, BESIDE].map(|off| end + along * (0.5 * edge) + normal * (off * edge));
            let continues = distance(other, &behind) < 0.0 && distance(other, &before) > 0.0;
            let is_flush = distance(other, &before) - distance(other, &behind) <= 2.2 * BESIDE * edge;
            let has_soil = [before, end - along * (0.5 * edge) + normal * (BESIDE * edge)]
                .iter()
                .all(|x| is_soil(case, x));
            if continues && is_flush && has_soil && distance(body, &behind) > 0.0 && parts(body, other, &normal) {
                return Some(width(case, &end, &far));
            }
        }
    }
    None
}

/// Distance of a place from the surface of a body that has not moved, m; negative inside.
fn distance(body: &RigidBody<2>, x: &Vector<2>) -> f64 {
    body.outline.nearest(&body.pose(&Vector::zeros()).seen(x)).distance
}

/// m  width of a face between two ends: twice that up to a side of the grid, about which all is symmetric.
fn width(case: &Case, end: &Vector<2>, far: &Vector<2>) -> f64 {
    let lengths = [0, 1].map(|axis| case.grid.axes[axis].length());
    let inside = Vector::from_fn(|axis, _| far[axis].clamp(0.0, lengths[axis]));
    let is_cut = (0..2).any(|axis| far[axis] != end[axis] && (far[axis] <= 0.0 || far[axis] >= lengths[axis]));
    (end - inside).norm() * if is_cut { 2.0 } else { 1.0 }
}

/// Whether soil is at a place, m from the grid's lower corner.
fn is_soil(case: &Case, x: &Vector<2>) -> bool {
    let lower = case.grid.lower();
    let at = [x[0] + lower[0], x[1] + lower[1], 0.0];
    case.bodies.iter().any(|body| is_in(body, &case.grid, at))
}

/// Whether two bodies move differently along a normal.
fn parts(one: &RigidBody<2>, other: &RigidBody<2>, normal: &Vector<2>) -> bool {
    let times = one.path.iter().chain(&other.path).map(|(t, _)| *t);
    let mut differences = times.map(|t| one.on_path(t) - other.on_path(t));
    one.is_free() || other.is_free() || differences.any(|of| of.fixed_rows::<2>(0).dot(normal) != 0.0)
}
