//! Writes the validation table to the screen, as Markdown (one section per theme), and as CSV.

use crate::launch::RunCost;
use crate::report::{Quoted, ReportTable, number, or_dash, some};

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

/// What the difference between the value and the published one is relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DifferenceScale {
    /// The published value.
    Published,
    /// Nothing: the tolerance has the unit of the quantity.
    None,
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TableRow {
    pub theme: String,
    pub study: String,
    pub quantity: String,
    /// path of the case file from the directory of the table
    pub case: String,
    pub published: Option<f64>,
    pub source: String,
    pub value: Option<f64>,
    pub scale: DifferenceScale,
    pub tolerance: String,
    pub verdict: RowVerdict,
    /// why it is known to fail
    pub reason: Option<String>,
    pub remark: String,
    /// exit codes of its runs, once if they are all the same
    pub codes: String,
    /// of the run, of several runs of the last one
    pub cells: Option<u64>,
    /// of the run, of several runs of the last one
    pub cost: RunCost,
}

/// A figure that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TableFigure {
    pub theme: String,
    pub caption: String,
    pub file: String,
}

impl RowVerdict {
    /// Whether it fails the validation.
    pub fn is_failure(self) -> bool {
        matches!(self, Self::Failed | Self::Missed | Self::Mended)
    }

    fn is_judged(self) -> bool {
        !matches!(self, Self::Warned | Self::NotReached)
    }

    fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Missed => "FAILED, not reached",
            Self::Known => "known failure",
            Self::Mended => "FAILED, passes now",
            Self::Warned => "not judged",
            Self::NotReached => "not reached",
        }
    }
}

impl TableRow {
    fn difference(&self) -> Option<String> {
        let (value, published) = self.value.zip(self.published)?;
        match self.scale {
            DifferenceScale::Published if published != 0.0 => {
                Some(format!("{:+.2} %", 100.0 * (value / published - 1.0)))
            }
            DifferenceScale::Published | DifferenceScale::None => Some(number(value - published)),
        }
    }

    /// The verdict, and the reason of a failure.
    fn judgement(&self) -> String {
        match (self.verdict, &self.reason) {
            (RowVerdict::Known, Some(reason)) => format!("known failure: {reason}"),
            (verdict, _) if verdict.is_failure() && self.remark.is_empty() => format!("**{}**", verdict.word()),
            (verdict, _) if verdict.is_failure() => format!("**{}**: {}", verdict.word(), self.remark),
            (verdict, _) => verdict.word().to_owned(),
        }
    }
}

fn add_columns(table: &mut ReportTable<TableRow>) {
    table
        .column("quantity", |row| &row.quantity)
        .right("source", |row| &row.source)
        .right("published", |row| some(row.published.map(number)))
        .right("bsmpm", |row| row.value.map_or_else(|| "none".to_owned(), number))
        .right("difference", |row| some(row.difference()))
        .right("tolerance", |row| &row.tolerance)
        .right("verdict", |row| row.verdict.word())
        .right("exit", |row| &row.codes)
        .right("cells", |row| some(row.cells))
        .right("steps", |row| row.cost.steps)
        .right("cutbacks", |row| row.cost.cuts)
        .right("iterations", |row| row.cost.iterations)
        .right("seconds", |row| format!("{:.1}", row.cost.wall_seconds))
        .column("remark", |row| &row.remark);
}

/// A study for the screen, in columns; sources and counts are in the files.
pub(super) fn text(title: &str, rows: &[TableRow]) -> String {
    let mut table = ReportTable::of(rows);
    add_columns(&mut table);
    table.only(&[
        "quantity",
        "published",
        "bsmpm",
        "difference",
        "tolerance",
        "verdict",
        "seconds",
        "remark",
    ]);
    format!("\n{title}\n{}", table.text("  ")).trim_end().to_owned()
}

