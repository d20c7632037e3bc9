//! Validates strength reduction.

use crate::case::{
    ActiveLoads, Case, Gravity, NamedMaterial, PointLoad, PointSelection, Quantity, Rigid, Stage, Traction,
};
use crate::nearest::unknown_name;
use crate::observables::{HistorySubject, Observable};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{Draft, ReductionTable};
use crate::words::Failure;
use bsmpm::field::pore_water::flow::Motion;
use bsmpm::model::Regime;
use bsmpm::schedule::between;
use bsmpm::tensor::Vector;

/// Parts of a step by which stages lie apart.
const APART: f64 = 1e-6;

/// The table, if strength is divided from the start on.
pub(super) fn at_start(draft: &Draft) -> Option<&ReductionTable> {
    draft.strength_reduction.value().filter(|table| !table.stage.is_given())
}

/// What is there at one of the `times` has strength that can be divided under the stress that it has.
pub(super) fn divisible(case: &Case, times: &[f64], key: &KeyPlace, report: &mut Report<'_>) {
    let followed: Vec<NamedMaterial> = times.iter().flat_map(|t| case.followed_at(*t)).collect();
    if let Some(named) = followed.iter().find(|named| !named.material.is_linear()) {
        let message = format!(
            "E0630: the strength of material.{} (modified Cam-clay) can be reduced from the start of the run only. \
             Use [strength_reduction] without `stage`.",
            named.name
        );
        key.error(message, report);
    }
    if !times.iter().any(|t| case.has_friction_at(*t)) && !followed.iter().any(|named| named.material.yields()) {
        report.warn(without_strength(key.path()));
    }
}

/// The warning that a strength reduction at a key path has nothing to reduce.
pub(super) fn without_strength(path: &str) -> String {
    format!(
        "W0601: {path}: the strength reduction has no effect, because no material yields and no contact has friction. \
         Remove the reduction, or use a material that yields."
    )
}

/// Ends the case with the reduction at the end of the stage that `[strength_reduction]` names, if it does.
pub(super) fn at_stage(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(table) = draft.strength_reduction.value() else {
        return;
    };
    if !table.stage.is_given() {
        let message = "E0631: this key applies to a strength reduction at the end of a stage, but `stage` is not \
             given. Remove this key, or add `stage`.";
        if table.steps.is_given() {
            table.steps.error(message, report);
        }
        if table.drainage.is_given() {
            table.drainage.error(message, report);
        }
        return;
    }
    let Some(name) = table.stage.text() else { return };
    let Some(factor) = table.factor.get() else { return };
    let Some(steps) = table.steps.get() else { return };
    let Some(unloaded) = table.unloaded.get() else { return };
    if case.analysis.regime == Regime::Dynamic {
        let message = "E0632: [strength_reduction] with `stage` needs a quasi-static analysis, but this analysis is \
                       dynamic. Set `strength_reduction` in a [[stage]] instead.";
        table.stage.error(message, report);
    }
    let Some(until) = case.end_of_stage(name) else {
        let names = case.stages.iter().filter_map(|stage| stage.name.as_deref());
        table.stage.error(unknown_name("[[stage]]", name, names), report);
        return;
    };
    if until == 0.0 && case.initial.is_none() && !unloaded {
        let message = "E0634: the strength is to be reduced at the start, but the ground has no stress then, so it \
             cannot fail at any strength. Add [initial], or use stage = \"end\".";
        table.stage.error(message, report);
        return;
    }
    if let Some(number) = case.stages.iter().position(|stage| stage.strength_reduction.is_some()) {
        let message =
            format!("E0635: the strength is already reduced by stage.{number}. Remove one of the two reductions.");
        table.stage.error(message, report);
    }
    divisible(case, &[case.just_before(until)], &table.stage, report);
    rest(case, table, unloaded, report);
    if !case.checks.is_empty() {
        report.note(
            draft.check.path(),
            "none",
            "strength_reduction.stage: checks apply to the unreduced strength",
        );
        case.checks.clear();
    }
    if unloaded {
        load_at_once(case, case.just_before(until), steps)
    } else {
        if steps > 0 {
            refuse_changes(case, until, table, report);
        }
        reduce(case, until, steps, factor)
    }
    let end = case.analysis.end;
    case.output.times.retain(|t| *t <= end);
}

/// Refuses loads and motions that still change at the time `until`.
fn refuse_changes(case: &Case, until: f64, table: &ReductionTable, report: &mut Report<'_>) {
    if case.still_grows(until) {
        let message = "E0636: a load still changes when this stage ends, and would go on changing during the \
                       strength reduction. End its `ramp` or `amplitude` before the stage ends.";
        table.stage.error(message, report);
    }
    if case.still_moves(until) {
        let message = "E0636: a footing or prescribed motion still moves when this stage ends, and would go on \
                       moving during the strength reduction. End its `path` before the stage ends.";
        table.stage.error(message, report);
    }
}

