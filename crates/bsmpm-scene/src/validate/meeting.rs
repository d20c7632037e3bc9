//! Strips that meet one another or a rigid body, and move differently.

use super::site::normal_of;
use crate::case::{Acting, Case, Site};
use crate::record::Record;
use crate::report::Report;
use crate::surfaces::{self, name_of_strip};
use crate::words::Geometry;
use bsmpm::boundary::{RigidBody, Strip};
use bsmpm::grid::Grid;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::tensor::Vector;

/// Cells by which a strip that meets another one may move along its own surface: its points keep their parts of both
/// motions, which splines follow exactly only where the points were at the start.
const ALONG: f64 = 0.25;
/// Cells by which the motions of strips that meet may differ: the material between them is deformed within one cell.
const APART: f64 = 1.0;

/// A strip, and what it meets.
struct Meeting {
    strip: usize,
    other: Other,
}

enum Other {
    /// another strip
    Strip {
        number: usize,
        /// m  largest difference of their motions
        apart: f64,
        /// m  the farther of their motions along their surfaces
        along: f64,
        /// m  an edge of the cells there
        edge: f64,
    },
    /// number of a rigid body whose surface continues that of the strip
    Rigid(usize),
}

/// Refuses motions that contradict each other where the rule for strips that meet does not cover them; notes those that
/// it covers.
pub(super) fn check(case: &Case, root: &Record, report: &mut Report<'_>) {
    let mut known = Vec::new();
    for t in std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at)) {
        let meetings = match case.geometry {
            Geometry::PlaneStrain => meetings::<PlaneStrain, 2>(case, t),
            Geometry::Axisymmetric => meetings::<Axisymmetric, 2>(case, t),
            Geometry::Solid => meetings::<Solid, 3>(case, t),
        };
        for meeting in meetings {
            let pair = match meeting.other {
                Other::Strip { number, .. } => (meeting.strip, name_of_strip(case, number)),
                Other::Rigid(number) => (meeting.strip, format!("rigid.{number}")),
            };
            if !known.contains(&pair) {
                judge(case, root, &meeting, &pair.1, report);
                known.push(pair);
            }
        }
    }
}

/// Refuses a meeting, or notes it and warns of it.
fn judge(case: &Case, root: &Record, meeting: &Meeting, other: &str, report: &mut Report<'_>) {
    let name = name_of_strip(case, meeting.strip);
    let record = match meeting.strip.checked_sub(usize::from(case.footing.is_some())) {
        None => root.record("footing"),
        Some(number) => root.records("prescribed").get(number),
    };
    let Some(record) = record else { return };
    match meeting.other {
        Other::Rigid(_) => {
            let message = format!(
                "{other} continues the surface of {name} and moves differently: the node between them cannot follow both. Use \
                 [[prescribed]] for both, [[rigid]] for both, or leave a cell between them."
            );
            record.error("from", message, report);
        }
        Other::Strip { along, edge, .. } if along > ALONG * edge => {
            let message = format!(
                "{other} meets {name} and moves differently, and one of them moves {along:.3} m along its surface (at most \
                 {ALONG} of a cell of {edge:.3} m is possible): the node between them cannot follow both. Leave a cell \
                 between them."
            );
            record.error("from", message, report);
        }
        Other::Strip { apart, edge, .. } => {
            let value = format!("follows {other}, too, where they meet");
            let reason = "they move differently: the motion changes over about one cell, and the force of each is the one that \
                          does work on its motion";
            report.note(&name, &value, reason);
            if apart > APART * edge {
                report.warn(format!(
                    "{name} and {other} meet, and their motions differ by {apart:.3} m, {:.1} cells: the material between \
                     them is deformed within one cell. Reduce the displacement, or use larger cells there.",
                    apart / edge
                ));
            }
        }
    }
}