/// The judged rows, a table a theme with its figures, below their counts; then those that have a published value and
/// are not judged. Rows without both are in the CSV.
pub(super) fn markdown(rows: &[TableRow], figures: &[TableFigure]) -> String {
    let (judged, others): (Vec<&TableRow>, Vec<&TableRow>) = rows.iter().partition(|row| row.verdict.is_judged());
    let others: Vec<&TableRow> = others.into_iter().filter(|row| row.published.is_some()).collect();
    let mut text = format!("# Validation\n\n{}", counts(&judged));
    for theme in themes(rows.iter()) {
        let part: Vec<&TableRow> = judged.iter().copied().filter(|row| row.theme == theme).collect();
        if !part.is_empty() {
            text += &format!("\n## {theme}\n\n{}", columns(&part).markdown());
        }
        for TableFigure { caption, file, .. } in figures.iter().filter(|figure| figure.theme == theme) {
            text += &format!("\n![{caption}]({file})\n");
        }
    }
    if !others.is_empty() {
        text += &format!("\n## Compared, not judged\n\n{}", columns(&others).markdown());
    }
    text
}

/// The themes in the order of their first rows.
fn themes<'a>(rows: impl Iterator<Item = &'a TableRow>) -> Vec<&'a str> {
    let mut themes: Vec<&str> = Vec::new();
    for row in rows {
        if !themes.contains(&row.theme.as_str()) {
            themes.push(&row.theme);
        }
    }
    themes
}

/// How many rows of each theme passed, fail as known, and failed.
fn counts(judged: &[&TableRow]) -> String {
    let mut parts: Vec<(&str, Vec<&TableRow>)> = Vec::new();
    for theme in themes(judged.iter().copied()) {
        let rows = judged.iter().copied().filter(|row| row.theme == theme);
        parts.push((theme, rows.collect()));
    }
    parts.push(("all", judged.to_vec()));
    let mut table = ReportTable::of(&parts);
    table
        .column("theme", |(theme, _)| *theme)
        .column("problems", |(_, rows)| rows.chunk_by(|a, b| a.study == b.study).count())
        .column("quantities", |(_, rows)| rows.len())
        .column("passed", |(_, rows)| {
            count(rows, |verdict| verdict == RowVerdict::Passed)
        })
        .column("known failures", |(_, rows)| {
            count(rows, |verdict| verdict == RowVerdict::Known)
        })
        .column("failed", |(_, rows)| count(rows, RowVerdict::is_failure));
    table.markdown()
}

/// Returns the number of rows with such a verdict.
fn count(rows: &[&TableRow], is: fn(RowVerdict) -> bool) -> usize {
    rows.iter().filter(|row| is(row.verdict)).count()
}

/// The table of a document.
fn columns<'a>(rows: &'a [&TableRow]) -> ReportTable<'a, &'a TableRow> {
    let mut table = ReportTable::of(rows);
    table
        .column("problem", |row| format!("{}: {}", row.study, row.quantity))
        .column("case file", |row| {
            let file = row.case.rsplit('/').next().unwrap_or(&row.case);
            format!("[`{file}`]({})", row.case)
        })
        .column("source", |row| &row.source)
        .column("published value", |row| or_dash(row.published.map(number)))
        .column("value of bsmpm", |row| or_dash(row.value.map(number)))
        .column("difference", |row| or_dash(row.difference()))
        .column("tolerance", |row| {
            or_dash(Some(&row.tolerance).filter(|text| !text.is_empty()))
        })
        .column("verdict", |row| row.judgement())
        .column("cells", |row| or_dash(row.cells))
        .column("seconds", |row| format!("{:.1}", row.cost.wall_seconds));
    table
}

