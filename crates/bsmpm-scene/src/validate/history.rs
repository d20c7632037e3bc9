//! Validates histories and their checks.

mod location;

pub(super) use location::ends;

use super::flow;
use crate::case::{Body, Check, Column, History, Made, NamedMaterial, PointSelection, Quantity, Support};
use crate::grid::GridSpec;
use crate::nearest::{nearest, unknown_name};
use crate::observables::{Aspect, HistorySubject, Observable, SubjectKeys, SubjectKind};
use crate::record::Record;
use crate::report::{Report, shortened};
use crate::schema::{Draft, SupportTable};
use crate::unit::Dimension;
use crate::words::{Geometry, Side, Word};
use bsmpm::model::Regime;
use location::{at, at_surface, at_x, face, section, within};
use std::collections::HashSet;

/// Histories at most, each a column or several of every row.
const MOST: usize = 1000;

/// What a footing without a name is called.
pub(super) const NAMELESS: &str = "footing";

/// Materials and bodies of the case, without errors.
#[derive(Clone, Copy)]
pub(super) struct CaseBodies<'a> {
    pub(super) materials: &'a [NamedMaterial],
    pub(super) bodies: &'a [Body],
}

/// All histories in the order of the file, without those that have an error.
pub(super) fn read_all(
    draft: &Draft,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Vec<History> {
    let records = draft.history.items();
    if records.len() > MOST {
        draft.history.error(too_many(records.len(), MOST), report);
        return Vec::new();
    }
    let mut taken = HashSet::from(["step".to_owned(), "time".to_owned()]);
    let mut histories = Vec::new();
    for record in records {
        let Some(history) = read(draft, record, regime, grid, made, report) else {
            continue;
        };
        if let Some(column) = history
            .columns()
            .into_iter()
            .find(|column| !taken.insert(column.name.clone()))
        {
            let message = format!(
                "E0610: another history already writes the column `{}` of history.csv. Give this history a \
                    different `name`.",
                column.name
            );
            record.error("name", message, report);
        }
        histories.push(history);
    }
    histories
}

fn read(
    draft: &Draft,
    record: &Record,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<History> {
    let observable: Observable = record.word("quantity")?;
    let of_strip = record.gives("of") && observable.definition().kind.is_of_strip();
    check_keys(record, observable, of_strip, draft.geometry.get(), report);
    check_case(draft, record, observable, regime, report);
    let subject = match of_strip {
        true => HistorySubject::Strip(strip(draft, record, observable, report)?),
        false => subject(observable, record, draft, grid, made, report)?,
    };
    let name = if record.gives("name") {
        record.text("name")?
    } else {
        observable.word()
    };
    let scale = record.number("scale")?;
    let geometry = draft.geometry.get()?;
    Some(History {
        quantity: Quantity::new(observable, subject),
        name: name.to_owned(),
        scale,
        geometry,
        lasts: false,
    })
}

/// Refuses keys that have no effect on the quantity, and reports those that it needs and does not have.
fn check_keys(
    record: &Record,
    observable: Observable,
    of_strip: bool,
    geometry: Option<Geometry>,
    report: &mut Report<'_>,
) {
    let SubjectKeys { own, needed } = observable.definition().kind.keys(geometry);
    for key in KEYS.into_iter().filter(|key| record.gives(key)) {
        if own.contains(&key) || needed.contains(&key) || (key == "of" && of_strip) {
            continue;
        }
        let message = format!("E0642: the key `{key}` has no effect on the quantity \"{observable}\". Remove `{key}`.");
        record.error(key, message, report);
    }
    if of_strip && record.gives("face") {
        let message = "E0643: the history has both `face` (a side of the grid) and `of` (a footing or motion), but \
            can measure only one. Remove one of the two keys.";
        record.error("of", message, report);
    }
    for key in needed.iter().filter(|key| !record.gives(key) && !of_strip) {
        let message = format!("E0644: the quantity \"{observable}\" cannot be measured without `{key}`. Add `{key}`.");
        report.error(record.origin, &record.path_of(key), message);
    }
}

/// Refuses a quantity that is zero, or has no meaning, in the case.
fn check_case(draft: &Draft, record: &Record, observable: Observable, regime: Option<Regime>, report: &mut Report<'_>) {
    if regime == Some(Regime::QuasiStatic) && observable.has(Aspect::NeedsVelocities) {
        record.error("quantity", needs_dynamics(observable.word()), report);
    }
    if observable.has(Aspect::NeedsFooting) && !draft.footing.is_given() {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs a footing, and the case has none. Add [footing], or use \
                another quantity."
        );
        record.consequence("quantity", message, &["footing"], report);
    }
    if observable.has(Aspect::NeedsFlow) && !flow::flows(draft) {
        record.error("quantity", needs_flow(observable.word()), report);
    }
    if record.number("scale") == Some(0.0) {
        record.error(
            "scale",
            "E0647: with scale = 0 all values of this history would be 0. Use another scale.",
            report,
        );
    }
    if let Some(side) = record
        .word::<Side>("face")
        .filter(|_| observable.has(Aspect::NeedsContact))
        && !supports(draft, side).contains(&Support::Contact)
    {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs contact, but the boundary `{side}` is not in contact. Set \
             boundary.{side} = \"contact\"."
        );
        record.error("face", message, report);
    }
    if let Some(side) = record
        .word::<Side>("face")
        .filter(|_| observable.has(Aspect::NeedsSupport))
        && is_never_held(draft, side)
    {
        let message = format!(
            "E0646: boundary `{side}` does not restrain the soil, so its reaction is always 0. Name another `face`, \
             or set boundary.{side} to \"fixed\" or \"roller\"."
        );
        record.consequence("face", message, &["boundary", "prescribed", "stage"], report);
    }
    let mut sides = Side::ALL.into_iter().flatten();
    if observable.has(Aspect::NeedsOutflow) && !sides.any(|side| supports(draft, side).contains(&Support::Outflow)) {
        let message = "E0646: no boundary has the condition \"outflow\", so no material can leave the grid. Set a \
             side in [boundary] to \"outflow\".";
        record.error("quantity", message, report);
    }
}

