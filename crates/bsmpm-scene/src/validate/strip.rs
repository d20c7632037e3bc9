//! Validates footings and prescribed displacements.

use super::course::{not_increasing, warn_of_late};
use super::place::{is_beyond, is_in, side_of_bodies};
use super::site::{AroundStrip, corners, normal_of, places, site};
use crate::case::{Base, Body, Case, Face, Footing, History, MotionPath, PrescribedMotion, Quantity, Site};
use crate::grid::GridSpec;
use crate::observables::{Aspect, HistorySubject, Observable};
use crate::record::{Field, ListRow};
use crate::report::Report;
use crate::schema::{Draft, MotionKey, StripKeys};
use crate::surfaces::{name_of_strip, strip_of_face};
use crate::words::{AnalysisType, Components, Side, Support, Word};
use bsmpm::interactions::strip::StripContact;

/// Parts of a motion below which it does not count.
const NOTHING: f64 = 1e-12;
/// Parts of a grid's length by which an end may lie off a face and be on it.
const ON: f64 = 1e-9;

/// The footing, if there is one and it is right.
pub(super) fn footing(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Footing> {
    let table = draft.footing.value()?;
    let strip = table.strip();
    let path = path(strip.motion, around.end, report);
    let site = site(strip.site, around, report);
    let path = path?;
    let site = site?;
    stays_inside(strip.motion, site, &path, around, report);
    let (base, contact) = match contact_of(draft, strip, site, around, report) {
        Some(found) => found?,
        None => (table.interface.plain()?, None),
    };
    if base == Base::Smooth && contact.is_none() && normal_part(&path, site) <= NOTHING * path.farthest() {
        let message = "E0416: a smooth footing acts only perpendicular to its base, but this motion is parallel to \
                       the base and would not load the soil. Use interface = \"rough\", or change the motion.";
        strip.motion.place().error(message, report);
    }
    Some(Footing {
        site,
        path,
        base,
        contact,
        rests: false,
    })
}

/// All prescribed motions in the order of the file, without those that have an error.
pub(super) fn prescribed(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<PrescribedMotion> {
    let mut found: Vec<PrescribedMotion> = Vec::new();
    for table in draft.prescribed.items() {
        let strip = table.strip();
        let path = path(strip.motion, around.end, report);
        let site = site(strip.site, around, report);
        let Some(path) = path else { continue };
        let Some(site) = site else { continue };
        match site {
            Site::Face(face) => {
                inward(strip.motion, face, &path, report);
                if found.iter().any(|other| other.site == site) {
                    let message = "E0417: another [[prescribed]] already moves this face of the grid. Combine both motions in \
                         one [[prescribed]].";
                    table.face.error(message, report);
                }
            }
            Site::Segment { .. } | Site::Plate(_) => stays_inside(strip.motion, site, &path, around, report),
        }
        let given = match site {
            Site::Segment { .. } | Site::Plate(_) => contact_of(draft, strip, site, around, report),
            Site::Face(_) => {
                if strip.contact.is_some() {
                    let message = "E0418: contact is not available on a moving face of the grid. Replace `face` by a \
                                   segment (`from`, `to`) inside the grid.";
                    table.components.error(message, report);
                }
                None
            }
        };
        let (base, contact) = match given {
            Some(Some(contact)) => contact,
            Some(None) => continue,
            None => (table.components.plain().unwrap_or(Components::All).base(), None),
        };
        found.push(PrescribedMotion {
            site,
            path,
            base,
            contact,
            rests: false,
        });
    }
    found
}

/// The frictional contact of a strip, and the components that it may prescribe so; `None` where the key is a word,
/// `Some(None)` after an error.
fn contact_of(
    draft: &Draft,
    strip: StripKeys<'_>,
    site: Site,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<Option<(Base, Option<StripContact<3>>)>> {
    let table = strip.contact?;
    let Some(law) = super::law(&table.friction_coefficient, &table.separates, around.factor, report) else {
        return Some(None);
    };
    let Some(grid) = around.grid else { return Some(None) };
    let Some(bodies) = around.bodies else { return Some(None) };
    let bodies: Vec<&Body> = bodies.iter().collect();
    let Some(side) = side_of_bodies(grid, |off| with_body(site, off, grid, &bodies)) else {
        let message = "E0404: contact needs soil on exactly one side of this surface, but bodies lie on both sides \
                       or on neither. Move this surface to the free surface of a body.";
        strip.interface.error(message, report);
        return Some(None);
    };
    let regime = draft.analysis.value().and_then(|analysis| analysis.r#type.get());
    if regime == Some(AnalysisType::Dynamic) {
        report.warn(format!(
            "W0406: {}: this contact is verified in quasi-static analysis only. In dynamic analysis impacts may \
             create or lose energy. Record the energy in a [[history]], and check the energy balance.",
            strip.interface.path()
        ));
    }
    let base = if law.friction > 0.0 { Base::Rough } else { Base::Smooth };
    Some(Some((
        base,
        Some(StripContact {
            law,
            inward: normal_of(site).map(|n| side * n).into(),
        }),
    )))
}

/// Places of a strip at which one of the bodies is so many metres along its normal.
pub(super) fn with_body(site: Site, off: f64, grid: &GridSpec, bodies: &[&Body]) -> usize {
    let normal = normal_of(site);
    let beside = places(site, grid)
        .into_iter()
        .map(|at| std::array::from_fn(|axis| at[axis] + off * normal[axis]));
    beside
        .filter(|at| bodies.iter().any(|body| is_in(body, grid, *at)))
        .count()
}

/// The path that a key gives.
pub(super) fn path(motion: MotionKey<'_>, end: Option<f64>, report: &mut Report<'_>) -> Option<MotionPath> {
    let rows = match motion {
        MotionKey::Displacement(key) => vec![(end?, key.vector()?)],
        MotionKey::Velocity(key) => vec![(end?, key.vector()?.map(|v| v * end.unwrap_or(0.0)))],
        MotionKey::Path(key) => rows(key, end, report)?,
    };
    Some(MotionPath { rows })
}

fn rows(path: &Field<Vec<ListRow>>, end: Option<f64>, report: &mut Report<'_>) -> Option<Vec<(f64, [f64; 3])>> {
    let written = path.value()?;
    let key = path.path();
    let mut rows: Vec<(f64, [f64; 3])> = Vec::with_capacity(written.len());
    for (k, row) in written.iter().enumerate() {
        let t = row.numbers[0];
        let along = &row.numbers[1..];
        let u: [f64; 3] = std::array::from_fn(|axis| along.get(axis).copied().unwrap_or(0.0));
        match rows.last() {
            _ if k == 0 && t == 0.0 && u == [0.0; 3] => continue,
            _ if k == 0 && t == 0.0 => {
                let message = format!(
                    "E0403: the displacement at t = 0 is {along:?} m, but a path must begin with zero. Set this row \
                     to zeros, or give the row a later time."
                );
                report.error(row.origin, key, message);
                return None;
            }
            Some((before, _)) if *before >= t => {
                report.error(row.origin, key, not_increasing("t", t, *before));
                return None;
            }
            None if t == 0.0 => {
                report.error(row.origin, key, not_increasing("t", t, 0.0));
                return None;
            }
            _ => rows.push((t, u)),
        }
    }
    if rows.is_empty() {
        path.error(
            "E0435: the path has no row after t = 0. Give at least one row [t, ux, uy].",
            report,
        );
        return None;
    }
    warn_of_late(key, rows.iter().map(|row| row.0), end, report);
    Some(rows)
}

/// Between its rows a path is straight, and the grid convex: the rows decide.
fn stays_inside(
    motion: MotionKey<'_>,
    site: Site,
    path: &MotionPath,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) {
    let Some(grid) = around.grid else { return };
    let corners = match site {
        // Of a disc what lies inside the grid counts anyway.
        Site::Plate(plate) if plate.round => [plate.middle(); 2],
        site => corners(site, grid),
    };
    let beyond = path.rows.iter().find_map(|(t, u)| {
        let mut ends = corners
            .iter()
            .map(|end| std::array::from_fn(|axis| end[axis] + u[axis]));
        Some((t, ends.find_map(|end| is_beyond(grid, end))?))
    });
    if let Some((t, outside)) = beyond {
        let message = format!(
            "E0419: at t = {t} this motion leaves the grid: {outside}. Reduce the motion, or enlarge the grid."
        );
        motion.place().error(message, report);
    }
}

fn inward(motion: MotionKey<'_>, face: Face, path: &MotionPath, report: &mut Report<'_>) {
    let mut rows = path.rows.iter().map(|(t, u)| (t, u[face.axis]));
    if let Some((t, u)) = rows.find(|(_, u)| if face.upper { *u > 0.0 } else { *u < 0.0 }) {
        let message = format!(
            "E0420: at t = {t} the face would be {} m outside the grid, but a face of the grid can move only inwards \
             or parallel to itself. Reverse the motion.",
            u.abs()
        );
        motion.place().error(message, report);
    }
}

/// The largest motion normal to a base, m.
fn normal_part(path: &MotionPath, site: Site) -> f64 {
    let normal = normal_of(site);
    let along = path
        .rows
        .iter()
        .map(|(_, u)| u[0] * normal[0] + u[1] * normal[1] + u[2] * normal[2]);
    along.map(f64::abs).fold(0.0, f64::max)
}

/// Warns of forces of strips that meet a face which holds, at the edge, a part of them: a fixed one, or a roller that
/// an inclined one presses on.
pub(super) fn beside_fixed(case: &Case, report: &mut Report<'_>) {
    let sites: Vec<Site> = case
        .footing
        .iter()
        .map(|of| of.site)
        .chain(case.prescribed.iter().map(|of| of.site))
        .collect();
    for (number, site) in sites.into_iter().enumerate() {
        let Some(history) = case.histories.iter().find(|history| is_of_force(history, number, case)) else {
            continue;
        };
        let Some((side, support)) = met(case, site) else {
            continue;
        };
        let name = name_of_strip(case, number);
        let history = &history.name;
        report.warn(match support {
            Support::Roller => format!(
                "W0407: `{name}` is inclined and ends at roller boundary `{side}`, which carries a part of its force. \
                 This part is missing in history `{history}`. Use only the component along `{side}`."
            ),
            _ => format!(
                "W0408: `{name}` ends at the fixed boundary `{side}`, so a part of its force goes into the boundary \
                 and is missing in history `{history}`. Set boundary.{side} = \"roller\"."
            ),
        });
    }
}

/// Whether the history is the force of that strip.
fn is_of_force(history: &History, number: usize, case: &Case) -> bool {
    let Quantity { observable, subject } = &history.quantity;
    match *subject {
        HistorySubject::Strip(of) => of == number && !observable.has(Aspect::NeedsContact),
        HistorySubject::Face(face) if *observable == Observable::Reaction => strip_of_face(case, face) == Some(number),
        HistorySubject::Case if observable.has(Aspect::Force) => case.footing.is_some() && number == 0,
        _ => false,
    }
}

/// The face that what is held there meets, on which it does not lie, and which holds a part of what it presses with.
fn met(case: &Case, site: Site) -> Option<(&'static str, Support)> {
    let corners = corners(site, &case.grid);
    let lower = case.grid.lower();
    let upper = case.grid.upper();
    let normal = normal_of(site);
    for (axis, sides) in Side::of(case.geometry).iter().enumerate() {
        for (end, side) in sides.iter().enumerate() {
            let at = [lower, upper][end][axis];
            let on = corners.map(|corner| (corner[axis] - at).abs() <= ON * (upper[axis] - lower[axis]));
            let support = case.boundary[axis][end];
            let holds = match support {
                Support::Fixed => true,
                Support::Roller => (ON..1.0 - ON).contains(&normal[axis].abs()),
                _ => false,
            };
            if holds && on[0] != on[1] {
                return Some((side.word(), support));
            }
        }
    }
    None
}

/// Whether the strip of that number (the footing, then prescribed motions) has moved before the time `t`.
pub(super) fn has_moved(case: &Case, number: usize, t: f64) -> bool {
    let footing = case.footing.iter().map(|footing| &footing.path);
    let mut paths = footing.chain(case.prescribed.iter().map(|prescribed| &prescribed.path));
    paths.nth(number).is_some_and(|path| path_begins_before(path, t))
}

/// Whether a path leads away from the start before a time.
pub(super) fn path_begins_before(path: &MotionPath, t: f64) -> bool {
    let times = path.rows.iter().map(|row| row.0);
    let is_away = path.rows.iter().map(|row| row.1 != [0.0; 3]);
    begins_before(times, is_away, t)
}

/// Whether something that rests at the start moves before the time `t`: given are the times of its rows, and whether it
/// is away from its place there.
pub(super) fn begins_before(times: impl Iterator<Item = f64>, mut is_away: impl Iterator<Item = bool>, t: f64) -> bool {
    let begin = is_away.position(|is_away| is_away);
    // It moves from the row before the first one that is not at rest on.
    let mut times = std::iter::once(0.0).chain(times);
    begin.and_then(|row| times.nth(row)).is_some_and(|from| from < t)
}

/// Whether a path moves at all.
pub(super) fn moves(path: &MotionPath) -> bool {
    path.farthest() > 0.0
}
