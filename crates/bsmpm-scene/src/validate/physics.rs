//! What only the whole case shows: supports that hold it, and combinations that are doubtful.

use super::NEARLY_INCOMPRESSIBLE;
use super::material::strength;
use super::place;
use super::strip::{moves, normal};
use crate::case::{Base, Body, Case, Prescribed, Site, Support};
use crate::grid::Axis;
use crate::record::Record;
use crate::report::Report;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;

/// Components of a normal below which it does not hold them.
const ALONG: f64 = 1e-9;

/// Ratio of moduli or densities beyond which an interface is told of.
const SMOOTH: f64 = 2.0;

/// Errors and warnings about a case that is valid in its parts.
pub(super) fn check(case: &Case, record: &Record, report: &mut Report<'_>) {
    if case.analysis.regime == Regime::QuasiStatic {
        held(case, record, report);
    }
    too_soon(case, record, report);
    warn_of_materials(case, report);
    warn_of_interfaces(case, report);
    if case.stabilisation == Stabilisation::None && !record.gives("stabilisation") {
        warn_of_locking(case, report);
    }
}

/// Times that lie so near to the start that no step ends there.
fn too_soon(case: &Case, record: &Record, report: &mut Report<'_>) {
    let least = 1e-6 * case.analysis.dt;
    let message = |time: f64| format!("{time} is no step away from the start; allowed: at least 1e-6 dt = {least}");
    if let (Some(time), Some(output)) = (case.output.times.first(), record.record("output"))
        && *time <= least
    {
        output.error("times", message(*time), report);
    }
    for (check, record) in case.checks.iter().zip(record.records("check")) {
        if check.at <= least {
            record.error("at", message(check.at), report);
        }
    }
}

/// A quasi-static body that nothing holds against a translation has no equilibrium: the stiffness is singular.
fn held(case: &Case, record: &Record, report: &mut Report<'_>) {
    for (component, name) in ["x", "y"].into_iter().enumerate() {
        let holds = |axis: usize, upper: bool| match case.boundary[axis][usize::from(upper)] {
            Support::Fixed => true,
            Support::Roller => axis == component,
            Support::Free => false,
        };
        let mut faces = [(0, false), (0, true), (1, false), (1, true)].into_iter();
        let by_face = faces.any(|(axis, upper)| holds(axis, upper) && reached(case, axis, upper));
        if !by_face && !held_by_strip(case, component) {
            let message = format!(
                "nothing holds the bodies along {name}: no fixed face or roller that a body reaches prescribes it, nor does \
                 a strip that a body is at, and a quasi-static analysis is singular then"
            );
            report.error(record.place("boundary"), "boundary", message);
        }
    }
}

/// Whether the footing or a prescribed motion holds a component of a body.
fn held_by_strip(case: &Case, component: usize) -> bool {
    let by_segment = |base: Base, from: [f64; 2], to: [f64; 2]| {
        let holds = base == Base::Rough || normal(from, to)[component].abs() > ALONG;
        holds && place::along([from, to]).any(|at| place::at_body(&case.bodies, &case.grid, at))
    };
    let by_motion = |prescribed: &Prescribed| match prescribed.site {
        Site::Segment { from, to } => by_segment(prescribed.base, from, to),
        Site::Face(face) => {
            let holds = prescribed.base == Base::Rough || face.axis == component;
            holds && reached(case, face.axis, face.upper)
        }
    };
    case.footing.iter().any(|footing| by_segment(footing.base, footing.from, footing.to))
        || case.prescribed.iter().any(by_motion)
}

/// Whether a body reaches into the cells along a face, and so has nodes on it.
fn reached(case: &Case, axis: usize, upper: bool) -> bool {
    case.bodies.iter().any(|body| {
        let cells = &body.occupied(&case.grid)[axis];
        if upper { cells.end == case.grid.axes[axis].cells() } else { cells.start == 0 }
    })
}

