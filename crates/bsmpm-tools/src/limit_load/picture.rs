//! Draws load against displacement on each grid.

use std::path::{Path, PathBuf};

use bsmpm_scene::SoughtLoad;

use super::report::LimitLoadReport;
use crate::Error;
use crate::batch::RunOrder;
use crate::launch::Outcome;
use crate::picture::axes::Label;
use crate::picture::chart::{Chart, ChartCurve, ChartLevel};
use crate::picture::colour;
use crate::picture::legend::{LegendEntry, Mark};
use crate::report::number;

/// Draws `limit-load.png`; one for every unit if loads have several.
pub(super) fn draw(
    report: &LimitLoadReport,
    orders: &[RunOrder],
    outcomes: &[Outcome],
    output: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let mut units: Vec<&str> = report.loads.iter().map(|load| &*load.unit).collect();
    units.dedup();
    let mut files = Vec::new();
    for (number, unit) in units.into_iter().enumerate() {
        let name = if number == 0 {
            "limit-load.png".to_owned()
        } else {
            format!("limit-load_{number}.png")
        };
        let file = output.join(name);
        draw_unit(report, unit, &curves(unit, orders, outcomes)).save(&file)?;
        files.push(file);
    }
    Ok(files)
}

fn draw_unit(report: &LimitLoadReport, unit: &str, curves: &[ChartCurve]) -> crate::picture::canvas::Canvas {
    let loads = report.loads.iter().filter(|load| load.unit == *unit);
    let levels = loads.map(|load| ChartLevel {
        value: load.load,
        text: format!("{}, extrapolated", load.name),
    });
    let below = format!(
        "stabilisation {}, {} points along each axis of a cell, {} steps; displacements multiplied by the stiffness factor",
        report.stabilisation, report.points_per_cell[0], report.steps
    );
    let levels: Vec<ChartLevel> = levels.collect();
    Chart {
        title: &report.title,
        below: &below,
        x: Label::of("Displacement", "m"),
        y: Label::of("Load", unit),
        curves,
        levels: &levels,
        legend: curves.iter().map(|curve| &curve.entry).collect(),
    }
    .draw()
}

/// A curve for every load in this unit on every grid.
fn curves(unit: &str, orders: &[RunOrder], outcomes: &[Outcome]) -> Vec<ChartCurve> {
    let mut curves = Vec::new();
    let count = orders.len();
    for (grid, (order, outcome)) in orders.iter().zip(outcomes).enumerate() {
        let loads = order.case.limit_load.iter().flat_map(|sought| &sought.loads);
        for load in loads.filter(|load| load.unit == *unit) {
            let name = format!("{}, cells of {} m", load.name, number(order.case.grid.shortest()));
            let entry = LegendEntry {
                name,
                colour: colour::line(grid, count),
                mark: Mark::Line,
            };
            curves.push(ChartCurve {
                entry,
                places: places(load, order, outcome),
            });
        }
    }
    curves
}

/// m and the load's unit: displacement, multiplied by the stiffness factor, and load of every step.
fn places(load: &SoughtLoad, order: &RunOrder, outcome: &Outcome) -> Vec<[f64; 2]> {
    let Some(history) = &outcome.history else {
        return Vec::new();
    };
    let stiffness = order.case.limit_load.as_ref().map_or(1.0, |sought| sought.stiffness);
    let times = history.get("time").unwrap_or_default();
    let mut places = Vec::new();
    for (row, time) in times.iter().enumerate() {
        let [x, y, z] = load.path.at(*time);
        let parts = load
            .columns
            .iter()
            .map(|(column, weight)| Some(weight * history.get(column)?.get(row)?));
        if let Some(load) = parts.sum::<Option<f64>>() {
            places.push([stiffness * x.hypot(y).hypot(z), load]);
        }
    }
    places
}
