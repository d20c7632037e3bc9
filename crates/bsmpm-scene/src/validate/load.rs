//! Tractions, point loads, and the stress at the start.

use super::place::{along, at_body, beyond};
use super::strip::{AroundStrip, segment};
use crate::case::{Body, Gravity, Initial, NamedMaterial, PointLoad, Traction};
use crate::record::Record;
use crate::report::Report;
use crate::words::Start;

/// All tractions in the order of the file, without those that have an error.
pub(super) fn tractions(root: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<Traction> {
    let mut read = |record: &Record| {
        let ends = segment(record, around, report);
        if let Some(ends) = ends {
            acts_on_body(record, "from", along(ends), around, report);
        }
        let ramp = ramp(record, around.end, report);
        let ([from, to], stress, ramp) = (ends?, record.pair("stress")?, ramp?);
        warn_of_nothing(record, "stress", stress, report);
        Some(Traction { from, to, stress, ramp })
    };
    root.records("traction").iter().filter_map(&mut read).collect()
}

/// All point loads in the order of the file, without those that have an error.
pub(super) fn point_loads(root: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<PointLoad> {
    let mut read = |record: &Record| {
        let (at, ramp) = (record.pair("at")?, ramp(record, around.end, report));
        let grid = around.grid?;
        if let Some(message) = beyond(grid, at) {
            record.error("at", message, report);
        } else {
            acts_on_body(record, "at", std::iter::once(at), around, report);
        }
        let force = record.pair("force")?;
        warn_of_nothing(record, "force", force, report);
        Some(PointLoad { at, force, ramp: ramp? })
    };
    root.records("point_load").iter().filter_map(&mut read).collect()
}

fn warn_of_nothing(record: &Record, key: &str, load: [f64; 2], report: &mut Report<'_>) {
    if load == [0.0; 2] {
        report.warn(format!("{}: zero: it does nothing", record.path_of(key)));
    }
}

/// A load has a body under every part of it.
fn acts_on_body(
    record: &Record,
    key: &str,
    mut places: impl Iterator<Item = [f64; 2]>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) {
    let (Some(grid), Some(bodies)) = (around.grid, around.bodies) else { return };
    if let Some(at) = places.find(|at| !at_body(bodies, grid, *at)) {
        let message = format!("no body is at {at:?} at the start; allowed: half a spacing of points from one");
        record.error(key, message, report);
    }
}

fn ramp(record: &Record, end: Option<f64>, report: &mut Report<'_>) -> Option<f64> {
    let ramp = record.number("ramp")?;
    if end.is_some_and(|end| ramp > end) {
        report.warn(format!("{}: {ramp} is beyond the end of the run; it never acts in full", record.path_of("ramp")));
    }
    Some(ramp)
}

/// The stress at the start, if any: the whole gravity acts from time 0 then.
pub(super) fn initial(
    root: &Record,
    (materials, bodies): (Option<&[NamedMaterial]>, Option<&[Body]>),
    gravity: Option<&Gravity>,
    report: &mut Report<'_>,
) -> Option<Initial> {
    let record = root.record("initial");
    let elastic = record.is_some_and(|record| record.gives("gravity"));
    if record.is_none() || elastic {
        let what = if elastic { "with initial.gravity" } else { "without [initial]" };
        for (_, material) in root.named("material").iter().filter(|(_, material)| material.gives("k0")) {
            material.error("k0", format!("has no meaning {what}"), report);
        }
    }
    let record = record?;
    loaded(root, record, (materials, bodies), gravity, report);
    if elastic {
        return record.word("gravity").map(|start| match start {
            Start::Elastic => Initial::Elastic,
        });
    }
    if let Some(gravity) = gravity.filter(|gravity| gravity.acceleration[0] != 0.0 || gravity.acceleration[1] >= 0.0) {
        let message = format!("{:?} is not straight down, which a state by k0 needs", gravity.acceleration);
        root.record("gravity")?.error("acceleration", message, report);
    }
    at_rest(root, record, bodies?, report).map(Initial::AtRest)
}

/// Whether the case starts without stress, whatever its [initial] says.
pub(super) fn is_unloaded(root: &Record) -> bool {
    root.record("strength_reduction").and_then(|reduction| reduction.flag("unloaded")).unwrap_or(false)
}

/// Lets every load that acts at once grow until `end`.
pub(super) fn grow(
    (gravity, tractions, loads): (Option<&mut Gravity>, &mut [Traction], &mut [PointLoad]),
    end: f64,
    report: &mut Report<'_>,
) {
    let gravity = gravity.map(|gravity| ("gravity.ramp".to_owned(), &mut gravity.ramp));
    let named = |name, number| format!("{name}.{number}.ramp");
    let tractions = tractions.iter_mut().enumerate().map(|(k, load)| (named("traction", k), &mut load.ramp));
    let loads = loads.iter_mut().enumerate().map(|(k, load)| (named("point_load", k), &mut load.ramp));
    for (key, ramp) in gravity.into_iter().chain(tractions).chain(loads).filter(|(_, ramp)| **ramp == 0.0) {
        *ramp = end;
        report.note(key, format!("{end:?}"), "strength_reduction.unloaded");
    }
}

/// Warns of loads that act in full from the start: a state by k0 knows the weight alone.
pub(super) fn sudden(tractions: &[Traction], loads: &[PointLoad], initial: Option<&Initial>, report: &mut Report<'_>) {
    if !matches!(initial, Some(Initial::AtRest(_))) {
        return;
    }
    let tractions = tractions.iter().map(|traction| ("traction", traction.ramp)).enumerate();
    let loads = loads.iter().map(|load| ("point_load", load.ramp)).enumerate();
    for (number, (name, _)) in tractions.chain(loads).filter(|(_, (_, ramp))| *ramp == 0.0) {
        report.warn(format!(
            "{name}.{number}: acts in full from time 0, and the stress at the start by k0 does not hold it; give it a ramp"
        ));
    }
}

/// Gravity must act from the start, on something.
fn loaded(
    root: &Record,
    record: &Record,
    (materials, bodies): (Option<&[NamedMaterial]>, Option<&[Body]>),
    gravity: Option<&Gravity>,
    report: &mut Report<'_>,
) {
    if !root.gives("gravity") {
        report.error(record.origin, &record.path, "a stress at the start needs [gravity]");
    }
    if let (Some(gravity), Some(written)) = (gravity, root.record("gravity"))
        && gravity.ramp > 0.0
    {
        let message =
            format!("{} with [initial]: gravity acts in full from the start then; allowed: 0.0", gravity.ramp);
        written.error("ramp", message, report);
    }
    if let (Some(materials), Some(bodies)) = (materials, bodies)
        && bodies.iter().all(|body| materials[body.material].density.is_none())
    {
        report.error(record.origin, &record.path, "a stress at the start needs mass: no body has any");
    }
}

/// The coefficient of every material; 0 for those without that no body is made of.
fn at_rest(root: &Record, record: &Record, bodies: &[Body], report: &mut Report<'_>) -> Option<Vec<f64>> {
    if record.gives("k0") && record.number("k0").is_none() {
        return None;
    }
    let named = root.named("material");
    let mut found = Vec::with_capacity(named.len());
    for (number, (name, material)) in named.iter().enumerate() {
        let own = if material.gives("k0") { Some(material.number("k0")?) } else { record.number("k0") };
        if own.is_none() && bodies.iter().any(|body| body.material == number) {
            let message = format!("missing: k0 (or one in [material.{name}]), or gravity = \"elastic\"");
            report.error(record.origin, &record.path, message);
            return None;
        }
        found.push(own.unwrap_or(0.0));
    }
    Some(found)
}