/// What water that flows until then does; and what only ground in which none flows can have.
fn rest(case: &mut Case, table: &ReductionTable, unloaded: bool, report: &mut Report<'_>) {
    let made: Vec<bool> = (0..case.materials.len())
        .map(|number| case.is_followed(number))
        .collect();
    let Some(flow) = &mut case.flow else {
        if table.drainage.get() == Some(Failure::Undrained) {
            let message = "E0637: drainage = \"undrained\" acts on pore water during failure, but no material has \
                 drainage = \"coupled\" or \"undrained\". Remove this key, or set drainage = \"undrained\" in a \
                 material.";
            table.drainage.error(message, report);
        }
        return;
    };
    let mut soils = flow
        .soils
        .iter()
        .zip(made)
        .filter(|(_, made)| *made)
        .filter_map(|(soil, _)| soil.as_ref());
    let stays = soils.all(|soil| soil.permeability.is_none());
    let failure = table
        .drainage
        .get()
        .unwrap_or(if stays { Failure::Undrained } else { Failure::Drained });
    if failure == Failure::Undrained {
        flow.at_rest = Motion::Undrained;
    }
    let changed: [(&KeyPlace, bool); 2] = [
        (&table.elastic, table.elastic.get() == Some(true)),
        (&table.stiffness, table.stiffness.get() != Some(1.0)),
    ];
    for (key, _) in changed.into_iter().filter(|(_, changed)| *changed && !unloaded) {
        let message = "E0638: this key changes the stiffness in all steps, also in the consolidation before the \
             strength reduction, which would be wrong. Remove it, or set unloaded = true (start without stress).";
        key.error(message, report);
    }
}

/// Goes on from `until` with one step more of whole strength, and then with so many of less and less.
fn reduce(case: &mut Case, until: f64, steps: u64, factor: f64) {
    let dt = case.analysis.dt;
    let ahead = case
        .stages
        .iter()
        .position(|stage| stage.at > until - APART * dt)
        .unwrap_or(case.stages.len());
    // What they would place and apply stays away.
    let mut never = case.stages.split_off(ahead);
    never.iter_mut().for_each(|stage| stage.at = f64::INFINITY);
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
        rests: false,
        resets_displacements: false,
        follows: Vec::new(),
    };
    if steps > 0 {
        stay(case, until);
        case.rigid.iter_mut().for_each(|rigid| rigid.stay(until));
    }
    if case.flow.is_some() && steps > 0 {
        case.stages.push(Stage {
            rests: true,
            ..nothing.clone()
        });
    }
    case.stages.extend((1..=steps).map(|step| Stage {
        at: until + step as f64 * dt,
        strength_reduction: Some(1.0 + (factor - 1.0) * (step as f64 / steps as f64)),
        resets_displacements: step == 1,
        ..nothing.clone()
    }));
    case.stages.append(&mut never);
    case.analysis.end = if steps == 0 {
        until
    } else {
        until + (steps + 1) as f64 * dt
    };
}

