//! What only the whole case shows: supports that hold it, and combinations that are doubtful.

use super::NEARLY_INCOMPRESSIBLE;
use super::place;
use super::strip::{moves, normal};
use crate::case::{Base, Case, Prescribed, Site, Support};
use crate::record::Record;
use crate::report::Report;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;

/// Components of a normal below which it does not hold them.
const ALONG: f64 = 1e-9;

/// Errors and warnings about a case that is valid in its parts.
pub(super) fn check(case: &Case, record: &Record, report: &mut Report<'_>) {
    if case.analysis.regime == Regime::QuasiStatic {
        held(case, record, report);
    }
    too_soon(case, record, report);
    warn_of_materials(case, report);
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
        let reason = match named.material.yields() {
            true => "is plastic".to_owned(),
            false if poisson > NEARLY_INCOMPRESSIBLE => format!("has poisson = {poisson} > {NEARLY_INCOMPRESSIBLE}"),
            false => continue,
        };
        report.warn(format!(
            "stabilisation: absent is none, and material.{} {reason}: expect locking and oscillating stress",
            named.name
        ));
        return;
    }
}
