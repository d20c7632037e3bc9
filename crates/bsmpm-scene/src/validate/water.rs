//! Water in the ground.

use super::STANDARD_GRAVITY;
use super::load::increasing;
use super::uplift;
use crate::case::{Body, Case, Gravity, Support, Water};
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::words::{Side, Word};
use bsmpm::model::Regime;
use bsmpm::water::ambient::{Ambient, LevelAt};

/// Slope of a phreatic line up to which the depth straight below it is taken for the pressure without a word: along a
/// slope that water flows down in parallel it is cos^2 less, 6 % here.
const GENTLE: f64 = 0.25;

/// Water, if any; none after an error.
pub(super) fn read(
    root: &Record,
    (grid, gravity): (Option<&GridSpec>, Option<&Gravity>),
    regime: Option<Regime>,
    end: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Water> {
    let Some(record) = root.record("water") else {
        for (_, material) in root.named("material") {
            if material.gives("saturated_unit_weight") {
                material.error("saturated_unit_weight", "has no meaning without [water]", report);
            }
        }
        return None;
    };
    if ["level", "level_path", "line", "line_path"].iter().all(|key| !record.gives(key)) {
        if !super::flow::flows(root) {
            let message =
                "missing: one of level, level_path, line, line_path: no water flows, and there is none that is still";
            report.error(record.origin, &record.path, message);
        }
        return None;
    }
    let table = table(record, (grid?, end), report)?;
    let given = record.number("unit_weight")?;
    if !root.gives("gravity") {
        report.error(record.origin, &record.path, "water weighs nothing without [gravity]");
    }
    let (acceleration, axes) = (gravity?.acceleration, grid?.dims());
    if !gravity?.acts_down(axes, regime) {
        let message = format!("{:?} is not straight down, which still water needs", &acceleration[..axes]);
        root.record("gravity")?.error("acceleration", message, report);
    }
    if !(8_000.0..=12_000.0).contains(&given) {
        report.warn(format!("{}: {given} N/m3 is unusual for water: check the unit", record.path_of("unit_weight")));
    }
    let unit_weight = given / STANDARD_GRAVITY * acceleration[axes - 1].abs();
    if unit_weight != given {
        let reason = format!("{given} N/m3 is that under 9.81 m/s2, as of materials");
        report.note(record.path_of("unit_weight"), format!("{unit_weight}"), reason);
    }
    Some(Water { unit_weight, table })
}

/// The water table, somewhere above the grid's base.
fn table(record: &Record, (grid, end): (&GridSpec, Option<f64>), report: &mut Report<'_>) -> Option<Ambient> {
    let key = ["level", "level_path", "line", "line_path"].into_iter().find(|key| record.gives(key))?;
    let rows = |report: &mut Report<'_>| Some(increasing(record, key, report)?.map(|row| (row[0], row[1])));
    let table = match key {
        "level" => Ambient::Level(vec![(0.0, record.number("level")?)]),
        "level_path" => Ambient::Level(rows(report)?.collect()),
        "line" => Ambient::Line(rows(report)?.map(|(x, y)| LevelAt { x, rows: vec![(0.0, y)] }).collect()),
        _ => Ambient::Line(lines(record, key, report)?),
    };
    // Ground may have suction above a table that is below it.
    let (base, axis) = (grid.lower()[grid.dims() - 1], ["x", "y", "z"][grid.dims() - 1]);
    let heights = || table.levels().into_iter().flatten();
    if !record.gives("suction") && heights().all(|row| row.1 <= base) {
        let message = format!(
            "the water table is nowhere above the grid's lower face, {axis} = {base}: leave [water] out, or give \
                     it a `suction`, which ground has above a table that is below it"
        );
        record.error(key, message, report);
        return None;
    }
    if let Some((t, _)) = heights().find(|(t, _)| end.is_some_and(|end| *t > end)) {
        report.warn(format!("{}: the row at t = {t} is beyond the end of the run", record.path_of(key)));
    }
    steep((&table, grid), (record, key), report);
    Some(table)
}

/// Lines of the same places at times.
fn lines(record: &Record, key: &str, report: &mut Report<'_>) -> Option<Vec<LevelAt>> {
    let rows = record.rows(key)?;
    let mut places: Vec<LevelAt> = Vec::new();
    let count = rows.iter().take_while(|row| row.numbers[0] == rows[0].numbers[0]).count();
    for (number, row) in rows.iter().enumerate() {
        let [t, x, y] = [0, 1, 2].map(|k| row.numbers[k]);
        let at = number % count;
        let wrong = if number < count {
            (at > 0 && places[at - 1].x >= x).then(|| format!("x = {x} is not above that of the row before"))
        } else if places[at].x != x || (at > 0 && rows[number - 1].numbers[0] != t) {
            Some(format!("t = {t}, x = {x}: the places of a time are those of the first, in their order"))
        } else if at == 0 && rows[number - 1].numbers[0] >= t {
            Some(format!("t = {t} is not above {}, that of the line before", rows[number - 1].numbers[0]))
        } else {
            None
        };
        if let Some(message) = wrong {
            report.error(row.origin, &record.path_of(key), message);
            return None;
        }
        if number < count {
            places.push(LevelAt { x, rows: Vec::new() });
        }
        places[at].rows.push((t, y));
    }
    if places.is_empty() || places.iter().any(|place| place.rows.len() != places[0].rows.len()) {
        record.error(key, "it needs at least one line, and every line all places", report);
        return None;
    }
    Some(places)
}

/// A line so steep that the depth below it is not the pressure, where water flows along it, or that points do not see
/// its step.
fn steep((table, grid): (&Ambient, &GridSpec), (record, key): (&Record, &str), report: &mut Report<'_>) {
    let Ambient::Line(places) = table else { return };
    let slope = |pair: &[LevelAt]| {
        let heights = pair[0].rows.iter().zip(&pair[1].rows);
        heights.map(|(from, to)| (to.1 - from.1).abs()).fold(0.0, f64::max) / (pair[1].x - pair[0].x)
    };
    let (key, cell) = (record.path_of(key), grid.axes[0].shortest());
    let is_step = |pair: &&[LevelAt]| slope(pair) > 1.0 && pair[1].x - pair[0].x < cell;
    if let Some(step) = places.windows(2).find(is_step) {
        let [from, to] = [step[0].x, step[1].x];
        report.warn(format!(
            "{key}: its step from x = {from} to {to} is narrower than a cell, {cell}: the water's thrust acts on what points lie \
             there, and is too small or none where they lie beside it; let the line fall over a cell or more"
        ));
    }
    let steepest = places.windows(2).filter(|pair| !is_step(pair)).map(slope).fold(0.0, f64::max);
    if steepest > GENTLE {
        report.warn(format!(
            "{key}: a slope of {steepest:.3}: the pressure is that of the depth straight below the line; where water flows along \
             it, it is less, by {:.0} % there, and factors of safety are on the safe side",
            100.0 * steepest * steepest / (1.0 + steepest * steepest)
        ));
    }
}

/// What only the whole case shows.
pub(super) fn check(case: &Case, record: &Record, report: &mut Report<'_>) {
    let (Some(water), Some(written)) = (&case.water, record.record("water")) else { return };
    if case.shaking.iter().any(|(_, ground)| *ground != [0.0; 3]) {
        let message =
            "the pressure of still water does not follow ground that shakes: [shaking] cannot be used with [water]";
        report.error(written.origin, &written.path, message);
    }
    for (side, support) in Side::of(case.geometry).iter().flatten().zip(case.boundary.into_iter().flatten()) {
        if matches!(support, Support::Absorbing | Support::FreeField) {
            let message = "with [water]: what absorbs was not shown to be right beside water: use \"roller\"";
            let side = side.word();
            report.error(record.place("boundary"), &format!("boundary.{side}"), message);
        }
    }
    floating(case, water, record, report);
    uplift::warn(case, water, report);
    let levels = water.table.levels();
    let highest = levels.into_iter().flatten().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
    let up = case.grid.dims() - 1;
    let low = case.bodies.iter().map(|body| body.region.corners()[0][up]).fold(f64::INFINITY, f64::min);
    if highest <= low && !written.gives("suction") {
        report.warn("water: the water table is below all bodies: it does nothing");
    }
    if !case.tractions.is_empty() || !case.point_loads.is_empty() {
        let reason = "the water presses on wet surfaces by itself; loads are what acts besides";
        report.note("water", "loads besides", reason);
    }
    let wets = |body: &usize| case.materials[case.bodies[*body].material].saturated.is_some();
    if water.table.moves() && case.stages.iter().any(|stage| stage.add.iter().any(wets)) {
        report.warn(
            "water: bodies that a stage places weigh saturated_unit_weight below the level at time 0, wherever it \
             is when they come",
        );
    }
}

/// Ground that the water lifts.
fn floating(case: &Case, water: &Water, record: &Record, report: &mut Report<'_>) {
    let Some(gravity) = &case.gravity else { return };
    let weight = |number: usize| {
        let named = &case.materials[number];
        named.saturated.or(named.density).unwrap_or(0.0) * gravity.acceleration[case.grid.dims() - 1].abs()
    };
    let up = case.grid.dims() - 1;
    let highest = water.table.levels().into_iter().flatten().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
    let is_wet = |body: &Body| body.region.corners()[0][up] < highest;
    for (number, (name, written)) in record.named("material").iter().enumerate() {
        if weight(number) < water.unit_weight && case.bodies.iter().any(|body| body.material == number && is_wet(body))
        {
            let message = format!(
                "missing or too little: material.{name} is lighter than water, {:.6} kN/m3, and would float where it lies below the table",
                water.unit_weight * 1e-3
            );
            let key = ["saturated_unit_weight", "unit_weight", "density"].into_iter().find(|key| written.gives(key));
            match key {
                Some(key) => written.error(key, message, report),
                None => report.error(written.origin, &written.path, message),
            }
        }
    }
}
