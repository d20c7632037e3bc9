//! Validates histories and their checks.

mod location;

pub(super) use location::ends;

use super::flow;
use crate::case::{Body, Check, Column, History, Made, NamedMaterial, PointSelection, Quantity, Support};
use crate::grid::GridSpec;
use crate::nearest::{nearest, unknown_name};
use crate::observables::{Aspect, HistorySubject, Observable, SubjectKeys, SubjectKind};
use crate::record::{CaseTable, Field, Measure};
use crate::report::{Report, shortened};
use crate::schema::{CheckTable, Draft, HistoryTable, SupportTable};
use crate::unit::Dimension;
use crate::words::{Geometry, Side, Word};
use bsmpm::model::Regime;
use location::{at, at_x, face, section, within};
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
            record.name.error(message, report);
        }
        histories.push(history);
    }
    histories
}

fn read(
    draft: &Draft,
    record: &HistoryTable,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<History> {
    let observable = record.quantity.get()?;
    let of_strip = record.of.is_given() && observable.definition().kind.is_of_strip();
    check_keys(record, observable, of_strip, draft.geometry.get(), report);
    check_case(draft, record, observable, regime, report);
    let subject = match of_strip {
        true => HistorySubject::Strip(strip(draft, record, observable, report)?),
        false => subject(observable, record, draft, grid, made, report)?,
    };
    let name = match record.name.is_given() {
        true => record.name.text()?,
        false => observable.word(),
    };
    let scale = record.scale.get()?;
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
    record: &HistoryTable,
    observable: Observable,
    of_strip: bool,
    geometry: Option<Geometry>,
    report: &mut Report<'_>,
) {
    let SubjectKeys { own, needed } = observable.definition().kind.keys(geometry);
    let keys = record.subject_keys();
    for key in keys.into_iter().filter(|key| key.is_given()) {
        let name = key.name();
        if own.contains(&name) || needed.contains(&name) || (name == "of" && of_strip) {
            continue;
        }
        let message =
            format!("E0642: the key `{name}` has no effect on the quantity \"{observable}\". Remove `{name}`.");
        key.error(message, report);
    }
    if of_strip && record.face.is_given() {
        let message = "E0643: the history has both `face` (a side of the grid) and `of` (a footing or motion), but \
            can measure only one. Remove one of the two keys.";
        record.of.error(message, report);
    }
    let missing = needed
        .iter()
        .filter_map(|name| keys.iter().find(|key| key.name() == *name));
    for key in missing.filter(|key| !key.is_given() && !of_strip) {
        let name = key.name();
        let message =
            format!("E0644: the quantity \"{observable}\" cannot be measured without `{name}`. Add `{name}`.");
        key.error(message, report);
    }
}

/// Refuses a quantity that is zero, or has no meaning, in the case.
fn check_case(
    draft: &Draft,
    record: &HistoryTable,
    observable: Observable,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) {
    if regime == Some(Regime::QuasiStatic) && observable.has(Aspect::NeedsVelocities) {
        record.quantity.error(needs_dynamics(observable.word()), report);
    }
    if observable.has(Aspect::NeedsFooting) && !draft.footing.is_given() {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs a footing, and the case has none. Add [footing], or use \
                another quantity."
        );
        record.quantity.consequence(message, &["footing"], report);
    }
    if observable.has(Aspect::NeedsFlow) && !flow::flows(draft) {
        record.quantity.error(needs_flow(observable.word()), report);
    }
    if record.scale.get() == Some(0.0) {
        record.scale.error(
            "E0647: with scale = 0 all values of this history would be 0. Use another scale.",
            report,
        );
    }
    if let Some(side) = record.face.get().filter(|_| observable.has(Aspect::NeedsContact))
        && !supports(draft, side).contains(&Support::Contact)
    {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs contact, but the boundary `{side}` is not in contact. Set \
             boundary.{side} = \"contact\"."
        );
        record.face.error(message, report);
    }
    if let Some(side) = record.face.get().filter(|_| observable.has(Aspect::NeedsSupport))
        && is_never_held(draft, side)
    {
        let message = format!(
            "E0646: boundary `{side}` does not restrain the soil, so its reaction is always 0. Name another `face`, \
             or set boundary.{side} to \"fixed\" or \"roller\"."
        );
        record
            .face
            .consequence(message, &["boundary", "prescribed", "stage"], report);
    }
    let mut sides = Side::ALL.into_iter().flatten();
    if observable.has(Aspect::NeedsOutflow) && !sides.any(|side| supports(draft, side).contains(&Support::Outflow)) {
        let message = "E0646: no boundary has the condition \"outflow\", so no material can leave the grid. Set a \
             side in [boundary] to \"outflow\".";
        record.quantity.error(message, report);
    }
}

