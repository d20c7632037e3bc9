//! Checks adjacent footings and prescribed segments with different displacements, and refuses contradictory
//! displacements.

use super::place::is_in;
use crate::case::{ActiveLoads, Case};
use crate::report::Report;
use crate::rounding::brief;
use crate::schema::Draft;
use crate::surfaces::transition::{ROUNDING, apart_at_corner, holds_all, meet};
use crate::surfaces::{self, name_of_strip};
use crate::words::Geometry;
use bsmpm::grid::Grid;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::interactions::strip::Strip;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::tensor::Vector;

/// Cells by which a strip that meets another one may move along its own surface: its points keep their parts of both
/// motions, which splines follow exactly only where the points were at the start.
const ALONG: f64 = 0.25;
/// Cells by which the motions of strips that meet may differ: the material between them is deformed within one cell.
const APART: f64 = 1.0;

/// Parts of a cell off a strip's plane at which soil and rigid bodies are looked for.
const BESIDE: f64 = 0.1;

/// A strip, and what it meets.
struct StripMeeting {
    strip: usize,
    other: Other,
}

enum Other {
    /// another strip
    Strip {
        number: usize,
        /// whether both act since the same time
        act_together: bool,
        /// m  largest difference of their motions
        apart: f64,
        /// m  the farther of their motions along their surfaces
        along: f64,
        /// m  largest difference of their motions along their surfaces, if both hold the soil there
        sliding: f64,
        /// m  an edge of the cells there
        edge: f64,
    },
    /// another strip at an angle, with a common corner
    Corner {
        number: usize,
        /// m  largest difference of their motions in a component that both hold
        apart: f64,
    },
    /// number of a rigid body whose surface continues that of the strip
    Rigid(usize),
}

/// Refuses motions that contradict each other where the rule for strips that meet does not cover them; notes those that
/// it covers.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let mut known = Vec::new();
    for t in std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at)) {
        let meetings = match case.geometry {
            Geometry::PlaneStrain => meetings::<PlaneStrain, 2>(case, t),
            Geometry::Axisymmetric => meetings::<Axisymmetric, 2>(case, t),
            Geometry::Solid => meetings::<Solid, 3>(case, t),
        };
        for meeting in meetings {
            let pair = match meeting.other {
                Other::Strip { number, .. } | Other::Corner { number, .. } => {
                    (meeting.strip, name_of_strip(case, number))
                }
                Other::Rigid(number) => (meeting.strip, format!("rigid.{number}")),
            };
            if !known.contains(&pair) {
                judge(case, draft, &meeting, &pair.1, report);
                known.push(pair);
            }
        }
    }
}

/// Refuses a meeting, or notes it and warns of it.
fn judge(case: &Case, draft: &Draft, meeting: &StripMeeting, other: &str, report: &mut Report<'_>) {
    let name = name_of_strip(case, meeting.strip);
    let Some(strip) = draft.strips().nth(meeting.strip) else {
        return;
    };
    match meeting.other {
        Other::Rigid(_) => {
            let message = format!(
                "E0251: `{name}` ([[prescribed]] or [footing]) and `{other}` ([[rigid]]) share an edge and move \
                 differently. The soil cannot follow both. Use one kind of table, or leave a cell between."
            );
            strip.from.error(message, report);
        }
        Other::Corner { apart, .. } => {
            let message = format!(
                "E0251: `{name}` and `{other}` share a corner, where their displacements differ by {} m. The soil \
                 cannot follow both. Use components = \"normal\" in both, or leave a cell between the two.",
                brief(apart)
            );
            strip.from.error(message, report);
        }
        Other::Strip {
            act_together: false, ..
        } => {
            let message = format!(
                "E0251: `{other}` and `{name}` are adjacent, move differently and begin to act in different stages. \
                 The soil cannot follow both. Apply both in the same stage, or leave a cell between the two."
            );
            strip.from.error(message, report);
        }
        Other::Strip { sliding, edge, .. } if sliding > ROUNDING * edge => {
            let message = format!(
                "E0251: `{name}` and `{other}` are adjacent, and their tangential displacements differ by {} m. The \
                 soil cannot follow both. Use components = \"normal\" in one, or leave a cell between the two.",
                brief(sliding)
            );
            strip.from.error(message, report);
        }
        Other::Strip { along, edge, .. } if along > ALONG * edge => {
            let message = format!(
                "E0251: `{name}` and `{other}` are adjacent, and one of them slides {along:.3} m along its surface \
                 (at most {:.3} m), which the soil next to both cannot follow. Leave a cell between the two.",
                ALONG * edge
            );
            strip.from.error(message, report);
        }
        Other::Strip { apart, edge, .. } => note_transition(&name, other, apart, edge, report),
    }
}

/// Notes that two strips share an end and that their motions differ (by `apart`, m), and warns of it if they differ by
/// more than a cell with this `edge`, m.
fn note_transition(name: &str, other: &str, apart: f64, edge: f64, report: &mut Report<'_>) {
    let value = format!("shares its end with `{other}`");
    let reason = "their motions differ: the displacement changes from one to the other over about one cell, \
                  and its reaction is divided between them";
    report.note(name, &value, reason);
    if apart > APART * edge {
        report.warn(format!(
            "W0233: `{name}` and `{other}` are adjacent, and their displacements differ by {apart:.3} m \
             ({:.1} cells). Stresses in the cell between the two are inaccurate. Reduce the difference.",
            apart / edge
        ));
    }
}

