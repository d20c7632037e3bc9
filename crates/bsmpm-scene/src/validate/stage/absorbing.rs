//! Checks stages with absorbing or free-field boundaries.

use crate::case::{ActiveLoads, Case, Face, Stage, Support};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::StageTable;
use crate::validate::free_field;
use crate::words::Word;

/// The forces that absorbing faces carry are found again as a stage begins, for ground at rest under constant loads and
/// next to columns of the free field that the stage does not change.
pub(super) fn check(case: &Case, stage: &Stage, record: &StageTable, report: &mut Report<'_>) {
    let faces = case.faces_at(stage.at);
    let mut supports = faces.iter().map(|of| of.support);
    if stage.only_resets() || !supports.any(|support| matches!(support, Support::Absorbing | Support::FreeField)) {
        return;
    }
    let mut refuse = |key: &KeyPlace, message: &str| key.error(message, report);
    if case.shakes_from() < stage.at {
        refuse(
            &record.at,
            "E0627: with absorbing boundaries a stage that changes the ground must begin before the earthquake. \
             Reduce `at`, or let [shaking] begin later.",
        );
    }
    if stage.strength_reduction.is_some() {
        refuse(
            &record.strength_reduction,
            "E0627: with absorbing boundaries a stage needs ground at rest, but reduced strength can set the ground \
             in motion. Make the absorbing boundaries \"fixed\".",
        );
    }
    if case.is_ever(Support::Contact) || !case.rigid.is_empty() {
        refuse(
            &record.at,
            "E0627: stages are not available if a case has absorbing boundaries together with contact boundaries or \
             rigid bodies. Make the absorbing boundaries \"fixed\".",
        );
    }
    let grows = stage.apply.iter().any(|(_, what)| match *what {
        ActiveLoads::Load(load) => case.grows_from(load),
        _ => true,
    });
    if case.still_grows(stage.at) || grows {
        refuse(
            &record.at,
            "E0627: with absorbing boundaries all loads must be constant when a stage begins. End the `ramp` or \
             `amplitude` of each load earlier, or use ramp = 0.",
        );
    }
    if stage
        .release
        .iter()
        .any(|(_, what)| !matches!(what, ActiveLoads::Load(_)))
    {
        refuse(
            &record.deactivate,
            "E0627: with absorbing boundaries a stage can deactivate loads, but not a footing or prescribed motion. \
             Make the absorbing boundaries \"fixed\".",
        );
    }
    for of in faces.iter().filter(|of| of.support == Support::FreeField) {
        check_column(case, stage, of.face, record, report);
    }
}

/// Refuses a stage that changes the column of the free field at a face, or the left or right boundary.
fn check_column(case: &Case, stage: &Stage, face: Face, record: &StageTable, report: &mut Report<'_>) {
    let (lower, higher) = free_field::column(case, face.upper);
    for (key, bodies) in [(&record.add, &stage.add), (&record.remove, &stage.remove)] {
        let mut bounds = bodies.iter().map(|body| case.bodies[*body].bounds());
        if bounds.any(|[from, to]| from[0] < higher && to[0] > lower) {
            let message = format!(
                "E0628: this body, which a stage changes, lies in the cells next to the free-field boundary `{}`, \
                 where stages may change nothing. Keep the body one cell away from the boundary.",
                face.side(case.geometry).word()
            );
            key.error(message, report);
        }
    }
    if !stage.materials.is_empty() {
        let message = "E0628: a stage cannot change materials if a side is \"free-field\", because the soil column of the \
             free field keeps its materials. Make the side \"fixed\" or \"roller\".";
        record.materials.error(message, report);
    }
    if stage.faces.iter().any(|of| of.face.axis == 0) {
        let message = "E0628: a stage cannot change the left or right boundary if a side is \"free-field\". Change \
             \"bottom\" or \"top\" only.";
        record.boundary.error(message, report);
    }
}