/// Number of the strip that a history is of, if the history has a meaning for it; `None` after an error.
fn strip(draft: &Draft, record: &HistoryTable, observable: Observable, report: &mut Report<'_>) -> Option<usize> {
    let wanted = record.of.text()?;
    let has_footing = draft.footing.value().is_some();
    let strips = draft.strips().zip(0..).map(|(strip, number)| {
        let unnamed = if has_footing && number == 0 { NAMELESS } else { "" };
        (strip, strip.name.text().unwrap_or(unnamed))
    });
    let strips: Vec<_> = strips.collect();
    let Some(number) = strips.iter().position(|(_, name)| *name == wanted) else {
        let names = strips.iter().map(|(_, name)| *name);
        let message = unknown_name("[[prescribed]] or [footing]", wanted, names);
        record.of.consequence(message, &["footing", "prescribed"], report);
        return None;
    };
    let (strip, _) = strips[number];
    if observable.has(Aspect::NeedsContact) && strip.contact.is_none() {
        let message = format!(
            "E0646: the quantity \"{observable}\" needs frictional contact, but {0} is tied to the ground. Add `{1}` \
             to {0}.",
            strip.location.path,
            strip.interface.name()
        );
        record.of.consequence(message, &[&strip.location.path], report);
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
        && !motions.any(|motion| motion.face.get() == Some(side))
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

/// What an observable is of.
fn subject(
    observable: Observable,
    record: &HistoryTable,
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
            let percentile = record.percentile.if_given()?.unwrap_or(100.0);
            HistorySubject::Percentile { percentile, of }
        }
        SubjectKind::Near => {
            let of = counted(record, grid, made, report)?;
            let at_x = at_x(&record.at_x, grid, report)?;
            HistorySubject::Near { at_x, of }
        }
        SubjectKind::MaterialPlace => HistorySubject::Place {
            at: at(&record.at, grid, report)?,
            surface: false,
        },
        SubjectKind::Place => HistorySubject::Place {
            at: at(&record.at, grid, report)?,
            surface: record.surface.if_given()?.unwrap_or(false),
        },
        SubjectKind::Face => HistorySubject::Face(face(&record.face, draft, report)?),
        SubjectKind::Section => {
            let (lines, round) = section(draft, record, grid, report)?;
            let fixed = record.fixed.if_given()?.unwrap_or(false);
            HistorySubject::Section { lines, round, fixed }
        }
        SubjectKind::Rigid => HistorySubject::Rigid(rigid(record, draft, report)?),
        SubjectKind::Drain => HistorySubject::Drain(flow::drain_of(record, draft, report)?),
        SubjectKind::Strip => return None,
    })
}

/// Number of the rigid body that a history is of.
fn rigid(record: &HistoryTable, draft: &Draft, report: &mut Report<'_>) -> Option<usize> {
    let name = record.rigid.text()?;
    let names: Vec<&str> = draft
        .rigid
        .items()
        .iter()
        .filter_map(|rigid| rigid.name.text())
        .collect();
    let found = names.iter().position(|known| *known == name);
    if found.is_none() {
        record
            .rigid
            .consequence(unknown_name("[[rigid]]", name, names), &["rigid"], report);
    }
    found
}

