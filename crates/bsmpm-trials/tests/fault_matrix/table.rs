//! Checks the outcome of a fault, and prints its row.

use crate::ground::Ground;
use crate::support::driver::{Column, Depth, Judged, Verdict, caught, first_line, number, numbers, words};

/// The columns of the table.
pub const COLUMNS: [Column; 7] = [
    words("row", 3),
    words("what", 74),
    numbers("tried", 5),
    numbers("passed", 6),
    words("figure", 44),
    words("verdict", 14),
    words("remark", 0),
];

/// What came of a row's trials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tried {
    pub tried: usize,
    pub passed: usize,
    /// the largest number that a trial gave
    pub largest: f64,
    pub figure: String,
    pub remark: String,
}

impl Tried {
    /// With the largest number of the trials, in words.
    pub fn figure(self, words: impl Fn(&str) -> String) -> Self {
        Self {
            figure: words(&number(self.largest)),
            ..self
        }
    }

    /// With what the reader should know if nothing went wrong.
    pub fn remark(mut self, remark: &str) -> Self {
        if self.remark.is_empty() {
            self.remark = remark.to_owned();
        }
        self
    }

    /// Not tried, and why.
    pub fn not(why: &str) -> Self {
        Self {
            remark: format!("not tried: {why}"),
            ..Self::default()
        }
    }

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        let remark = if self.remark.is_empty() {
            other.remark
        } else {
            self.remark
        };
        Self {
            tried: self.tried + other.tried,
            passed: self.passed + other.passed,
            largest: self.largest.max(other.largest),
            figure: self.figure,
            remark,
        }
    }
}

/// Tries something so often. A trial fails by its panic; the first one's words are kept.
pub fn trials(count: usize, mut one: impl FnMut(usize) -> f64) -> Tried {
    let mut all = Tried {
        tried: count,
        ..Tried::default()
    };
    for index in 0..count {
        match caught(|| one(index)) {
            Ok(figure) => {
                all.passed += 1;
                all.largest = all.largest.max(figure);
            }
            Err(words) if all.remark.is_empty() => {
                all.remark = format!("trial {index}: {}", first_line(&words));
                if std::env::var_os("BSMPM_FAULTS_TELL").is_some() {
                    eprintln!("trial {index}: {words}");
                }
            }
            Err(_) => {}
        }
    }
    all
}

/// A row as it is declared.
pub struct Row {
    /// number in the list of the faults that this project set itself
    pub id: &'static str,
    pub what: &'static str,
    /// trials of the short run, of which there may be none, and of the full one
    trials: [usize; 2],
    measure: fn(&Ground, usize) -> Tried,
}

/// A row with its trials in the short and in the full run.
pub fn row(id: &'static str, what: &'static str, trials: [usize; 2], measure: fn(&Ground, usize) -> Tried) -> Row {
    Row {
        id,
        what,
        trials,
        measure,
    }
}

impl Row {
    pub fn depth(&self) -> Depth {
        if self.trials[0] == 0 { Depth::Full } else { Depth::Short }
    }

    /// Tries and judges: a row passes if every trial does.
    pub fn judge(&self, ground: &Ground) -> Judged {
        let count = self.trials[usize::from(ground.depth == Depth::Full)];
        let (tried, crashed) = match caught(|| (self.measure)(ground, count)) {
            Ok(tried) => (tried, false),
            Err(words) => (
                Tried {
                    tried: 1,
                    remark: first_line(&words),
                    ..Tried::default()
                },
                true,
            ),
        };
        let passes = tried.passed == tried.tried;
        let verdict = Verdict::of(passes, false, crashed);
        let word = if tried.tried == 0 { "not tried" } else { verdict.word() };
        let count = tried.tried.to_string();
        let passed = tried.passed.to_string();
        let cells = [
            self.id.into(),
            self.what.into(),
            count,
            passed,
            tried.figure,
            word.into(),
            tried.remark,
        ];
        Judged {
            cells: cells.into(),
            verdict,
        }
    }
}
