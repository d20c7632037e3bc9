//! Values by the type that the schema gives them.

use super::{Datum, Record, Row};
use crate::unit::Dimension;
use crate::words::Word;

/// Typed access: `None` if the key is absent or an error has been reported.
impl Record {
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        if let Datum::Number(number) = self.datum(key)? { Some(*number) } else { None }
    }

    pub(crate) fn measure(&self, key: &str) -> Option<(f64, Option<Dimension>)> {
        if let Datum::Measure(number, dimension) = self.datum(key)? { Some((*number, *dimension)) } else { None }
    }

    pub(crate) fn numbers(&self, key: &str) -> Option<&[f64]> {
        if let Datum::Numbers(numbers) = self.datum(key)? { Some(numbers) } else { None }
    }

    pub(crate) fn rows(&self, key: &str) -> Option<&[Row]> {
        if let Datum::Rows(rows) = self.datum(key)? { Some(rows) } else { None }
    }

    pub(crate) fn pair(&self, key: &str) -> Option<[f64; 2]> {
        self.numbers(key)?.try_into().ok()
    }

    pub(crate) fn count(&self, key: &str) -> Option<u64> {
        if let Datum::Count(count) = self.datum(key)? { Some(*count) } else { None }
    }

    /// What the key's word stands for; `T` is the choice that the schema names.
    pub(crate) fn word<T: Word>(&self, key: &str) -> Option<T> {
        let Datum::Word(word) = self.datum(key)? else { return None };
        let choice = T::of(word);
        debug_assert!(choice.is_some(), "{key}: \"{word}\" is no {}", std::any::type_name::<T>());
        choice
    }

    /// The same of a key that may be absent; the outer option is `None` after an error.
    pub(crate) fn word_if_given<T: Word>(&self, key: &str) -> Option<Option<T>> {
        if self.gives(key) { self.word(key).map(Some) } else { Some(None) }
    }

    pub(crate) fn text(&self, key: &str) -> Option<&str> {
        if let Datum::Text(text) = self.datum(key)? { Some(text) } else { None }
    }

    pub(crate) fn flag(&self, key: &str) -> Option<bool> {
        if let Datum::Flag(flag) = self.datum(key)? { Some(*flag) } else { None }
    }

    pub(crate) fn record(&self, key: &str) -> Option<&Record> {
        if let Datum::Record(record) = self.datum(key)? { Some(record) } else { None }
    }

    pub(crate) fn named(&self, key: &str) -> &[(String, Record)] {
        if let Some(Datum::Named(named)) = self.datum(key) { named } else { &[] }
    }

    pub(crate) fn records(&self, key: &str) -> &[Record] {
        if let Some(Datum::Records(records)) = self.datum(key) { records } else { &[] }
    }
}
