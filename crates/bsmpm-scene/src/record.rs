//! Compares a case file with the schema. The result is a record: typed values in SI units, with angles in degrees.

mod field;
mod value;

use crate::document::{self, DocumentTable, Node, Value};
use crate::error::Origin;
use crate::key_path::join;
use crate::report::Report;
use crate::schema::{Group, Key, Kind, Presence, Table};
use crate::slips;
use crate::unit::Dimension;
use crate::words::{AnalysisType, Geometry};
pub(crate) use field::{CaseTable, Field, KeyPlace, Location, Measure, OrTable, vector};
pub(crate) use value::UNREAD;

/// Of a key of the language that this version does not have.
const NOT_YET: &str = "E0012: this key is not available yet. Delete it.";
/// Keys whose words choose values that are not given.
const PRESETS: &[&str] = &["accuracy", "analysis.purpose"];

/// The keys whose words would give a value to a key or group that has a preset.
fn presets(has_preset: bool) -> &'static [&'static str] {
    if has_preset { PRESETS } else { &[] }
}

/// A table whose keys and values are as the schema says.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) path: String,
    origin: Origin,
    pub(crate) fields: Vec<RecordField>,
}

/// A key of a table that has a value, given or by default, or an error.
#[derive(Clone, Debug)]
pub(crate) struct RecordField {
    pub(crate) key: &'static str,
    origin: Origin,
    pub(crate) written: bool,
    /// a text, or a list with one, as a number with its unit is
    is_worded: bool,
    pub(crate) datum: Option<Datum>, // None: an error has been reported
}

impl RecordField {
    /// A key that the file does not give.
    fn absent(key: &'static str, origin: Origin, datum: Option<Datum>) -> Self {
        Self {
            key,
            origin,
            written: false,
            is_worded: false,
            datum,
        }
    }
}

/// A value of a known type; quantities are in SI, angles in degrees.
#[derive(Clone, Debug)]
pub(crate) enum Datum {
    Number(f64),
    /// the dimension is that of its unit, if it has one
    Measure(f64, Option<Dimension>),
    Numbers(Vec<f64>),
    Rows(Vec<ListRow>),
    Count(u64),
    Word(&'static str),
    Text(String),
    Names(Vec<String>),
    Flag(bool),
    Record(Record),
    Named(Vec<(String, Record)>),
    Records(Vec<Record>),
}

/// A row of numbers and its place.
#[derive(Clone, Debug)]
pub(crate) struct ListRow {
    pub(crate) origin: Origin,
    pub(crate) numbers: Vec<f64>,
}

/// What the types of values depend on besides the schema.
#[derive(Clone, Copy)]
struct Context {
    /// table of the whole file
    root: &'static Table,
    /// time is a pseudo-time without unit
    pseudo_time: bool,
    geometry: Geometry,
}

/// The whole file, whose table is `root`, as a record; what does not fit goes to `report`.
pub(crate) fn read(root: &'static Table, document: &DocumentTable, report: &mut Report<'_>) -> Record {
    let kind = document.word::<AnalysisType>("analysis.type");
    let geometry = document.word::<Geometry>("geometry");
    Context {
        root,
        pseudo_time: kind.is_some_and(|(kind, _)| kind.is_timeless()),
        geometry: geometry.map_or(Geometry::PlaneStrain, |(geometry, _)| geometry),
    }
    .record(root, document, Origin::Nowhere, "", report)
}

impl Context {
    fn record(
        self,
        table: &'static Table,
        written: &DocumentTable,
        origin: Origin,
        path: &str,
        report: &mut Report<'_>,
    ) -> Record {
        slips::report_unknown(self.root, table, written, path, report);
        let mut record = Record {
            path: path.to_owned(),
            origin,
            fields: Vec::new(),
        };
        for key in table.keys {
            let path = join(path, key.name);
            match (written.get(key.name), key.presence) {
                (Some(entry), Presence::Later) => report.error(entry.origin, &path, NOT_YET),
                (Some(entry), Presence::Retired) => {
                    if self.datum(&key.kind, &entry.node, &path, report).is_some() {
                        report.warn(format!(
                            "W0001: {path}: this key has no effect any more, because {}. Delete the \
                             key.",
                            key.doc
                        ));
                    }
                }
                (Some(entry), _) => {
                    let datum = self.datum(&key.kind, &entry.node, &path, report);
                    record.fields.push(RecordField {
                        key: key.name,
                        origin: entry.node.origin,
                        written: true,
                        is_worded: entry.node.is_worded(),
                        datum,
                    });
                }
                (None, Presence::Required) => {
                    let message = missing(key);
                    report.missing(origin, &record.path, &[key.name], message, presets(key.has_preset));
                    record.fields.push(RecordField::absent(key.name, origin, None));
                }
                (None, Presence::Default(text)) => {
                    let datum = self.default(&key.kind, text, origin, &path, report);
                    record.fields.push(RecordField::absent(key.name, origin, datum));
                }
                (None, Presence::Optional | Presence::Later | Presence::Retired) => {}
            }
        }
        let mut reported = ReportedGroups::default();
        for group in table.exclusive {
            exclusive(group, written, &record, &mut reported, report);
        }
        record
    }

