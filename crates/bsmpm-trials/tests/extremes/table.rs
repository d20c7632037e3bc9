//! Compares an extreme case with its bounds, and prints the row.

pub use crate::support::driver::Depth;
use crate::support::driver::{Column, Judged, Verdict, caught, first_line, number, numbers, words};
use std::time::Instant;

/// The columns of the table.
pub const COLUMNS: [Column; 7] = [
    words("row", 3),
    words("what", 82),
    numbers("figure", 10),
    words("bound", 20),
    words("verdict", 14),
    numbers("s", 6),
    words("remark", 0),
];

/// What a figure may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// this at most
    AtMost(f64),
    /// between both
    Within(f64, f64),
    /// zero: the same bits
    Same,
    /// anything finite: the row is there to be read
    Reported,
}

/// What a measurement gave.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// a number, and what its reader should know
    Figure(f64, String),
    /// no number, but a reason: exit code 65, 80 or 82 of the program, or 0 with a warning
    Warned(i32, String),
    /// neither: a crash, a hang, numbers that are none
    Broken(String),
}

impl From<f64> for Found {
    fn from(value: f64) -> Self {
        Self::Figure(value, String::new())
    }
}

/// A row as it is declared.
pub struct Row {
    /// number in the list of the extremes that this project set itself
    pub id: &'static str,
    /// the extreme, and the number that is measured there
    pub what: &'static str,
    pub limit: Limit,
    pub depth: Depth,
    /// whether a clean refusal or warning is an answer, too
    pub may_refuse: bool,
    /// whether the end of a run from which a material point would leave the grid is an answer, too
    pub may_leave: bool,
    /// why it fails at present
    pub known: Option<&'static str>,
    pub measure: Box<dyn Fn() -> Found>,
}

/// A row that must give a figure, measured always.
pub fn row<F: Into<Found>>(
    id: &'static str,
    what: &'static str,
    limit: Limit,
    measure: impl Fn() -> F + 'static,
) -> Row {
    let measure = Box::new(move || measure().into());
    Row {
        id,
        what,
        limit,
        depth: Depth::Short,
        may_refuse: false,
        may_leave: false,
        known: None,
        measure,
    }
}

impl Row {
    /// In the full run only.
    pub fn full(self) -> Self {
        Self {
            depth: Depth::Full,
            ..self
        }
    }

    /// A clean refusal passes as well.
    pub fn or_refused(self) -> Self {
        Self {
            may_refuse: true,
            ..self
        }
    }

    /// A run that ends because a material point would leave the grid (exit code 81) passes as well.
    pub fn or_left(self) -> Self {
        Self {
            may_leave: true,
            ..self
        }
    }

    /// It fails at present, and why.
    pub fn fails(self, why: &'static str) -> Self {
        Self {
            known: Some(why),
            ..self
        }
    }

    /// Measures and judges.
    pub fn judge(&self) -> Judged {
        let started = Instant::now();
        let found = caught(|| (self.measure)()).unwrap_or_else(Found::Broken);
        let crashed = matches!(found, Found::Broken(_));
        let verdict = Verdict::of(self.passes(&found), self.known.is_some(), crashed);
        Judged {
            cells: self.cells(&found, verdict, started.elapsed().as_secs_f64()).into(),
            verdict,
        }
    }

    /// row, what, figure, bound, verdict, seconds, remark
    fn cells(&self, found: &Found, verdict: Verdict, seconds: f64) -> [String; 7] {
        let limit = match self.limit {
            Limit::AtMost(most) => format!("<= {}", number(most)),
            Limit::Within(least, most) => format!("{} .. {}", number(least), number(most)),
            Limit::Same => "same bits".into(),
            Limit::Reported => "reported".into(),
        };
        let (figure, remark) = match found {
            Found::Figure(value, remark) => (number(*value), remark.clone()),
            Found::Warned(0, reason) => ("warned".into(), reason.clone()),
            Found::Warned(code, reason) => (format!("exit {code}"), reason.clone()),
            Found::Broken(reason) => ("none".into(), first_line(reason)),
        };
        let remarks = [remark.as_str(), self.known.unwrap_or_default()].map(str::to_owned);
        let remark = remarks
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join("; ");
        let refusal = if self.may_refuse { ", or a warning" } else { "" };
        let id = self.id.to_owned();
        let what = self.what.to_owned();
        let verdict = verdict.word().to_owned();
        [
            id,
            what,
            figure,
            limit + refusal,
            verdict,
            format!("{seconds:.1}"),
            remark,
        ]
    }

    fn passes(&self, found: &Found) -> bool {
        match found {
            Found::Figure(value, _) if !value.is_finite() => false,
            Found::Figure(value, _) => match self.limit {
                Limit::AtMost(most) => *value <= most,
                Limit::Within(least, most) => (least..=most).contains(value),
                Limit::Same => *value == 0.0,
                Limit::Reported => true,
            },
            Found::Warned(81, reason) => self.may_leave && !reason.is_empty(),
            Found::Warned(code, reason) => self.may_refuse && [0, 65, 80, 82].contains(code) && !reason.is_empty(),
            Found::Broken(_) => false,
        }
    }
}
