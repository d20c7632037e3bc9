//! Checks stages with absorbing or free-field boundaries.

use crate::case::{Acting, Case, Stage, Support};
use crate::record::Record;
use crate::report::Report;
use crate::validate::free_field;
use crate::words::Word;

/// The forces that absorbing faces carry are found again as a stage begins, for ground at rest under constant loads and
/// next to columns of the free field that the stage does not change.
pub(super) fn check(case: &Case, stage: &Stage, record: &Record, report: &mut Report<'_>) {
    let absorbs = |support: Support| matches!(support, Support::Absorbing | Support::FreeField);
    let faces = case.faces_at(stage.at);
    if stage.only_resets() || !faces.iter().any(|of| absorbs(of.support)) {
        return;
    }
    let mut refuse = |key: &str, message: &str| record.error(key, message, report);
    if case.shakes_from() < stage.at {
        refuse(
            "at",
            "E0627: with absorbing boundaries a stage that changes the ground must begin before the earthquake. \
             Reduce `at`, or let [shaking] begin later.",
        );
    }
    if stage.strength_reduction.is_some() {
        refuse(
            "strength_reduction",
            "E0627: with absorbing boundaries a stage needs ground at rest, but reduced strength can set the ground \
             in motion. Make the absorbing boundaries \"fixed\".",
        );
    }
    if case.is_ever(Support::Contact) || !case.rigid.is_empty() {
        refuse(
            "at",
            "E0627: stages are not available if a case has absorbing boundaries together with contact boundaries or \
             rigid bodies. Make the absorbing boundaries \"fixed\".",
        );
    }
    let grows = |what: Acting| match what {
        Acting::Load(load) => case.grows_from(load),
        _ => true,
    };
    if case.still_grows(stage.at) || stage.apply.iter().any(|(_, what)| grows(*what)) {
        refuse(
            "at",
            "E0627: with absorbing boundaries all loads must be constant when a stage begins. End the `ramp` or \
             `amplitude` of each load earlier, or use ramp = 0.",
        );
    }
    if stage.release.iter().any(|(_, what)| !matches!(what, Acting::Load(_))) {
        refuse(
            "deactivate",
            "E0627: with absorbing boundaries a stage can deactivate loads, but not a footing or prescribed motion. \
             Make the absorbing boundaries \"fixed\".",
        );
    }
    for of in faces.iter().filter(|of| of.support == Support::FreeField) {
        let (lower, higher) = free_field::column(case, of.face.upper);
        let is_in = |body: &usize| {
            let [from, to] = case.bodies[*body].bounds();
            from[0] < higher && to[0] > lower
        };
        for key in ["add", "remove"] {
            let bodies = if key == "add" { &stage.add } else { &stage.remove };
            if bodies.iter().any(is_in) {
                let message = format!(
                    "E0628: this body, which a stage changes, lies in the cells next to the free-field boundary `{}`, \
                     where stages may change nothing. Keep the body one cell away from the boundary.",
                    of.face.side(case.geometry).word()
                );
                refuse(key, &message);
            }
        }
        if !stage.materials.is_empty() {
            refuse(
                "materials",
                "E0628: a stage cannot change materials if a side is \"free-field\", because the soil column of the \
                 free field keeps its materials. Make the side \"fixed\" or \"roller\".",
            );
        }
        if stage.faces.iter().any(|of| of.face.axis == 0) {
            refuse(
                "boundary",
                "E0628: a stage cannot change the left or right boundary if a side is \"free-field\". Change \
                 \"bottom\" or \"top\" only.",
            );
        }
    }
}
