//! Validates hydrostatic water.

use super::course::increasing;
use super::uplift;
use crate::case::{Case, Gravity, Support, Water};
use crate::constants::STANDARD_GRAVITY;
use crate::grid::GridSpec;
use crate::record::{CaseTable, Field, KeyPlace, ListRow};
use crate::report::Report;
use crate::schema::{Draft, WaterTable};
use crate::words::{Side, Word};
use bsmpm::field::pore_water::ambient::{Ambient, LevelAt};
use bsmpm::model::Regime;

/// Slope of a phreatic line up to which the depth straight below it is taken for the pressure without a word: along a
/// slope that water flows down in parallel it is cos^2 less, 6 % here.
const GENTLE: f64 = 0.25;

/// Water, if any; none after an error.
pub(super) fn read(
    draft: &Draft,
    grid: Option<&GridSpec>,
    gravity: Option<&Gravity>,
    regime: Option<Regime>,
    end: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Water> {
    let Some(record) = draft.water.value() else {
        refuse_saturated_weights(draft, report);
        return None;
    };
    if record.gives_no_table() {
        if !super::flow::flows(draft) {
            let message = "E0521: [water] gives no water table, and no material has pore-water flow, so [water] has \
                           no effect. Give one of `level`, `level_path`, `line` and `line_path`, or remove [water].";
            record.location().error(message, report);
        }
        return None;
    }
    let table = table(record, grid?, end, report)?;
    let given = record.unit_weight.get()?;
    if !draft.gravity.is_given() {
        let message = "E0522: hydrostatic pressure requires gravity, and the case has none. Add [gravity], or \
                       remove the water table.";
        record.location().error(message, report);
    }
    let acceleration = gravity?.acceleration;
    let axes = grid?.dims();
    if !gravity?.acts_down(axes, regime) {
        let message = format!(
            "E0523: gravity of {:?} m/s2 does not point vertically downwards, but hydrostatic pore pressure requires \
             this direction. Give a negative {} component, and set the other components to zero.",
            &acceleration[..axes],
            ["x", "y", "z"][axes - 1]
        );
        draft.gravity.value()?.acceleration.error(message, report);
    }
    if !(8_000.0..=12_000.0).contains(&given) {
        report.warn(format!(
            "W0520: {}: {given} N/m3 is an unusual unit weight of water (8000 to 12000 N/m3), and scales all pore \
             pressures. Check the unit.",
            record.unit_weight.path()
        ));
    }
    let unit_weight = given / STANDARD_GRAVITY * acceleration[axes - 1].abs();
    if unit_weight != given {
        let reason = format!("{given} N/m3 applies to 9.81 m/s2, and is scaled to the gravity of this case");
        report.note(record.unit_weight.path(), format!("{unit_weight}"), reason);
    }
    Some(Water { unit_weight, table })
}

/// Refuses unit weights of soil below the water table in a case without one.
fn refuse_saturated_weights(draft: &Draft, report: &mut Report<'_>) {
    for (_, material) in draft.material.items() {
        if material.saturated_unit_weight.is_given() {
            let message = "E0520: `saturated_unit_weight` has no effect, because the case has no water table. \
                           Give `water.level`, or remove `saturated_unit_weight`.";
            material.saturated_unit_weight.error(message, report);
        }
    }
}

/// The water table, somewhere above the grid's base.
fn table(record: &WaterTable, grid: &GridSpec, end: Option<f64>, report: &mut Report<'_>) -> Option<Ambient> {
    let (table, key): (_, &KeyPlace) = if record.level.is_given() {
        let level = vec![(0.0, record.level.get()?)];
        (Ambient::Level(level), &record.level)
    } else if record.level_path.is_given() {
        let rows = increasing(&record.level_path, report)?;
        let levels = rows.map(|row| (row[0], row[1])).collect();
        (Ambient::Level(levels), &record.level_path)
    } else if record.line.is_given() {
        let places = increasing(&record.line, report)?.map(|row| LevelAt {
            x: row[0],
            rows: vec![(0.0, row[1])],
        });
        (Ambient::Line(places.collect()), &record.line)
    } else {
        let places = lines(&record.line_path, report)?;
        (Ambient::Line(places), &record.line_path)
    };
    // Ground may have suction above a table that is below it.
    let base = grid.lower()[grid.dims() - 1];
    let axis = ["x", "y", "z"][grid.dims() - 1];
    let heights: Vec<(f64, f64)> = table.levels().concat();
    if !record.suction.is_given() && heights.iter().all(|row| row.1 <= base) {
        let message = format!(
            "E0524: the water table never rises above the bottom of the grid ({axis} = {base} m), so it has no \
             effect. Raise the water table, remove [water], or give `suction` for unsaturated soil."
        );
        key.error(message, report);
        return None;
    }
    if let Some((t, _)) = heights.iter().find(|(t, _)| end.is_some_and(|end| *t > end)) {
        report.warn(format!(
            "W0521: {}: the row at t = {t} s is after the end of the analysis, so its water level is never reached. \
             Increase `analysis.end`, or remove the row.",
            key.path()
        ));
    }
    steep(&table, grid, key.path(), report);
    Some(table)
}

/// Lines of the same places at times.
fn lines(line_path: &Field<Vec<ListRow>>, report: &mut Report<'_>) -> Option<Vec<LevelAt>> {
    let rows = line_path.value()?;
    let mut places: Vec<LevelAt> = Vec::new();
    let count = rows
        .iter()
        .take_while(|row| row.numbers[0] == rows[0].numbers[0])
        .count();
    for (number, row) in rows.iter().enumerate() {
        let [t, x, y] = [0, 1, 2].map(|k| row.numbers[k]);
        let at = number % count;
        let wrong = if number < count {
            let is_behind = at > 0 && places[at - 1].x >= x;
            is_behind.then(|| {
                format!(
                    "E0525: x = {x} m is not greater than x of the previous row. Sort the points of the phreatic \
                     line by x."
                )
            })
        } else if places[at].x != x || (at > 0 && rows[number - 1].numbers[0] != t) {
            Some(format!(
                "E0525: the point at x = {x} m of the phreatic line at t = {t} s does not match the line at the \
                 first time. Give the same values of x, in the same order, at each time."
            ))
        } else if at == 0 && rows[number - 1].numbers[0] >= t {
            Some(format!(
                "E0525: t = {t} s is not later than the time of the previous phreatic line, {} s. Sort the lines by \
                 time.",
                rows[number - 1].numbers[0]
            ))
        } else {
            None
        };
        if let Some(message) = wrong {
            report.error(row.origin, line_path.path(), message);
            return None;
        }
        if number < count {
            places.push(LevelAt { x, rows: Vec::new() });
        }
        places[at].rows.push((t, y));
    }
    if places.is_empty() || places.iter().any(|place| place.rows.len() != places[0].rows.len()) {
        let message = "E0525: a phreatic line has fewer points than the line at the first time. Give the same values \
                       of x, in the same order, at each time.";
        line_path.error(message, report);
        return None;
    }
    Some(places)
}

/// A line so steep that the depth below it is not the pressure, where water flows along it, or that points do not see
/// its step.
fn steep(table: &Ambient, grid: &GridSpec, key: &str, report: &mut Report<'_>) {
    let Ambient::Line(places) = table else { return };
    let cell = grid.axes[0].shortest();
    let (steps, slopes): (Vec<_>, Vec<_>) = places
        .windows(2)
        .partition(|pair| slope(pair) > 1.0 && pair[1].x - pair[0].x < cell);
    if let Some(step) = steps.first() {
        let [from, to] = [step[0].x, step[1].x];
        report.warn(format!(
            "W0522: {key}: the water table drops between x = {from} and {to} m, in less than a cell ({cell} m), so \
             the water thrust is too small. Extend the drop over at least one cell."
        ));
    }
    let steepest = slopes.into_iter().map(slope).fold(0.0, f64::max);
    if steepest > GENTLE {
        report.warn(format!(
            "W0523: {key}: the line has a slope of {steepest:.3} (limit {GENTLE}). If water flows along it, pore \
             pressures are {:.0} % too high. Accept this as conservative, or set `drainage = \"coupled\"`.",
            100.0 * steepest * steepest / (1.0 + steepest * steepest)
        ));
    }
}

/// The largest slope of a line between two of its places.
fn slope(pair: &[LevelAt]) -> f64 {
    let heights = pair[0].rows.iter().zip(&pair[1].rows);
    heights.map(|(from, to)| (to.1 - from.1).abs()).fold(0.0, f64::max) / (pair[1].x - pair[0].x)
}

/// What only the whole case shows.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(water) = &case.water else { return };
    let Some(written) = draft.water.value() else { return };
    if case.shaking.iter().any(|(_, ground)| *ground != [0.0; 3]) {
        let message = "E0526: [water] and [shaking] cannot be combined, because the pore pressures of [water] stay \
             hydrostatic during an earthquake. Remove [water], and use undrained strengths.";
        written.location().error(message, report);
    }
    for (side, support) in Side::of(case.geometry)
        .iter()
        .flatten()
        .zip(case.boundary.into_iter().flatten())
    {
        if matches!(support, Support::Absorbing | Support::FreeField) {
            let message = format!(
                "E0527: the boundary condition \"{support}\" is not available together with [water], because its \
                 dashpots would neglect the pore water. Use \"roller\"."
            );
            let side = side.word();
            report.error(draft.boundary.origin(), &format!("boundary.{side}"), message);
        }
    }
    floating(case, water, draft, report);
    uplift::warn(case, water, report);
    let levels = water.table.levels();
    let highest = levels
        .into_iter()
        .flatten()
        .map(|row| row.1)
        .fold(f64::NEG_INFINITY, f64::max);
    let up = case.grid.dims() - 1;
    let low = case
        .bodies
        .iter()
        .map(|body| body.region.corners()[0][up])
        .fold(f64::INFINITY, f64::min);
    if highest <= low && !written.suction.is_given() {
        report.warn(format!(
            "W0524: water: the water table (at most at {highest} m) is below all bodies (lowest point at {low} m), \
             so it has no effect. Raise the water table, or remove [water]."
        ));
    }
    if !case.tractions.is_empty() || !case.point_loads.is_empty() {
        let reason = "water pressure on submerged surfaces is applied automatically; do not include it in the loads";
        report.note(draft.water.path(), "in addition to loads", reason);
    }
    let mut added = case.stages.iter().flat_map(|stage| &stage.add);
    let is_wetted = added.any(|body| case.materials[case.bodies[*body].material].saturated.is_some());
    if water.table.moves() && is_wetted {
        report.warn(
            "W0525: water: bodies that a stage adds get the saturated unit weight below the water level of t = 0, \
             although the level moves. Give such bodies a material with the unit weight at their stage.",
        );
    }
}