/// What is there and acts at the time `until`, there from the start on, with its loads growing over the run.
fn load_at_once(case: &mut Case, until: f64, steps: u64) {
    let strips = usize::from(case.footing.is_some());
    let tractions = case.tractions.len();
    let loads = tractions + case.point_loads.len();
    let has_footing = case.acts_since(ActiveLoads::Strip(0), until).is_some();
    let footing = case.footing.clone().filter(|_| has_footing);
    let prescribed = act_at(
        case,
        until,
        (0..case.prescribed.len()).map(|k| ActiveLoads::Strip(strips + k)),
    );
    let points = act_at(case, until, (tractions..loads).map(ActiveLoads::Load));
    let loads = act_at(case, until, (0..tractions).map(ActiveLoads::Load));
    let rigid = act_at(case, until, (0..case.rigid.len()).map(ActiveLoads::Rigid));
    let bodies: Vec<bool> = (0..case.bodies.len()).map(|body| case.is_there(body, until)).collect();
    let end = steps.max(1) as f64 * case.analysis.dt;
    settle(case, until, end);
    case.materials = case.materials_at(until);
    case.footing = footing;
    for of in case.faces_at(until) {
        case.boundary[of.face.axis][usize::from(of.face.upper)] = of.support;
        case.contacts[of.face.axis][usize::from(of.face.upper)] = of.contact;
    }
    retain(&mut case.prescribed, &prescribed);
    retain(&mut case.tractions, &loads);
    retain(&mut case.point_loads, &points);
    retain(&mut case.rigid, &rigid);
    // The ground is as it is drawn, and so are they.
    case.rigid.iter_mut().for_each(|rigid| rigid.stay(0.0));
    case.footing.iter_mut().for_each(|footing| footing.path.stay(0.0));
    case.prescribed
        .iter_mut()
        .for_each(|prescribed| prescribed.path.stay(0.0));
    retain(&mut case.bodies, &bodies);
    case.stages.clear();
    case.flow.iter_mut().for_each(|flow| flow.motion = Motion::Held);
    // Others may be of what is not there.
    let whole = Quantity::new(
        Observable::MaxDisplacement,
        HistorySubject::Part(PointSelection::default()),
    );
    case.histories.retain(|history| history.quantity == whole);
    case.analysis.end = end;
    let ramps = (case.gravity.iter_mut().map(|Gravity { ramp, .. }| ramp))
        .chain(case.tractions.iter_mut().map(|Traction { ramp, .. }| ramp))
        .chain(case.point_loads.iter_mut().map(|PointLoad { ramp, .. }| ramp))
        .chain(case.rigid.iter_mut().map(|Rigid { ramp, .. }| ramp));
    ramps.for_each(|ramp| *ramp = end);
}

/// Which of some loads, strips or rigid bodies act at a time.
fn act_at(case: &Case, t: f64, all: impl Iterator<Item = ActiveLoads>) -> Vec<bool> {
    all.map(|acting| case.acts_since(acting, t).is_some()).collect()
}

/// Lets the water's level stay where it is at the time `until`.
fn stay(case: &mut Case, until: f64) {
    for rows in case.water.iter_mut().flat_map(|water| water.table.levels_mut()) {
        let Some(level) = between(rows, rows[0].1, until).or(rows.last().map(|row| row.1)) else {
            continue;
        };
        rows.retain(|row| row.0 < until);
        rows.push((until, level));
    }
}

/// Gives what follows time the value of the time `until`: the water's level, and loads with an amplitude, which grow
/// to it until `end`.
fn settle(case: &mut Case, until: f64, end: f64) {
    stay(case, until);
    for rows in case.water.iter_mut().flat_map(|water| water.table.levels_mut()) {
        rows.drain(..rows.len() - 1);
    }
    let loads = (0..case.tractions.len() + case.point_loads.len()).map(ActiveLoads::Load);
    let loads = loads.chain((0..case.rigid.len()).map(ActiveLoads::Rigid));
    let ages: Vec<f64> = loads
        .map(|load| until - case.acts_since(load, until).unwrap_or(until))
        .collect();
    let tractions = case.tractions.iter_mut().map(|load| &mut load.amplitude);
    let points = case.point_loads.iter_mut().map(|load| &mut load.amplitude);
    let amplitudes = tractions
        .chain(points)
        .chain(case.rigid.iter_mut().map(|rigid| &mut rigid.amplitude));
    for (rows, age) in amplitudes.zip(ages).filter(|(rows, _)| !rows.is_empty()) {
        let share = between(rows, Vector::zeros(), age).or(rows.last().map(|row| row.1));
        *rows = vec![(end, share.unwrap_or(Vector::from_element(1.0)))];
    }
}