    fn default(self, kind: &Kind, text: &str, origin: Origin, path: &str, report: &mut Report<'_>) -> Option<Datum> {
        let Ok(node) = document::parse_value(text, origin) else {
            let message =
                format!("E0099: the default value `{text}` cannot be read. Report this defect of the program.");
            report.error(origin, path, message);
            return None;
        };
        let listed = path
            .split('.')
            .any(|part| part.starts_with(|c: char| c.is_ascii_digit()));
        if kind.table().is_none() && !listed {
            report.note(path, text, "default");
        }
        self.datum(kind, &node, path, report)
    }

    fn datum(self, kind: &Kind, node: &Node, path: &str, report: &mut Report<'_>) -> Option<Datum> {
        match (kind, &node.value) {
            (
                Kind::Table(table) | Kind::Profile(.., table) | Kind::PairProfile(.., table) | Kind::ChoiceOr(_, table),
                Value::Table(written),
            ) => Some(Datum::Record(self.record(table, written, node.origin, path, report))),
            (Kind::Named(table), Value::Table(written)) => Some(self.named(table, written, path, report)),
            (Kind::Tables(table), Value::List(items)) => self.records(table, items, path, report),
            (Kind::Table(_) | Kind::Named(_) | Kind::Tables(_), _) => {
                report.error(node.origin, path, value::expected(kind, node));
                None
            }
            _ => value::read(kind, node, path, self.pseudo_time, self.geometry, report),
        }
    }

    fn named(self, table: &'static Table, written: &DocumentTable, path: &str, report: &mut Report<'_>) -> Datum {
        let mut named = Vec::new();
        for entry in &written.entries {
            let path = join(path, &entry.key);
            if !value::is_name(&entry.key) {
                report.error(
                    entry.origin,
                    &path,
                    format!("E0024: this name is not allowed. Use {}.", Kind::Name),
                );
            }
            match &entry.node.value {
                Value::Table(inner) => {
                    named.push((
                        entry.key.clone(),
                        self.record(table, inner, entry.origin, &path, report),
                    ));
                }
                _ => {
                    report.error(entry.origin, &path, value::expected(&Kind::Table(table), &entry.node));
                }
            }
        }
        Datum::Named(named)
    }

    fn records(self, table: &'static Table, items: &[Node], path: &str, report: &mut Report<'_>) -> Option<Datum> {
        let mut records = Vec::new();
        for (number, item) in items.iter().enumerate() {
            let path = join(path, &number.to_string());
            match &item.value {
                Value::Table(written) => records.push(self.record(table, written, item.origin, &path, report)),
                _ => report.error(item.origin, &path, value::expected(&Kind::Table(table), item)),
            }
        }
        (records.len() == items.len()).then_some(Datum::Records(records))
    }
}

/// What has been reported of the groups of a table.
#[derive(Default)]
struct ReportedGroups<'a> {
    /// keys that are both given
    pairs: Vec<[&'a str; 2]>,
    /// keys of groups without any
    missing: Vec<&'static str>,
}

/// What is wrong with a group of keys; nothing of two that were reported with another group, nor of a group that has
/// keys in common with one that is missing.
fn exclusive<'a>(
    group: &'static Group,
    written: &'a DocumentTable,
    record: &Record,
    reported: &mut ReportedGroups<'a>,
    report: &mut Report<'_>,
) {
    let given: Vec<_> = group.keys.iter().filter_map(|key| written.get(key)).collect();
    if let [first, second, ..] = given[..]
        && !reported.pairs.contains(&[&first.key, &second.key])
    {
        reported.pairs.push([&first.key, &second.key]);
        let message = format!(
            "E0016: `{}` and `{}` are both given, but only one of the keys {} is allowed. Delete one of the two.",
            first.key,
            second.key,
            group.keys.join(", ")
        );
        report.error(second.origin, &join(&record.path, &second.key), message);
    }
    let is_reported = group.keys.iter().any(|key| reported.missing.contains(key));
    if given.is_empty() && group.required && !is_reported {
        reported.missing.extend(group.keys);
        let message = format!(
            "E0014: none of the keys {} is given. Add one of them.",
            group.keys.join(", ")
        );
        report.missing(
            record.origin,
            &record.path,
            group.keys,
            message,
            presets(group.has_preset),
        );
    }
}

/// What to add where a required key is missing.
fn missing(key: &Key) -> String {
    let (Kind::Tables(table) | Kind::Named(table)) = key.kind else {
        return format!("E0014: this key is missing. Add it; its value is {}.", key.kind);
    };
    // A preset fills the others.
    let required = table
        .keys
        .iter()
        .filter(|key| matches!(key.presence, Presence::Required) && !key.has_preset);
    let groups = table.exclusive.iter().filter(|group| group.required);
    let names: Vec<String> = required
        .map(|key| format!("`{}`", key.name))
        .chain(groups.map(first_two))
        .collect();
    format!(
        "E0052: the table {} is missing. Add this table with the keys {}.",
        table.header,
        names.join(" and ")
    )
}

/// Two keys of a group as examples of it.
fn first_two(group: &Group) -> String {
    let names: Vec<String> = group.keys.iter().take(2).map(|name| format!("`{name}`")).collect();
    names.join(" or ")
}
