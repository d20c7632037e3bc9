//! The footing and prescribed motions.

use super::place::{along, beyond, face, is_at, is_beyond, is_in, over};
use crate::case::{Base, Body, Case, Face, Footing, MotionPath, Plate, Prescribed, Site, Support};
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::words::{AnalysisType, Axis, Components, Side};
use bsmpm::boundary::StripContact;

/// Parts of a motion below which it does not count.
const NOTHING: f64 = 1e-12;

/// What the rest of the case says to a strip.
#[derive(Clone, Copy)]
pub(super) struct AroundStrip<'a> {
    pub(super) grid: Option<&'a GridSpec>,
    pub(super) bodies: Option<&'a [Body]>,
    pub(super) boundary: Option<[[Support; 2]; 3]>,
    /// of the strength reduction
    pub(super) factor: Option<f64>,
    pub(super) end: Option<f64>,
    pub(super) dt: Option<f64>,
}

/// The footing, if there is one and it is right.
pub(super) fn footing(root: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Footing> {
    let record = root.record("footing")?;
    let path = path(record, around.end, report);
    let site = site(record, around, report);
    let (path, site) = (path?, site?);
    stays_inside(record, site, &path, around, report);
    let (base, contact) = match rubs((root, record), "base", site, around, report) {
        Some(rubs) => rubs?,
        None => (record.word("base")?, None),
    };
    if base == Base::Smooth && contact.is_none() && normal_part(&path, site) <= NOTHING * size(&path) {
        let message = "a smooth base holds its normal component only, and the motion has none";
        record.error(motion(record), message, report);
    }
    Some(Footing { site, path, base, contact })
}

/// All prescribed motions in the order of the file, without those that have an error.
pub(super) fn prescribed(root: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<Prescribed> {
    let mut found: Vec<Prescribed> = Vec::new();
    for record in root.records("prescribed") {
        let path = path(record, around.end, report);
        let site = site(record, around, report);
        let (Some(path), Some(site)) = (path, site) else { continue };
        match site {
            Site::Face(face) => {
                inward(record, face, &path, report);
                if found.iter().any(|other| other.site == site) {
                    record.error("face", "its motion is prescribed already", report);
                }
            }
            Site::Segment { .. } | Site::Plate(_) => stays_inside(record, site, &path, around, report),
        }
        let rubs = match site {
            Site::Segment { .. } | Site::Plate(_) => rubs((root, record), "components", site, around, report),
            Site::Face(_) => {
                if record.record("components").is_some() {
                    let message =
                        "a face that moves does not rub or let go; a segment does, and a face that rests in [boundary]";
                    record.error("components", message, report);
                }
                None
            }
        };
        let (base, contact) = match rubs {
            Some(Some(rubs)) => rubs,
            Some(None) => continue,
            None => (record.word("components").unwrap_or(Components::All).base(), None),
        };
        found.push(Prescribed { site, path, base, contact });
    }
    found
}

/// Parts of the shortest cell beside a strip at which bodies are looked for.
const BESIDE: f64 = 0.25;

/// What a strip does that rubs and lets go, and what it may hold so; `None` where the key is a word, `Some(None)` after
/// an error.
fn rubs(
    (root, record): (&Record, &Record),
    key: &str,
    site: Site,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<Option<(Base, Option<StripContact<3>>)>> {
    let table = record.record(key)?;
    let Some(law) = super::law(table, around.factor, report) else { return Some(None) };
    let (Some(grid), Some(bodies)) = (around.grid, around.bodies) else { return Some(None) };
    let (off, normal) = (BESIDE * grid.axes[0].shortest().min(grid.axes[1].shortest()), normal_of(site));
    let count = |side: f64| {
        let beside = |at: [f64; 3]| std::array::from_fn(|axis| at[axis] + side * off * normal[axis]);
        places(site, grid).into_iter().filter(|at| bodies.iter().any(|body| is_in(body, grid, beside(*at)))).count()
    };
    let (left, right) = (count(1.0), count(-1.0));
    if left.abs_diff(right) * 2 < left.max(right) {
        record.error(key, "bodies lie on both sides of it: it rubs and lets go on one", report);
        return Some(None);
    }
    let regime = root.record("analysis").and_then(|analysis| analysis.word("type"));
    if regime == Some(AnalysisType::Dynamic) {
        report.warn(format!(
            "{}: strips that rub and let go were shown to be right in quasi-static analysis only; look at the energy history \
             for what impacts make or lose",
            record.path_of(key)
        ));
    }
    let side = if left > right { 1.0 } else { -1.0 };
    let base = if law.friction > 0.0 { Base::Rough } else { Base::Smooth };
    Some(Some((base, Some(StripContact { law, inward: normal.map(|n| side * n).into() }))))
}

/// A segment's ends inside the grid.
pub(super) fn segment(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<[[f64; 2]; 2]> {
    let (from, to) = (record.pair("from")?, record.pair("to")?);
    if from == to {
        record.error("to", format!("{to:?} is `from` too: the length is zero"), report);
        return None;
    }
    let grid = around.grid?;
    let mut inside = true;
    for (key, at) in [("from", from), ("to", to)] {
        if let Some(message) = beyond(grid, at) {
            record.error(key, message, report);
            inside = false;
        }
    }
    inside.then_some([from, to])
}

/// A strip starts at a body, if only with a part of it.
fn starts_at_body(record: &Record, key: &str, site: Site, around: AroundStrip<'_>, report: &mut Report<'_>) {
    let (Some(grid), Some(bodies)) = (around.grid, around.bodies) else { return };
    if !places(site, grid).into_iter().any(|at| is_at(bodies, grid, at)) {
        let [from, to] = corners(site, grid).map(|at| at[..grid.dims()].to_vec());
        let message =
            format!("no body is at {from:?} to {to:?} at the start; allowed: half a spacing of points from one");
        record.error(key, message, report);
    }
}

/// m  two opposite corners of what is held
fn corners(site: Site, grid: &GridSpec) -> [[f64; 3]; 2] {
    match site {
        Site::Segment { from, to } => [from, to].map(|[x, y]| [x, y, 0.0]),
        Site::Plate(plate) => [plate.lower, plate.upper],
        Site::Face(face) => {
            let (mut lower, mut upper) = (grid.lower(), grid.upper());
            let at = if face.upper { upper[face.axis] } else { lower[face.axis] };
            (lower[face.axis], upper[face.axis]) = (at, at);
            [lower, upper]
        }
    }
}

/// Places of what is held, in the middles of equal pieces.
pub(super) fn places(site: Site, grid: &GridSpec) -> Vec<[f64; 3]> {
    let ends = corners(site, grid);
    if grid.dims() == 2 {
        return along(ends.map(|[x, y, _]| [x, y])).map(|[x, y]| [x, y, 0.0]).collect();
    }
    over(ends).filter(|at| !matches!(site, Site::Plate(plate) if !plate.covers(*at))).collect()
}

/// Unit normal of what is held.
pub(super) fn normal_of(site: Site) -> [f64; 3] {
    let along = |axis: usize| std::array::from_fn(|k| f64::from(u8::from(k == axis)));
    match site {
        Site::Segment { from, to } => {
            let [x, y] = normal(from, to);
            [x, y, 0.0]
        }
        Site::Plate(plate) => along(plate.normal()),
        Site::Face(face) => along(face.axis),
    }
}

/// A plate inside the grid; of a disc a part of it.
pub(super) fn plate(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Plate> {
    let grid = around.grid?;
    if let Some(disc) = record.record("disc") {
        let (center, radius) = (disc.vector("center")?, disc.number("radius")?);
        let normal = disc.word::<Axis>("normal")? as usize;
        let corner = |side: f64| std::array::from_fn(|k| center[k] + if k == normal { 0.0 } else { side * radius });
        let plate = Plate { lower: corner(-1.0), upper: corner(1.0), round: true };
        let (lower, upper) = (grid.lower(), grid.upper());
        let inside = |axis: usize| lower[axis] <= plate.upper[axis] && plate.lower[axis] <= upper[axis];
        if !(0..3).all(inside) || plate.area([lower, upper]) == 0.0 {
            record.error("disc", "no part of it is inside the grid", report);
            return None;
        }
        return Some(plate);
    }
    let table = record.record("rectangle")?;
    let (lower, upper) = (table.vector("lower")?, table.vector("upper")?);
    let flat = (0..3).filter(|&axis| lower[axis] == upper[axis]).count();
    if flat != 1 || (0..3).any(|axis| lower[axis] > upper[axis]) {
        let message =
            format!("{lower:?} to {upper:?} is no rectangle; allowed: alike along one axis, more along the others");
        record.error("rectangle", message, report);
        return None;
    }
    if let Some(message) = [lower, upper].into_iter().find_map(|corner| beyond(grid, corner)) {
        record.error("rectangle", message, report);
        return None;
    }
    Some(Plate { lower, upper, round: false })
}

fn site(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Site> {
    if let Some(key) = ["rectangle", "disc"].into_iter().find(|key| record.gives(key)) {
        let site = Site::Plate(plate(record, around, report)?);
        starts_at_body(record, key, site, around, report);
        return Some(site);
    }
    if !record.gives("face") {
        let [from, to] = segment(record, around, report)?;
        starts_at_body(record, "from", Site::Segment { from, to }, around, report);
        return Some(Site::Segment { from, to });
    }
    let (side, face) = (record.word::<Side>("face")?, face(record, around.grid?, report)?);
    let support = around.boundary?[face.axis][usize::from(face.upper)];
    if support != Support::Free {
        let message = format!("[boundary] holds \"{side}\" too; leave it free there");
        record.error("face", message, report);
        return None;
    }
    starts_at_body(record, "face", Site::Face(face), around, report);
    Some(Site::Face(face))
}

/// The key that gives a motion.
fn motion(record: &Record) -> &'static str {
    ["displacement", "velocity"].into_iter().find(|key| record.gives(key)).unwrap_or("path")
}

pub(super) fn path(record: &Record, end: Option<f64>, report: &mut Report<'_>) -> Option<MotionPath> {
    let rows = if record.gives("displacement") {
        vec![(end?, record.vector("displacement")?)]
    } else if record.gives("velocity") {
        vec![(end?, record.vector("velocity")?.map(|v| v * end.unwrap_or(0.0)))]
    } else {
        rows(record, end, report)?
    };
    Some(MotionPath { rows })
}

fn rows(record: &Record, end: Option<f64>, report: &mut Report<'_>) -> Option<Vec<(f64, [f64; 3])>> {
    let written = record.rows("path")?;
    let mut rows: Vec<(f64, [f64; 3])> = Vec::with_capacity(written.len());
    for (k, row) in written.iter().enumerate() {
        let (t, along) = (row.numbers[0], &row.numbers[1..]);
        let u: [f64; 3] = std::array::from_fn(|axis| along.get(axis).copied().unwrap_or(0.0));
        let key = record.path_of("path");
        match rows.last() {
            _ if k == 0 && t == 0.0 && u == [0.0; 3] => continue,
            _ if k == 0 && t == 0.0 => {
                report.error(
                    row.origin,
                    &key,
                    format!("{along:?} at time 0; a path starts with {:?} there", vec![0.0; along.len()]),
                );
                return None;
            }
            Some((before, _)) if *before >= t => {
                report.error(row.origin, &key, format!("t = {t} is not above {before}, that of the row before"));
                return None;
            }
            None if t == 0.0 => {
                report.error(row.origin, &key, "t = 0 is not above 0, that of the row before");
                return None;
            }
            _ => rows.push((t, u)),
        }
    }
    if rows.is_empty() {
        record.error("path", "a path needs at least one row [t, ux, uy] with t > 0", report);
        return None;
    }
    if let Some((t, _)) = rows.iter().find(|(t, _)| end.is_some_and(|end| *t > end)) {
        report.warn(format!("{}: the row at t = {t} is beyond the end of the run", record.path_of("path")));
    }
    Some(rows)
}

/// Between its rows a path is straight, and the grid convex: the rows decide.
fn stays_inside(record: &Record, site: Site, path: &MotionPath, around: AroundStrip<'_>, report: &mut Report<'_>) {
    let Some(grid) = around.grid else { return };
    let corners = match site {
        // Of a disc what lies inside the grid counts anyway.
        Site::Plate(plate) if plate.round => [plate.middle(); 2],
        site => corners(site, grid),
    };
    let at = |end: [f64; 3], u: [f64; 3]| std::array::from_fn(|axis| end[axis] + u[axis]);
    let beyond =
        |(t, u): &(f64, [f64; 3])| Some((*t, corners.into_iter().find_map(|end| is_beyond(grid, at(end, *u)))?));
    if let Some((t, message)) = path.rows.iter().find_map(beyond) {
        record.error(motion(record), format!("at t = {t} it has left the grid: {message}"), report);
    }
}

fn inward(record: &Record, face: Face, path: &MotionPath, report: &mut Report<'_>) {
    let outward = |u: f64| if face.upper { u > 0.0 } else { u < 0.0 };
    if let Some((t, u)) = path.rows.iter().find(|(_, u)| outward(u[face.axis])) {
        let message = format!("at t = {t} the face has left the grid by {u:?}; it may move inward or along itself");
        record.error(motion(record), message, report);
    }
}

fn size(path: &MotionPath) -> f64 {
    path.rows.iter().map(|(_, u)| u[0].hypot(u[1]).hypot(u[2])).fold(0.0, f64::max)
}

/// The largest motion normal to a base, m.
fn normal_part(path: &MotionPath, site: Site) -> f64 {
    let normal = normal_of(site);
    let along = |u: &[f64; 3]| u[0] * normal[0] + u[1] * normal[1] + u[2] * normal[2];
    path.rows.iter().map(|(_, u)| along(u).abs()).fold(0.0, f64::max)
}

/// Unit normal of a segment.
pub(super) fn normal(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    [-along[1] / length, along[0] / length]
}

/// Whether the strip of that number (the footing, then prescribed motions) has moved before the time `t`.
pub(super) fn has_moved(case: &Case, number: usize, t: f64) -> bool {
    let footing = case.footing.iter().map(|footing| &footing.path);
    let mut paths = footing.chain(case.prescribed.iter().map(|prescribed| &prescribed.path));
    let earlier = |path: &MotionPath| {
        let moved = |(_, u): &(f64, [f64; 3])| *u != [0.0; 3];
        let begin = path.rows.iter().position(moved);
        // It moves from the row before the first one that is not zero on.
        begin.is_some_and(|row| row.checked_sub(1).map_or(0.0, |before| path.rows[before].0) < t)
    };
    paths.nth(number).is_some_and(earlier)
}

/// Whether a path moves at all.
pub(super) fn moves(path: &MotionPath) -> bool {
    size(path) > 0.0
}