/// Ground that the water lifts.
fn floating(case: &Case, water: &Water, draft: &Draft, report: &mut Report<'_>) {
    let Some(gravity) = &case.gravity else { return };
    let up = case.grid.dims() - 1;
    let highest = water
        .table
        .levels()
        .into_iter()
        .flatten()
        .map(|row| row.1)
        .fold(f64::NEG_INFINITY, f64::max);
    for (number, (_, written)) in draft.material.items().iter().enumerate() {
        let named = &case.materials[number];
        let weight = named.saturated.or(named.density).unwrap_or(0.0) * gravity.acceleration[up].abs();
        let mut bodies = case.bodies.iter().filter(|body| body.material == number);
        if weight < water.unit_weight && bodies.any(|body| body.region.corners()[0][up] < highest) {
            let message = format!(
                "E0528: the unit weight of this soil below the water table is missing or below that of water ({:.2} \
                 kN/m3), so the soil would float. Set `saturated_unit_weight`, for example to \"20 kN/m3\".",
                water.unit_weight * 1e-3
            );
            let keys = [&written.saturated_unit_weight, &written.unit_weight, &written.density];
            match keys.into_iter().find(|key| key.is_given()) {
                Some(key) => key.error(message, report),
                None => written.location().error(message, report),
            }
        }
    }
}
