//! Strength that is divided not from the start on but in a stage, or at the end of one: what is left of the case until
//! then, and the steps that follow.

use crate::case::{Acting, Case, Gravity, PointLoad, Quantity, Stage, Traction};
use crate::nearest::hint;
use crate::record::Record;
use crate::report::{Report, shortened};
use bsmpm::model::Regime;

/// Parts of a step by which stages lie apart.
const APART: f64 = 1e-6;

/// The table, if strength is divided from the start on.
pub(super) fn at_start(root: &Record) -> Option<&Record> {
    root.record("strength_reduction").filter(|table| !table.gives("stage"))
}

/// Some material has strength that can be divided under the stress that it has.
pub(super) fn divisible(case: &Case, record: &Record, report: &mut Report<'_>) {
    let key = if record.gives("strength_reduction") { "strength_reduction" } else { "stage" };
    let mut followed = case.materials.iter().enumerate().filter(|(number, _)| case.is_followed(*number));
    if let Some((_, named)) = followed.find(|(_, named)| !named.material.is_linear()) {
        let message = format!(
            "material.{}: its strength and what it was compressed by are one state, which cannot be divided under the \
             stress that it has; of the start: [strength_reduction] without stage",
            named.name
        );
        record.error(key, message, report);
    }
    let rubs = case.faces_at(case.analysis.end).into_iter().any(|face| face.contact.is_some());
    if !rubs && !case.materials.iter().any(|named| named.material.yields()) {
        report.warn(format!("{}: no material has strength: it does nothing", record.path_of(key)));
    }
}

/// Ends the case with the reduction at the end of the stage that `[strength_reduction]` names, if it does.
pub(super) fn at_stage(case: &mut Case, root: &Record, report: &mut Report<'_>) {
    let Some(table) = root.record("strength_reduction").filter(|table| table.gives("stage")) else { return };
    let (Some(name), Some(factor)) = (table.text("stage"), table.number("factor")) else { return };
    let (Some(steps), Some(unloaded)) = (table.count("steps"), table.flag("unloaded")) else { return };
    if case.analysis.regime == Regime::Dynamic {
        let message = "it looks for equilibrium, and needs a quasi-static analysis; in a dynamic one a [[stage]] with \
                       strength_reduction lets the body fail in time";
        table.error("stage", message, report);
    }
    let Some(until) = case.end_of_stage(name) else {
        let names = case.stages.iter().filter_map(|stage| stage.name.as_deref());
        let message = format!(
            "there is no [[stage]] with name = \"{}\"{}; \"start\" is before the first, \"end\" that of the run",
            shortened(name),
            hint(name, names)
        );
        table.error("stage", message, report);
        return;
    };
    if until == 0.0 && case.initial.is_none() && !unloaded {
        table.error("stage", "nothing has loaded the ground at the start: give [initial], or \"end\"", report);
        return;
    }
    if let Some(number) = case.stages.iter().position(|stage| stage.strength_reduction.is_some()) {
        table.error("stage", format!("stage.{number} divides the strength, too: leave one of them out"), report);
    }
    divisible(case, table, report);
    if !case.checks.is_empty() {
        report.note("check", "none", "strength_reduction.stage: they are of the case as it is");
        case.checks.clear();
    }
    if unloaded {
        load_at_once(case, until, steps)
    } else {
        reduce(case, (until, steps), factor)
    }
    let end = case.analysis.end;
    case.output.times.retain(|t| *t <= end);
}

/// Goes on from `until` with one step more of whole strength, and then with so many of less and less.
fn reduce(case: &mut Case, (until, steps): (f64, u64), factor: f64) {
    let dt = case.analysis.dt;
    case.stages.retain(|stage| stage.at < until - APART * dt);
    let nothing = Stage {
        name: None,
        at: until,
        remove: Vec::new(),
        add: Vec::new(),
        apply: Vec::new(),
        release: Vec::new(),
        faces: Vec::new(),
        materials: Vec::new(),
        strength_reduction: None,
        resets_displacements: false,
        follows: Vec::new(),
    };
    case.stages.extend((1..=steps).map(|step| Stage {
        at: until + step as f64 * dt,
        strength_reduction: Some(1.0 + (factor - 1.0) * (step as f64 / steps as f64)),
        resets_displacements: step == 1,
        ..nothing.clone()
    }));
    case.analysis.end = if steps == 0 { until } else { until + (steps + 1) as f64 * dt };
}

/// What is there and acts at the time `until`, there from the start on, with its loads growing over the run.
fn load_at_once(case: &mut Case, until: f64, steps: u64) {
    let strips = usize::from(case.footing.is_some());
    let tractions = case.tractions.len();
    let acts = |what: Acting| case.acts_since(what, until).is_some();
    let footing = case.footing.clone().filter(|_| acts(Acting::Strip(0)));
    let kept = |acting: &dyn Fn(usize) -> Acting, count: usize| (0..count).map(|k| acts(acting(k))).collect::<Vec<_>>();
    let prescribed = kept(&|k| Acting::Strip(strips + k), case.prescribed.len());
    let loads = kept(&Acting::Load, tractions);
    let points = kept(&|k| Acting::Load(tractions + k), case.point_loads.len());
    let bodies: Vec<bool> = (0..case.bodies.len()).map(|body| case.is_there(body, until)).collect();
    (case.materials, case.footing) = (case.materials_at(until), footing);
    for of in case.faces_at(until) {
        case.boundary[of.face.axis][usize::from(of.face.upper)] = of.support;
        case.contacts[of.face.axis][usize::from(of.face.upper)] = of.contact;
    }
    retain(&mut case.prescribed, &prescribed);
    retain(&mut case.tractions, &loads);
    retain(&mut case.point_loads, &points);
    retain(&mut case.bodies, &bodies);
    case.stages.clear();
    // Others may be of what is not there.
    case.histories.retain(|history| history.quantity == Quantity::MaxDisplacement);
    case.analysis.end = steps.max(1) as f64 * case.analysis.dt;
    let end = case.analysis.end;
    let ramps = (case.gravity.iter_mut().map(|Gravity { ramp, .. }| ramp))
        .chain(case.tractions.iter_mut().map(|Traction { ramp, .. }| ramp))
        .chain(case.point_loads.iter_mut().map(|PointLoad { ramp, .. }| ramp));
    ramps.for_each(|ramp| *ramp = end);
}

fn retain<T>(all: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    all.retain(|_| kept.next() == Some(&true));
}
