//! A row of the extremes: what it measures, what it may give, and how it is printed.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// When a row is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Depth {
    /// always
    Short,
    /// in the full run only: it takes its time
    Full,
}

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
    /// no number, but a reason: exit code 65 or 80 of the program, or 0 with a warning
    Told(i32, String),
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
    Row { id, what, limit, depth: Depth::Short, may_refuse: false, known: None, measure }
}

impl Row {
    /// In the full run only.
    pub fn full(self) -> Self {
        Self { depth: Depth::Full, ..self }
    }

    /// A clean refusal passes as well.
    pub fn or_refused(self) -> Self {
        Self { may_refuse: true, ..self }
    }

    /// It fails at present, and why.
    pub fn fails(self, why: &'static str) -> Self {
        Self { known: Some(why), ..self }
    }

    /// Measures and judges.
    pub fn judge(&self) -> Judged<'_> {
        let started = Instant::now();
        let found = catch_unwind(AssertUnwindSafe(|| (self.measure)())).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            Found::Broken(text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.into())).unwrap_or_default())
        });
        let verdict = match (self.passes(&found), self.known) {
            (true, None) => Verdict::Passed,
            (true, Some(_)) => Verdict::Mended,
            (false, None) => Verdict::Failing,
            // What is known is a wrong number or a refusal, not a crash.
            (false, Some(_)) if matches!(found, Found::Broken(_)) => Verdict::Failing,
            (false, Some(_)) => Verdict::Known,
        };
        Judged { row: self, found, verdict, seconds: started.elapsed().as_secs_f64() }
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
            Found::Told(code, reason) => self.may_refuse && [0, 65, 80].contains(code) && !reason.is_empty(),
            Found::Broken(_) => false,
        }
    }
}

/// How a row stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Passed,
    Failing,
    /// fails as declared
    Known,
    /// passes although it is declared as failing: the declaration is to be mended
    Mended,
}

impl Verdict {
    /// Whether it fails the run.
    pub fn is_failure(self) -> bool {
        matches!(self, Self::Failing | Self::Mended)
    }

    /// Whether it fails as declared.
    pub fn is_known(self) -> bool {
        self == Self::Known
    }

    fn word(self) -> &'static str {
        match self {
            Self::Passed => "pass",
            Self::Failing => "FAILING",
            Self::Known => "FAILING, known",
            Self::Mended => "passes, declared as failing",
        }
    }
}

/// A row with what came of it.
pub struct Judged<'a> {
    row: &'a Row,
    found: Found,
    pub verdict: Verdict,
    seconds: f64,
}

impl Judged<'_> {
    /// id, what, figure, bound, verdict, seconds, remark
    fn cells(&self) -> [String; 7] {
        let limit = match self.row.limit {
            Limit::AtMost(most) => format!("<= {}", number(most)),
            Limit::Within(least, most) => format!("{} .. {}", number(least), number(most)),
            Limit::Same => "same bits".into(),
            Limit::Reported => "reported".into(),
        };
        let (figure, mut remark) = match &self.found {
            Found::Figure(value, remark) => (number(*value), remark.clone()),
            Found::Told(0, reason) => ("warned".into(), reason.clone()),
            Found::Told(code, reason) => (format!("exit {code}"), reason.clone()),
            Found::Broken(reason) => {
                ("none".into(), reason.lines().next().unwrap_or_default().chars().take(160).collect())
            }
        };
        if let Some(why) = self.row.known {
            remark =
                [remark, why.into()].iter().filter(|part| !part.is_empty()).cloned().collect::<Vec<_>>().join("; ");
        }
        let refusal = if self.row.may_refuse { ", or told" } else { "" };
        let (id, what, verdict) = (self.row.id.to_owned(), self.row.what.to_owned(), self.verdict.word().to_owned());
        [id, what, figure, limit + refusal, verdict, format!("{:.1}", self.seconds), remark]
    }

    /// For the screen.
    pub fn line(&self) -> String {
        aligned(&self.cells())
    }
}

fn aligned([id, what, figure, limit, verdict, seconds, remark]: &[String; 7]) -> String {
    let line = format!("{id:<3}  {what:<82}  {figure:>10}  {limit:<20}  {verdict:<14}  {seconds:>6}  {remark}");
    line.trim_end().to_owned()
}

const HEADINGS: [&str; 7] = ["row", "what", "figure", "bound", "verdict", "s", "remark"];

/// The first line of the table on the screen.
pub fn heading() -> String {
    aligned(&HEADINGS.map(str::to_owned))
}

/// All rows, for a document.
pub fn markdown(rows: &[Judged<'_>]) -> String {
    let line = |cells: [String; 7]| format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
    let rows: String = rows.iter().map(|row| line(row.cells())).collect();
    format!("{}|{}\n{rows}", line(HEADINGS.map(str::to_owned)), " --- |".repeat(HEADINGS.len()))
}

/// Three digits, without an exponent where that is readable.
fn number(value: f64) -> String {
    if value != 0.0 && !(1e-2..1e5).contains(&value.abs()) {
        return format!("{value:.1e}");
    }
    let digits = (3 - value.abs().max(1.0).log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
