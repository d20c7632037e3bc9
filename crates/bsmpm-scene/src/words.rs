//! Rust enums of the words that keys of a case accept, such as `"plane-strain"`, with descriptions.

#[macro_use]
mod define;
mod output;
mod physics;
mod retired;
mod scene;
mod solver;

pub use output::LimitedIndicator;
pub(crate) use retired::{BACKGROUND_CELLS, BACKGROUND_KIND};
pub use scene::{
    Accuracy, AnalysisType, Axis, Base, C0Lines, Components, Drainage, Failure, Format, Geometry, Order, Path, Purpose,
    RigidMotion, Settled, Side, Start, Support,
};
pub use solver::{LinearSolver, Nonlinear};

/// What one of several words stands for.
pub trait Word: Copy + 'static {
    /// All its words.
    const WORDS: Words;

    /// What `word` stands for, if it is one of them.
    fn of(word: &str) -> Option<Self>;

    /// Its word.
    fn word(self) -> &'static str;
}

/// The words of a choice, in the order in which messages list them.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// The word that leaves it to the program, if there is one.
    pub auto: Option<(&'static str, &'static str)>,
    /// Words and what they mean.
    pub words: &'static [(&'static str, &'static str)],
    /// Words that are not available yet.
    pub later: &'static [&'static str],
    /// Words that others use, and which of these is meant; with a code where what is meant is not available.
    pub misnomers: &'static [(&'static str, &'static str)],
    /// Words of earlier versions, which are still read, and those of now.
    pub earlier: &'static [(&'static str, &'static str)],
    /// Words that earlier versions had.
    pub removed: &'static [RemovedWord],
}

/// A word that earlier versions read and this one does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RemovedWord {
    /// The word, or the header of a table, `{ .. }`, that stood in its place.
    pub word: &'static str,
    /// The last version that reads it.
    pub last: &'static str,
    /// What a case says instead, an imperative sentence.
    pub remedy: &'static str,
}

impl RemovedWord {
    /// The value as a case writes it.
    pub fn value(&self) -> String {
        match self.word.starts_with('{') {
            true => self.word.to_owned(),
            false => format!("\"{}\"", self.word),
        }
    }
}

impl Words {
    /// The word of now for a word of an earlier version.
    pub fn renamed(&self, earlier: &str) -> Option<&'static str> {
        self.earlier
            .iter()
            .find(|(word, _)| *word == earlier)
            .map(|(_, now)| *now)
    }

    /// Words and what they mean.
    pub fn all(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.auto
            .into_iter()
            .chain(self.words.iter().copied())
            .map(|(word, doc)| (word, doc.trim_start()))
    }

    /// The words.
    pub fn words(&self) -> impl Iterator<Item = &'static str> {
        self.all().map(|(word, _)| word)
    }
}

/// What the word `auto` leaves to the program is `None`.
impl<T: Word> Word for Option<T> {
    const WORDS: Words = Words {
        auto: Some((AUTO, "Chosen by the program.")),
        ..T::WORDS
    };

    fn of(word: &str) -> Option<Self> {
        if word == AUTO {
            Some(None)
        } else {
            T::of(word).map(Some)
        }
    }

    fn word(self) -> &'static str {
        self.map_or(AUTO, T::word)
    }
}

const AUTO: &str = "auto";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::LawName;

    #[test]
    fn words_lead_to_their_choice_and_back() {
        for (word, doc) in Option::<LinearSolver>::WORDS.all() {
            assert!(!doc.is_empty());
            assert_eq!(Option::<LinearSolver>::of(word).map(Word::word), Some(word));
        }
        assert_eq!(LinearSolver::of(AUTO), None);
        assert_eq!(LawName::of("cam-clay"), None);
    }
}
