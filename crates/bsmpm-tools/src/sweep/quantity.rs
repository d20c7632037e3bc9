//! Quantities of a run, and their relative error.

use bsmpm_io::table::Columns;
use bsmpm_scene::History;

use crate::plot;

/// The column that a search of the factor of safety leaves.
pub(super) const FACTOR: &str = "factor-of-safety";
/// The share of a time by which a row may lie before it: that of rounding.
const NEAR: f64 = 1e-9;

/// One number of a run, or several that count together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SweepQuantity {
    /// As it was asked for.
    pub name: String,
    pub parts: Vec<QuantityPart>,
}

/// A column at a time; at the end without one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct QuantityPart {
    pub column: String,
    /// s or pseudo-time
    pub at: Option<f64>,
}

impl SweepQuantity {
    /// `NAME[@TIME],...`; a name without a time takes that of the next one that has it.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::read(text).map_err(|why| {
            format!(
                "E0835: --quantity {text} is invalid: {why}. Give NAME or NAME@TIME, or several separated by commas."
            )
        })
    }

    /// As [`SweepQuantity::parse`]; the error says in a few words what is wrong.
    fn read(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        for part in text.split(',').rev() {
            let (column, at) = match part.split_once('@') {
                Some((column, time)) => (column.trim(), Some(plot::time(time)?)),
                None => (part.trim(), parts.last().and_then(|next: &QuantityPart| next.at)),
            };
            if column.is_empty() {
                return Err("a name is empty".to_owned());
            }
            parts.push(QuantityPart {
                column: column.to_owned(),
                at,
            });
        }
        parts.reverse();
        let name = text.chars().filter(|c| !c.is_whitespace()).collect();
        Ok(Self { name, parts })
    }

    /// Whether it is the factor of safety.
    pub fn is_factor(&self) -> bool {
        self.parts.iter().any(|part| part.column == FACTOR)
    }

    /// The quantity in words, with its columns and times: `footing pressure (p_over_c) at t = 0.25 and 1`.
    pub fn subject(&self, histories: &[History]) -> String {
        let columns = distinct(self.parts.iter().map(|part| part.column.clone()).collect());
        let words = distinct(columns.iter().map(|column| in_words(column, histories)).collect());
        let times = self.parts.iter().filter_map(|part| part.at).map(|at| at.to_string());
        let times = distinct(times.collect());
        let mut subject = words.join(", ");
        if columns.join(", ").replace('-', " ") != subject {
            subject += &format!(" ({})", columns.join(", "));
        }
        if !times.is_empty() {
            subject += &format!(" at t = {}", times.join(" and "));
        }
        subject
    }

    /// Its numbers in a history.
    pub fn values(&self, history: &Columns) -> Result<Vec<f64>, String> {
        self.parts.iter().map(|part| part.value(history)).collect()
    }

    /// How far numbers are from a reference: sqrt(mean(((v - r)/r)²)); none where a reference is zero.
    pub fn error(&self, values: &[f64], reference: &[f64]) -> Option<f64> {
        let squares = values
            .iter()
            .zip(reference)
            .map(|(value, reference)| ((value - reference) / reference).powi(2));
        let mean = squares.sum::<f64>() / self.parts.len() as f64;
        Some(mean.sqrt()).filter(|error| error.is_finite())
    }
}

impl QuantityPart {
    /// Its number in a history: linear between rows.
    pub fn value(&self, history: &Columns) -> Result<f64, String> {
        let times = column(history, "time")?;
        let values = column(history, &self.column)?;
        let Some((&end, &last)) = times.last().zip(values.last()) else {
            return Err("its history has no row".to_owned());
        };
        let Some(at) = self.at else { return Ok(last) };
        if at > end && at <= end + NEAR * end.abs() {
            return Ok(last);
        }
        let after = times.iter().position(|&time| time >= at);
        match after {
            None => Err(format!("its history ends at {end}, before {at}")),
            Some(row) if times[row] == at => Ok(values[row]),
            Some(0) => Err(format!("its history begins at {}, after {at}", times[0])),
            Some(row) => {
                let share = (at - times[row - 1]) / (times[row] - times[row - 1]);
                Ok(values[row - 1] + share * (values[row] - values[row - 1]))
            }
        }
    }

