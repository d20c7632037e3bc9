//! Finds the values of keys in the text of a case, so that tests can replace them.

use bsmpm_scene::schema::{Dimension, Kind, Presence, ROOT, Range, Table};
use std::ops::Range as Span;
use toml::de::{DeTable, DeValue};

/// A value of a key, or an item of the list that is its value.
#[derive(Clone, Debug)]
pub struct Written {
    /// Path of the key, as errors name it.
    pub path: String,
    /// The table that the schema has the key in, by its header, and the key.
    pub of: (&'static str, &'static str),
    /// What the value may be.
    pub fits: Fits,
    pub presence: Presence,
    /// The key; none for an item of a list.
    pub name: Option<Span<usize>>,
    pub value: Span<usize>,
    /// It stands as `key = value`, not as a header.
    pub is_entry: bool,
}

/// What a value may be.
#[derive(Clone, Copy, Debug)]
pub enum Fits {
    Kind(&'static Kind),
    /// One number of a list.
    Number(Dimension, Range),
    /// One row of numbers.
    Row,
}

/// All of them, outer ones first.
pub fn all(text: &str) -> Vec<Written> {
    let document = DeTable::parse(text).unwrap();
    let mut found = Vec::new();
    table(ROOT, document.get_ref(), "", text, &mut found);
    found
}

fn table(schema: &'static Table, written: &DeTable<'_>, path: &str, text: &str, found: &mut Vec<Written>) {
    for (name, value) in written {
        let path = format!("{path}{}", name.get_ref());
        let key = schema
            .key(name.get_ref())
            .unwrap_or_else(|| panic!("{path} is not in the schema"));
        let name = name.span();
        let span = value.span();
        let is_entry = span.start > name.end && text[name.end..span.start].trim() == "=";
        found.push(Written {
            path: path.clone(),
            of: (schema.header, key.name),
            fits: Fits::Kind(&key.kind),
            presence: key.presence,
            name: Some(name),
            value: span,
            is_entry,
        });
        below(&key.kind, value.get_ref(), &path, text, found);
    }
}

fn below(kind: &'static Kind, value: &DeValue<'_>, path: &str, text: &str, found: &mut Vec<Written>) {
    let whole = found.last().unwrap().clone();
    let mut item = |fits, value| {
        found.push(Written {
            fits,
            value,
            name: None,
            presence: Presence::Optional,
            ..whole.clone()
        })
    };
    match (kind, value) {
        (
            Kind::Table(schema) | Kind::Profile(.., schema) | Kind::PairProfile(.., schema) | Kind::ChoiceOr(_, schema),
            DeValue::Table(written),
        ) => {
            table(schema, written, &format!("{path}."), text, found);
        }
        (Kind::Named(schema), DeValue::Table(named)) => {
            for (name, value) in named {
                let DeValue::Table(written) = value.get_ref() else {
                    panic!("{path}")
                };
                table(schema, written, &format!("{path}.{}.", name.get_ref()), text, found);
            }
        }
        (Kind::Tables(schema), DeValue::Array(items)) => {
            for (number, value) in items.iter().enumerate() {
                let DeValue::Table(written) = value.get_ref() else {
                    panic!("{path}")
                };
                table(schema, written, &format!("{path}.{number}."), text, found);
            }
        }
        (
            Kind::Pair(dimension, range)
            | Kind::Vector(dimension, range)
            | Kind::PairProfile(dimension, range, _)
            | Kind::Either(dimension, range)
            | Kind::List(dimension, range),
            DeValue::Array(items),
        ) => items
            .iter()
            .for_each(|value| item(Fits::Number(*dimension, *range), value.span())),
        (Kind::Rows(_) | Kind::Course(_), DeValue::Array(rows)) => {
            for row in rows.iter() {
                item(Fits::Row, row.span());
                let DeValue::Array(items) = row.get_ref() else {
                    panic!("{path}")
                };
                let columns: Vec<(Dimension, Range)> = match kind {
                    Kind::Rows(columns) => columns.to_vec(),
                    Kind::Course(dimension) => {
                        let moves = std::iter::repeat((*dimension, Range::ANY));
                        let time = std::iter::once((Dimension::Time, Range::NOT_NEGATIVE));
                        time.chain(moves).take(items.len()).collect()
                    }
                    _ => unreachable!("other kinds have no rows"),
                };
                for (value, (dimension, range)) in items.iter().zip(&columns) {
                    item(Fits::Number(*dimension, *range), value.span());
                }
            }
        }
        _ => {}
    }
}

impl Fits {
    /// Whether the schema alone refuses a value, whatever the rest of the case says.
    pub fn refuses(self, put: &str) -> bool {
        let kind = match self {
            Self::Row => return put != "[1, 2, 3]",
            Self::Number(dimension, range) => return !is_number(put, dimension, &range),
            Self::Kind(kind) => kind,
        };
        let is_text = put.starts_with('"');
        let is_list = put == "[]" || put == "[1, 2, 3]";
        match kind {
            Kind::Quantity(dimension, range) | Kind::Profile(dimension, range, _) => !is_number(put, *dimension, range),
            // Of a solid a list of three is right, too.
            Kind::Either(dimension, range) => put != "[1, 2, 3]" && !is_number(put, *dimension, range),
            Kind::Gradient(dimension) => !is_number(put, *dimension, &Range::ANY) || is_text,
            Kind::Measure => !is_number(put, Dimension::Number, &Range::ANY) && put != STRESS,
            Kind::Pair(..) => true,
            Kind::Vector(..) | Kind::GradientVector(_) => put != "[1, 2, 3]",
            Kind::PairProfile(..) => !["{}", "[1, 2, 3]"].contains(&put),
            Kind::List(dimension, _) if put == "[1, 2, 3]" => dimension.units().next().is_none(),
            Kind::List(..) => !is_list,
            Kind::Rows(_) | Kind::Course(_) => put != "[]",
            Kind::Count(least, most) => !put.parse().is_ok_and(|count: u64| (*least..=*most).contains(&count)),
            Kind::Choice(..) | Kind::Open => true,
            Kind::Text(_) => !is_text,
            Kind::Name => put != "\"abc\"",
            Kind::Names | Kind::Choices(_) => put != "[]",
            Kind::Flag => put != "true",
            Kind::Table(_) | Kind::Named(_) | Kind::ChoiceOr(..) => put != "{}",
            Kind::Tables(_) => put != "[]",
        }
    }
}

/// A text that is a quantity, if only a stress.
pub const STRESS: &str = "\"1 kPa\"";

fn is_number(put: &str, dimension: Dimension, range: &Range) -> bool {
    let not_tiny = |value: f64| value == 0.0 || value.abs() >= dimension.least();
    let divides = dimension == Dimension::Time || !range.contains(0.0);
    let bounded = |value: f64| {
        value.is_finite() && range.contains(value) && value.abs() <= dimension.limit() && (!divides || not_tiny(value))
    };
    if put == STRESS {
        return dimension == Dimension::Stress && bounded(1e3);
    }
    let is_whole = put.trim_start_matches('-').bytes().all(|byte| byte.is_ascii_digit());
    let fits = !is_whole || put.parse::<i64>().is_ok();
    // A date is no number although Rust's reader and TOML's agree on all that are.
    put.parse().is_ok_and(|value: f64| fits && bounded(value))
}