/// All rows for programs.
pub(super) fn csv(rows: &[TableRow]) -> String {
    let mut table = ReportTable::of(rows);
    add_columns(
        table
            .column("theme", |row| &row.theme)
            .column("problem", |row| &row.study)
            .column("case", |row| &row.case),
    );
    table.csv(Quoted::All)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(quantity: &str, value: Option<f64>, verdict: RowVerdict) -> TableRow {
        TableRow {
            theme: "Limit loads".into(),
            study: "A study".into(),
            quantity: quantity.into(),
            case: "../cases/footing.toml".into(),
            published: Some(5.141593),
            source: "Prandtl".into(),
            value,
            scale: DifferenceScale::Published,
            tolerance: "5 %".into(),
            verdict,
            reason: Some("the grid is coarse".into()),
            remark: "coarse".into(),
            codes: "0".into(),
            cells: Some(64),
            cost: RunCost {
                steps: 20,
                ..RunCost::default()
            },
        }
    }

    #[test]
    fn rows_stand_in_columns_with_their_verdict() {
        let rows = [
            row("p/c", Some(5.2), RowVerdict::Passed),
            row("longer", None, RowVerdict::Failed),
        ];
        let text = text("A study", &rows);
        let words: Vec<&str> = text.lines().nth(3).unwrap().split_whitespace().collect();
        assert_eq!(
            words,
            [
                "p/c", "5.1416", "5.2", "+1.14", "%", "5", "%", "passed", "0.0", "coarse"
            ],
            "{text}"
        );
        assert!(text.contains("none") && text.contains("FAILED"));
        assert_eq!(csv(&rows).lines().count(), 3);
    }

    #[test]
    fn a_document_has_counts_a_table_for_each_theme_and_what_is_not_judged() {
        let settlement = TableRow {
            theme: "Water".into(),
            ..row("u", Some(5.0), RowVerdict::Known)
        };
        let unknown = TableRow {
            published: None,
            ..row("for the reader", Some(1.0), RowVerdict::Warned)
        };
        let rows = [
            row("p/c", Some(5.2), RowVerdict::Passed),
            settlement,
            row("finer", Some(5.15), RowVerdict::Passed),
            row("coarser", Some(9.0), RowVerdict::Warned),
            unknown,
        ];
        let figure = TableFigure {
            theme: "Water".into(),
            caption: "u".into(),
            file: "u.png".into(),
        };
        let text = markdown(&rows, &[figure]);
        let passed = "| A study: p/c | [`footing.toml`](../cases/footing.toml) | Prandtl | 5.1416 | 5.2 | +1.14 % | 5 % \
                      | passed | 64 | 0.0 |";
        assert!(
            text.contains("| all | 1 | 3 | 2 | 1 | 0 |") && text.contains(passed),
            "{text}"
        );
        assert!(
            text.contains("| known failure: the grid is coarse |") && text.contains("\n![u](u.png)\n"),
            "{text}"
        );
        let place = |part: &str| text.find(part).unwrap_or_else(|| panic!("no {part} in {text}"));
        assert!(
            place("## Limit loads") < place("finer") && place("finer") < place("## Water"),
            "{text}"
        );
        let failed = TableRow {
            remark: "exit code 80".into(),
            ..row("p/c", None, RowVerdict::Failed)
        };
        assert!(markdown(&[failed], &[]).contains("| **FAILED**: exit code 80 |"));
        assert!(
            place("## Water") < place("## Compared, not judged") && !text.contains("for the reader"),
            "{text}"
        );
    }

    #[test]
    fn a_difference_is_relative_to_the_published_value_unless_the_tolerance_has_a_unit() {
        let row = row("p", Some(5.2), RowVerdict::Passed);
        assert_eq!(row.difference().as_deref(), Some("+1.14 %"));
        let absolute = TableRow {
            published: Some(5.0),
            scale: DifferenceScale::None,
            ..row.clone()
        };
        assert_eq!(absolute.difference().as_deref(), Some("0.2"));
        assert_eq!(
            TableRow {
                published: Some(0.0),
                ..row.clone()
            }
            .difference()
            .as_deref(),
            Some("5.2")
        );
        assert_eq!(TableRow { published: None, ..row }.difference(), None);
    }
}