/// Number of the strip that a history is of, if the history has a meaning for it; `None` after an error.
fn strip(draft: &Draft, record: &Record, observable: Observable, report: &mut Report<'_>) -> Option<usize> {
    let wanted = record.text("of")?;
    let footing = draft
        .footing
        .value()
        .into_iter()
        .map(|strip| (strip, strip.text("name").unwrap_or(NAMELESS), "interface"));
    let motions = draft
        .prescribed
        .items()
        .iter()
        .map(|strip| (strip, strip.text("name").unwrap_or(""), "components"));
    let strips: Vec<_> = footing.chain(motions).collect();
    let Some(number) = strips.iter().position(|(_, name, _)| *name == wanted) else {
        let names = strips.iter().map(|(_, name, _)| *name);
        let message = unknown_name("[[prescribed]] or [footing]", wanted, names);
        record.consequence("of", message, &["footing", "prescribed"], report);
        return None;
    };
    let (strip, _, key) = strips[number];
    if observable.has(Aspect::NeedsContact) && strip.record(key).is_none() {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs frictional contact, but {0} is tied to the ground. Add `{key}` \
             to {0}.",
            strip.path
        );
        record.consequence("of", message, &[&strip.path], report);
        return None;
    }
    Some(number)
}

/// What a face is at the start, and what stages make of it.
fn supports(draft: &Draft, side: Side) -> Vec<Support> {
    let stages = draft.stage.items().iter().filter_map(|stage| stage.boundary.value());
    let later = stages.map(|boundary| boundary as &dyn SupportTable);
    let start = draft.boundary.value().map(|boundary| boundary as &dyn SupportTable);
    start
        .into_iter()
        .chain(later)
        .filter_map(|boundary| super::support(boundary, side))
        .collect()
}

/// Whether nothing ever holds material at a face.
fn is_never_held(draft: &Draft, side: Side) -> bool {
    let is_axis = draft.geometry.get() == Some(Geometry::Axisymmetric) && side == Side::Left;
    let mut motions = draft.prescribed.items().iter();
    !is_axis
        && supports(draft, side)
            .iter()
            .all(|support| matches!(support, Support::Free | Support::Outflow))
        && !motions.any(|motion| motion.gives("face") && motion.word::<Side>("face") == Some(side))
}

/// The error of a time after the end of the run.
pub(super) fn after_the_end(time: f64) -> String {
    format!("E0663: the time t = {time} is after the end of the run. Use an earlier time, or increase `analysis.end`.")
}

