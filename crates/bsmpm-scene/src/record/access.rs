//! Typed access to values of a record.

use super::{Datum, Record};
use crate::schema::Kind;
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
        numbers: &[f64],
            Kind::Pair(..) | Kind::Vector(..) | Kind::PairProfile(..) | Kind::GradientVector(_) | Kind::Either(..)
            | Kind::List(..)
            => Datum::Numbers(numbers) => numbers;
        flag: bool, Kind::Flag => Datum::Flag(flag) => *flag;
        /// A table, also where it may stand for a number or a word.
        record: &Record,
            Kind::Table(_) | Kind::Profile(..) | Kind::PairProfile(..) | Kind::ChoiceOr(..) => Datum::Record(record) => record;
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

    /// The same of a key that may be absent; the outer option is `None` after an error.
    pub(crate) fn word_if_given<T: Word>(&self, key: &str) -> Option<Option<T>> {
        if self.gives(key) {
            self.word(key).map(Some)
        } else {
            Some(None)
        }
    }
}
