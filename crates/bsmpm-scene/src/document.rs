//! The parsed text of a case: values with their positions in the file, for messages.

use crate::error::Origin;
use crate::report::{Report, shortened};
use crate::source::Source;
use crate::words::Word;
use toml::de::{DeTable, DeValue};

mod syntax;
mod write;

use syntax::SyntaxError;

/// A value with its place.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) origin: Origin,
    pub(crate) value: Value,
}

impl Node {
    /// Whether it is a text or a list with one.
    pub(crate) fn is_worded(&self) -> bool {
        match &self.value {
            Value::Text(_) => true,
            Value::List(items) => items.iter().any(Self::is_worded),
            _ => false,
        }
    }
}

/// A value of TOML. Numbers are kept as text, without underscores.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(String),
    Float(String),
    Flag(bool),
    Date(String),
    List(Vec<Node>),
    Table(DocumentTable),
}

/// The entries of a table in the order of the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct DocumentTable {
    pub(crate) entries: Vec<DocumentEntry>,
}

/// A key, its place and its value.
#[derive(Clone, Debug)]
pub(crate) struct DocumentEntry {
    pub(crate) key: String,
    pub(crate) origin: Origin,
    pub(crate) node: Node,
}

impl DocumentTable {
    pub(crate) fn get(&self, key: &str) -> Option<&DocumentEntry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut DocumentEntry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }

    /// The value at a path of keys, such as `analysis.type`.
    pub(crate) fn node(&self, path: &str) -> Option<&Node> {
        let mut keys = path.split('.');
        let first = &self.get(keys.next()?)?.node;
        keys.try_fold(first, |node, key| match &node.value {
            Value::Table(table) => table.get(key).map(|entry| &entry.node),
            _ => None,
        })
    }

    /// The word at a path of keys, if it is one of those of `T`, and its place.
    pub(crate) fn word<T: Word>(&self, path: &str) -> Option<(T, Origin)> {
        let node = self.node(path)?;
        let Value::Text(text) = &node.value else { return None };
        Some((T::of(text)?, node.origin))
    }
}

impl Node {
    /// The value as an error shows it.
    pub(crate) fn show(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("\"{}\"", shortened(text)),
            Value::Integer(text) | Value::Float(text) | Value::Date(text) => shortened(text),
            Value::Flag(flag) => flag.to_string(),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }
}

/// The document in `source`; syntax errors go to `report`, one per line.
pub(crate) fn parse(source: &Source<'_>, report: &mut Report<'_>) -> DocumentTable {
    let (table, errors) = DeTable::parse_recoverable(source.text);
    let errors: Vec<SyntaxError<'_>> = errors
        .iter()
        .map(|error| SyntaxError {
            span: error.span(),
            message: error.message(),
        })
        .collect();
    syntax::report_all(source, &errors, report);
    entries(table.get_ref(), &|span| Origin::Text(span.start))
}

/// The value `text` of an override, standing at `origin`.
pub(crate) fn parse_value(text: &str, origin: Origin) -> Result<Node, String> {
    let value = DeValue::parse(text).map_err(|error| error.message().to_owned())?;
    Ok(Node {
        origin,
        value: convert(value.get_ref(), &|_| origin),
    })
}

type Placing<'a> = dyn Fn(std::ops::Range<usize>) -> Origin + 'a;

fn entries(table: &DeTable<'_>, place: &Placing<'_>) -> DocumentTable {
    let entries = table.iter().map(|(key, value)| DocumentEntry {
        key: key.get_ref().to_string(),
        origin: place(key.span()),
        node: node(value, place),
    });
    let mut entries: Vec<DocumentEntry> = entries.collect();
    entries.sort_by_key(|entry| entry.origin);
    DocumentTable { entries }
}

/// Converts a value and keeps its place.
fn node(value: &toml::Spanned<DeValue<'_>>, place: &Placing<'_>) -> Node {
    Node {
        origin: place(value.span()),
        value: convert(value.get_ref(), place),
    }
}

fn convert(value: &DeValue<'_>, place: &Placing<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(decimal) => Value::Integer(decimal.to_string()),
            Err(_) => Value::Integer(number.to_string()),
        },
        DeValue::Float(number) => Value::Float(number.as_str().to_owned()),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Array(list) => Value::List(list.iter().map(|item| node(item, place)).collect()),
        DeValue::Table(table) => Value::Table(entries(table, place)),
    }
}
