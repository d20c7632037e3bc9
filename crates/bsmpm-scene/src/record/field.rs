//! Values of a typed table, each with the place where it is written.

use super::{Datum, ListRow, Record};
use crate::error::Origin;
use crate::key_path::join;
use crate::report::Report;
use crate::schema::Table;
use crate::unit::Dimension;
use crate::words::Word;
use std::ops::Deref;

/// A table of the case file as a struct, whose fields are its keys.
pub(crate) trait CaseTable: Sized {
    /// What the table may contain.
    const TABLE: &'static Table;

    /// Where the table is written.
    fn location(&self) -> &Location;

    /// Moves the values of a record of this table into the struct.
    fn from_record(record: Record) -> Self;
}

/// Where a table is written.
#[derive(Clone, Debug)]
pub(crate) struct Location {
    /// Path of the table, as `--set` takes it (`body.0`).
    pub(crate) path: String,
    /// Place of the table.
    pub(crate) origin: Origin,
}

impl Location {
    /// Records an error about the table as a whole.
    pub(crate) fn error(&self, message: impl Into<String>, report: &mut Report<'_>) {
        report.error(self.origin, &self.path, message);
    }
}

/// Where a key of a table is written, or would be.
#[derive(Clone, Debug)]
pub(crate) struct KeyPlace {
    path: String,
    origin: Origin,
    is_given: bool,
    has_unit: bool,
}

impl KeyPlace {
    /// Whether the case gives the key with a unit, so that its author has said which one is meant.
    pub(crate) fn has_unit(&self) -> bool {
        self.has_unit
    }

    /// Whether the case gives the key, even with a wrong value.
    pub(crate) fn is_given(&self) -> bool {
        self.is_given
    }

    /// Path of the key, as `--set` takes it (`body.0.material`).
    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    /// The key.
    pub(crate) fn name(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or(&self.path)
    }

    /// Place of the value, or of the table if the key is absent.
    pub(crate) fn origin(&self) -> Origin {
        self.origin
    }

    /// Path of the table that has the key.
    pub(crate) fn table_path(&self) -> &str {
        self.path.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// Records an error about the key that follows from another one if that is about one of the `causes`.
    pub(crate) fn consequence(&self, message: impl Into<String>, causes: &[&str], report: &mut Report<'_>) {
        report.consequence(self.origin, &self.path, message, causes);
    }

    /// Records an error about the key.
    pub(crate) fn error(&self, message: impl Into<String>, report: &mut Report<'_>) {
        report.error(self.origin, &self.path, message);
    }
}

/// The value of a key and where it is written.
#[derive(Clone, Debug)]
pub(crate) struct Field<T> {
    place: KeyPlace,
    value: Option<T>, // None: the key is absent, or an error has been reported
}

impl<T> Deref for Field<T> {
    type Target = KeyPlace;

    fn deref(&self) -> &KeyPlace {
        &self.place
    }
}

impl<T> Field<T> {
    /// The value; `None` if the key is absent or an error has been reported.
    pub(crate) fn value(&self) -> Option<&T> {
        self.value.as_ref()
    }
}

impl<T: Copy> Field<T> {
    /// A copy of the value; `None` if the key is absent or an error has been reported.
    pub(crate) fn get(&self) -> Option<T> {
        self.value
    }

    /// A copy of the value of a key that may be absent; the outer option is `None` after an error.
    pub(crate) fn if_given(&self) -> Option<Option<T>> {
        if self.is_given {
            self.value.map(Some)
        } else {
            Some(None)
        }
    }
}

impl<V, T> Field<OrTable<V, T>> {
    /// The table, if the case gives one in place of a value.
    pub(crate) fn table(&self) -> Option<&T> {
        match self.value()? {
            OrTable::Table(table) => Some(table),
            OrTable::Value(_) => None,
        }
    }
}

impl<V: Copy, T> Field<OrTable<V, T>> {
    /// A copy of the value, if the case does not give a table in its place.
    pub(crate) fn plain(&self) -> Option<V> {
        match self.value()? {
            OrTable::Value(value) => Some(*value),
            OrTable::Table(_) => None,
        }
    }
}

impl Field<String> {
    /// The text; `None` if the key is absent or an error has been reported.
    pub(crate) fn text(&self) -> Option<&str> {
        self.value.as_deref()
    }
}

impl Field<Vec<f64>> {
    /// As many numbers as the geometry has axes, and zeros behind.
    pub(crate) fn vector(&self) -> Option<[f64; 3]> {
        self.value().map(|numbers| vector(numbers))
    }

    /// Two numbers, if there are two.
    pub(crate) fn pair(&self) -> Option<[f64; 2]> {
        self.value()?.as_slice().try_into().ok()
    }
}

/// As many numbers as the geometry has axes, and zeros behind.
pub(crate) fn vector(numbers: &[f64]) -> [f64; 3] {
    std::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(0.0))
}

