//! Warns of soil and drains above the water table, and of heads above the ground.

use super::crossing::places;
use crate::case::{Case, Flow, Water};
use crate::report::Report;
use crate::validate::side::side;
use bsmpm::field::pore_water::flow::{Course, Given};
use bsmpm_shapes::GridAxis;

/// Cells of water that a step may let into the ground where a drain lies above the water table.
const FILM: f64 = 0.1;

/// Water that begins without the pressure of its own weight.
pub(super) fn weighed(case: &Case, report: &mut Report<'_>) {
    if case.gravity.is_some() && case.water.is_none() {
        report.warn(
            "W0551: water: the case has gravity but no water table, so pore pressures are zero at the start, and the \
             hydrostatic pressure builds up in time like an excess pressure. Give `water.level`.",
        );
    }
}

/// Drains above the water table, which let water in without end where the ground would take it.
pub(super) fn ponds(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = &case.water else { return };
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    let cell = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    // Without a table all of the ground is above it: what is let in sinks, if it has weight.
    let none = if case.gravity.is_some() {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    let up = case.grid.dims() - 1;
    let permeable = flow
        .soils
        .iter()
        .flatten()
        .filter_map(|soil| soil.permeability.as_ref());
    let most = permeable.map(|k| k.along.max()).fold(0.0, f64::max);
    let end = case.analysis.end;
    let dt = case
        .analysis
        .growth
        .map_or(case.analysis.dt, |(_, longest)| longest.min(end));
    // What has suction loses it in however many steps.
    let (time, period) = if flow.retains() {
        (end, "during the analysis")
    } else {
        (dt, "in one step")
    };
    let height = most * time / cell;
    for (number, drain) in flow
        .drains
        .iter()
        .enumerate()
        .filter(|(_, drain)| drain.given == Given::StillWater)
    {
        let is_dry = height > FILM
            && places(drain, case)
                .iter()
                .any(|at| at[up] > lowest_table(water, &times, at[0], none) + 0.5 * cell);
        if is_dry {
            report.warn(format!(
                "W0552: drain.{number}: above the water table soil suction draws water from this drain, a layer up to \
                 {height:.1} cells high {period}. Set `seepage = true`, or for a pond give its `head`."
            ));
        }
    }
}

/// m  lowest water table at x over some times, `none` when there is none
fn lowest_table(water: &Water, times: &[f64], x: f64, none: f64) -> f64 {
    let heights = times.iter().map(|t| water.table.table(x, *t));
    heights
        .map(|table| table.map_or(none, |(height, _)| height))
        .fold(f64::INFINITY, f64::min)
}

/// Ground above the water table whose pores stay full all the same: the water in them hangs on its skeleton.
pub(super) fn hanging(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = case.water.as_ref().filter(|_| case.grid.dims() == 2) else {
        return;
    };
    let lower = case.grid.lower();
    let cell = case.grid.shortest();
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    for (number, named) in case.materials.iter().enumerate() {
        let is_full = flow.soils[number]
            .as_ref()
            .is_some_and(|soil| soil.permeability.is_some() && soil.retention.is_none());
        if !is_full {
            continue;
        }
        let made = case.bodies.iter().filter(|body| body.material == number);
        let corners = made
            .flat_map(|body| body.region.edges(&case.grid.axes).0)
            .flat_map(|edge| [edge.a, edge.b]);
        let above = corners.flat_map(|[x, y]| {
            let heights = times.iter().filter_map(move |t| water.table.table(lower[0] + x, *t));
            heights.map(move |(height, _)| lower[1] + y - height)
        });
        let most = above.fold(0.0, f64::max);
        if most > cell {
            report.warn(format!(
                "W0553: material.{}: the soil stays saturated to {most:.2} m above the water table, and suction (to \
                 {:.0} kPa) strengthens it. Add `retention`. If that soil is dry, set drainage = \"hydrostatic\".",
                named.name,
                1e-3 * most * water.unit_weight
            ));
        }
    }
}

/// Heads above a body's surface, where water would stand on it and press; but for what still water presses.
pub(super) fn weightless(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let up = case.grid.dims() - 1;
    let cell = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    for (number, drain) in flow.drains.iter().enumerate() {
        let Given::Head(Course(rows)) = &drain.given else {
            continue;
        };
        let lines = drain.site.lines();
        if !lines
            .iter()
            .any(|line| side(line, &case.grid, case.bodies.iter()).is_some())
        {
            continue; // a face of the grid, or a well inside the ground
        }
        let highest = rows.iter().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
        let above = places(drain, case)
            .into_iter()
            .map(|at| highest - at[up].max(still_water(case, at[0])));
        let most = above.fold(0.0, f64::max);
        if most > 0.5 * cell {
            report.warn(format!(
                "W0554: drain.{number}: the head is up to {most:.3} m above the surface of the soil, but no water \
                 presses on the surface. For a pond or reservoir give `water.level` instead of `head`."
            ));
        }
    }
}

/// m  the highest level of the still water at x
fn still_water(case: &Case, x: f64) -> f64 {
    let tables = case.water.iter().map(|water| &water.table);
    let heights = tables.flat_map(|table| {
        let rows = table.levels().into_iter().flatten();
        rows.filter_map(move |row| table.table(x, row.0))
    });
    heights.map(|(height, _)| height).fold(f64::NEG_INFINITY, f64::max)
}