/// What meets once the stages until the time `t` have begun.
fn meetings<K: Kinematics<D>, const D: usize>(case: &Case, t: f64) -> Vec<StripMeeting> {
    let Ok(grid) = crate::model::grid::<D>(case) else {
        return Vec::new();
    };
    let strips = surfaces::strips::<K, D>(case, &grid, 1.0, t);
    let neighbours = surfaces::neighbours::<D>(case, t);
    let bodies = surfaces::rigid::<D>(case, t);
    let mut found = Vec::new();
    let acting = (0..strips.len()).filter(|&number| neighbours[number].since.is_some());
    let acting: Vec<usize> = acting.collect();
    for &strip in &acting {
        let of = &strips[strip];
        for &number in acting.iter().filter(|&&number| number > strip) {
            let both = [&neighbours[strip], &neighbours[number]];
            if let Some(apart) = apart_at_corner(of, &strips[number], both, &grid) {
                found.push(StripMeeting {
                    strip,
                    other: Other::Corner { number, apart },
                });
            }
            if !meet(of, &strips[number], both, &grid) {
                continue;
            }
            let other = &strips[number];
            let apart = largest(&[of, other], |t| of.path.at(t) - other.path.at(t));
            let normal = &both[0].normal;
            let along = [of, other].map(|strip| largest(&[strip], |t| in_plane(strip.path.at(t), normal)));
            let sliding = match holds_all(of) && holds_all(other) {
                true => largest(&[of, other], |t| in_plane(of.path.at(t) - other.path.at(t), normal)),
                false => 0.0,
            };
            let act_together = both[0].since == both[1].since;
            let along = along[0].max(along[1]);
            let edge = edge(&of.points[0].x, &grid);
            let other = Other::Strip {
                number,
                act_together,
                apart,
                along,
                sliding,
                edge,
            };
            found.push(StripMeeting { strip, other });
        }
        for (number, body) in bodies.iter().enumerate() {
            let acts = case.acts_since(ActiveLoads::Rigid(number), t).is_some();
            let Some(inward) = inward::<D>(case, of, &neighbours[strip].normal, &grid) else {
                continue;
            };
            if acts && !body.is_free() && continues(of, &inward, body, &grid) {
                found.push(StripMeeting {
                    strip,
                    other: Other::Rigid(number),
                });
            }
        }
    }
    found
}

/// The part of a motion that is not along a unit normal.
fn in_plane<const D: usize>(motion: Vector<D>, normal: &Vector<D>) -> Vector<D> {
    motion - normal * normal.dot(&motion)
}

/// The normal of a strip towards the soil; `None` where soil lies on both sides of its middle, or on none.
fn inward<const D: usize>(case: &Case, strip: &Strip<D>, normal: &Vector<D>, grid: &Grid<D>) -> Option<Vector<D>> {
    let middle = strip.points[strip.points.len() / 2].x;
    let lower = case.grid.lower();
    let has_soil = [-1.0, 1.0].map(|side| {
        let x = middle + normal * (side * BESIDE * edge(&middle, grid));
        let at = std::array::from_fn(|axis| if axis < D { x[axis] + lower[axis] } else { 0.0 });
        case.bodies.iter().any(|body| is_in(body, &case.grid, at))
    });
    match has_soil {
        [false, true] => Some(*normal),
        [true, false] => Some(-normal),
        _ => None,
    }
}

/// m  the largest length of a displacement at the rows of the strips' paths
fn largest<const D: usize>(strips: &[&Strip<D>], displacement: impl Fn(f64) -> Vector<D>) -> f64 {
    let times = strips.iter().flat_map(|strip| strip.path.rows.iter().map(|(t, _)| *t));
    times.map(|t| displacement(t).norm()).fold(0.0, f64::max)
}

/// m  the shortest edge of the cell at a place
fn edge<const D: usize>(x: &Vector<D>, grid: &Grid<D>) -> f64 {
    grid.locate(x)
        .map_or(grid.smallest_edge(), |cell| grid.cell_box(&cell).1.min())
}

/// Whether the surface of a rigid body that moves differently along the strip's normal goes on where the strip ends:
/// beyond an end, the body lies behind the strip's plane and not in front of it, where the soil is.
fn continues<const D: usize>(strip: &Strip<D>, normal: &Vector<D>, body: &RigidBody<D>, grid: &Grid<D>) -> bool {
    let times = strip
        .path
        .rows
        .iter()
        .map(|(t, _)| *t)
        .chain(body.path.iter().map(|(t, _)| *t));
    let differences = times.map(|t| {
        let difference = strip.path.at(t) - Vector::from_fn(|axis, _| body.on_path(t)[axis]);
        difference.dot(normal).abs()
    });
    if differences.fold(0.0, f64::max) == 0.0 {
        return false;
    }
    let pose = body.pose(&Vector::zeros());
    for corner in strip.points.iter().flat_map(|point| point.corners) {
        let edge = edge(&corner, grid);
        let middle = strip.points[strip.points.len() / 2].x;
        let Some(outward) = (corner - middle).try_normalize(0.0) else {
            continue;
        };
        let x = corner + (outward - normal * normal.dot(&outward)) * (0.5 * edge);
        let mut corners = strip.points.iter().flat_map(|point| point.corners);
        let is_beyond = corners.all(|corner| (corner - x).norm() > 0.25 * edge);
        let [behind, ahead] = [-BESIDE, BESIDE].map(|off| {
            let seen = pose.seen(&(x + normal * (off * edge)));
            body.outline.nearest(&seen).distance
        });
        if is_beyond && behind < 0.0 && ahead > 0.0 && ahead - behind <= 2.2 * BESIDE * edge {
            return true;
        }
    }
    false
}