impl Field<Vec<ListRow>> {
    /// The first two numbers of each row.
    pub(crate) fn pairs(&self) -> Option<Vec<[f64; 2]>> {
        let rows = self.value()?.iter();
        Some(rows.map(|row| [row.numbers[0], row.numbers[1]]).collect())
    }
}

impl<T> Field<Vec<T>> {
    /// The items; none if the key is absent or an error has been reported.
    pub(crate) fn items(&self) -> &[T] {
        self.value.as_deref().unwrap_or_default()
    }

    /// The items, none if the key is absent; `None` if an error has been reported.
    pub(crate) fn list(&self) -> Option<&[T]> {
        if self.is_given {
            self.value.as_deref()
        } else {
            Some(&[])
        }
    }
}

impl Record {
    /// Moves the value of a key out of the record.
    pub(crate) fn take<T>(&mut self, key: &str, read: fn(Datum) -> Option<T>) -> Field<T> {
        let mut place = KeyPlace {
            path: join(&self.path, key),
            origin: self.origin,
            is_given: false,
            has_unit: false,
        };
        let Some(field) = self.fields.iter_mut().find(|field| field.key == key) else {
            return Field { place, value: None };
        };
        place.origin = field.origin;
        place.is_given = field.written;
        place.has_unit = field.is_worded;
        Field {
            place,
            value: field.datum.take().and_then(read),
        }
    }

    /// Where the table is written.
    pub(crate) fn into_location(self) -> Location {
        Location {
            path: self.path,
            origin: self.origin,
        }
    }
}

/// A number in SI and the dimension of its unit, if it has one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measure {
    pub(crate) number: f64,
    pub(crate) dimension: Option<Dimension>,
}

/// A value, or a table in its place.
#[derive(Clone, Debug)]
pub(crate) enum OrTable<V, T> {
    /// The value.
    Value(V),
    /// The table.
    Table(T),
}

/// A reader of one type: `None` for a datum of another type, which the declaration of the key excludes.
macro_rules! readers {
    ($($name:ident: $Type:ty, $datum:pat => $value:expr;)+) => {$(
        pub(crate) fn $name(self) -> Option<$Type> {
            if let $datum = self { Some($value) } else { None }
        }
    )+};
}

/// Conversion to the types of the fields.
impl Datum {
    readers! {
        number: f64, Self::Number(number) => number;
        numbers: Vec<f64>, Self::Numbers(numbers) => numbers;
        rows: Vec<ListRow>, Self::Rows(rows) => rows;
        count: u64, Self::Count(count) => count;
        measure: Measure, Self::Measure(number, dimension) => Measure { number, dimension };
        text: String, Self::Text(text) => text;
        names: Vec<String>, Self::Names(names) => names;
        flag: bool, Self::Flag(flag) => flag;
        record: Record, Self::Record(record) => record;
        records: Vec<Record>, Self::Records(records) => records;
        named_records: Vec<(String, Record)>, Self::Named(records) => records;
    }

    pub(crate) fn pair(self) -> Option<[f64; 2]> {
        self.numbers()?.try_into().ok()
    }

    pub(crate) fn word<T: Word>(self) -> Option<T> {
        if let Self::Word(word) = self { T::of(word) } else { None }
    }

    pub(crate) fn words<T: Word>(self) -> Option<Vec<T>> {
        self.names()?.iter().map(|word| T::of(word)).collect()
    }

    pub(crate) fn table<T: CaseTable>(self) -> Option<T> {
        self.record().map(T::from_record)
    }

    pub(crate) fn tables<T: CaseTable>(self) -> Option<Vec<T>> {
        let records = self.records()?.into_iter();
        Some(records.map(T::from_record).collect())
    }

    pub(crate) fn named<T: CaseTable>(self) -> Option<Vec<(String, T)>> {
        let records = self.named_records()?.into_iter();
        Some(records.map(|(name, record)| (name, T::from_record(record))).collect())
    }

    pub(crate) fn number_or_table<T: CaseTable>(self) -> Option<OrTable<f64, T>> {
        match self {
            Self::Number(number) => Some(OrTable::Value(number)),
            other => other.table().map(OrTable::Table),
        }
    }

    pub(crate) fn numbers_or_table<T: CaseTable>(self) -> Option<OrTable<Vec<f64>, T>> {
        match self {
            Self::Numbers(numbers) => Some(OrTable::Value(numbers)),
            other => other.table().map(OrTable::Table),
        }
    }

    pub(crate) fn word_or_table<V: Word, T: CaseTable>(self) -> Option<OrTable<V, T>> {
        match self {
            Self::Word(word) => V::of(word).map(OrTable::Value),
            other => other.table().map(OrTable::Table),
        }
    }
}
