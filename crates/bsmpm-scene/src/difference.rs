//! Compares two cases key by key, for a restart.

use crate::document;
use crate::earlier;
use crate::error::Error;
use crate::key_path::join;
use crate::preset;
use crate::record::{self, Datum, Record};
use crate::report::Report;
use crate::schema::ROOT;
use crate::source::Source;
use std::collections::BTreeMap;
use std::fmt;

/// Keys with which a run may go on changed: they say how far, how finely and how it is reported, not what is solved.
const FREE: [&str; 17] = [
    "title",
    "analysis.dt",
    "analysis.steps",
    "solver.extension",
    "solver.nonlinear",
    "solver.tolerance",
    "solver.force_tolerance",
    "solver.max_iterations",
    "solver.linear",
    "solver.reproducible",
    "output",
    "check",
    "element",
    "analysis.end",
    DIVIDED[0],
    DIVIDED[1],
    DIVIDED[2],
];
/// Keys that nothing has been solved with before the stage of `[strength_reduction]` has ended.
const DIVIDED: [&str; 3] = [
    "strength_reduction.factor",
    "strength_reduction.steps",
    "strength_reduction.drainage",
];
/// The key that says which.
const STAGE: &str = "strength_reduction.stage";
/// Keys among them that belong to the tables of a run, whose columns stay.
const BOUND: [&str; 1] = ["output.residuals"];
/// Things whose motion is given by where it ends: with them, another end is another motion.
const MOVED: [&str; 3] = ["footing", "prescribed", "rigid"];

/// A key whose value is not the same in two cases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The key.
    pub key: String,
    /// Its value in the one case, in SI; `None` where it is not given.
    pub was: Option<String>,
    /// Its value in the other.
    pub is: Option<String>,
    /// Whether a run may go on with the other value.
    pub may_change: bool,
}

impl Difference {
    /// Whether it is of the strength that is divided at the end of a stage: a run that has come further has been solved
    /// with it.
    pub fn is_of_later_strength(&self) -> bool {
        DIVIDED.contains(&self.key.as_str())
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let was = self.was.as_deref().unwrap_or("not given");
        let is = self.is.as_deref().unwrap_or("not given");
        write!(f, "{} was {was}, and is {is}", self.key)
    }
}

/// Every key whose value differs between two valid cases, however it is written.
///
/// # Errors
/// Those of a text that is no case.
pub fn differences(was: &str, is: &str) -> Result<Vec<Difference>, Vec<Error>> {
    let was = values(was)?;
    let is = values(is)?;
    let moved = [&was, &is]
        .iter()
        .any(|values| values.keys().any(|key| MOVED.iter().any(|table| below(key, table))));
    let divides_later = was.contains_key(STAGE) && is.contains_key(STAGE);
    let keys: std::collections::BTreeSet<&String> = was.keys().chain(is.keys()).collect();
    let differing = keys.into_iter().filter(|key| match (was.get(*key), is.get(*key)) {
        (Some(was), Some(is)) => was.shown != is.shown,
        // The default of a table that only one of them has.
        (one, other) => one.or(other).is_some_and(|value| value.written),
    });
    Ok(differing
        .map(|key| Difference {
            key: key.clone(),
            was: was.get(key).map(|value| value.shown.clone()),
            is: is.get(key).map(|value| value.shown.clone()),
            may_change: FREE.iter().any(|free| below(key, free))
                && !BOUND.iter().any(|bound| below(key, bound))
                && (divides_later || !DIVIDED.contains(&key.as_str()))
                && !(moved && below(key, "analysis.end")),
        })
        .collect())
}

