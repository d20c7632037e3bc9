//! Validates tractions, point loads and shaking.

use super::course::{coarse, component, course, increasing, path, warn_of_late};
use super::place::{along, at_body, at_volume, beyond, is_at, is_beyond, ring};
use super::sheet::pieces;
use super::site::{AroundStrip, places, plate, segment};
use crate::case::{Gravity, LoadedLine, PointLoad, Push, Rigid, Shares, Site, Traction};
use crate::record::{CaseTable, Field, KeyPlace, ListRow, OrTable, vector};
use crate::report::Report;
use crate::schema::{CircleTable, Draft, PointLoadTable, SiteKey, TractionTable};
use bsmpm::material::Profile;
use bsmpm::model::Regime;

/// All tractions in the order of the file, without those that have an error.
pub(super) fn tractions(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<Traction> {
    let records = draft.traction.items().iter();
    records.filter_map(|record| traction(record, around, report)).collect()
}

/// A traction; `None` after an error.
fn traction(record: &TractionTable, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Traction> {
    let line = line(record.site(), around, report);
    let push = push(record, around, report);
    let line = line?;
    let (push, (ramp, amplitude)) = push?;
    let traction = Traction {
        line,
        push,
        ramp,
        amplitude,
    };
    warn_of_nothing(record.load(), [traction.largest(); 3], report);
    Some(traction)
}

/// Where a traction acts: on a body everywhere.
fn line(key: SiteKey<'_>, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<LoadedLine> {
    match key {
        SiteKey::Circle(circle_key) => {
            let (center, radius, places) = circle(circle_key, around, report)?;
            acts_on_body(circle_key, places.into_iter(), around, report);
            Some(LoadedLine::Circle { center, radius })
        }
        SiteKey::Plate(plate_key) => {
            let grid = around.grid?;
            let bodies = around.bodies?;
            let plate = plate(plate_key, grid, report)?;
            let mut places = places(Site::Plate(plate), grid).into_iter();
            if let Some(at) = places.find(|at| beyond(grid, *at).is_none() && !at_volume(bodies, grid, *at)) {
                key.place().consequence(no_body(&at), &["body"], report);
                return None;
            }
            Some(LoadedLine::Plate(plate))
        }
        SiteKey::Segment(from_key, to_key) => {
            let [from, to] = segment([from_key, to_key], around, report)?;
            acts_on_body(from_key, along([from, to]), around, report);
            Some(LoadedLine::Segment { from, to })
        }
        SiteKey::Surface(_) | SiteKey::Sphere(_) => Some(LoadedLine::Triangles(pieces(key, around, report)?)),
        SiteKey::Face(_) => None,
    }
}

/// Centre, radius and places of a circle, some of which are inside the grid.
pub(super) fn circle(
    key: &Field<CircleTable>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<([f64; 2], f64, Vec<[f64; 2]>)> {
    let (center, radius) = key.value()?.circle()?;
    let lower = around.grid?.lower();
    let upper = around.grid?.upper();
    let places: Vec<[f64; 2]> = ring(center, radius)
        .filter(|at| (0..2).all(|axis| lower[axis] <= at[axis] && at[axis] <= upper[axis]))
        .collect();
    if places.is_empty() {
        let message =
            "E0201: no part of the circle is inside the grid. Move the circle into the grid, or enlarge the grid.";
        key.error(message, report);
        return None;
    }
    Some((center, radius, places))
}

/// A stress along the axes, by depth.
fn stresses(record: &TractionTable) -> Option<[Profile; 3]> {
    let table = match record.stress.value()? {
        OrTable::Value(stress) => return Some(vector(stress).map(Profile::constant)),
        OrTable::Table(table) => table,
    };
    let value = table.value.vector()?;
    let at = table.at_y.get()?;
    let growth = table.per_metre.vector()?;
    Some([0, 1, 2].map(|axis| Profile {
        value: value[axis],
        at,
        per_metre: growth[axis],
    }))
}

/// What a traction is; on which side of a pressure bodies lie follows from the whole case only ([`super::side`]).
fn push(record: &TractionTable, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<(Push, (f64, Shares))> {
    let side = 0.0;
    if record.pressure_path.is_given() {
        let (largest, shares) = path(&record.pressure_path, around, report)?;
        let profile = Profile::constant(largest[0]);
        return Some((Push::Pressure { profile, side }, (0.0, shares)));
    }
    if record.stress_path.is_given() {
        let (largest, shares) = path(&record.stress_path, around, report)?;
        return Some((Push::Stress(largest.map(Profile::constant)), (0.0, shares)));
    }
    let course = course(&record.ramp, &record.amplitude, around, report);
    let push = match record.pressure.is_given() {
        true => Push::Pressure {
            profile: record.pressure.profile()?,
            side,
        },
        false => Push::Stress(stresses(record)?),
    };
    Some((push, course?))
}

/// All point loads in the order of the file, without those that have an error.
pub(super) fn point_loads(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<PointLoad> {
    let records = draft.point_load.items().iter();
    records
        .filter_map(|record| point_load(record, around, report))
        .collect()
}

/// A point load; `None` after an error.
fn point_load(record: &PointLoadTable, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<PointLoad> {
    let at = record.at.vector()?;
    let PointLoadTable {
        force: constant,
        force_path,
        ramp,
        amplitude,
        ..
    } = record;
    let value = match constant.is_given() {
        true => constant.vector(),
        false => Some([0.0; 3]),
    };
    let force = force(value, force_path, ramp, amplitude, around, report);
    let grid = around.grid?;
    let bodies = around.bodies?;
    if let Some(message) = is_beyond(grid, at) {
        record.at.error(message, report);
    } else if !is_at(bodies, grid, at) {
        record.at.consequence(no_body(&at[..grid.dims()]), &["body"], report);
    }
    let (force, (ramp, amplitude)) = force?;
    warn_of_nothing(record.load(), force, report);
    Some(PointLoad {
        at,
        force,
        ramp,
        amplitude,
    })
}

/// A force along the axes that exist, and what of it acts in time: a `constant` one with its ramp or amplitude, or that
/// of a `force_path`.
pub(super) fn force(
    constant: Option<[f64; 3]>,
    force_path: &Field<Vec<ListRow>>,
    ramp: &Field<f64>,
    amplitude: &Field<Vec<ListRow>>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<([f64; 3], (f64, Shares))> {
    if force_path.is_given() {
        let (largest, shares) = path(force_path, around, report)?;
        return Some((largest, (0.0, shares)));
    }
    let course = course(ramp, amplitude, around, report);
    Some((constant?, course?))
}

fn warn_of_nothing(key: &KeyPlace, load: [f64; 3], report: &mut Report<'_>) {
    if load == [0.0; 3] {
        report.warn(format!(
            "W0401: {}: this load is zero and has no effect. Give a value, or delete the load.",
            key.path()
        ));
    }
}

/// Says that no body lies at a place of a load, m.
fn no_body(at: &[f64]) -> String {
    format!(
        "E0401: no body lies at {at:.3?} m at the start, so nothing carries this load. Move the load to \
         the surface of a body."
    )
}

/// A load has a body under every part of it.
fn acts_on_body(
    key: &KeyPlace,
    mut places: impl Iterator<Item = [f64; 2]>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) {
    let Some(grid) = around.grid else { return };
    let Some(bodies) = around.bodies else { return };
    if let Some(at) = places.find(|at| !at_body(bodies, grid, *at)) {
        key.consequence(no_body(&at), &["body"], report);
    }
}

/// Rows of the ground's acceleration; none without it, or after an error. The run ends and steps by the second numbers.
pub(super) fn shaking(
    draft: &Draft,
    regime: Option<Regime>,
    times: Option<(f64, f64)>,
    report: &mut Report<'_>,
) -> Vec<(f64, [f64; 3])> {
    let Some(shaking) = draft.shaking.value() else {
        return Vec::new();
    };
    if regime == Some(Regime::QuasiStatic) {
        let message = "E0414: a quasi-static analysis has no inertia, so [shaking] has no effect. Use analysis.type \
                       = \"dynamic\", or give gravity.acceleration a horizontal component (pseudo-static).";
        shaking.location().error(message, report);
    }
    let acceleration = &shaking.acceleration;
    let Some(rows) = increasing(acceleration, report) else {
        return Vec::new();
    };
    let rows: Vec<(f64, [f64; 3])> = rows
        .map(|row| (row[0], [0, 1, 2].map(|axis| component(row, axis))))
        .collect();
    if rows.iter().all(|(_, ground)| *ground == [0.0; 3]) {
        acceleration.error(
            "E0415: all accelerations are zero, so the ground does not shake. Delete [shaking].",
            report,
        );
        return Vec::new();
    }
    let Some((end, dt)) = times else { return rows };
    let path = acceleration.path();
    warn_of_late(path, rows.iter().map(|row| row.0), Some(end), report);
    coarse(path, rows.iter().map(|row| row.0), Some(dt), report);
    rows
}

/// Whether the case starts without stress, whatever its [initial] says.
pub(super) fn is_unloaded(draft: &Draft) -> bool {
    draft
        .strength_reduction
        .value()
        .and_then(|reduction| reduction.unloaded.get())
        .unwrap_or(false)
}

/// Lets every load that acts at once grow until `end`.
pub(super) fn grow(
    gravity: Option<&mut Gravity>,
    tractions: &mut [Traction],
    loads: &mut [PointLoad],
    rigid: &mut [Rigid],
    end: f64,
    report: &mut Report<'_>,
) {
    let gravity = gravity.map(|gravity| ("gravity.ramp".to_owned(), &mut gravity.ramp));
    let tractions = tractions
        .iter_mut()
        .enumerate()
        .filter(|(_, load)| load.amplitude.is_empty());
    let tractions = tractions.map(|(k, load)| (format!("traction.{k}.ramp"), &mut load.ramp));
    let loads = loads
        .iter_mut()
        .enumerate()
        .filter(|(_, load)| load.amplitude.is_empty());
    let loads = loads.map(|(k, load)| (format!("point_load.{k}.ramp"), &mut load.ramp));
    let rigid = rigid
        .iter_mut()
        .enumerate()
        .filter(|(_, of)| of.force != [0.0; 3] && of.amplitude.is_empty());
    let rigid = rigid.map(|(k, of)| (format!("rigid.{k}.ramp"), &mut of.ramp));
    let all = gravity.into_iter().chain(tractions).chain(loads).chain(rigid);
    for (key, ramp) in all.filter(|(_, ramp)| **ramp == 0.0) {
        *ramp = end;
        let reason = "strength_reduction.unloaded: every load grows from zero until the end of the analysis";
        report.note(key, format!("{end:?}"), reason);
    }
}