/// The error of too many tables.
pub(super) fn too_many(number: usize, most: usize) -> String {
    format!("E0640: the case has {number} tables of this kind (limit: {most}). Remove some of these tables.")
}

/// The error of a quantity that a quasi-static analysis does not have.
pub(super) fn needs_dynamics(quantity: &str) -> String {
    format!(
        "E0645: the quantity \"{quantity}\" needs velocities, but a quasi-static analysis has none. Use another \
         quantity, or analysis.type = \"dynamic\"."
    )
}

/// The error of a quantity of flowing water.
pub(super) fn needs_flow(quantity: &str) -> String {
    format!(
        "E0646: the quantity \"{quantity}\" needs a material with drainage = \"coupled\" or \"undrained\", but the \
         case has none. Set `drainage` in a material, or use another quantity."
    )
}

/// Keys that belong to some quantities.
const KEYS: [&str; 16] = [
    "percentile",
    "face",
    "at",
    "at_x",
    "box",
    "material",
    "body",
    "from",
    "to",
    "fixed",
    "surface",
    "rigid",
    "of",
    "drain",
    "rectangle",
    "disc",
];

/// What an observable is of.
fn subject(
    observable: Observable,
    record: &Record,
    draft: &Draft,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<HistorySubject> {
    Some(match observable.definition().kind {
        SubjectKind::Case => HistorySubject::Case,
        SubjectKind::Part => {
            let of = counted(record, grid, made, report)?;
            match observable.has(Aspect::NeedsMass) {
                true => HistorySubject::Part(weighing(of, record, made, report)?),
                false => HistorySubject::Part(of),
            }
        }
        SubjectKind::Percentile => {
            let of = counted(record, grid, made, report)?;
            let given = record.gives("percentile");
            let percentile = if given { record.number("percentile")? } else { 100.0 };
            HistorySubject::Percentile { percentile, of }
        }
        SubjectKind::Near => {
            let of = counted(record, grid, made, report)?;
            let at_x = at_x(record, grid, report)?;
            HistorySubject::Near { at_x, of }
        }
        SubjectKind::MaterialPlace => HistorySubject::Place {
            at: at(record, grid, report)?,
            surface: false,
        },
        SubjectKind::Place => HistorySubject::Place {
            at: at(record, grid, report)?,
            surface: at_surface(record)?,
        },
        SubjectKind::Face => HistorySubject::Face(face(record, draft, report)?),
        SubjectKind::Section => {
            let (lines, round) = section(draft, record, grid, report)?;
            let fixed = record.gives("fixed") && record.flag("fixed")?;
            HistorySubject::Section { lines, round, fixed }
        }
        SubjectKind::Rigid => HistorySubject::Rigid(rigid(record, draft, report)?),
        SubjectKind::Drain => HistorySubject::Drain(flow::drain_of(record, draft, report)?),
        SubjectKind::Strip => return None,
    })
}

/// Number of the rigid body that a history is of.
fn rigid(record: &Record, draft: &Draft, report: &mut Report<'_>) -> Option<usize> {
    let name = record.text("rigid")?;
    let names: Vec<&str> = draft
        .rigid
        .items()
        .iter()
        .filter_map(|rigid| rigid.text("name"))
        .collect();
    let found = names.iter().position(|known| *known == name);
    if found.is_none() {
        record.consequence("rigid", unknown_name("[[rigid]]", name, names), &["rigid"], report);
    }
    found
}

/// The points that count: of a material that a body is made of, of a body, or all; of those all, or those in a box.
fn counted(
    record: &Record,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<PointSelection> {
    let within = if record.gives("box") {
        Some(within(record.record("box")?, grid, report)?)
    } else {
        None
    };
    let made = match (record.gives("material"), record.gives("body")) {
        (true, _) => Made::Material(material(record, made, report)?),
        (_, true) => Made::Body(body(record, made?.bodies, report)?),
        _ => Made::All,
    };
    Some(PointSelection { made, within })
}

/// Number of the history's material, which a body is made of.
fn material(record: &Record, made: Option<CaseBodies<'_>>, report: &mut Report<'_>) -> Option<u16> {
    let name = record.text("material")?;
    let CaseBodies { materials, bodies } = made?;
    let Some(number) = materials.iter().position(|material| material.name == name) else {
        let names = materials.iter().map(|material| &*material.name);
        record.error("material", unknown_name("material", name, names), report);
        return None;
    };
    if bodies.iter().all(|body| body.material != number) {
        let message = format!(
            "E0613: no body consists of the material `{name}`, so there is nothing to measure. Name \
            the material of a body."
        );
        record.error("material", message, report);
        return None;
    }
    u16::try_from(number).ok()
}

/// Number of the history's body.
fn body(record: &Record, bodies: &[Body], report: &mut Report<'_>) -> Option<usize> {
    let name = record.text("body")?;
    let found = bodies.iter().position(|body| body.name.as_deref() == Some(name));
    if found.is_none() {
        let names = bodies.iter().filter_map(|body| body.name.as_deref());
        record.consequence("body", unknown_name("[[body]]", name, names), &["body"], report);
    }
    found
}

/// The points that count, if they have mass.
fn weighing(
    of: PointSelection,
    record: &Record,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<PointSelection> {
    let CaseBodies { materials, bodies } = made?;
    let mut counted = bodies.iter().enumerate().filter(|(number, body)| match of.made {
        Made::All => true,
        Made::Material(of) => usize::from(of) == body.material,
        Made::Body(of) => of == *number,
    });
    if !counted.any(|(_, body)| materials[body.material].density.is_some()) {
        let message = "E0646: this quantity needs the mass of the soil, but the material of this part of the ground has no \
             weight. Add `unit_weight` to the material.";
        record.error("quantity", message, report);
        return None;
    }
    Some(of)
}

/// All checks in the order of the file, without those that have an error.
pub(super) fn checks(draft: &Draft, histories: &[History], end: Option<f64>, report: &mut Report<'_>) -> Vec<Check> {
    draft
        .check
        .items()
        .iter()
        .filter_map(|record| check(record, histories, end, report))
        .collect()
}

fn check(record: &Record, histories: &[History], end: Option<f64>, report: &mut Report<'_>) -> Option<Check> {
    let quantity = record.text("quantity")?;
    let columns: Vec<Column> = histories.iter().flat_map(History::columns).collect();
    let Some(column) = columns.iter().find(|column| column.name == quantity) else {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        let known = match nearest(quantity, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if names.is_empty() => "the case has no history".to_owned(),
            None => format!("known columns: {}", names.join(", ")),
        };
        let message = format!(
            "E0660: no [[history]] records a column `{}` ({known}). Correct the name, or add a [[history]].",
            shortened(quantity)
        );
        record.consequence("quantity", message, &["history", "geometry"], report);
        return None;
    };
    let at = if record.gives("at") { record.number("at")? } else { end? };
    if end.is_some_and(|end| at > end) {
        record.error("at", after_the_end(at), report);
    }
    let min = bound("min", record, column, report)?;
    let max = bound("max", record, column, report)?;
    match (min, max) {
        (None, None) => {
            let message = "E0661: the check has no limit, so it can never fail. Add `min`, `max` or both.";
            report.error(record.origin, &record.path, message);
        }
        (Some(min), Some(max)) if min > max => {
            let message = format!(
                "E0661: `min` = {min} is larger than `max` = {max}, so the check could never pass. Exchange \
                    `min` and `max`."
            );
            record.error("min", message, report);
        }
        _ => {}
    }
    Some(Check {
        quantity: quantity.to_owned(),
        at,
        min,
        max,
    })
}

/// A bound in the column's unit; the outer option is `None` after an error.
fn bound(key: &str, record: &Record, column: &Column, report: &mut Report<'_>) -> Option<Option<f64>> {
    if !record.gives(key) {
        return Some(None);
    }
    let (value, dimension) = record.measure(key)?;
    let Some(dimension) = dimension else {
        return Some(Some(value));
    };
    let expected = Dimension::of_unit(&column.unit);
    if expected == Some(dimension) {
        return Some(Some(value));
    }
    let allowed = expected.map_or("a number".to_owned(), |expected| expected.to_string());
    let message = format!(
        "E0665: this limit has the unit of {dimension}, but the column `{}` is {allowed}. Correct the unit of \
         `{key}`.",
        column.name
    );
    record.error(key, message, report);
    None
}
