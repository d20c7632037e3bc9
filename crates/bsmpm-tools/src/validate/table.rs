//! The table: for the screen study by study, as Markdown and as CSV whole.

use crate::launch::RunCost;
use crate::report::{Quoted, ReportTable, number, some};

/// How a row stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowVerdict {
    Passed,
    Failed,
    /// failed because a run did not come so far
    Missed,
    /// failed, as the matrix says
    Known,
    /// passed, though the matrix says that it fails
    Mended,
    /// not judged
    Warned,
    /// not judged, and without a number because a run did not come so far
    NotReached,
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TableRow {
    pub study: String,
    pub quantity: String,
    pub reference: Option<f64>,
    pub source: String,
    pub ours: Option<f64>,
    pub wanted: String,
    pub verdict: RowVerdict,
    pub remark: String,
    /// exit codes of its runs, once if they are all the same
    pub codes: String,
    pub cost: RunCost,
}

impl RowVerdict {
    /// Whether it fails the validation.
    pub fn is_failure(self) -> bool {
        matches!(self, Self::Failed | Self::Missed | Self::Mended)
    }

    fn word(self) -> &'static str {
        match self {
            Self::Passed => "pass",
            Self::Failed => "FAIL",
            Self::Missed => "FAIL, not reached",
            Self::Known => "FAIL, known",
            Self::Mended => "FAIL, holds now",
            Self::Warned => "-",
            Self::NotReached => "not reached",
        }
    }
}

impl TableRow {
    fn deviation(&self) -> String {
        let both = self.ours.zip(self.reference).filter(|(_, reference)| *reference != 0.0);
        some(both.map(|(ours, reference)| format!("{:+.2} %", 100.0 * (ours / reference - 1.0))))
    }
}

fn add_columns(table: &mut ReportTable<TableRow>) {
    table
        .column("quantity", |row| &row.quantity)
        .right("reference", |row| some(row.reference.map(number)))
        .right("source", |row| &row.source)
        .right("ours", |row| row.ours.map_or_else(|| "none".to_owned(), number))
        .right("deviation", TableRow::deviation)
        .right("allowed", |row| &row.wanted)
        .right("verdict", |row| row.verdict.word())
        .right("exit", |row| &row.codes)
        .right("steps", |row| row.cost.steps)
        .right("cuts", |row| row.cost.cuts)
        .right("iterations", |row| row.cost.iterations)
        .right("s", |row| format!("{:.1}", row.cost.wall_seconds))
        .column("remark", |row| &row.remark);
}

/// A study for the screen, in columns; sources and counts are in the files.
pub(super) fn text(title: &str, rows: &[TableRow]) -> String {
    let mut table = ReportTable::of(rows);
    add_columns(&mut table);
    table.only(&["quantity", "reference", "ours", "deviation", "allowed", "verdict", "s", "remark"]);
    format!("\n{title}\n{}", table.text("  ")).trim_end().to_owned()
}

/// All rows, a table a study.
pub(super) fn markdown(rows: &[TableRow]) -> String {
    let of_study = |part: &[TableRow]| {
        let mut table = ReportTable::of(part);
        add_columns(&mut table);
        format!("\n## {}\n\n{}", part[0].study, table.markdown())
    };
    "# Validation\n".to_owned() + &rows.chunk_by(|a, b| a.study == b.study).map(of_study).collect::<String>()
}

/// All rows for programs.
pub(super) fn csv(rows: &[TableRow]) -> String {
    let mut table = ReportTable::of(rows);
    add_columns(table.column("study", |row| &row.study));
    table.csv(Quoted::All)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_columns_with_their_verdict() {
        let row = |quantity: &str, ours, verdict| TableRow {
            study: "A study".into(),
            quantity: quantity.into(),
            reference: Some(5.141593),
            source: "Prandtl".into(),
            ours,
            wanted: "5 %".into(),
            verdict,
            remark: "coarse".into(),
            codes: "0".into(),
            cost: RunCost { steps: 20, ..RunCost::default() },
        };
        let rows = [row("p/c", Some(5.2), RowVerdict::Passed), row("longer", None, RowVerdict::Failed)];
        let text = text("A study", &rows);
        let words: Vec<&str> = text.lines().nth(3).unwrap().split_whitespace().collect();
        assert_eq!(words, ["p/c", "5.1416", "5.2", "+1.14", "%", "5", "%", "pass", "0.0", "coarse"], "{text}");
        assert!(text.contains("none") && text.contains("FAIL"));
        assert_eq!(markdown(&rows).lines().filter(|line| line.starts_with('|')).count(), 4);
        assert_eq!(csv(&rows).lines().count(), 3);
    }
}