/// What meets once the stages until the time `t` have begun.
fn meetings<K: Kinematics<D>, const D: usize>(case: &Case, t: f64) -> Vec<Meeting> {
    let Ok(grid) = crate::model::grid::<D>(case) else { return Vec::new() };
    let strips = surfaces::strips::<K, D>(case, &grid, (1.0, t));
    let footing = case.footing.iter().map(|footing| footing.site);
    let sites: Vec<Site> = footing.chain(case.prescribed.iter().map(|prescribed| prescribed.site)).collect();
    let mut found = Vec::new();
    for (strip, of) in strips.iter().enumerate() {
        let shares = of.transitions.iter().flat_map(|(point, shares)| shares.iter().map(move |share| (*point, share)));
        for (point, share) in shares.filter(|(_, share)| share.strip > strip) {
            let is_known = |meeting: &Meeting| {
                meeting.strip == strip && matches!(meeting.other, Other::Strip { number, .. } if number == share.strip)
            };
            if found.iter().any(is_known) {
                continue;
            }
            let number = share.strip;
            let apart = largest(&[of, &strips[number]], |t| of.path.at(t) - strips[number].path.at(t));
            let along = [strip, number].map(|number| {
                let normal = crate::grid::vector::<D, 3>(normal_of(sites[number]));
                largest(&[&strips[number]], |t| {
                    let moved = strips[number].path.at(t);
                    moved - normal * normal.dot(&moved)
                })
            });
            let edge = edge(&of.points[point].x, &grid);
            let other = Other::Strip { number, apart, along: along[0].max(along[1]), edge };
            found.push(Meeting { strip, other });
        }
        for (number, body) in surfaces::rigid::<D>(case, t).iter().enumerate() {
            let acts = case.acts_since(Acting::Rigid(number), t).is_some();
            let normal = crate::grid::vector::<D, 3>(normal_of(sites[strip]));
            if acts && of.acts() && !body.is_free() && continues(of, &normal, body, &grid) {
                found.push(Meeting { strip, other: Other::Rigid(number) });
            }
        }
    }
    found
}

/// m  the largest length of a displacement at the rows of the strips' paths
fn largest<const D: usize>(strips: &[&Strip<D>], displacement: impl Fn(f64) -> Vector<D>) -> f64 {
    let times = strips.iter().flat_map(|strip| strip.path.rows.iter().map(|(t, _)| *t));
    times.map(|t| displacement(t).norm()).fold(0.0, f64::max)
}

/// m  the shortest edge of the cell at a place
fn edge<const D: usize>(x: &Vector<D>, grid: &Grid<D>) -> f64 {
    grid.locate(x).map_or(grid.smallest_edge(), |cell| grid.cell_box(&cell).1.min())
}

/// Whether the surface of a rigid body that moves differently along the strip's normal goes on where the strip ends:
/// beyond an end, the body lies on one side of the strip's plane only.
fn continues<const D: usize>(strip: &Strip<D>, normal: &Vector<D>, body: &RigidBody<D>, grid: &Grid<D>) -> bool {
    let times = strip.path.rows.iter().map(|(t, _)| *t).chain(body.path.iter().map(|(t, _)| *t));
    let difference = |t: f64| strip.path.at(t) - Vector::from_fn(|axis, _| body.on_path(t)[axis]);
    if times.map(|t| difference(t).dot(normal).abs()).fold(0.0, f64::max) == 0.0 {
        return false;
    }
    let pose = body.pose(&Vector::zeros());
    let distance = |x: &Vector<D>| body.outline.nearest(&pose.seen(x)).distance;
    let is_beyond = |x: &Vector<D>, edge: f64| {
        strip.points.iter().flat_map(|point| point.corners).all(|corner| (corner - x).norm() > 0.25 * edge)
    };
    for corner in strip.points.iter().flat_map(|point| point.corners) {
        let (edge, middle) = (edge(&corner, grid), strip.points[strip.points.len() / 2].x);
        let Some(outward) = (corner - middle).try_normalize(0.0) else { continue };
        let x = corner + (outward - normal * normal.dot(&outward)) * (0.5 * edge);
        let sides = [-0.1, 0.1].map(|off| distance(&(x + normal * (off * edge))));
        if is_beyond(&x, edge) && sides[0] * sides[1] < 0.0 && sides[0].abs().max(sides[1].abs()) <= 0.11 * edge {
            return true;
        }
    }
    false
}