    /// The column and the time.
    pub fn words(&self) -> String {
        self.at
            .map_or_else(|| self.column.clone(), |at| format!("{}@{at}", self.column))
    }
}

/// The texts without those that equal the text before.
fn distinct(mut texts: Vec<String>) -> Vec<String> {
    texts.dedup();
    texts
}

/// What the history of a column records, in words; the name of a column that no history has.
fn in_words(column: &str, histories: &[History]) -> String {
    let of_column = histories.iter().find(|history| {
        let suffix = column.strip_prefix(history.name.as_str());
        suffix.is_some_and(|suffix| suffix.is_empty() || suffix.starts_with('-'))
    });
    let name = of_column.map_or_else(|| column.to_owned(), |history| history.quantity.observable.to_string());
    name.replace('-', " ")
}

/// A column of a history, or that there is none.
fn column<'a>(history: &'a Columns, name: &str) -> Result<&'a [f64], String> {
    let column = history.get(name);
    column.ok_or_else(|| format!("its history has no column {name}"))
}

#[cfg(test)]
mod tests {
    use bsmpm_io::table;
    use bsmpm_scene::Case;

    use super::*;

    fn quantity(text: &str) -> SweepQuantity {
        SweepQuantity::parse(text).unwrap()
    }

    #[test]
    fn a_subject_has_the_words_of_the_field() {
        let case = "geometry = \"plane-strain\"\nanalysis = { type = \"quasi-static\", steps = 2 }\n\
             grid = { lower = [0, 0], upper = [2, 2], cell = 1 }\n\
             material.soil = { model = \"elastic\", young = 1e6, poisson = 0.3 }\n\
             body = [{ material = \"soil\", box = { lower = [0, 0], upper = [2, 1] }, points_per_cell = 3 }]\n\
             boundary.bottom = \"fixed\"\n\
             history = [{ quantity = \"max-displacement\", name = \"crest\" }, { quantity = \"height\" }]\n";
        let case = Case::from_text("case.toml", case, &[]).unwrap();
        let subject = |text: &str| quantity(text).subject(&case.histories);
        assert_eq!(
            subject("crest@0.5,crest@1"),
            "max displacement (crest) at t = 0.5 and 1"
        );
        assert_eq!(subject("height"), "height");
        assert_eq!(subject("factor-of-safety"), "factor of safety");
    }

    #[test]
    fn names_and_times_are_read() {
        let places = |text: &str| {
            let parts = quantity(text).parts;
            parts.iter().map(QuantityPart::words).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(places("runout"), "runout");
        assert_eq!(places("runout @ 0.607 s"), "runout@0.607");
        assert_eq!(
            places("surface-200, surface-302@0.607"),
            "surface-200@0.607 surface-302@0.607"
        );
        assert_eq!(places("p@.25,p@1,q"), "p@0.25 p@1 q");
        for text in ["", "a,", "a@soon", "@1", "a@inf"] {
            assert!(SweepQuantity::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_are_interpolated_in_time_as_far_as_the_run_came() {
        let history = table::parse("step,time,a\n0,0,1\n1,0.5,3\n2,0.6,5\n").unwrap();
        let value = |text: &str| quantity(text).values(&history).map(|values| values[0]);
        assert_eq!(value("a"), Ok(5.0));
        assert_eq!(value("a@0"), Ok(1.0));
        assert_eq!(value("a@0.25"), Ok(2.0));
        assert!((value("a@0.55").unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(value("a@0.6000000000001"), Ok(5.0));
        assert!(value("a@0.7").unwrap_err().contains("ends at 0.6"));
        assert!(value("a@-1").is_err() && value("b").unwrap_err().contains("no column b"));
        let empty = table::parse("step,time,a\n").unwrap();
        assert!(quantity("a").values(&empty).is_err());
    }

    #[test]
    fn the_error_is_the_root_of_the_mean_square_of_relative_differences() {
        let both = quantity("a,b");
        let error = both.error(&[1.03, 8.4], &[1.0, 8.0]).unwrap();
        assert!((error - ((0.03_f64.powi(2) + 0.05_f64.powi(2)) / 2.0).sqrt()).abs() < 1e-12);
        assert_eq!(both.error(&[1.0, 1.0], &[1.0, 0.0]), None);
        assert!((quantity("a").error(&[-1.1], &[-1.0]).unwrap() - 0.1).abs() < 1e-12);
    }
}
