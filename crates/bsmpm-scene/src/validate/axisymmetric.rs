//! Checks rules of axisymmetric cases.

use crate::case::{Case, DrainSite, Face, Geometry, LoadedLine, Support};
use crate::observables::{Aspect, HistorySubject};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{Draft, SupportTable};
use crate::words::Side;

/// The face at the axis.
const AXIS: Face = Face { axis: 0, upper: false };
const SIDEWAYS: &str = "E0242: in an axisymmetric case x is the radius, so this motion or force cannot have a \
                        component along x. Set the x component to 0.";
const ROTATION: &str = "E0242: in an axisymmetric case a body cannot rotate in the plane. Delete this key.";

/// Errors of a case that is valid in its parts.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.geometry != Geometry::Axisymmetric {
        return;
    }
    axis(case, draft, report);
    water_on_axis(case, draft, report);
    sideways(case, draft, report);
    rigid(case, draft, report);
    quantities(case, draft, report);
    cubic(case, report);
}

/// Cubic splines at the axis, where points lie so that they integrate linear and quadratic ones.
fn cubic(case: &Case, report: &mut Report<'_>) {
    let grid = &case.grid;
    if grid.order == 3 && case.bodies.iter().any(|body| body.occupied(grid)[0].start == 0) {
        report.warn(
            "W0234: grid.degree: with cubic splines, a uniform stress is up to 2 % off at the axis of symmetry. Use \
             \"quadratic\" splines, whose error is below 0.2 %.",
        );
    }
}

/// The grid begins at r = 0, where no displacement leads away from the axis.
fn axis(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if let Some(grid) = draft.grid.value()
        && case.grid.lower()[0] != 0.0
    {
        let key: &KeyPlace = if grid.knots.is_given() {
            &grid.knots
        } else {
            &grid.lower
        };
        let message = "E0238: the grid of an axisymmetric case must begin at x = 0, because x is the radius. Set the \
             lower end of the grid along x to 0. The body may begin at x > 0.";
        key.error(message, report);
    }
    let stages = draft.stage.items().iter().filter_map(|stage| stage.boundary.value());
    let stages = stages.map(|boundary| boundary as &dyn SupportTable);
    let start = draft.boundary.value().map(|boundary| boundary as &dyn SupportTable);
    let tables = start.into_iter().chain(stages);
    for boundary in tables {
        for side in Side::ALL.into_iter().flatten() {
            let found = super::support(boundary, side);
            if Face::of(side, Geometry::Axisymmetric) == Some(AXIS) {
                if found.is_some_and(|found| found != Support::Roller) {
                    boundary.face(side).error(
                        "E0239: this face is the axis of symmetry. Set it to \"roller\".",
                        report,
                    );
                }
            } else if found == Some(Support::FreeField) {
                let message = "E0240: a free field follows horizontal shaking in one direction, which is not \
                     axisymmetric. Use \"absorbing\", or \"roller\" at a larger distance from the axis.";
                boundary.face(side).error(message, report);
            }
        }
    }
}

/// Drains and inflows, none of which lies on the axis alone.
fn water_on_axis(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let drains = case.flow.iter().flat_map(|flow| &flow.drains).zip(draft.drain.items());
    for (drain, record) in drains {
        match &drain.site {
            DrainSite::Face(AXIS) => {
                record.face.error(
                    "E0241: the axis of symmetry has no area, so nothing can drain there. Use another face.",
                    report,
                );
            }
            DrainSite::Lines(lines) if record.from.is_given() => {
                lines.iter().for_each(|ends| on_axis(*ends, &record.from, report));
            }
            _ => {}
        }
    }
    let inflows = case
        .flow
        .iter()
        .flat_map(|flow| &flow.inflows)
        .zip(draft.inflow.items());
    for (inflow, record) in inflows {
        inflow
            .site
            .ends()
            .into_iter()
            .for_each(|ends| on_axis(ends, &record.from, report));
    }
}

/// Vectors that are the same all around the axis have nothing along x.
fn sideways(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if let Some(gravity) = draft.gravity.value()
        && case
            .gravity
            .as_ref()
            .is_some_and(|gravity| gravity.acceleration[0] != 0.0)
    {
        gravity.acceleration.error(SIDEWAYS, report);
    }
    if case.shaking.iter().any(|(_, ground)| ground[0] != 0.0) {
        draft.shaking.error(SIDEWAYS, report);
    }
    for (body, record) in case.bodies.iter().zip(draft.body.items()) {
        if body.velocity.is_some_and(|v| v[0] != 0.0) {
            record.velocity.error(SIDEWAYS, report);
        }
        if body.spin.is_some() {
            record.spin.error(ROTATION, report);
        }
    }
    if let Some(footing) = &case.footing
        && footing.path.rows.iter().any(|(_, moved)| moved[0] != 0.0)
        && let Some(record) = draft.footing.value()
    {
        record.motion().place().error(SIDEWAYS, report);
    }
    for (prescribed, record) in case.prescribed.iter().zip(draft.prescribed.items()) {
        prescribed
            .site
            .ends()
            .into_iter()
            .for_each(|ends| on_axis(ends, &record.from, report));
    }
    for (traction, record) in case.tractions.iter().zip(draft.traction.items()) {
        if let LoadedLine::Segment { from, to } = traction.line {
            on_axis([from, to], &record.from, report);
        }
    }
    for (load, record) in case.point_loads.iter().zip(draft.point_load.items()) {
        if load.at[0] == 0.0 && load.force[0] != 0.0 {
            record.load().error(
                "E0242: a force on the axis of symmetry cannot have a radial component. Set the x component of the \
                 force to 0.",
                report,
            );
        }
    }
}

/// Rigid bodies are bodies of revolution that move along the axis.
fn rigid(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (rigid, record) in case.rigid.iter().zip(draft.rigid.items()) {
        if rigid.path.rows.iter().any(|(_, moved)| moved[0] != 0.0) {
            record.motion().place().error(SIDEWAYS, report);
        }
        if !rigid.rotation.is_empty() {
            record.rotation.error(ROTATION, report);
        }
        if rigid.free[0] || rigid.free[2] {
            record.free.error(
                "E0242: in an axisymmetric case a rigid body can move along the axis (y) only. Use free = [\"y\"].",
                report,
            );
        }
    }
}

/// Quantities that have no meaning.
fn quantities(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (history, record) in case.histories.iter().zip(draft.history.items()) {
        let observable = history.quantity.observable;
        if observable.has(Aspect::ZeroByAxisymmetry) {
            record.quantity.error(
                format!(
                    "E0243: the quantity \"{observable}\" is zero in every axisymmetric case, because of the symmetry. \
                     Choose another quantity."
                ),
                report,
            );
        }
        if let HistorySubject::Section { lines, .. } = &history.quantity.subject {
            lines
                .iter()
                .for_each(|[from, to]| on_axis([[from[0], from[1]], [to[0], to[1]]], &record.from, report));
        }
    }
}

/// What lies on the axis has no area.
fn on_axis(ends: [[f64; 2]; 2], from: &KeyPlace, report: &mut Report<'_>) {
    if ends.iter().all(|end| end[0] == 0.0) {
        from.error(
            "E0241: the segment lies on the axis of symmetry, so its area is zero. Move one end away from the axis.",
            report,
        );
    }
}
