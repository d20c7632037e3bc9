//! Refuses keys that do not apply to the geometry (2-D or 3-D) of a case.

use crate::case::{Case, FaceSupport, Support};
use crate::observables::Aspect;
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{Draft, SupportTable};
use crate::words::{Geometry, LinearSolver, Side};
use bsmpm::stabilisation::Stabilisation;

/// Unknowns beyond which there is a warning of a large factor: its fronts are planes of nodes.
const MANY: u64 = 30_000;

/// Errors about keys that the case's geometry has not.
pub(super) fn refuse(draft: &Draft, report: &mut Report<'_>) {
    let Some(geometry) = draft.geometry.get() else {
        return;
    };
    if geometry != Geometry::Solid {
        return in_space(draft, report);
    }
    let message = "E0225: this key is available in 2-D only, and the case is 3-D. Use `face`, rectangle = { lower, \
                   upper } or `disc`.";
    for drain in draft.drain.items() {
        refuse_given(
            &[&drain.from, &drain.to, &drain.circle, &drain.surface],
            message,
            report,
        );
    }
    for inflow in draft.inflow.items() {
        refuse_given(&[&inflow.from, &inflow.to], message, report);
    }
    for traction in draft.traction.items() {
        let message = "E0225: this key is available in 2-D only, and the case is 3-D. Use rectangle = { lower, upper \
                       }, `disc`, `sphere` or `surface`.";
        refuse_given(&[&traction.from, &traction.to, &traction.circle], message, report);
    }
    for strip in draft.strips() {
        let message = "E0225: this key is available in 2-D only, and the case is 3-D. Use rectangle = { lower, upper \
                       } or `disc`.";
        refuse_given(&[strip.from, strip.to], message, report);
    }
    for history in draft.history.items() {
        if let Some(quantity) = history.quantity.get().filter(|of| of.has(Aspect::PlaneOnly)) {
            let message = format!(
                "E0226: the quantity \"{quantity}\" is not available in 3-D. Delete this history, and evaluate \
                     the quantity from the output frames."
            );
            history.quantity.error(message, report);
        }
        if history.at_x.is_given() {
            history
                .at_x
                .error("E0226: this key is not available in 3-D. Delete it.", report);
        }
    }
}

/// Errors about those of the keys that are given.
fn refuse_given(keys: &[&KeyPlace], message: &str, report: &mut Report<'_>) {
    for key in keys.iter().filter(|key| key.is_given()) {
        key.error(message, report);
    }
}

/// Of a plane what only a solid has.
fn in_space(draft: &Draft, report: &mut Report<'_>) {
    let message = "E0207: this key is available in 3-D only. Use `from` and `to`, or set geometry = \"3d\".";
    for traction in draft.traction.items() {
        refuse_given(&[&traction.rectangle, &traction.disc], message, report);
    }
    for strip in draft.strips() {
        refuse_given(&[strip.rectangle, strip.disc], message, report);
    }
    for drain in draft.drain.items() {
        refuse_given(&[&drain.rectangle, &drain.disc], message, report);
    }
    for inflow in draft.inflow.items() {
        refuse_given(&[&inflow.rectangle, &inflow.disc], message, report);
    }
    for traction in draft.traction.items() {
        let message = "E0207: this key is available in 3-D only. Use `from` and `to`, or `circle`, or set geometry = \
                       \"3d\".";
        refuse_given(&[&traction.sphere, &traction.surface], message, report);
    }
    let stages = draft.stage.items().iter().filter_map(|stage| stage.boundary.value());
    let stages = stages.map(|boundary| boundary as &dyn SupportTable);
    let start = draft.boundary.value().map(|boundary| boundary as &dyn SupportTable);
    for boundary in start.into_iter().chain(stages) {
        let faces = [Side::Front, Side::Back].map(|side| boundary.face(side));
        for face in faces.into_iter().filter(|face| face.is_given()) {
            let message = "E0207: a 2-D grid has no front and no back face. Delete this key, or use geometry = \"3d\".";
            face.error(message, report);
        }
    }
    let message = "E0207: this shape is available in 3-D only. Use `box`, `polygon` or `circle`, or set geometry = \
                   \"3d\".";
    for body in draft.body.items() {
        refuse_given(&body.solid_shapes(), message, report);
        for cut in body.subtract.items() {
            refuse_given(&cut.solid_shapes(), message, report);
        }
    }
    for rigid in draft.rigid.items() {
        refuse_given(&[&rigid.sphere, &rigid.revolve, &rigid.terrain], message, report);
    }
}

/// Errors about what the faces of a solid do, of which a table says some.
fn faces(all: &[FaceSupport], boundary: &dyn SupportTable, report: &mut Report<'_>) {
    for of in all.iter().filter(|of| boundary.face(side(of)).is_given()) {
        if !matches!(
            of.support,
            Support::Fixed | Support::Roller | Support::Free | Support::Contact | Support::Outflow
        ) {
            let message = "E0226: this support is not available in 3-D. Use one of: \"fixed\", \"roller\", \"free\", \
                 \"outflow\", \"contact\", { friction_coefficient = ... }.";
            boundary.face(side(of)).error(message, report);
        }
    }
    let with_friction: Vec<&FaceSupport> = all
        .iter()
        .filter(|of| of.contact.is_some_and(|contact| contact.friction > 0.0))
        .collect();
    let mut given = with_friction.iter().filter(|of| boundary.face(side(of)).is_given());
    if let Some(of) = given.rfind(|of| with_friction.iter().any(|other| other.face.axis != of.face.axis)) {
        let message = "E0226: friction on two faces that share an edge is not available in 3-D. Set one of the two \
                       faces to \"contact\" or \"roller\".";
        boundary.face(side(of)).error(message, report);
    }
}

/// The key of a face of a solid.
fn side(of: &FaceSupport) -> Side {
    of.face.side(Geometry::Solid)
}

/// Errors and warnings about a whole case in three dimensions.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.geometry != Geometry::Solid {
        return;
    }
    let start = draft.boundary.value().map(|boundary| boundary as &dyn SupportTable);
    let stages = draft.stage.items().iter().map(|stage| stage.boundary.value());
    let stages = stages.map(|boundary| boundary.map(|boundary| boundary as &dyn SupportTable));
    let times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
    let tables = std::iter::once(start).chain(stages);
    for (t, boundary) in times.zip(tables).filter_map(|(t, table)| Some((t, table?))) {
        faces(&case.faces_at(t), boundary, report);
    }
    if matches!(
        case.stabilisation,
        Stabilisation::SubgridFBar | Stabilisation::ModifiedFBar
    ) {
        let key = draft.stabilisation.value();
        key.into_iter().for_each(|of| {
            let message = "E0226: this method is not available in 3-D. Use \"consistent-f-bar\" or \"f-bar\".";
            of.method.error(message, report);
        });
    }
}

impl Case {
    /// Warnings of the case as so many ranks run it: what a factor in space takes on them among them.
    pub fn warnings_on(&self, ranks: usize) -> Vec<String> {
        let estimate = self.estimate(ranks);
        let is_factored = self.geometry == Geometry::Solid && self.solver.linear_on(ranks) == LinearSolver::Direct;
        let mut warnings = self.warnings.clone();
        if is_factored && estimate.active > MANY {
            warnings.push(format!(
                "W0235: solver.linear: the direct solution of {} unknowns needs about {:.1} GB of memory. If poisson \
                 <= 0.4, use \"incomplete-cholesky\"; otherwise use \"spline-multigrid\" on one MPI rank.",
                estimate.active,
                estimate.bytes as f64 / 1e9
            ));
        }
        warnings
    }
}
