//! Warns of tiny bodies and of histories outside all material.

use crate::case::{Body, Case};
use crate::record::CaseTable;
use crate::report::{Report, listed};
use crate::rounding::brief;
use crate::schema::{BodyTable, Draft};
use crate::validate::place::is_in;

/// Size of a body over that of the grid, along each axis, below which a unit is probably wrong.
const TINY: f64 = 1.0 / 300.0;
/// Parts of a cell around a place at which material is looked for.
const DISTANCES: [f64; 6] = [0.0, 0.05, 0.25, 0.5, 0.75, 1.0];

/// Warns of bodies that are tiny in their grid.
pub(super) fn bodies(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let dims = case.grid.dims();
    let all = case.bodies.iter().zip(draft.body.items());
    let tiny: Vec<(&Body, &BodyTable)> = all.filter(|(body, _)| is_tiny(body, case)).collect();
    let Some((first, _)) = tiny.first() else { return };
    let paths: Vec<String> = tiny.iter().map(|(_, record)| record.location().path.clone()).collect();
    let [lower, upper] = first.region.corners();
    let sizes: Vec<String> = (0..dims)
        .map(|axis| format!("{} m", brief(upper[axis] - lower[axis])))
        .collect();
    let lengths: Vec<String> = (0..dims)
        .map(|axis| format!("{} m", brief(case.grid.axes[axis].length())))
        .collect();
    report.warn(format!(
        "W0105: {}: the body is tiny: {} in a grid of {}. Correct its coordinates (in m, unless each has a unit), or \
         use a smaller grid (grid.lower, grid.upper).",
        listed(&paths),
        sizes.join(" x "),
        lengths.join(" x "),
    ));
}

/// Whether a body is tiny in the grid.
fn is_tiny(body: &Body, case: &Case) -> bool {
    let [lower, upper] = body.region.corners();
    let parts = (0..case.grid.dims()).map(|axis| (upper[axis] - lower[axis]) / case.grid.axes[axis].length());
    parts.fold(0.0, f64::max) < TINY
}

/// Warns of histories at places from which all bodies are more than a cell away.
pub(super) fn histories(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for record in draft.history.items().iter() {
        let Some(at) = record.at.vector() else { continue };
        let reach = case.grid.axes.iter().map(|axis| axis.longest()).fold(0.0, f64::max);
        if case.bodies.iter().any(|body| is_near(body, case, at, reach)) {
            continue;
        }
        report.warn(format!(
            "W0106: {}: no body is within a cell ({reach:.2} m) of the place {:?} m. The history records the nearest \
             material point, which is at another place. Move `at` into a body.",
            record.at.path(),
            &at[..case.grid.dims()]
        ));
    }
}

/// Whether a body is within `reach` (m) of a place.
fn is_near(body: &Body, case: &Case, at: [f64; 3], reach: f64) -> bool {
    let [lower, upper] = body.region.corners();
    let dims = case.grid.dims();
    if (0..dims).any(|axis| at[axis] < lower[axis] - reach || at[axis] > upper[axis] + reach) {
        return false;
    }
    // Of a cube of 5 x 5 x 5 directions, in a plane those in it.
    let cube = (0..125).map(|n| [n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2]);
    let directions = cube.filter(|direction| dims == 3 || direction[2] == 0);
    let mut places = directions.flat_map(|direction| places(at, direction, reach));
    places.any(|place| is_in(body, &case.grid, place))
}

/// Places around another one in a direction, up to `reach` (m) away along an axis.
fn places(at: [f64; 3], direction: [i32; 3], reach: f64) -> [[f64; 3]; DISTANCES.len()] {
    let largest = direction.iter().map(|part| part.abs()).max().unwrap_or(0).max(1);
    DISTANCES.map(|part| {
        std::array::from_fn(|axis| at[axis] + part * reach * f64::from(direction[axis]) / f64::from(largest))
    })
}
