//! Compares one value of a case file with the type that the schema requires.

use super::{Datum, ListRow};
use crate::document::{Node, Value};
use crate::error::Origin;
use crate::nearest::hint;
use crate::report::{Report, shortened};
use crate::schema::{Kind, Range, Words};
use crate::unit::{self, Dimension};
use crate::words::{Geometry, RemovedWord};
use bsmpm_messages::{code_of, with_context};

/// Rows of a list that are wrong one after the other, behind which the rest is not looked at.
const WRONG_ROWS: usize = 3;

/// Of a file that `--set` names: a case is whole before it is overridden.
pub(crate) const UNREAD: &str = "E0027: --set does not read data files. Name the data file in the case file, or write \
     the rows of numbers after the `=` of --set.";

/// Longest name of a material, column or check.
const LONGEST_NAME: usize = 64;

/// What the values in a column of rows are.
#[derive(Clone, Copy)]
struct ValueColumn {
    dimension: Dimension,
    range: Range,
}

impl ValueColumn {
    fn new(dimension: Dimension, range: Range) -> Self {
        Self { dimension, range }
    }
}

/// The value of `node` as `kind` says; `None` after an error.
pub(super) fn read(
    kind: &Kind,
    node: &Node,
    path: &str,
    pseudo_time: bool,
    geometry: Geometry,
    report: &mut Report<'_>,
) -> Option<Datum> {
    let name = path.rsplit('.').next().unwrap_or(path);
    let dims = geometry.dims();
    let mut reader = ValueReader {
        kind,
        path,
        name,
        pseudo_time,
        geometry,
        report,
    };
    match kind {
        Kind::Quantity(dimension, range) => reader.quantity(node, *dimension, range).map(Datum::Number),
        Kind::Profile(dimension, range, _) => reader.quantity(node, *dimension, range).map(Datum::Number),
        Kind::Gradient(dimension) => reader.gradient(node, *dimension).map(Datum::Number),
        Kind::GradientVector(dimension) => reader.gradients(node, *dimension),
        Kind::Rows(columns) => {
            let columns = columns.iter().map(|(of, range)| ValueColumn::new(*of, *range));
            reader.rows(node, &columns.collect::<Vec<_>>())
        }
        Kind::Course(dimension) => {
            let mut columns = vec![ValueColumn::new(*dimension, Range::ANY); dims + 1];
            columns[0] = ValueColumn::new(Dimension::Time, Range::NOT_NEGATIVE);
            reader.rows(node, &columns)
        }
        Kind::Measure => reader.measure(node),
        Kind::Pair(dimension, range) => reader.quantities(node, *dimension, range, Some(2)),
        Kind::Vector(dimension, range) | Kind::PairProfile(dimension, range, _) => {
            reader.quantities(node, *dimension, range, Some(dims))
        }
        Kind::List(dimension, range) => reader.quantities(node, *dimension, range, None),
        Kind::Either(dimension, range) => match node.value {
            Value::List(_) => reader.quantities(node, *dimension, range, Some(dims)),
            _ => reader
                .quantity(node, *dimension, range)
                .map(|number| Datum::Numbers(vec![number])),
        },
        Kind::Count(least, most) => reader.count(node, *least, *most),
        Kind::Choice(words) | Kind::ChoiceOr(words, _) => reader.choice(node, words),
        Kind::Text(most) => reader.text(node, *most),
        Kind::Name => match &node.value {
            Value::Text(text) if is_name(text) => Some(Datum::Text(text.clone())),
            _ => reader.unexpected(node),
        },
        Kind::Names => reader.names(node),
        Kind::Choices(words) => reader.choices(node, words),
        Kind::Flag => match node.value {
            Value::Flag(flag) => Some(Datum::Flag(flag)),
            _ => reader.unexpected(node),
        },
        Kind::Table(_) | Kind::Named(_) | Kind::Tables(_) | Kind::Open => reader.unexpected(node),
    }
}

/// What is wrong with a value of another type than its kind.
pub(super) fn expected(kind: &Kind, node: &Node) -> String {
    format!(
        "E0013: the value has the wrong form: expected {kind}, found {}.",
        node.show()
    )
}

/// What is wrong with a whole number that has more digits than one can have.
fn too_long(text: &str) -> String {
    format!(
        "E0010: {} has too many digits for a whole number. Write the number with an exponent, such as 1e20.",
        shortened(text)
    )
}

/// Whether `text` is fit for a name that stands in files' headers and key paths.
pub(super) fn is_name(text: &str) -> bool {
    (1..=LONGEST_NAME).contains(&text.len())
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'))
}

