//! Refuses what a stage may not change in a case with pore-water flow, and warns of surfaces that its changes leave
//! without drains.

use super::not_available;
use crate::case::{ActiveLoads, Case, DrainSite, Flow, Stage};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::StageTable;
use crate::validate::flow::crossing::{is_beside, places};
use crate::validate::flow::is_permeable;
use bsmpm::model::Regime;

/// What a stage changes.
pub(super) fn of_stage(case: &Case, number: usize, record: &StageTable, report: &mut Report<'_>) {
    if record.remove.is_given() && case.analysis.regime != Regime::QuasiStatic {
        let message = not_available(
            "removal of bodies in a dynamic analysis",
            "Use analysis.type = \"consolidation\".",
        );
        record.remove.error(message, report);
    } else if case
        .stages
        .get(number)
        .is_some_and(|stage| !stage.remove.is_empty() && !drains_what_is_bare(case, stage))
    {
        report.warn(format!(
            "W0544: stage.{number}.remove: the surface exposed by the excavation has no drain, so it is impermeable. \
             Add a [[drain]] along this surface, and list the drain in `activate` of this stage."
        ));
    }
    case.stages
        .get(number)
        .into_iter()
        .for_each(|stage| goes(case, number, stage, report));
    if record.add.is_given() && case.analysis.regime != Regime::QuasiStatic {
        let message = not_available(
            "placement of bodies in a dynamic analysis",
            "Use analysis.type = \"consolidation\".",
        );
        record.add.error(message, report);
    } else if let Some(stage) = case.stages.get(number) {
        placed(case, number, stage, report);
    }
    let changes: [(&KeyPlace, &str, &str); 3] = [
        (
            &record.boundary,
            "a change of the boundary",
            "Remove `boundary` of this stage, and give one boundary for all stages in [boundary].",
        ),
        (
            &record.strength_reduction,
            "a strength reduction in a stage",
            "Remove it, and find the factor of safety with `bsmpm fos --stage end`.",
        ),
        (
            &record.materials,
            "a change of material",
            "Remove `materials`: fast loading of \"coupled\" soil is undrained anyway.",
        ),
    ];
    for (key, what, instead) in changes.into_iter().filter(|(key, ..)| key.is_given()) {
        key.error(not_available(what, instead), report);
    }
}

/// What a stage places, and what that covers.
fn placed(case: &Case, number: usize, stage: &Stage, report: &mut Report<'_>) {
    let Some(flow) = &case.flow else { return };
    for &body in &stage.add {
        if !is_permeable(&flow.soils, case.bodies[body].material) {
            continue;
        }
        let is_drained = flow.drains.iter().enumerate().any(|(drain, of)| {
            acts_at(case, drain, stage.at)
                && places(of, case)
                    .iter()
                    .any(|at| is_beside(case, at, |other| other == body))
        });
        if !is_drained {
            report.warn(format!(
                "W0544: stage.{number}.add: the added body.{body} has no drain, so its surface is impermeable. Add a \
                 [[drain]] along this surface, and list the drain in `activate` of this stage."
            ));
        }
    }
    for (drain, of) in flow.drains.iter().enumerate() {
        let stays = acts_at(case, drain, case.just_before(stage.at)) && acts_at(case, drain, stage.at);
        if stays && places(of, case).iter().any(|at| is_covered(case, flow, stage, at)) {
            report.warn(format!(
                "W0545: stage.{number}.add: drain.{drain} keeps draining below the added soil, like a drainage \
                 blanket. If there is no blanket, list the drain in `deactivate` of this stage."
            ));
        }
    }
}

/// Whether a drain acts at a time.
fn acts_at(case: &Case, drain: usize, t: f64) -> bool {
    case.acts_since(ActiveLoads::Drain(drain), t).is_some()
}

/// Whether a body is at a place at a time.
fn is_ground(case: &Case, at: &[f64; 3], t: f64) -> bool {
    is_beside(case, at, |body| case.is_there(body, t))
}

/// Whether a stage adds soil with pore water at a place of ground.
fn is_covered(case: &Case, flow: &Flow, stage: &Stage, at: &[f64; 3]) -> bool {
    is_beside(case, at, |body| {
        stage.add.contains(&body) && flow.soils[case.bodies[body].material].is_some()
    }) && is_ground(case, at, case.just_before(stage.at))
}

/// Warns of drains whose ground goes with what a stage removes.
fn goes(case: &Case, number: usize, stage: &Stage, report: &mut Report<'_>) {
    let before = case.just_before(stage.at);
    for (drain, of) in case.flow.iter().flat_map(|flow| flow.drains.iter().enumerate()) {
        let acts = acts_at(case, drain, before) && acts_at(case, drain, stage.at);
        if acts
            && matches!(of.site, DrainSite::Lines(_) | DrainSite::Plate(_))
            && places(of, case)
                .iter()
                .all(|at| is_ground(case, at, before) && !is_ground(case, at, stage.at))
        {
            report.warn(format!(
                "W0546: stage.{number}.remove: drain.{drain} is removed with its soil, so the new surface is \
                 impermeable. Add a [[drain]] along the new surface, and list it in `activate` of this stage."
            ));
        }
    }
}

/// Whether a drain lies between what a stage removes and what stays.
fn drains_what_is_bare(case: &Case, stage: &Stage) -> bool {
    let mut drains = case.flow.iter().flat_map(|flow| &flow.drains);
    drains.any(|drain| {
        places(drain, case).iter().all(|at| {
            is_beside(case, at, |number| stage.remove.contains(&number))
                && is_beside(case, at, |number| !stage.remove.contains(&number))
        })
    })
}
