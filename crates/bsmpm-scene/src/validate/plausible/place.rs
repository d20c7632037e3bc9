//! Warns of tiny bodies and of histories outside all material.

use crate::case::{Body, Case};
use crate::record::Record;
use crate::report::{Report, brief, listed};
use crate::validate::place::is_in;

/// Size of a body over that of the grid, along each axis, below which a unit is probably wrong.
const TINY: f64 = 1.0 / 300.0;
/// Parts of a cell around a place at which material is looked for.
const DISTANCES: [f64; 6] = [0.0, 0.05, 0.25, 0.5, 0.75, 1.0];

/// Warns of bodies that are tiny in their grid.
pub(super) fn bodies(case: &Case, root: &Record, report: &mut Report<'_>) {
    let dims = case.grid.dims();
    let is_tiny = |body: &Body| {
        let [lower, upper] = body.region.corners();
        let part = |axis: usize| (upper[axis] - lower[axis]) / case.grid.axes[axis].length();
        (0..dims).map(part).fold(0.0, f64::max) < TINY
    };
    let all = case.bodies.iter().zip(root.records("body"));
    let tiny: Vec<(&Body, &Record)> = all.filter(|(body, _)| is_tiny(body)).collect();
    let Some((first, _)) = tiny.first() else { return };
    let paths: Vec<String> = tiny.iter().map(|(_, record)| record.path.clone()).collect();
    let [lower, upper] = first.region.corners();
    let size = |axis: usize| format!("{} m", brief(upper[axis] - lower[axis]));
    let length = |axis: usize| format!("{} m", brief(case.grid.axes[axis].length()));
    let sizes: Vec<String> = (0..dims).map(size).collect();
    let lengths: Vec<String> = (0..dims).map(length).collect();
    report.warn(format!(
        "W0105: {}: the body is tiny: {} in a grid of {}. Correct its coordinates (in m, unless each has a unit), or \
         use a smaller grid (grid.lower, grid.upper).",
        listed(&paths),
        sizes.join(" x "),
        lengths.join(" x "),
    ));
}

/// Warns of histories at places from which all bodies are more than a cell away.
pub(super) fn histories(case: &Case, root: &Record, report: &mut Report<'_>) {
    for record in root.records("history").iter().filter(|record| record.gives("at")) {
        let Some(at) = record.vector("at") else { continue };
        let reach = case.grid.axes.iter().map(|axis| axis.longest()).fold(0.0, f64::max);
        if case.bodies.iter().any(|body| is_near(body, case, at, reach)) {
            continue;
        }
        report.warn(format!(
            "W0106: {}: no body is within a cell ({reach:.2} m) of the place {:?} m. The history records the nearest \
             material point, which is at another place. Move `at` into a body.",
            record.path_of("at"),
            &at[..case.grid.dims()]
        ));
    }
}

/// Whether a body is within `reach` (m) of a place.
fn is_near(body: &Body, case: &Case, at: [f64; 3], reach: f64) -> bool {
    let ([lower, upper], dims) = (body.region.corners(), case.grid.dims());
    if (0..dims).any(|axis| at[axis] < lower[axis] - reach || at[axis] > upper[axis] + reach) {
        return false;
    }
    let steps = |axis: usize| if axis < dims { -2..=2 } else { 0..=0 };
    let directions = steps(0).flat_map(|x| steps(1).flat_map(move |y| steps(2).map(move |z| [x, y, z])));
    let places = |direction: [i32; 3]| {
        let largest = direction.iter().map(|part| part.abs()).max().unwrap_or(0).max(1);
        DISTANCES.map(|part| {
            std::array::from_fn(|axis| at[axis] + part * reach * f64::from(direction[axis]) / f64::from(largest))
        })
    };
    directions.flat_map(places).any(|place| is_in(body, &case.grid, place))
}
