//! Determines limit loads from histories at the end of a limit load analysis.

use bsmpm_io::manifest::ManifestLimitLoad;
use bsmpm_io::table::Columns;
use bsmpm_scene::{Case, LimitLoad, SoughtLoad};

/// Part of the displacement from which on the load should not change any more.
const LATE: f64 = 0.75;
/// Relative change since then up to which the limit counts as reached.
const REACHED: f64 = 0.01;
/// Cells across the width for which errors are stated; they are inversely proportional to the number of cells.
const STATED_CELLS: f64 = 16.0;
/// Least and largest error of verified limit loads with so many cells, of both methods; they are too high
/// (verification manual, `scripts/limit-loads`).
const ERRORS_OF_AVERAGES: [f64; 2] = [0.01, 0.05];
const ERRORS_WITHOUT_AVERAGES: [f64; 2] = [0.02, 0.26];

/// The limit loads that the history of a run shows at its end; empty for a case that seeks none, or without rows.
pub fn found(case: &Case, history: &Columns) -> Vec<ManifestLimitLoad> {
    let Some(sought) = &case.limit_load else {
        return Vec::new();
    };
    sought
        .loads
        .iter()
        .filter_map(|load| of_load(sought, load, history))
        .collect()
}

/// How far (m) that which carries the load has been moved at `t`.
fn moved(load: &SoughtLoad, t: f64) -> f64 {
    let moved = load.path.at(t);
    moved.iter().fold(0.0, |length: f64, along| length.hypot(*along))
}

/// The load in a row of the history; `None` without its columns there.
fn sum(load: &SoughtLoad, history: &Columns, row: usize) -> Option<f64> {
    let parts = load.columns.iter();
    parts
        .map(|(column, weight)| Some(weight * history.get(column)?.get(row)?))
        .sum()
}

fn of_load(sought: &LimitLoad, load: &SoughtLoad, history: &Columns) -> Option<ManifestLimitLoad> {
    let times = history.get("time")?;
    let last = times.len().checked_sub(1)?;
    let late = (0..=last).find(|&row| moved(load, times[row]) >= LATE * moved(load, times[last]))?;
    let before = sum(load, history, late)?;
    let value = sum(load, history, last)?;
    let change = if value == 0.0 { 0.0 } else { (value - before) / value };
    let is_reached = value > 0.0 && change.abs() <= REACHED;
    Some(ManifestLimitLoad {
        name: load.name.clone(),
        columns: load.columns.clone(),
        unit: load.unit.clone(),
        value,
        change,
        is_reached,
        cells: load.width.map(|width| width.cells),
        modelled: load.width.map_or(1.0, |width| width.modelled),
        stiffness: sought.stiffness,
    })
}

/// A line on each of them that was reached.
pub fn report_lines(case: &Case, loads: &[ManifestLimitLoad]) -> Vec<String> {
    let averages = case.limit_load.as_ref().is_some_and(|sought| sought.averages);
    loads
        .iter()
        .filter(|load| load.is_reached)
        .map(|load| reached(load, averages))
        .collect()
}

/// A warning of each of them that was not.
pub fn warnings(loads: &[ManifestLimitLoad]) -> Vec<String> {
    loads.iter().filter(|load| !load.is_reached).map(not_reached).collect()
}

fn reached(load: &ManifestLimitLoad, averages: bool) -> String {
    let ManifestLimitLoad { name, value, unit, .. } = load;
    let part = load.part();
    let errors = if averages {
        ERRORS_OF_AVERAGES
    } else {
        ERRORS_WITHOUT_AVERAGES
    };
    let expected = load.cells.map_or_else(String::new, |cells| {
        let [least, most] = errors.map(|error| 100.0 * error * STATED_CELLS / cells);
        format!(
            ", with {cells:.1} cells across its width. With so many cells, verified footings were {least:.0} to {most:.0} % too high, \
             which is the unsafe side. Extrapolate with `bsmpm limit-load`."
        )
    });
    format!("Limit load of {name}{part}: {value:.4e} {unit}{expected}")
}

fn not_reached(load: &ManifestLimitLoad) -> String {
    let ManifestLimitLoad {
        name,
        value,
        unit,
        change,
        ..
    } = load;
    let percent = 100.0 * change;
    if *value <= 0.0 {
        return format!(
            "W0726: the soil does not resist `{name}` (load at the end: {value:.4e} {unit}), so there is no limit \
             load. Check that `{name}` touches the soil and moves towards it."
        );
    }
    let last = format!("{value:.4e} {unit}");
    match *change > 0.0 {
        true => format!(
            "W0727: the load on `{name}` still grew by {percent:.1} % over the last quarter of its path, to {last}. \
             The limit load is not reached. Increase the prescribed displacement."
        ),
        false => format!(
            "W0728: the load on `{name}` fell by {:.1} % over the last quarter of its path, to {last}. Steps are too \
             large or the soil softens, so this is no limit load. Increase `analysis.steps`.",
            -percent
        ),
    }
}