struct ValueReader<'a, 'r> {
    kind: &'a Kind,
    path: &'a str,
    name: &'a str,
    pseudo_time: bool,
    geometry: Geometry,
    report: &'a mut Report<'r>,
}

impl ValueReader<'_, '_> {
    fn fail<T>(&mut self, node: &Node, message: impl Into<String>) -> Option<T> {
        self.report.error(node.origin, self.path, message);
        None
    }

    fn unexpected<T>(&mut self, node: &Node) -> Option<T> {
        let message = expected(self.kind, node);
        match self.kind {
            // How many numbers there are follows from the number of dimensions.
            Kind::Vector(..) | Kind::PairProfile(..) | Kind::GradientVector(_) | Kind::Either(..) | Kind::Course(_) => {
                self.report.consequence(node.origin, self.path, message, &["geometry"]);
                None
            }
            _ => self.fail(node, message),
        }
    }

    /// A file that was named where none is read.
    fn unread<T>(&mut self, node: &Node) -> Option<T> {
        let message = match node.origin {
            Origin::Override(_) => UNREAD,
            Origin::Text(_) | Origin::Nowhere => {
                "E0027: the braces must name a data file. The key `file` is required, `along` is optional, and other \
                 keys are not allowed. Write { file = \"rows.csv\" }."
            }
        };
        self.fail(node, message)
    }

    /// What a solid wants three numbers of.
    fn not_of_three<T>(&mut self, node: &Node, dimension: Dimension) -> Option<T> {
        let unit = if dimension == Dimension::LineForce {
            ", in N"
        } else {
            ""
        };
        self.fail(
            node,
            format!(
                "{} Give three components in 3-D, [x, y, z]{unit}.",
                expected(self.kind, node)
            ),
        )
    }

    fn quantity(&mut self, node: &Node, dimension: Dimension, range: &Range) -> Option<f64> {
        let read = match &node.value {
            Value::Integer(text) if text.parse::<i64>().is_err() => Err(too_long(text)),
            Value::Integer(text) | Value::Float(text) => unit::finite(text),
            Value::Text(_) if dimension == Dimension::Number => return self.unexpected(node),
            Value::Text(text) => self.worded(node, text, dimension),
            _ => return self.unexpected(node),
        };
        let value = match read {
            Ok(value) => value,
            Err(message) => return self.fail(node, message + self.key_meant(node)),
        };
        if !range.contains(value) {
            let allowed = range.condition(self.name) + &self.si(dimension);
            let why = if range.why.is_empty() {
                String::new()
            } else {
                format!(": {}", range.why)
            };
            return self.fail(
                node,
                format!(
                    "E0010: {} is outside the allowed range ({allowed}){why}. Correct the value.",
                    node.show()
                ),
            );
        }
        let divides = dimension == Dimension::Time || !range.contains(0.0);
        if divides && value != 0.0 && value.abs() < dimension.least() {
            let least = dimension.least();
            let unit = self.si(dimension);
            let found = node.show();
            let message = format!(
                "E0010: {found} is too close to zero: the smallest allowed value of {dimension} is {least:e}{unit}. \
                 Correct the value or its unit."
            );
            return self.fail(node, message);
        }
        self.bounded(node, value, dimension)
    }

