//! What only the whole case shows: supports that hold it, and combinations that are doubtful.

use crate::case::{Case, Support};
use crate::record::Record;
use crate::report::Report;
use bsmpm::material::Material;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;

/// Errors and warnings about a case that is valid in its parts.
pub(super) fn check(case: &Case, record: &Record, report: &mut Report<'_>) {
    if case.analysis.regime == Regime::QuasiStatic {
        held(case, record, report);
    }
    warn_of_materials(case, report);
    if case.stabilisation == Stabilisation::None && !record.gives("stabilisation") {
        warn_of_locking(case, report);
    }
}

/// A quasi-static body that no face holds against a translation has no equilibrium: the stiffness is singular.
fn held(case: &Case, record: &Record, report: &mut Report<'_>) {
    for (component, name) in ["x", "y"].into_iter().enumerate() {
        let holds = |axis: usize, upper: bool| match case.boundary[axis][usize::from(upper)] {
            Support::Fixed => true,
            Support::Roller => axis == component,
            Support::Free => false,
        };
        let mut faces = [(0, false), (0, true), (1, false), (1, true)].into_iter();
        if !faces.any(|(axis, upper)| holds(axis, upper) && reached(case, axis, upper)) {
            let message = format!(
                "nothing holds the bodies along {name}: no fixed face or roller that a body reaches prescribes it, and a \
                 quasi-static analysis is singular then"
            );
            report.error(record.place("boundary"), "boundary", message);
        }
    }
}

/// Whether a body reaches into the cells along a face, and so has nodes on it.
fn reached(case: &Case, axis: usize, upper: bool) -> bool {
    case.bodies.iter().any(|body| {
        let cells = &body.extents(&case.grid)[axis].cells;
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
    if case.analysis.regime == Regime::QuasiStatic && case.gravity.is_none() {
        report.warn("nothing loads the bodies: there is no [gravity]");
    }
}

fn warn_of_locking(case: &Case, report: &mut Report<'_>) {
    for body in &case.bodies {
        let named = &case.materials[body.material];
        let poisson = named.material.elastic().poisson;
        let reason = match named.material {
            Material::MohrCoulomb(_) => "is plastic".to_owned(),
            _ if poisson > 0.45 => format!("has poisson = {poisson} > 0.45"),
            _ => continue,
        };
        report.warn(format!(
            "stabilisation: absent is none, and material.{} {reason}: expect locking and oscillating stress",
            named.name
        ));
        return;
    }
}
