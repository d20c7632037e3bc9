//! Bodies: their material, their place in the grid and the number of their points.

use crate::case::Body;
use crate::estimate::MOST_POINTS;
use crate::grid::GridSpec;
use crate::nearest::hint;
use crate::record::Record;
use crate::report::{Report, shortened};
use bsmpm::model::Regime;

/// Bodies at most; every pair is tried for overlap.
const MOST: usize = 10_000;
/// Parts of a cell by which a body may reach beyond the grid: rounding.
const ROUNDING: f64 = 1e-9;

/// All bodies in the order of the file; place and points are checked only if the grid is valid.
pub(super) fn read_all(
    root: &Record,
    grid: Option<&GridSpec>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Vec<Body>> {
    let records = root.records("body");
    if root.gives("body") && records.is_empty() {
        root.error("body", "at least one [[body]] with a box is needed", report);
    }
    if records.len() > MOST {
        root.error("body", format!("{} bodies; at most {MOST} are possible", records.len()), report);
        return None;
    }
    let read: Vec<_> = records.iter().map(|record| read(record, root, grid, regime, report)).collect();
    let bodies: Vec<Body> = read.into_iter().collect::<Option<_>>()?;
    let points: u128 = grid.map_or(0, |grid| bodies.iter().map(|body| body.points(grid)).sum());
    if points > MOST_POINTS {
        root.error("body", format!("{points} material points in all; at most {MOST_POINTS} are possible"), report);
        return None;
    }
    warn_of_overlap(&bodies, report);
    Some(bodies)
}

fn read(
    record: &Record,
    root: &Record,
    grid: Option<&GridSpec>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Body> {
    let material = material(record, root, report);
    if record.gives("velocity") && regime == Some(Regime::QuasiStatic) {
        record.error("velocity", "has no meaning in a quasi-static analysis", report);
    }
    let points_per_cell = record.count("points_per_cell").map(|count| count as usize);
    if points_per_cell == Some(1) {
        report.warn(format!("{}: 1 point per cell integrates too coarsely; take 2 or more", record.path));
    }
    let shape = record.record("box")?;
    let (lower, upper) = (shape.pair("lower")?, shape.pair("upper")?);
    if lower[0] >= upper[0] || lower[1] >= upper[1] {
        shape.error("upper", format!("{upper:?} is not above lower = {lower:?}: the body is empty"), report);
        return None;
    }
    let velocity = record.pair("velocity");
    let body = Body { material: material?, lower, upper, points_per_cell: points_per_cell?, velocity };
    if let Some(grid) = grid {
        inside(&body, shape, grid, report)?;
        if body.points(grid) == 0 {
            shape.error("upper", "the body is thinner than 1e-9 of a cell: it has no points", report);
        }
    }
    Some(body)
}

fn material(record: &Record, root: &Record, report: &mut Report<'_>) -> Option<usize> {
    let name = record.text("material")?;
    let named = root.named("material");
    let found = named.iter().position(|(known, _)| known == name);
    if found.is_none() {
        let hint = hint(name, named.iter().map(|(known, _)| known.as_str()));
        record.error("material", format!("there is no [material.{}]{hint}", shortened(name)), report);
    }
    found
}

fn inside(body: &Body, shape: &Record, grid: &GridSpec, report: &mut Report<'_>) -> Option<()> {
    let (lower, upper) = (grid.lower(), grid.upper());
    let mut within = true;
    for axis in 0..2 {
        let spacing = f64::EPSILON * lower[axis].abs().max(upper[axis].abs());
        let slack = ROUNDING * grid.axes[axis].shortest() + 4.0 * spacing;
        let name = ["x", "y"][axis];
        if body.lower[axis] < lower[axis] - slack {
            let message = format!("{} is outside the grid, which starts at {name} = {}", body.lower[axis], lower[axis]);
            shape.error("lower", message, report);
            within = false;
        }
        if body.upper[axis] > upper[axis] + slack {
            let message = format!("{} is outside the grid, which ends at {name} = {}", body.upper[axis], upper[axis]);
            shape.error("upper", message, report);
            within = false;
        }
    }
    within.then_some(())
}

fn warn_of_overlap(bodies: &[Body], report: &mut Report<'_>) {
    let overlap = |a: &Body, b: &Body| {
        (0..2).all(|axis| {
            let common = a.upper[axis].min(b.upper[axis]) - a.lower[axis].max(b.lower[axis]);
            let smaller = (a.upper[axis] - a.lower[axis]).min(b.upper[axis] - b.lower[axis]);
            common > 1e-9 * smaller
        })
    };
    let mut pairs = (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| (i, j)));
    if let Some((i, j)) = pairs.find(|(i, j)| overlap(&bodies[*i], &bodies[*j])) {
        report.warn(format!("body.{i} and body.{j} overlap: the common part holds the points of both"));
    }
}
