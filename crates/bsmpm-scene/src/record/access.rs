//! Typed access to values of a record.

use super::{Datum, ListRow, Record};
use crate::schema::Kind;
use crate::unit::Dimension;
use crate::words::Word;

/// An accessor: its type, the kinds of keys that have such values, and the value as it is stored.
macro_rules! typed {
    ($($(#[$doc:meta])* $name:ident: $Type:ty, $($kind:pat_param)|+ => $datum:pat => $value:expr;)+) => {$(
        $(#[$doc])*
        pub(crate) fn $name(&self, key: &str) -> Option<$Type> {
            if let $datum = self.datum(key, |kind| matches!(kind, $($kind)|+))? { Some($value) } else { None }
        }
    )+};
}

/// Typed access: `None` if the key is absent or an error has been reported.
impl Record {
    typed! {
        number: f64, Kind::Quantity(..) | Kind::Profile(..) | Kind::Gradient(_) => Datum::Number(number) => *number;
        measure: (f64, Option<Dimension>), Kind::Measure => Datum::Measure(number, unit) => (*number, *unit);
        numbers: &[f64],
            Kind::Pair(..) | Kind::Vector(..) | Kind::PairProfile(..) | Kind::GradientVector(_) | Kind::Either(..)
            | Kind::List(..)
            => Datum::Numbers(numbers) => numbers;
        rows: &[ListRow], Kind::Rows(_) | Kind::Course(_) => Datum::Rows(rows) => rows;
        count: u64, Kind::Count(..) => Datum::Count(count) => *count;
        text: &str, Kind::Text(_) | Kind::Name => Datum::Text(text) => text;
        names: &[String], Kind::Names => Datum::Names(names) => names;
        flag: bool, Kind::Flag => Datum::Flag(flag) => *flag;
        /// A table, also where it may stand for a number or a word.
        record: &Record,
            Kind::Table(_) | Kind::Profile(..) | Kind::PairProfile(..) | Kind::ChoiceOr(..) => Datum::Record(record) => record;
    }

    pub(crate) fn pair(&self, key: &str) -> Option<[f64; 2]> {
        self.numbers(key)?.try_into().ok()
    }

    /// As many numbers as the geometry has axes, and zeros behind.
    pub(crate) fn vector(&self, key: &str) -> Option<[f64; 3]> {
        let numbers = self.numbers(key)?;
        Some(std::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(0.0)))
    }

    /// What the key's word stands for; `T` is the choice that the schema names.
    pub(crate) fn word<T: Word>(&self, key: &str) -> Option<T> {
        let datum = self.datum(key, |kind| match kind {
            Kind::Choice(words) | Kind::ChoiceOr(words, _) => words.words().eq(T::WORDS.words()),
            _ => false,
        });
        if let Datum::Word(word) = datum? {
            T::of(word)
        } else {
            None
        }
    }

    /// What the words of a key's list stand for; `T` is the choice that the schema names.
    pub(crate) fn choices<T: Word>(&self, key: &str) -> Option<Vec<T>> {
        let datum = self.datum(
            key,
            |kind| matches!(kind, Kind::Choices(words) if words.words().eq(T::WORDS.words())),
        );
        let Datum::Names(words) = datum? else { return None };
        words.iter().map(|word| T::of(word)).collect()
    }

    /// The same of a key that may be absent; the outer option is `None` after an error.
    pub(crate) fn word_if_given<T: Word>(&self, key: &str) -> Option<Option<T>> {
        if self.gives(key) {
            self.word(key).map(Some)
        } else {
            Some(None)
        }
    }

    /// All tables of a key that may stand several times, or once.
    pub(crate) fn records(&self, key: &str) -> &[Record] {
        match self.datum(key, |kind| matches!(kind, Kind::Tables(_) | Kind::Table(_))) {
            Some(Datum::Records(records)) => records,
            Some(Datum::Record(record)) => std::slice::from_ref(record),
            _ => &[],
        }
    }
}
