//! Validates pore pressure ratios `ru`.

use crate::case::{Case, Support};
use crate::report::Report;
use crate::schema::{Draft, MaterialTable};
use crate::words::{Side, Word};

/// What only the whole case shows.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let mut named = draft.material.items().iter().zip(&case.materials);
    let Some(((_, material), _)) = named.find(|(_, of)| of.ratio > 0.0) else {
        return;
    };
    if !case.carries_pressure() {
        report.warn(format!(
            "W0313: {}: no body consists of this material, so `ru` has no effect. Assign the material to a body, or \
             remove the material.",
            material.ru.path()
        ));
        return;
    }
    if draft.water.is_given() || case.flow.is_some() {
        let message = if case.flow.is_some() {
            "E0320: this case computes the pore pressure from the flow of water, so `ru` would define the pore \
             pressure twice. Remove `ru`, or remove `drainage` from all materials."
        } else {
            "E0320: [water] already gives the pore pressure by a water table, so `ru` would define the pore pressure \
             twice. Remove `ru`, or [water]."
        };
        material.ru.error(message, report);
    }
    refuse_gravity(case, material, report);
    refuse_changes(case, material, report);
    if case.bodies.iter().any(|body| !is_wet(case, body.material)) {
        report.note(
            material.ru.path(),
            "this material only",
            "the other materials have no pore pressure",
        );
    }
    warn_of_thin_bodies(case, report);
    warn_of_cubic_splines(case, report);
    if !case.tractions.is_empty() || !case.point_loads.is_empty() {
        report.note(
            material.ru.path(),
            "from the weight alone",
            "applied loads are drained and raise no pore pressure",
        );
    }
}

/// Whether a material has a pore pressure ratio.
fn is_wet(case: &Case, material: usize) -> bool {
    case.materials[material].ratio > 0.0
}

/// Refuses a case without gravity, or with one that is not vertical.
fn refuse_gravity(case: &Case, material: &MaterialTable, report: &mut Report<'_>) {
    match &case.gravity {
        None => {
            let message = "E0321: `ru` relates the pore pressure to the weight of the soil, but the case has no \
                           gravity. Add [gravity].";
            material.ru.error(message, report);
        }
        Some(gravity) if !gravity.acts_down(case.grid.dims(), Some(case.analysis.regime)) => {
            let message = format!(
                "E0321: the pore pressure ratio `ru` needs vertical gravity, but gravity.acceleration = {:?}. Set \
                 the horizontal components of gravity.acceleration to 0.",
                &gravity.acceleration[..case.grid.dims()]
            );
            material.ru.error(message, report);
        }
        Some(_) => {}
    }
}

/// Refuses what would change the pore pressure in the run: stages, shaking, and boundaries that absorb.
fn refuse_changes(case: &Case, material: &MaterialTable, report: &mut Report<'_>) {
    let mut bodies = case
        .stages
        .iter()
        .flat_map(|stage| stage.add.iter().chain(&stage.remove));
    let mut exchanges = case.stages.iter().flat_map(|stage| &stage.materials);
    if bodies.next().is_some() || exchanges.any(|(from, to)| is_wet(case, *from) || is_wet(case, *to)) {
        let message = "E0322: the pore pressure from `ru` follows from the initial weight, and is wrong after a stage \
             adds, removes or changes soil. Use [water] instead of `ru`, or delete these stages.";
        material.ru.error(message, report);
    }
    if case.shaking.iter().any(|(_, ground)| *ground != [0.0; 3]) {
        let message = "E0322: the pore pressure from `ru` is constant, but an earthquake would change the pore \
                       pressure. Remove `ru` or [shaking].";
        material.ru.error(message, report);
    }
    for (side, support) in Side::of(case.geometry)
        .iter()
        .flatten()
        .zip(case.boundary.into_iter().flatten())
    {
        if matches!(support, Support::Absorbing | Support::FreeField) {
            let side = side.word();
            let message = format!(
                "E0322: the pore pressure from `ru` is not available with an absorbing or free-field boundary, here \
                 `{side}`. Set boundary.{side} = \"fixed\" or \"roller\"."
            );
            material.ru.error(message, report);
        }
    }
}

/// The normal force on a face is divided correctly where the material there is at least a cell thick: in a body of half
/// a cell friction was 25 % too large.
fn warn_of_thin_bodies(case: &Case, report: &mut Report<'_>) {
    for axis in (0..case.grid.dims()).filter(|axis| has_friction(case, *axis)) {
        let edge = case.grid.axes[axis].longest();
        let corners = case.bodies.iter().map(|body| body.region.corners());
        let thicknesses = corners.map(|[lower, upper]| upper[axis] - lower[axis]);
        let thickest = thicknesses.fold(0.0, f64::max);
        if thickest < edge {
            report.warn(format!(
                "W0316: ru: bodies on a boundary with friction are thinner ({thickest:.3} m) than a cell ({edge:.3} \
                 m), so friction is up to 30 % too large. Use smaller cells."
            ));
        }
    }
}

/// With cubic splines the normal forces of nodes near a corner lie too far from their pore pressures.
fn warn_of_cubic_splines(case: &Case, report: &mut Report<'_>) {
    let has_side = (0..case.grid.dims() - 1).any(|axis| has_friction(case, axis));
    if case.grid.order > 2 && has_side {
        report.warn(
            "W0317: ru: with cubic splines the friction on the sides of the grid has an error of up to 6 %. Use \
             grid.degree = \"quadratic\".",
        );
    }
}

/// Whether a face across an axis has friction.
fn has_friction(case: &Case, axis: usize) -> bool {
    case.contacts[axis].iter().flatten().any(|law| law.friction > 0.0)
}
