//! Pore pressure that points carry, `ru`, and what is not shown to be right together with it.

use crate::case::{Body, Case, Support};
use crate::record::Record;
use crate::report::Report;
use crate::words::{Side, Word};

const KEY: &str = "ru";

/// What only the whole case shows.
pub(super) fn check(case: &Case, root: &Record, report: &mut Report<'_>) {
    let wet = |number: usize| case.materials[number].ratio > 0.0;
    let bodies = || case.bodies.iter().map(|body| body.material);
    let Some((_, material)) = root.named("material").iter().enumerate().find(|(number, _)| wet(*number)) else {
        return;
    };
    let material = &material.1;
    if !case.carries_pressure() {
        report.warn(format!("{}: no body is of this material: it does nothing", material.path_of(KEY)));
        return;
    }
    if root.gives("water") || case.flow.is_some() {
        let message = if case.flow.is_some() {
            "is the pore pressure of water that does not flow: with \"coupled\" or \"undrained\" soil the flow makes it, from \
             that of [water] at the start; leave ru out, or drainage"
        } else {
            "[water] gives the pore pressure, too: give one of them"
        };
        material.error(KEY, message, report);
    }
    match &case.gravity {
        None => material.error(KEY, "nothing weighs without [gravity]", report),
        Some(gravity) if !gravity.acts_down(case.grid.dims(), Some(case.analysis.regime)) => {
            let message =
                format!("gravity.acceleration = {:?} is not straight down", &gravity.acceleration[..case.grid.dims()]);
            material.error(KEY, message, report);
        }
        Some(_) => {}
    }
    let changes = |stage: &crate::case::Stage| !(stage.add.is_empty() && stage.remove.is_empty());
    let exchanges = |stage: &crate::case::Stage| stage.materials.iter().any(|&(from, to)| wet(from) || wet(to));
    if case.stages.iter().any(|stage| changes(stage) || exchanges(stage)) {
        let message = "points carry it from the start, whatever stages place, take away or exchange: it cannot be used \
                       with those";
        material.error(KEY, message, report);
    }
    if case.shaking.iter().any(|(_, ground)| *ground != [0.0; 3]) {
        material.error(KEY, "it does not follow ground that shakes: it cannot be used with [shaking]", report);
    }
    for (side, support) in Side::of(case.geometry).iter().flatten().zip(case.boundary.into_iter().flatten()) {
        if matches!(support, Support::Absorbing | Support::FreeField) {
            let side = side.word();
            material.error(KEY, format!("boundary.{side} absorbs, which was not shown to be right beside it"), report);
        }
    }
    if bodies().any(|number| !wet(number)) {
        report.note(material.path_of(KEY), "this material only", "pores of the others hold no pressure");
    }
    warn_of_thin_bodies(case, report);
    warn_of_cubic_splines(case, report);
    if !case.tractions.is_empty() || !case.point_loads.is_empty() {
        report.note(material.path_of(KEY), "of the weight alone", "loads raise no pore pressure: they are drained");
    }
}

/// A face divides the normal force right where the material at it is at least a cell thick: in a body of half a cell
/// friction was 25 % too large.
fn warn_of_thin_bodies(case: &Case, report: &mut Report<'_>) {
    for axis in (0..case.grid.dims()).filter(|axis| has_friction(case, *axis)) {
        let edge = case.grid.axes[axis].longest();
        let thickness = |body: &Body| body.region.corners().map(|corner| corner[axis]);
        let thickest = case.bodies.iter().map(thickness).map(|[lower, upper]| upper - lower);
        let thickest = thickest.fold(0.0, f64::max);
        if thickest < edge {
            report.warn(format!(
                "ru: bodies are {thickest:.3} m thick at a face with friction, less than a cell of {edge:.3} m. Its friction is up \
                 to 30 % too large. Use smaller cells."
            ));
        }
    }
}

/// With cubic splines the normal forces of nodes near a corner are too far from their pore pressures.
fn warn_of_cubic_splines(case: &Case, report: &mut Report<'_>) {
    let has_side = (0..case.grid.dims() - 1).any(|axis| has_friction(case, axis));
    if case.grid.order > 2 && has_side {
        report.warn(
            "ru: with cubic splines friction on sides of the grid is up to 6 % off. Use grid.degree = \"quadratic\".",
        );
    }
}

/// Whether a face across an axis has friction.
fn has_friction(case: &Case, axis: usize) -> bool {
    case.contacts[axis].iter().flatten().any(|law| law.friction > 0.0)
}