fn retain<T>(all: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    all.retain(|_| kept.next() == Some(&true));
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIFTS: &str = r#"
        geometry = "plane-strain"
        [analysis]
        type = "quasi-static"
        end = 3
        steps = 6
        [grid]
        lower = [0, 0]
        upper = [4, 4]
        cell = "1 m"
        order = "quadratic"
        [material.fill]
        model = "mohr-coulomb"
        young = "10 MPa"
        poisson = 0.3
        friction = 30
        cohesion = "5 kPa"
        unit_weight = "18 kN/m3"
        [[body]]
        material = "fill"
        box = { lower = [0, 0], upper = [4, 1] }
        points_per_cell = 2
        [[body]]
        name = "lift-1"
        material = "fill"
        box = { lower = [0, 1], upper = [4, 2] }
        points_per_cell = 2
        [[body]]
        name = "lift-2"
        material = "fill"
        box = { lower = [0, 2], upper = [4, 3] }
        points_per_cell = 2
        [[point_load]]
        name = "load"
        at = [1, 1]
        force = [0, "-1 kN/m"]
        [[stage]]
        name = "first"
        at = 1
        add = ["lift-1"]
        [[stage]]
        name = "second"
        at = 2
        add = ["lift-2"]
        apply = ["load"]
        [gravity]
        acceleration = [0, -9.81]
        [boundary]
        bottom = "fixed"
        left = "roller"
        right = "roller"
        [strength_reduction]
        factor = 1.5
        stage = "first"
        steps = 2
    "#;

    fn case(set: &[&str]) -> Case {
        let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
        Case::from_text("case", LIFTS, &set).unwrap_or_else(|errors| panic!("{errors:?}"))
    }

    fn there(case: &Case, t: f64) -> Vec<bool> {
        (0..case.bodies.len()).map(|body| case.is_there(body, t)).collect()
    }

    #[test]
    fn the_case_ends_with_the_reduction_and_what_comes_later_stays_away() {
        let case = case(&[]);
        assert_eq!(
            case.analysis.end, 3.5,
            "the stage ends at 2, then a step of the whole strength and two of less"
        );
        let cohesion = |t: f64| case.materials_at(t)[0].material.parameters()[2];
        assert_eq!(
            [0.0, 2.0, 2.5, 3.0, 3.5].map(cohesion),
            [5e3, 5e3, 5e3 / 1.25, 5e3 / 1.5, 5e3 / 1.5]
        );
        assert_eq!(there(&case, 0.0), [true, false, false]);
        assert_eq!(there(&case, 3.5), [true, true, false]);
        assert_eq!(case.acts_since(ActiveLoads::Load(0), 3.5), None);
        let resets: Vec<f64> = case
            .stages
            .iter()
            .filter(|stage| stage.resets_displacements)
            .map(|it| it.at)
            .collect();
        assert_eq!(resets, [2.5]);
    }

    #[test]
    fn without_steps_it_ends_with_the_stage_and_unloaded_it_is_what_is_there_then() {
        assert_eq!(case(&["strength_reduction.steps=0"]).analysis.end, 2.0);
        let first = case(&["strength_reduction.unloaded=true"]);
        assert_eq!(
            (first.bodies.len(), first.stages.len(), first.point_loads.len()),
            (2, 0, 0)
        );
        assert_eq!(first.gravity.map(|gravity| gravity.ramp), Some(first.analysis.end));
        let last = case(&["strength_reduction.unloaded=true", "strength_reduction.stage=end"]);
        assert_eq!((last.bodies.len(), last.point_loads.len()), (3, 1));
        // What follows time has the value of the end.
        let timed = [
            "point_load.0.amplitude=[[4.0, 0.8]]",
            "water={ level_path = [[0.0, 1.0], [4.0, 2.0]] }",
        ];
        let timed = case(
            &[
                &["strength_reduction.unloaded=true", "strength_reduction.stage=end"][..],
                &timed,
            ]
            .concat(),
        );
        let [(time, share)] = timed.point_loads[0].amplitude[..] else {
            panic!("{:?}", timed.point_loads)
        };
        assert!(
            time == timed.analysis.end && (share[0] - 0.2).abs() < 1e-6,
            "it acts for one second: {share}"
        );
        let level = timed.water.unwrap().table.table(0.0, 0.1).unwrap().0;
        assert!((level - 1.75).abs() < 1e-6, "{level}");
        // A prescribed motion stays where it is then; next to ground as it is drawn, at its first place.
        let way = "rigid=[{ name = \"wall\", polygon = [[5, 0], [6, 0], [6, 4]], path = [[1.0, 0.2, 0.0], [3.0, 0.4, 0.0]], \
                   rotation = [[4.0, 8.0]] }]";
        let wall = |set: &[&str]| case(&[&[way][..], set].concat()).rigid[0].clone();
        let held = wall(&[]);
        assert_eq!(
            held.path.rows.last().map(|row| (row.0, (row.1[0] * 1e9).round())),
            Some((2.0, 0.3e9))
        );
        assert!(matches!(held.rotation[..], [(t, angle)] if t == 2.0 && (angle - 4_f64.to_radians()).abs() < 1e-12));
        assert!(!wall(&["strength_reduction.unloaded=true"]).is_moved());
        let rises = [
            "strength_reduction.stage=end",
            "water={ level_path = [[0.0, 1.0], [4.0, 2.0]] }",
        ];
        let level = |t: f64| case(&rises).water.unwrap().table.table(0.0, t).unwrap().0;
        assert_eq!(
            [2.0, 3.0, 4.0].map(level),
            [1.5, 1.75, 1.75],
            "it stays while the strength falls"
        );
        let before = case(&["strength_reduction.unloaded=true", "strength_reduction.stage=start"]);
        assert_eq!((before.bodies.len(), before.point_loads.len()), (1, 0));
    }
}