fn warn_of_materials(case: &Case, report: &mut Report<'_>) {
    let mut used = vec![false; case.materials.len()];
    case.bodies.iter().for_each(|body| used[body.material] = true);
    for (material, _) in case.materials.iter().zip(used).filter(|(_, used)| !used) {
        report.warn(format!("material.{}: no body is made of it", material.name));
    }
    if case.gravity.is_some() && case.bodies.iter().all(|body| case.materials[body.material].density.is_none()) {
        report.warn("gravity: no body has mass: it does nothing");
    }
    if case.analysis.regime == Regime::QuasiStatic && !loaded(case) {
        report.warn("nothing loads the bodies: there is no [gravity], no load, and nothing that moves");
    }
}

/// Bodies that meet and differ by more than was shown: the strain jumps from one to the other, and that of the splines cannot.
fn warn_of_interfaces(case: &Case, report: &mut Report<'_>) {
    let near = case.grid.axes.each_ref().map(|axis| match axis {
        Axis::Uniform { cell, .. } => *cell,
        Axis::Graded(_) => (0..axis.cells()).map(|i| axis.cell(i)).fold(0.0, f64::max),
    });
    let meet = |a: &Body, b: &Body| {
        let ([lower, upper], [low, high]) = (a.bounds(), b.bounds());
        (0..2).all(|axis| lower[axis] <= high[axis] + near[axis] && low[axis] <= upper[axis] + near[axis])
    };
    let ratio = |a: f64, b: f64| (a / b).max(b / a);
    let mut told = Vec::new();
    for (number, a) in case.bodies.iter().enumerate() {
        for b in case.bodies[..number].iter().filter(|b| meet(a, b)) {
            let pair = [a.material.min(b.material), a.material.max(b.material)];
            if pair[0] == pair[1] || told.contains(&pair) {
                continue;
            }
            told.push(pair);
            let [a, b] = pair.map(|material| &case.materials[material]);
            let stiffer = ratio(a.material.elastic().young, b.material.elastic().young);
            let heavier = a.density.zip(b.density).map_or(1.0, |(a, b)| ratio(a, b));
            let (what, by, off) = if stiffer > SMOOTH {
                (
                    "young",
                    stiffer,
                    "the stress within two cells of the interface is off, in level ground by 14 % at 1 : 2 \
                 and 50 % at 1 : 100, more where a much stiffer body moves",
                )
            } else if heavier > SMOOTH && case.stabilisation != Stabilisation::None {
                (
                    "density",
                    heavier,
                    "the horizontal stress within a cell of the interface is off, in level ground by 3 to \
                 7 % at 1 : 2 and by 30 to 60 % of the lighter one's at 1 : 10",
                )
            } else {
                continue;
            };
            report.warn(format!(
                "material.{} and material.{} meet and differ in {what} by a factor of {by:.3}: the strain of the splines \
                 cannot jump, and {off}; smaller cells there narrow that zone, with order = \"linear\" it is 3 %",
                a.name, b.name
            ));
        }
    }
}

fn loaded(case: &Case) -> bool {
    let pulls = |load: [f64; 2]| load != [0.0; 2];
    case.gravity.is_some()
        || case.footing.iter().any(|footing| moves(&footing.path))
        || case.prescribed.iter().any(|prescribed| moves(&prescribed.path))
        || case.tractions.iter().any(|traction| pulls(traction.stress))
        || case.point_loads.iter().any(|load| pulls(load.force))
}

fn warn_of_locking(case: &Case, report: &mut Report<'_>) {
    for body in &case.bodies {
        let named = &case.materials[body.material];
        let poisson = named.material.elastic().poisson;
        let reason = match strength(&named.material, 0.0) {
            Some(_) => "is plastic".to_owned(),
            _ if poisson > NEARLY_INCOMPRESSIBLE => format!("has poisson = {poisson} > {NEARLY_INCOMPRESSIBLE}"),
            _ => continue,
        };
        report.warn(format!(
            "stabilisation: absent is none, and material.{} {reason}: expect locking and oscillating stress",
            named.name
        ));
        return;
    }
}
