//! Warns of permanent loads that only absorbing boundaries resist: their dashpots carry no static load, so the ground
//! drifts.

use super::physics::{ALONG, holds_at_rest};
use super::place::{along, ring};
use super::site::{normal, normal_of};
use crate::case::{ActiveLoads, Case, Initial, LoadedLine, MotionPath, Push, Rigid, Shares, Site, Support, Traction};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::Draft;
use crate::surfaces::name_of_strip;

/// Part of the largest share or way that the last one may be and count as none: a record of samples ends on no zero.
const NOTHING: f64 = 0.01;

/// Warns of every load and motion that does not end as it began along an axis that nothing else holds.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if !case.is_ever(Support::Absorbing) && !case.is_ever(Support::FreeField) {
        return;
    }
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let held = holds_at_rest(case, axis, None);
        for what in loads(case, axis).filter(|_| !held).chain(rigid(case, draft, axis)) {
            report.warn(format!(
                "W0231: {what}: the load remains at the end, so the ground drifts along {name}, where only absorbing \
                 boundaries (without stiffness) support it. Fix a distant face, or end the load at 0."
            ));
        }
        for what in strips(case, axis) {
            report.warn(format!(
                "W0231: {what}: the motion does not return to 0, so the ground drifts along {name}, where only \
                 absorbing boundaries (without stiffness) support it. Fix a distant face, or end the motion at 0."
            ));
        }
    }
}

/// Tractions and point loads that last along an axis.
fn loads(case: &Case, axis: usize) -> impl Iterator<Item = String> {
    let tractions = case.tractions.iter().enumerate().map(move |(k, of)| {
        let pushes = net(case, of, axis).abs() > ALONG * of.largest();
        (format!("traction.{k}"), of.ramp, &of.amplitude, pushes)
    });
    let forces = case.point_loads.iter().enumerate();
    let forces = forces.map(move |(k, of)| (format!("point_load.{k}"), of.ramp, &of.amplitude, of.force[axis] != 0.0));
    let all = tractions.chain(forces).enumerate();
    let lasting = all.filter(move |(number, (_, ramp, amplitude, pushes))| {
        let acts = case.acts_since(ActiveLoads::Load(*number), 0.0) == Some(0.0);
        *pushes && lasts(case, *ramp, amplitude, axis, acts)
    });
    lasting.map(|(_, (name, ..))| name)
}

/// Whether the share of a load at the end is not the one that `[initial]` has found.
fn lasts(case: &Case, ramp: f64, amplitude: &Shares, axis: usize, acts_at_start: bool) -> bool {
    let is_found = acts_at_start && (case.settles || case.initial == Some(Initial::Elastic));
    let first = match amplitude.first() {
        Some((t, share)) if *t == 0.0 => share[axis],
        None if ramp == 0.0 => 1.0,
        _ => 0.0,
    };
    let last = amplitude.last().map_or(1.0, |(_, share)| share[axis]);
    let largest = amplitude.iter().map(|(_, share)| share[axis].abs()).fold(0.0, f64::max);
    let largest = if amplitude.is_empty() { 1.0 } else { largest };
    (last - if is_found { first } else { 0.0 }).abs() > NOTHING * largest
}

/// Whether what moves along a path ends elsewhere along an axis.
fn stays_away(path: &MotionPath, axis: usize) -> bool {
    let largest = path.rows.iter().map(|(_, moved)| moved[axis].abs()).fold(0.0, f64::max);
    path.rows
        .last()
        .is_some_and(|(_, moved)| moved[axis].abs() > NOTHING * largest)
}

/// Pa  what a traction pushes with along an axis, in the mean over its places.
fn net(case: &Case, traction: &Traction, axis: usize) -> f64 {
    let lower = case.grid.lower();
    let upper = case.grid.upper();
    let places: Vec<([f64; 2], [f64; 2])> = match traction.line {
        LoadedLine::Segment { from, to } => along([from, to]).map(|at| (at, normal(from, to))).collect(),
        LoadedLine::Circle { center, radius } => ring(center, radius)
            .filter(|at| (0..2).all(|k| lower[k] <= at[k] && at[k] <= upper[k]))
            .map(|at| (at, [0, 1].map(|k| (center[k] - at[k]) / radius)))
            .collect(),
        LoadedLine::Plate(_) | LoadedLine::Triangles(_) => Vec::new(), // of a solid, of which no face absorbs
    };
    let pushed = places.iter().map(|([_, y], normal)| match traction.push {
        Push::Stress(stress) => stress[axis].at(*y),
        Push::Pressure { profile, side } => side * profile.at(*y) * normal[axis],
    });
    pushed.sum::<f64>() / places.len().max(1) as f64
}

/// Rigid bodies that push along an axis, or stay away from where they began.
fn rigid(case: &Case, draft: &Draft, axis: usize) -> impl Iterator<Item = String> {
    // With gravity all of them are warned of.
    let all = case
        .rigid
        .iter()
        .enumerate()
        .zip(draft.rigid.items())
        .filter(|_| case.gravity.is_none());
    all.filter(move |((number, of), _)| pushes(case, *number, of, axis))
        .map(|(_, record)| record.location().path.clone())
}

/// Whether a rigid body with a number pushes along an axis, or stays away from where it began, and nothing else holds
/// the ground there.
fn pushes(case: &Case, number: usize, of: &Rigid, axis: usize) -> bool {
    let moves = stays_away(&of.path, axis);
    let acting = ActiveLoads::Rigid(number);
    let acts = case.acts_since(acting, 0.0) == Some(0.0);
    let pushes = moves || of.force[axis] != 0.0 && lasts(case, of.ramp, &of.amplitude, axis, acts);
    pushes && !holds_at_rest(case, axis, Some(acting))
}

/// The footing and prescribed motions whose last place along an axis is not the first, and beside which nothing holds.
fn strips(case: &Case, axis: usize) -> impl Iterator<Item = String> {
    let footing = case.footing.iter().map(|of| (of.site, &of.path));
    let all = footing
        .chain(case.prescribed.iter().map(|of| (of.site, &of.path)))
        .enumerate();
    let lasting = all.filter(move |(number, (site, path))| {
        // What is stuck to a face goes along with it, and what lies before it is pushed.
        let pushes = !matches!(site, Site::Face(_)) || normal_of(*site)[axis] != 0.0;
        pushes && stays_away(path, axis) && !holds_at_rest(case, axis, Some(ActiveLoads::Strip(*number)))
    });
    lasting.map(move |(number, _)| name_of_strip(case, number))
}