/// The points that count: of a material that a body is made of, of a body, or all; of those all, or those in a box.
fn counted(
    record: &HistoryTable,
    grid: Option<&GridSpec>,
    made: Option<CaseBodies<'_>>,
    report: &mut Report<'_>,
) -> Option<PointSelection> {
    let within = match record.r#box.is_given() {
        true => Some(within(record.r#box.value()?, grid, report)?),
        false => None,
    };
    let made = match (record.material.is_given(), record.body.is_given()) {
        (true, _) => Made::Material(material(record, made, report)?),
        (_, true) => Made::Body(body(record, made?.bodies, report)?),
        _ => Made::All,
    };
    Some(PointSelection { made, within })
}

/// Number of the history's material, which a body is made of.
fn material(record: &HistoryTable, made: Option<CaseBodies<'_>>, report: &mut Report<'_>) -> Option<u16> {
    let name = record.material.text()?;
    let CaseBodies { materials, bodies } = made?;
    let Some(number) = materials.iter().position(|material| material.name == name) else {
        let names = materials.iter().map(|material| &*material.name);
        record.material.error(unknown_name("material", name, names), report);
        return None;
    };
    if bodies.iter().all(|body| body.material != number) {
        let message = format!(
            "E0613: no body consists of the material `{name}`, so there is nothing to measure. Name \
            the material of a body."
        );
        record.material.error(message, report);
        return None;
    }
    u16::try_from(number).ok()
}

/// Number of the history's body.
fn body(record: &HistoryTable, bodies: &[Body], report: &mut Report<'_>) -> Option<usize> {
    let name = record.body.text()?;
    let found = bodies.iter().position(|body| body.name.as_deref() == Some(name));
    if found.is_none() {
        let names = bodies.iter().filter_map(|body| body.name.as_deref());
        record
            .body
            .consequence(unknown_name("[[body]]", name, names), &["body"], report);
    }
    found
}

/// The points that count, if they have mass.
fn weighing(
    of: PointSelection,
    record: &HistoryTable,
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
        record.quantity.error(message, report);
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

fn check(record: &CheckTable, histories: &[History], end: Option<f64>, report: &mut Report<'_>) -> Option<Check> {
    let quantity = record.quantity.text()?;
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
        record.quantity.consequence(message, &["history", "geometry"], report);
        return None;
    };
    let at = match record.at.if_given()? {
        Some(at) => at,
        None => end?,
    };
    if end.is_some_and(|end| at > end) {
        record.at.error(after_the_end(at), report);
    }
    let min = bound(&record.min, column, report)?;
    let max = bound(&record.max, column, report)?;
    match (min, max) {
        (None, None) => {
            let message = "E0661: the check has no limit, so it can never fail. Add `min`, `max` or both.";
            record.location().error(message, report);
        }
        (Some(min), Some(max)) if min > max => {
            let message = format!(
                "E0661: `min` = {min} is larger than `max` = {max}, so the check could never pass. Exchange \
                    `min` and `max`."
            );
            record.min.error(message, report);
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
fn bound(key: &Field<Measure>, column: &Column, report: &mut Report<'_>) -> Option<Option<f64>> {
    let Some(Measure { number, dimension }) = key.if_given()? else {
        return Some(None);
    };
    let Some(dimension) = dimension else {
        return Some(Some(number));
    };
    let expected = Dimension::of_unit(&column.unit);
    if expected == Some(dimension) {
        return Some(Some(number));
    }
    let allowed = expected.map_or("a number".to_owned(), |expected| expected.to_string());
    let message = format!(
        "E0665: this limit has the unit of {dimension}, but the column `{}` is {allowed}. Correct the unit of \
         `{}`.",
        column.name,
        key.name()
    );
    key.error(message, report);
    None
}
