//! Validates stages.

mod absorbing;
mod effects;

pub(super) use effects::{check, surfaces};

use super::history::NAMELESS;
use crate::case::{ActiveLoads, Body, Face, FaceSupport, Stage, Support};
use crate::nearest::unknown_name;
use crate::record::{CaseTable, Field, Location};
use crate::report::{Report, shortened};
use crate::schema::{Draft, StageTable, SupportTable};
use crate::words::{Geometry, Side};

/// Parts of a step by which stages must lie apart: a step ends at each.
const APART: f64 = 1e-6;
/// Keys of what a stage may apply or release.
const MAY_ACT: &[&str] = &[
    "drain",
    "footing",
    "inflow",
    "point_load",
    "prescribed",
    "rigid",
    "traction",
];

/// All stages in the order of the file, which must be that of time; `time` is the end of the run and the nominal step.
pub(super) fn read_all(
    draft: &Draft,
    factor: Option<f64>,
    bodies: Option<&[Body]>,
    time: Option<(f64, f64)>,
    report: &mut Report<'_>,
) -> Option<Vec<Stage>> {
    let bodies = bodies?;
    let (end, dt) = time?;
    let acting = acting(draft, report);
    for (number, record) in draft.body.items().iter().enumerate() {
        let name = &bodies[number].name;
        if let Some(first) = bodies[..number]
            .iter()
            .position(|body| name.is_some() && body.name == *name)
        {
            let message = format!("E0610: body.{first} has the same name as this body. Rename one of the two bodies.");
            record.name.error(message, report);
        }
    }
    let mut before = 0.0;
    let mut read = Vec::new();
    for record in draft.stage.items() {
        let stage = stage(record, factor, draft, bodies, &acting, report);
        if let Some(stage) = &stage {
            timed(stage.at, before, end, dt, record, report);
            before = stage.at;
        }
        read.push(stage);
    }
    let stages: Vec<Stage> = read.into_iter().collect::<Option<_>>()?;
    (0..bodies.len()).for_each(|body| once(body, &stages, draft, report));
    acting.iter().for_each(|acting| in_turn(acting, &stages, draft, report));
    Some(stages)
}

/// Something with a name that stages apply and release, or place and remove.
struct NamedItem<'a, T> {
    name: &'a str,
    what: T,
}

/// Strips and loads with names, which are unique, rigid bodies, and what water crosses.
fn acting<'a>(draft: &'a Draft, report: &mut Report<'_>) -> Vec<NamedItem<'a, ActiveLoads>> {
    let strips = draft.strips().zip(0..);
    let strips = strips.map(|(strip, number)| (strip.name, strip.location, ActiveLoads::Strip(number)));
    let tractions = draft.traction.items().iter();
    let tractions = tractions.map(|load| (&load.name, load.location()));
    let loads = draft.point_load.items().iter();
    let loads = tractions
        .chain(loads.map(|load| (&load.name, load.location())))
        .zip(0..);
    let all = strips.chain(loads.map(|((name, location), number)| (name, location, ActiveLoads::Load(number))));
    let mut found: Vec<(&str, ActiveLoads, &Location)> = Vec::new();
    for (key, location, acting) in all {
        let Some(name) = key.text() else { continue };
        if let Some((.., first)) = found.iter().find(|(other, ..)| *other == name) {
            key.error(
                format!(
                    "E0610: {} has the same name, so a stage could not tell which of the two is \
                meant. Rename one of the two.",
                    first.path
                ),
                report,
            );
        }
        found.push((name, acting, location));
    }
    let rigid = draft.rigid.items().iter().zip(0..);
    let rigid = rigid.map(|(rigid, number)| (&rigid.name, ActiveLoads::Rigid(number)));
    let drains = draft.drain.items().iter().zip(0..);
    let drains = drains.map(|(drain, number)| (&drain.name, ActiveLoads::Drain(number)));
    let inflows = draft.inflow.items().iter().zip(0..);
    let inflows = inflows.map(|(inflow, number)| (&inflow.name, ActiveLoads::Inflow(number)));
    let others = rigid.chain(drains).chain(inflows).filter_map(|(name, what)| {
        let name = name.text()?;
        Some(NamedItem { name, what })
    });
    let unique = found.into_iter().map(|(name, what, _)| NamedItem { name, what });
    let mut all: Vec<NamedItem<'_, ActiveLoads>> = unique.chain(others).collect();
    // As histories call one without a name.
    let is_nameless = draft
        .footing
        .value()
        .is_some_and(|footing| footing.name.text().is_none());
    if is_nameless && all.iter().all(|named| named.name != NAMELESS) {
        all.push(NamedItem {
            name: NAMELESS,
            what: ActiveLoads::Strip(0),
        });
    }
    all
}