/// Whether a key is `table` or in it.
fn below(key: &str, table: &str) -> bool {
    key.strip_prefix(table)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// A value in SI, and whether it is written or a default.
struct DifferenceValue {
    shown: String,
    written: bool,
}

/// All values of a case by key.
fn values(text: &str) -> Result<BTreeMap<String, DifferenceValue>, Vec<Error>> {
    let source = Source::new("case", text);
    let mut report = Report::new(&source, &[]);
    let mut document = document::parse(&source, &mut report);
    earlier::replace(&mut document, &mut report);
    earlier::star_slopes(&mut document);
    preset::fill(&mut document, &source, &[], &mut report);
    let record = record::read(ROOT, &document, &mut report);
    if report.failed() {
        return Err(report.into_errors());
    }
    let mut values = BTreeMap::new();
    collect(&record, &mut values);
    Ok(values)
}

fn collect(record: &Record, values: &mut BTreeMap<String, DifferenceValue>) {
    for field in &record.fields {
        let Some(datum) = &field.datum else { continue };
        let shown = match datum {
            Datum::Record(inner) => {
                collect(inner, values);
                continue;
            }
            Datum::Named(named) => {
                named.iter().for_each(|(_, inner)| collect(inner, values));
                // Their order, too: it is the points' number for them.
                named
                    .iter()
                    .map(|(name, _)| name.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            }
            Datum::Records(inner) => {
                inner.iter().for_each(|inner| collect(inner, values));
                continue;
            }
            Datum::Number(number) | Datum::Measure(number, _) => format!("{number:?}"),
            Datum::Numbers(numbers) => format!("{numbers:?}"),
            Datum::Rows(rows) => format!("{:?}", rows.iter().map(|row| &row.numbers).collect::<Vec<_>>()),
            Datum::Count(count) => count.to_string(),
            Datum::Word(word) => format!("\"{word}\""),
            Datum::Text(text) => format!("{text:?}"),
            Datum::Names(names) => format!("{names:?}"),
            Datum::Flag(flag) => flag.to_string(),
        };
        values.insert(
            join(&record.path, field.key),
            DifferenceValue {
                shown,
                written: field.written,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"
        title = "block"
        geometry = "plane-strain"
        [analysis]
        type = "dynamic"
        end = "1 s"
        dt = "1 ms"
        [grid]
        lower = [0.0, 0.0]
        upper = [1.0, 1.0]
        cell = 0.1
        degree = "quadratic"
        [material.soil]
        model = "elastic"
        young = "5840 kPa"
        poisson = 0.3
        density = 2000.0
        [[body]]
        material = "soil"
        box = { lower = [0.0, 0.0], upper = [0.5, 0.5] }
        points_per_cell = 2
    "#;

    fn reported(from: &str, to: &str) -> Vec<(String, bool)> {
        assert!(CASE.contains(from), "{from}");
        let found = differences(CASE, &CASE.replace(from, to)).unwrap_or_else(|e| panic!("{e:?}"));
        found
            .iter()
            .map(|difference| (difference.to_string(), difference.may_change))
            .collect()
    }

    #[test]
    fn the_key_and_both_values_are_reported() {
        assert_eq!(
            reported("poisson = 0.3", "poisson = 0.35"),
            [("material.soil.poisson was 0.3, and is 0.35".into(), false)]
        );
        let found = reported("[material.soil]", "[material.clay]");
        assert!(
            found.contains(&("material.soil.young was 5840000.0, and is not given".into(), false)),
            "{found:?}"
        );
        assert_eq!(reported("cell = 0.1", "cell = 0.05").len(), 1);
    }

    #[test]
    fn the_order_of_materials_is_that_of_the_points_numbers() {
        let clay = "[material.clay]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\ndensity = 2000.0\n";
        let soil_first = CASE.replace("[[body]]", &format!("{clay}[[body]]"));
        let clay_first = CASE.replace("[material.soil]", &format!("{clay}[material.soil]"));
        let found = differences(&soil_first, &clay_first).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].to_string().as_str(), found[0].may_change),
            ("material was soil, clay, and is clay, soil", false)
        );
    }

    #[test]
    fn another_way_to_write_the_same_is_no_difference() {
        assert_eq!(reported("\"5840 kPa\"", "5.84e6"), []);
        assert_eq!(reported("\"1 ms\"", "0.001 # s"), []);
    }

    #[test]
    fn a_run_may_go_on_with_another_end_step_or_tolerance_but_not_with_another_motion() {
        let end = ("end = \"1 s\"", "end = \"2 s\"");
        assert_eq!(
            reported(end.0, end.1),
            [("analysis.end was 1.0, and is 2.0".into(), true)]
        );
        assert!(reported("\"1 ms\"", "\"2 ms\"")[0].1);
        assert!(
            reported("[grid]", "[output]\nevery = 0.1\n[grid]")
                .iter()
                .all(|(_, may_change)| *may_change)
        );
        assert!(
            !reported("[grid]", "[output]\nresiduals = true\n[grid]")
                .iter()
                .all(|(_, may_change)| *may_change)
        );
        let footing = "[footing]\nfrom = [0.0, 0.5]\nto = [0.1, 0.5]\ndisplacement = [0.0, -0.1]\n[grid]";
        let footing = CASE.replace("[grid]", footing);
        let found = differences(&footing, &footing.replace(end.0, end.1)).unwrap();
        assert_eq!((found.len(), found[0].may_change), (1, false));
    }
}
