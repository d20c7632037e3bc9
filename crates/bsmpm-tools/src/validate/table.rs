//! The table: for the screen study by study, as Markdown and as CSV whole.

use super::runs::MatrixCost;
use crate::columns::number;

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
    Told,
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
    pub cost: MatrixCost,
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
            Self::Told => "-",
            Self::NotReached => "not reached",
        }
    }
}

const HEADINGS: [&str; 13] = [
    "quantity",
    "reference",
    "source",
    "ours",
    "deviation",
    "allowed",
    "verdict",
    "exit",
    "steps",
    "cuts",
    "iterations",
    "s",
    "remark",
];

impl TableRow {
    fn cells(&self) -> [String; 13] {
        let deviation = self.ours.zip(self.reference).filter(|(_, reference)| *reference != 0.0);
        [
            self.quantity.clone(),
            self.reference.map(number).unwrap_or_default(),
            self.source.clone(),
            self.ours.map_or_else(|| "none".to_owned(), number),
            deviation
                .map(|(ours, reference)| format!("{:+.2} %", 100.0 * (ours / reference - 1.0)))
                .unwrap_or_default(),
            self.wanted.clone(),
            self.verdict.word().to_owned(),
            self.codes.clone(),
            self.cost.steps.to_string(),
            self.cost.cuts.to_string(),
            self.cost.iterations.to_string(),
            format!("{:.1}", self.cost.seconds),
            self.remark.clone(),
        ]
    }
}

/// A study for the screen, in columns.
pub(super) fn text(title: &str, rows: &[TableRow]) -> String {
    let shown = [0, 1, 3, 4, 5, 6, 11]; // sources and counts are in the files
    let mut lines: Vec<Vec<String>> = vec![shown.iter().map(|&column| HEADINGS[column].to_owned()).collect()];
    lines.extend(rows.iter().map(|row| {
        let cells = row.cells();
        shown.iter().map(|&column| cells[column].clone()).collect()
    }));
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..shown.len()).map(width).collect();
    let aligned = |line: &Vec<String>| {
        let cell = |(column, text): (usize, &String)| match column {
            0 => format!("{text:<width$}", width = widths[column]),
            _ => format!("{text:>width$}", width = widths[column]),
        };
        line.iter().enumerate().map(cell).collect::<Vec<_>>().join("  ")
    };
    let mut made = format!("\n{title}\n");
    for (index, line) in lines.iter().enumerate() {
        let remark = index.checked_sub(1).map_or("remark", |row| &rows[row].remark);
        made += format!("  {}  {remark}", aligned(line)).trim_end();
        made.push('\n');
    }
    made.trim_end().to_owned()
}

/// All rows, a table a study.
pub(super) fn markdown(rows: &[TableRow]) -> String {
    let mut made = String::from("# Validation\n");
    for part in rows.chunk_by(|a, b| a.study == b.study) {
        made +=
            &format!("\n## {}\n\n| {} |\n|{}\n", part[0].study, HEADINGS.join(" | "), " --- |".repeat(HEADINGS.len()));
        for row in part {
            made += &format!("| {} |\n", row.cells().map(|cell| cell.replace('|', "\\|")).join(" | "));
        }
    }
    made
}

/// All rows for programs.
pub(super) fn csv(rows: &[TableRow]) -> String {
    let quoted = |cell: &String| format!("\"{}\"", cell.replace('"', "\"\""));
    let mut made = format!("study,{}\n", HEADINGS.join(","));
    for row in rows {
        let cells: Vec<String> = [row.study.clone()].iter().chain(&row.cells()).map(quoted).collect();
        made += &format!("{}\n", cells.join(","));
    }
    made
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
            cost: MatrixCost { steps: 20, ..MatrixCost::default() },
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