fn stage(
    record: &StageTable,
    factor: Option<f64>,
    draft: &Draft,
    bodies: &[Body],
    acting: &[NamedItem<'_, ActiveLoads>],
    report: &mut Report<'_>,
) -> Option<Stage> {
    let bodies = bodies.iter().enumerate().filter_map(|(what, body)| {
        let name = body.name.as_deref()?;
        Some(NamedItem { name, what })
    });
    let bodies: Vec<NamedItem<'_, usize>> = bodies.collect();
    let remove = named(&record.remove, &bodies, report);
    let add = named(&record.add, &bodies, report);
    let apply = named(&record.activate, acting, report);
    let release = named(&record.deactivate, acting, report);
    let materials = exchanges(record, draft, report);
    let faces = faces(record, factor, draft, report);
    let at = record.at.get()?;
    let resets_displacements = record.reset_displacements.get()?;
    let remove: Vec<usize> = remove?.into_iter().map(|(_, body)| body).collect();
    let add: Vec<usize> = add?.into_iter().map(|(_, body)| body).collect();
    let apply = apply?;
    let release = release?;
    let faces = faces?;
    let materials = materials?;
    let is_still = remove.is_empty() && add.is_empty() && apply.is_empty() && release.is_empty();
    let strength_reduction = record.strength_reduction.get();
    let is_still = is_still && strength_reduction.is_none() && !record.strength_reduction.is_given();
    if is_still && faces.is_empty() && materials.is_empty() && !resets_displacements {
        let message = "E0611: the stage changes nothing. Give it one of `add`, `remove`, `activate`, `deactivate`, \
                       `boundary`, `materials`, `strength_reduction` or `reset_displacements`.";
        record.location().error(message, report);
    }
    let name = record.name.text().map(str::to_owned);
    Some(Stage {
        name,
        at,
        remove,
        add,
        apply,
        release,
        faces,
        materials,
        strength_reduction,
        rests: false,
        resets_displacements,
        follows: Vec::new(),
    })
}

/// The names of a key, and what they name.
fn named<T: Copy>(
    names: &Field<Vec<String>>,
    known: &[NamedItem<'_, T>],
    report: &mut Report<'_>,
) -> Option<Vec<(String, T)>> {
    let bodies = ["remove", "add"].contains(&names.name());
    let kind = if bodies {
        "[[body]]"
    } else {
        "load, motion, footing, rigid body, drain or inflow"
    };
    let mut found = Vec::new();
    for name in names.list()? {
        let mut all = known.iter().filter(|known| known.name == name);
        let first = all.next().map(|known| (name.clone(), known.what));
        if !bodies && all.next().is_some() {
            let message = format!(
                "E0610: several loads, motions or rigid bodies have the name `{}`, so the stage cannot tell which one \
                 is meant. Rename all but one.",
                shortened(name)
            );
            names.error(message, report);
        }
        if first.is_none() {
            let message = unknown_name(kind, name, known.iter().map(|known| known.name));
            names.consequence(message, if bodies { &["body"] } else { MAY_ACT }, report);
        }
        found.push(first);
    }
    found.into_iter().collect()
}

/// The faces of the grid that a stage changes.
fn faces(record: &StageTable, factor: Option<f64>, draft: &Draft, report: &mut Report<'_>) -> Option<Vec<FaceSupport>> {
    let Some(boundary) = record.boundary.value() else {
        return Some(Vec::new());
    };
    let mut found = Vec::new();
    let axes = Side::of(draft.geometry.get()?).iter().enumerate();
    let sides = axes.flat_map(|(axis, sides)| [(sides[0], axis, false), (sides[1], axis, true)]);
    for (side, axis, upper) in sides.filter(|(side, ..)| boundary.face(*side).is_given()) {
        let support = super::support(boundary, side)?;
        let contact = super::contact(boundary, side, factor, report)?;
        if support == Support::FreeField {
            let message = "E0614: a stage cannot create a free-field boundary, which must exist from the start. Move \
                           this side from the stage to [boundary].";
            boundary.face(side).error(message, report);
        }
        let is_wet = draft.water.is_given() || draft.material.items().iter().any(|(_, of)| of.drainage.is_given());
        let is_solid = draft.geometry.get() == Some(Geometry::Solid);
        if support == Support::Absorbing && (side != Side::Bottom || is_wet || is_solid) {
            let message = "E0614: a stage can make a boundary absorbing only at the bottom of a 2-D case without \
                 water. Move this side from the stage to [boundary], and add [initial].";
            boundary.face(side).error(message, report);
        }
        let mut motions = draft.prescribed.items().iter();
        let moving = motions.find(|motion| motion.face.get() == Some(side));
        if let Some(motion) = moving.filter(|_| support != Support::Free) {
            let message = format!(
                "E0615: {} already prescribes the motion of this boundary, so the stage cannot restrain the same \
                 boundary. Remove this side from the stage.",
                motion.location().path
            );
            boundary.face(side).error(message, report);
        }
        found.push(FaceSupport {
            face: Face { axis, upper },
            support,
            contact,
        });
    }
    Some(found)
}

/// Numbers of the materials that a stage exchanges.
fn exchanges(record: &StageTable, draft: &Draft, report: &mut Report<'_>) -> Option<Vec<(usize, usize)>> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    for pair in record.materials.items() {
        let from = number_of_material(&pair.from, draft, report);
        let to = number_of_material(&pair.to, draft, report);
        let from = from?;
        let to = to?;
        if found.iter().any(|(other, _)| *other == from) {
            let message = "E0617: the stage already replaces this material by another one. Remove one of the two \
                entries of `materials`.";
            pair.from.error(message, report);
        }
        found.push((from, to));
    }
    Some(found)
}

/// Number of the material that a key names; `None` after an error.
fn number_of_material(key: &Field<String>, draft: &Draft, report: &mut Report<'_>) -> Option<usize> {
    let name = key.text()?;
    let materials = draft.material.items();
    let found = materials.iter().position(|(other, _)| other == name);
    if found.is_none() {
        let names = materials.iter().map(|(name, _)| name.as_str());
        key.consequence(unknown_name("material", name, names), &["material"], report);
    }
    found
}

/// Only what is active is deactivated, and only what is inactive is activated.
fn in_turn(named: &NamedItem<'_, ActiveLoads>, stages: &[Stage], draft: &Draft, report: &mut Report<'_>) {
    let name = named.name;
    let mut acts: Option<bool> = None;
    for (stage, record) in stages.iter().zip(draft.stage.items()) {
        let [releases, applies] = stage.switches(named.what);
        if releases && applies {
            let message = format!(
                "E0618: the stage both activates and deactivates `{name}`. Remove `{name}` from one of the \
                    two lists."
            );
            record.activate.error(message, report);
        } else if (releases && acts == Some(false)) || (applies && acts == Some(true)) {
            let (key, state) = if releases {
                (&record.deactivate, "inactive")
            } else {
                (&record.activate, "active")
            };
            let message = format!(
                "E0619: `{name}` is already {state} when this stage begins. Remove `{name}` from `{}` of \
                    this stage.",
                key.name()
            );
            key.error(message, report);
        }
        acts = if releases || applies { Some(applies) } else { acts };
    }
}

fn timed(at: f64, before: f64, end: f64, dt: f64, record: &StageTable, report: &mut Report<'_>) {
    if at >= end {
        let message = format!(
            "E0620: the stage begins at t = {at}, but the run ends at t = {end}. Use an earlier time, or increase \
             `analysis.end`."
        );
        record.at.error(message, report);
    } else if at - before <= APART * dt {
        let message = format!(
            "E0621: the stage must begin after t = {before} (start of the run or of the previous stage), but begins \
             at t = {at}. Increase `at`, or sort the stages by time."
        );
        record.at.error(message, report);
    }
}

/// A body is placed once at most, and removed once at most, after that.
fn once(body: usize, stages: &[Stage], draft: &Draft, report: &mut Report<'_>) {
    let records = draft.stage.items();
    let mut added = Vec::new();
    let mut removed = Vec::new();
    for (number, stage) in stages.iter().enumerate() {
        added.extend(stage.add.iter().filter(|&&own| own == body).map(|_| number));
        removed.extend(stage.remove.iter().filter(|&&own| own == body).map(|_| number));
    }
    if let Some(&again) = added.get(1) {
        let message = format!(
            "E0622: body.{body} is already added by stage.{}, and a body can be added only once. Remove one of the \
             two entries.",
            added[0]
        );
        records[again].add.error(message, report);
    }
    if let Some(&again) = removed.get(1) {
        let message = format!(
            "E0622: body.{body} is already removed by stage.{}, and a body can be removed only once. Delete one of \
             the two entries.",
            removed[0]
        );
        records[again].remove.error(message, report);
    }
    if let (Some(&added), Some(&removed)) = (added.first(), removed.first())
        && removed <= added
    {
        let message = format!(
            "E0622: body.{body} does not exist yet, because stage.{added} adds it. Remove body.{body} in a stage \
             after stage.{added}."
        );
        records[removed].remove.error(message, report);
    }
}
