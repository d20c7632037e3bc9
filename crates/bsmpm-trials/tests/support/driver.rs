//! Selects, runs and prints the rows of a table.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

/// When a row is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Depth {
    /// always
    Short,
    /// in the full run only: it takes its time
    Full,
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
    /// Of a row that passes or not, and is declared as failing or not. What is `known` is no crash.
    pub fn of(passes: bool, declared: bool, crashed: bool) -> Self {
        match (passes, declared) {
            (true, false) => Self::Passed,
            (true, true) => Self::Mended,
            (false, true) if !crashed => Self::Known,
            (false, _) => Self::Failing,
        }
    }

    /// Whether it fails the run.
    fn is_failure(self) -> bool {
        matches!(self, Self::Failing | Self::Mended)
    }

    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "pass",
            Self::Failing => "FAILING",
            Self::Known => "FAILING, known",
            Self::Mended => "passes, declared as failing",
        }
    }
}

/// A row with what came of it.
pub struct Judged {
    pub cells: Vec<String>,
    pub verdict: Verdict,
}

/// What a driver is asked for on its command line.
pub struct Request {
    pub depth: Depth,
    /// rows whose number or text has this
    part: String,
    output: Option<String>,
}

impl Request {
    /// None without `--short` or `--full`, as `cargo test` calls it.
    pub fn read() -> Option<Self> {
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        let after = |name: &str| {
            arguments
                .iter()
                .skip_while(|argument| *argument != name)
                .nth(1)
                .cloned()
        };
        let depths = [("--short", Depth::Short), ("--full", Depth::Full)];
        let (_, depth) = depths
            .into_iter()
            .find(|(name, _)| arguments.iter().any(|argument| argument == name))?;
        Some(Self {
            depth,
            part: after("--only").unwrap_or_default(),
            output: after("--output"),
        })
    }

    /// Whether a row is wanted.
    pub fn wants(&self, depth: Depth, id: &str, what: &str) -> bool {
        depth <= self.depth && (id.contains(&self.part) || what.contains(&self.part))
    }

    /// Measures rows and prints each as soon as it is there. The last line is "N passed, M failed".
    pub fn run<R>(&self, columns: &[Column], rows: impl Iterator<Item = R>, judge: impl Fn(R) -> Judged) -> ExitCode {
        let started = Instant::now();
        // What a measurement has to say goes into its row.
        std::panic::set_hook(Box::new(|_| ()));
        let mut judged: Vec<Judged> = Vec::new();
        println!("{}", line(columns, columns.iter().map(|column| column.heading)));
        for row in rows {
            judged.push(judge(row));
            println!(
                "{}",
                line(columns, judged[judged.len() - 1].cells.iter().map(String::as_str))
            );
            if let Some(path) = &self.output {
                std::fs::write(path, markdown(columns, &judged)).expect("the table can be written");
            }
        }
        let known = judged.iter().filter(|row| row.verdict == Verdict::Known).count();
        let failed = judged.iter().filter(|row| row.verdict.is_failure()).count();
        println!(
            "\n{} rows, {known} of them failing as declared, {:.0} s",
            judged.len(),
            started.elapsed().as_secs_f64()
        );
        println!("{} passed, {failed} failed", judged.len() - known - failed);
        ExitCode::from(u8::from(failed > 0 || judged.is_empty()))
    }
}

/// Says how many rows are declared, and fails where one of the numbers that there must be has none.
pub fn look_through(script: &str, numbers: impl Iterator<Item = String>, ids: &[&str]) -> ExitCode {
    let missing: Vec<String> = numbers.filter(|number| !ids.contains(&number.as_str())).collect();
    missing.iter().for_each(|id| println!("no row for {id}"));
    println!("{} rows are declared; {script} measures them", ids.len());
    println!("{} passed, {} failed", usize::from(missing.is_empty()), missing.len());
    ExitCode::from(u8::from(!missing.is_empty()))
}

/// A measurement, or what it panicked with.
pub fn caught<T>(measure: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(measure)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.into()))
            .unwrap_or_default()
    })
}

/// The first line of what something panicked with, and not too much of it.
pub fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().chars().take(160).collect()
}

/// A column of the table: its heading, and how wide it is on the screen.
pub struct Column {
    pub heading: &'static str,
    pub width: usize,
    /// numbers are
    pub is_right: bool,
}

/// A column of words.
pub const fn words(heading: &'static str, width: usize) -> Column {
    Column {
        heading,
        width,
        is_right: false,
    }
}

/// A column of numbers.
pub const fn numbers(heading: &'static str, width: usize) -> Column {
    Column {
        heading,
        width,
        is_right: true,
    }
}

fn line<'a>(columns: &[Column], cells: impl Iterator<Item = &'a str>) -> String {
    let aligned = columns
        .iter()
        .zip(cells)
        .map(|(&Column { width, is_right, .. }, cell)| {
            if is_right {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        });
    aligned.collect::<Vec<_>>().join("  ").trim_end().to_owned()
}

/// All rows, for a document.
fn markdown(columns: &[Column], rows: &[Judged]) -> String {
    let line = |cells: Vec<String>| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rows: String = rows.iter().map(|row| line(row.cells.clone())).collect();
    let headings = line(columns.iter().map(|column| column.heading.to_owned()).collect());
    format!("{headings}|{}\n{rows}", " --- |".repeat(columns.len()))
}

/// Three digits, without an exponent where that is readable.
pub fn number(value: f64) -> String {
    if value != 0.0 && !(1e-2..1e5).contains(&value.abs()) {
        return format!("{value:.1e}");
    }
    let digits = (3 - value.abs().max(1.0).log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
