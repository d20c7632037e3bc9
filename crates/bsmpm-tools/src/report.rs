//! Tables for the screen, as Markdown and as CSV.

use std::io::Write;
use std::path::{Path, PathBuf};

use bsmpm_io::atomic;
use serde::Serialize;

use crate::Error;

/// At which side of its column a text stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Align {
    Left,
    Right,
}

/// Which cells of CSV are quoted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quoted {
    All,
    /// Those with a comma, a quote or a line break (RFC 4180).
    Needed,
}

/// A row for each of several things, and columns with their headings.
pub(crate) struct ReportTable<'a, T> {
    rows: &'a [T],
    columns: Vec<ReportColumn>,
}

struct ReportColumn {
    heading: String,
    align: Align,
    /// Of each row.
    cells: Vec<String>,
}

impl<'a, T> ReportTable<'a, T> {
    pub fn of(rows: &'a [T]) -> Self {
        Self {
            rows,
            columns: Vec::new(),
        }
    }

    /// A column of texts at its left side.
    pub fn column<C: ToString>(&mut self, heading: impl Into<String>, cell: impl Fn(&'a T) -> C) -> &mut Self {
        self.add(heading.into(), Align::Left, |row| cell(row).to_string())
    }

    /// A column of texts at its right side.
    pub fn right<C: ToString>(&mut self, heading: impl Into<String>, cell: impl Fn(&'a T) -> C) -> &mut Self {
        self.add(heading.into(), Align::Right, |row| cell(row).to_string())
    }

    fn add(&mut self, heading: String, align: Align, cell: impl Fn(&'a T) -> String) -> &mut Self {
        let cells = self.rows.iter().map(cell).collect();
        self.columns.push(ReportColumn { heading, align, cells });
        self
    }

    /// Leaves the columns of other headings out.
    pub fn only(&mut self, headings: &[&str]) -> &mut Self {
        self.columns.retain(|column| headings.contains(&&*column.heading));
        self
    }

    /// The headings, then the cells of every row.
    fn lines(&self) -> impl Iterator<Item = Vec<&String>> {
        let headings = self.columns.iter().map(|column| &column.heading).collect();
        let rows = (0..self.rows.len()).map(|row| self.columns.iter().map(|column| &column.cells[row]).collect());
        std::iter::once(headings).chain(rows)
    }

    /// Columns as wide as they must be, two spaces apart, all behind an indent.
    pub fn text(&self, indent: &str) -> String {
        let mut text = String::new();
        for line in self.lines() {
            let cells = self.columns.iter().zip(line);
            let cells: Vec<String> = cells.map(|(column, cell)| column.aligned(cell)).collect();
            text += format!("{indent}{}", cells.join("  ")).trim_end();
            text.push('\n');
        }
        text
    }

    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for (number, line) in self.lines().enumerate() {
            let cells: Vec<String> = line.iter().map(|cell| cell.replace('|', "\\|")).collect();
            text += &format!("| {} |\n", cells.join(" | "));
            if number == 0 {
                text += &format!("|{}\n", " --- |".repeat(self.columns.len()));
            }
        }
        text
    }

    /// Comma-separated values. The headings are quoted where they must be only.
    pub fn csv(&self, quoted: Quoted) -> String {
        let mut text = String::new();
        for (number, line) in self.lines().enumerate() {
            let quoted = if number == 0 { Quoted::Needed } else { quoted };
            let cells: Vec<String> = line.into_iter().map(|cell| quoted.cell(cell)).collect();
            text += &cells.join(",");
            text.push('\n');
        }
        text
    }
}

impl ReportColumn {
    /// A cell, filled with spaces to the width of the column.
    fn aligned(&self, cell: &str) -> String {
        let cells = self.cells.iter().chain([&self.heading]);
        let width = cells.map(|cell| cell.chars().count()).max().unwrap_or(0);
        match self.align {
            Align::Left => format!("{cell:<width$}"),
            Align::Right => format!("{cell:>width$}"),
        }
    }
}

impl Quoted {
    /// A cell of comma-separated values.
    fn cell(self, cell: &str) -> String {
        match self == Self::All || cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.to_owned(),
        }
    }
}

/// What there is, or nothing.
pub(crate) fn some<C: ToString>(value: Option<C>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// What there is, or a dash.
pub(crate) fn or_dash<C: ToString>(value: Option<C>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}

/// Five digits, without an exponent where that is readable.
pub(crate) fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-3..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// The word that stands for a variant in JSON.
pub(crate) fn word(variant: impl Serialize) -> String {
    let word = serde_json::to_value(variant).ok();
    word.and_then(|word| word.as_str().map(str::to_owned))
        .unwrap_or_default()
}

/// bytes  in MiB
pub(crate) fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// Writes `NAME.csv` and `NAME.json` into a directory; their paths.
pub(crate) fn save(directory: &Path, name: &str, csv: &str, report: &impl Serialize) -> Result<Vec<PathBuf>, Error> {
    let [table, all] = ["csv", "json"].map(|ending| directory.join(format!("{name}.{ending}")));
    atomic::replace(&table, |file| file.write_all(csv.as_bytes()))?;
    atomic::replace(&all, |file| {
        serde_json::to_writer_pretty(&mut *file, report)?;
        file.write_all(b"\n")
    })?;
    Ok(vec![table, all])
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [(&str, &str); 2] = [("[1, 2]", "3"), ("\"q\" | r", "")];

    fn table() -> ReportTable<'static, (&'static str, &'static str)> {
        let mut table = ReportTable::of(&ROWS);
        table
            .column("a", |row| row.0)
            .right("value", |row| row.1)
            .column("twice", |row| row.1.repeat(2));
        table
    }

    #[test]
    fn columns_are_as_wide_as_they_must_be() {
        assert_eq!(
            table().text(" "),
            " a        value  twice\n [1, 2]       3  33\n \"q\" | r\n"
        );
        assert_eq!(
            table().only(&["twice", "value"]).text(""),
            "value  twice\n    3  33\n\n"
        );
    }

    #[test]
    fn what_would_end_a_cell_is_quoted() {
        assert_eq!(
            table().only(&["a", "value"]).csv(Quoted::Needed),
            "a,value\n\"[1, 2]\",3\n\"\"\"q\"\" | r\",\n"
        );
        assert_eq!(table().only(&["value"]).csv(Quoted::All), "value\n\"3\"\n\"\"\n");
        assert_eq!(
            table().only(&["a"]).markdown(),
            "| a |\n| --- |\n| [1, 2] |\n| \"q\" \\| r |\n"
        );
    }

    #[test]
    fn a_variant_has_the_word_of_json() {
        assert_eq!(
            word(crate::grid_convergence::ConvergenceType::OscillatoryDiverging),
            "oscillatory-diverging"
        );
    }
}