    /// Where a unit weight and a density of a material are mixed up: the key that is meant.
    fn key_meant(&self, node: &Node) -> &'static str {
        let Value::Text(text) = &node.value else { return "" };
        let has_unit_of = |dimension| unit::parse(text, dimension).is_ok();
        match self.name {
            "density" if self.path.starts_with("material.") && has_unit_of(Dimension::UnitWeight) => {
                " Use the key `unit_weight`."
            }
            "unit_weight" if has_unit_of(Dimension::Density) => " Use the key `density`.",
            _ => "",
        }
    }

    /// The SI unit of a dimension behind a number; nothing of what has none, as pseudo-time.
    fn si(&self, dimension: Dimension) -> String {
        let unit = match dimension {
            Dimension::Time | Dimension::Velocity if self.pseudo_time => None,
            Dimension::LineForce if self.geometry != Geometry::PlaneStrain => Dimension::Force.units().next(),
            _ => dimension.units().next(),
        };
        unit.map_or(String::new(), |unit| format!(" {unit}"))
    }

    /// The value of a number with a unit, or what is wrong with it.
    fn worded(&self, node: &Node, text: &str, dimension: Dimension) -> Result<f64, String> {
        match dimension {
            Dimension::Time if self.pseudo_time => Err(format!(
                "E0023: {} has a unit, but time is a dimensionless pseudo-time in a quasi-static analysis. Write the \
                 number without a unit.",
                node.show()
            )),
            Dimension::Velocity if self.pseudo_time => Err(format!(
                "E0023: {} has a unit of time, but time is a dimensionless pseudo-time in a quasi-static analysis. \
                 Write the velocity without a unit, in m per unit of pseudo-time.",
                node.show()
            )),
            Dimension::LineForce if self.geometry != Geometry::PlaneStrain => unit::parse(text, Dimension::Force),
            _ => unit::parse(text, dimension),
        }
    }

    /// The value, if what is derived from it stays finite.
    fn bounded(&mut self, node: &Node, value: f64, dimension: Dimension) -> Option<f64> {
        let most = dimension.limit();
        if value.abs() > most {
            let found = node.show();
            let unit = self.si(dimension);
            let message = format!(
                "E0010: {found} is too large: the largest allowed value of {dimension} is {most:e}{unit}. Correct the \
                 value or its unit."
            );
            return self.fail(node, message);
        }
        Some(value)
    }

    fn gradient(&mut self, node: &Node, dimension: Dimension) -> Option<f64> {
        let Value::Text(text) = &node.value else {
            return self.quantity(node, dimension, &Range::ANY);
        };
        match unit::parse_per_metre(text, dimension) {
            Ok(value) => self.bounded(node, value, dimension),
            Err(message) => self.fail(node, message),
        }
    }

    fn gradients(&mut self, node: &Node, dimension: Dimension) -> Option<Datum> {
        match &node.value {
            Value::List(items) if items.len() == self.geometry.dims() => {
                let read: Vec<Option<f64>> = items.iter().map(|item| self.gradient(item, dimension)).collect();
                read.into_iter().collect::<Option<_>>().map(Datum::Numbers)
            }
            _ => self.unexpected(node),
        }
    }

    fn names(&mut self, node: &Node) -> Option<Datum> {
        let Value::List(items) = &node.value else {
            return self.unexpected(node);
        };
        let names = items.iter().map(|item| match &item.value {
            Value::Text(text) if is_name(text) => Some(text.clone()),
            _ => None,
        });
        match names.collect() {
            Some(names) => Some(Datum::Names(names)),
            None => self.unexpected(node),
        }
    }

    fn rows(&mut self, node: &Node, columns: &[ValueColumn]) -> Option<Datum> {
        let items = match &node.value {
            Value::List(items) => items,
            Value::Table(table) if table.get("file").is_some() => return self.unread(node),
            _ => return self.unexpected(node),
        };
        if let Some(message) = columns
            .iter()
            .enumerate()
            .find_map(|(k, column)| self.heading(items, k, column.dimension))
        {
            return self.fail(node, message);
        }
        let mut read: Vec<Option<ListRow>> = Vec::with_capacity(items.len());
        for item in items {
            read.push(self.row(item, columns));
            let wrong = read.iter().rev().take(WRONG_ROWS).filter(|row| row.is_none()).count();
            if wrong == WRONG_ROWS && read.len() < items.len() {
                let more = items.len() - read.len();
                let message = format!(
                    "E0009: the remaining {more} rows were not checked, because the {WRONG_ROWS} rows before them \
                     have errors. Correct these rows first."
                );
                return self.fail(node, message);
            }
        }
        read.into_iter().collect::<Option<Vec<ListRow>>>().map(Datum::Rows)
    }

    /// What is wrong with a unit that a column has in all of several rows, as the heading of a file gives it.
    fn heading(&self, rows: &[Node], column: usize, dimension: Dimension) -> Option<String> {
        let first = rows.first().filter(|_| rows.len() > 1)?;
        let (unit, message) = self.wrong_unit(first, column, dimension)?;
        let is_of_all = rows[1..].iter().all(|row| {
            let found = self.wrong_unit(row, column, dimension);
            found.is_some_and(|(other, _)| other == unit)
        });
        let number = column + 1;
        let all = with_context(&message, &format!("column {number} of all {} rows", rows.len()));
        is_of_all.then(|| all + " In a data file, change the unit in the heading.")
    }

    /// The unit of a row's cell, and what is wrong with it.
    fn wrong_unit(&self, row: &Node, column: usize, dimension: Dimension) -> Option<(String, String)> {
        let Value::List(cells) = &row.value else { return None };
        let cell = cells.get(column)?;
        let Value::Text(text) = &cell.value else { return None };
        let unit = text.split_once(' ')?.1.to_owned();
        self.worded(cell, text, dimension).err().map(|message| (unit, message))
    }

    fn row(&mut self, node: &Node, columns: &[ValueColumn]) -> Option<ListRow> {
        let items = match &node.value {
            Value::List(items) if items.len() == columns.len() => items,
            _ => return self.unexpected(node),
        };
        let read = items
            .iter()
            .zip(columns)
            .map(|(item, column)| self.quantity(item, column.dimension, &column.range));
        let read: Vec<Option<f64>> = read.collect();
        Some(ListRow {
            origin: node.origin,
            numbers: read.into_iter().collect::<Option<_>>()?,
        })
    }

    fn quantities(&mut self, node: &Node, dimension: Dimension, range: &Range, length: Option<usize>) -> Option<Datum> {
        let items = match &node.value {
            Value::List(items) if length.is_none_or(|length| length == items.len()) => items,
            _ if length == Some(3) => return self.not_of_three(node, dimension),
            _ => return self.unexpected(node),
        };
        let read: Vec<Option<f64>> = items.iter().map(|item| self.quantity(item, dimension, range)).collect();
        read.into_iter().collect::<Option<Vec<f64>>>().map(Datum::Numbers)
    }

    fn measure(&mut self, node: &Node) -> Option<Datum> {
        let Value::Text(text) = &node.value else {
            return self
                .quantity(node, Dimension::Number, &Range::ANY)
                .map(|number| Datum::Measure(number, None));
        };
        match unit::parse_any(text, None) {
            Ok((number, dimension)) => Some(Datum::Measure(number, Some(dimension))),
            Err(message) => self.fail(node, message),
        }
    }

    fn count(&mut self, node: &Node, least: u64, most: u64) -> Option<Datum> {
        let Value::Integer(text) = &node.value else {
            return self.unexpected(node);
        };
        match text.parse::<u64>() {
            Ok(count) if (least..=most).contains(&count) => Some(Datum::Count(count)),
            _ => {
                let found = shortened(text);
                let name = self.name;
                self.fail(
                    node,
                    format!(
                        "E0010: {found} is outside the allowed range ({least} <= {name} <= {most}). Correct the value."
                    ),
                )
            }
        }
    }

    fn choice(&mut self, node: &Node, words: &Words) -> Option<Datum> {
        let is_meant = |removed: &&RemovedWord| match &node.value {
            Value::Text(text) => removed.word == text,
            Value::Table(_) => removed.word.starts_with('{'),
            _ => false,
        };
        if let Some(removed) = words.removed.iter().find(is_meant) {
            self.report.removed(node.origin, self.path, removed);
            return None;
        }
        let Value::Text(text) = &node.value else {
            return self.unexpected(node);
        };
        if let Some(word) = words.words().find(|word| word == text) {
            return Some(Datum::Word(word));
        }
        if words.later.contains(&text.as_str()) {
            return self.fail(
                node,
                format!("E0012: the value \"{text}\" is not available yet. Use {}.", self.kind),
            );
        }
        let meant = words.misnomers.iter().find(|(word, _)| word == text);
        let near = match (meant, hint(text, words.words())) {
            (Some((_, meant)), _) if code_of(meant).is_some() => return self.fail(node, *meant),
            (Some((_, meant)), _) => format!(". {meant}."),
            (None, hint) if hint.is_empty() => ".".to_owned(),
            (None, hint) => hint,
        };
        self.fail(
            node,
            format!(
                "E0017: this value is not allowed: expected {}, found {}{near}",
                self.kind,
                node.show()
            ),
        )
    }

    /// Words of a list, in its order; none twice.
    fn choices(&mut self, node: &Node, words: &Words) -> Option<Datum> {
        let Value::List(items) = &node.value else {
            return self.unexpected(node);
        };
        let mut found: Vec<String> = Vec::new();
        for item in items {
            let word = match self.choice(item, words)? {
                Datum::Word(word) if found.iter().any(|other| other == word) => {
                    return self.fail(
                        item,
                        format!("E0019: the list has \"{word}\" twice. Delete one of them."),
                    );
                }
                Datum::Word(word) => word,
                _ => return None,
            };
            found.push(word.to_owned());
        }
        Some(Datum::Names(found))
    }

    fn text(&mut self, node: &Node, most: usize) -> Option<Datum> {
        match &node.value {
            Value::Text(text) if text.chars().nth(most).is_none() && !text.chars().any(char::is_control) => {
                Some(Datum::Text(text.clone()))
            }
            _ => self.unexpected(node),
        }
    }
}
