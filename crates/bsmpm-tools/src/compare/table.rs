//! Writes the curves of several runs as a table with one row per value of x.

use super::runs::Runs;
use crate::picture::axes::label;
use crate::picture::ticks::{Ticks, ValueRange, range};
use crate::record::short;
use crate::report::{ReportTable, or_dash};

/// How many rows there are about when nobody says which.
const ROWS: f64 = 10.0;
/// The share of a curve's length by which an x may lie beyond its end: that of rounding.
const NEAR: f64 = 1e-9;

/// A row of the table: its x, and which of several values a curve of single runs has there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TableRow {
    x: f64,
    number: usize,
}

/// The table, its columns right-aligned; where a curve does not reach, there is a dash. Runs of one label that end at
/// the same x have a row each.
pub(super) fn text(runs: &Runs, at: &[f64]) -> String {
    let at = if at.is_empty() { places(runs) } else { at.to_vec() };
    let rows: Vec<TableRow> = at.iter().flat_map(|&x| rows(runs, x)).collect();
    let heading = label(&runs.x.0, &runs.x.1);
    let heading = if heading.is_empty() { "x".to_owned() } else { heading };
    let mut table = ReportTable::of(&rows);
    table.right(heading, |row| written(row.x));
    for (name, places) in &runs.curves {
        table.right(name, |row| or_dash(value(places, *row).map(written)));
    }
    format!("{}\n{}", label(&runs.y.0, &runs.y.1), table.text(""))
}

/// As many rows as the curve with the most values at `x` has; of curves along which there are rows of a run, one.
fn rows(runs: &Runs, x: f64) -> impl Iterator<Item = TableRow> {
    let mut most = 1;
    if runs.last {
        for (_, places) in &runs.curves {
            most = most.max(places.iter().filter(|place| is_at(places, place[0], x)).count());
        }
    }
    (0..most).map(move |number| TableRow { x, number })
}

/// The value of a curve in a row: of several at its x that of its number, else the one of the curve.
fn value(places: &[[f64; 2]], row: TableRow) -> Option<f64> {
    if row.number == 0 {
        return interpolated(places, row.x);
    }
    places
        .iter()
        .filter(|place| is_at(places, place[0], row.x))
        .nth(row.number)
        .map(|place| place[1])
}

/// Whether the x of a place of a curve is `x`, but for rounding.
fn is_at(places: &[[f64; 2]], of_place: f64, x: f64) -> bool {
    let length = range(places.iter().map(|place| place[0])).map_or(0.0, ValueRange::length);
    (of_place - x).abs() <= NEAR * length.max(x.abs())
}

/// Round numbers along the curves; of runs that are single places, where these are.
fn places(runs: &Runs) -> Vec<f64> {
    let mut all: Vec<f64> = runs
        .curves
        .iter()
        .flat_map(|curve| &curve.1)
        .map(|place| place[0])
        .collect();
    if runs.last {
        all.sort_by(f64::total_cmp);
        let length = all.last().zip(all.first()).map_or(0.0, |(high, low)| high - low);
        all.dedup_by(|later, before| (*later - *before).abs() <= NEAR * length.max(before.abs()));
        return all;
    }
    match range(all.iter().copied()) {
        Some(ValueRange { low, high }) if high > low => Ticks::between(low, high, ROWS).values,
        ends => ends.iter().map(|ends| ends.low).collect(),
    }
}

/// The curve at `x`, where it comes there first: linear between its places.
fn interpolated(places: &[[f64; 2]], x: f64) -> Option<f64> {
    if let Some(place) = places.iter().find(|place| is_at(places, place[0], x)) {
        return Some(place[1]);
    }
    let mut pairs = places.windows(2).map(|pair| [pair[0], pair[1]]);
    let [from, to] = pairs.find(|[from, to]| from[0].min(to[0]) <= x && x <= from[0].max(to[0]))?;
    Some(from[1] + (to[1] - from[1]) * (x - from[0]) / (to[0] - from[0]))
}

/// A number to six digits.
fn written(value: f64) -> String {
    let rounded = short(value);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(curves: &[(&str, &[[f64; 2]])], last: bool) -> Runs {
        let curves = curves
            .iter()
            .map(|(name, places)| ((*name).to_owned(), places.to_vec()))
            .collect();
        let axis = |label: &str, unit: &str| (label.to_owned(), unit.to_owned());
        Runs {
            title: String::new(),
            x: axis("Time", "s"),
            y: axis("Runout", "m"),
            curves,
            last,
            notes: Vec::new(),
        }
    }

    #[test]
    fn curves_are_interpolated_as_far_as_they_reach() {
        let curves = runs(
            &[
                ("long", &[[0.0, 1.0], [1.0, 3.0]]),
                ("short", &[[0.0, 0.0], [0.3, 1e-6]]),
            ],
            false,
        );
        let expected =
            "Runout (m)\nTime (s)  long  short\n       0     1      0\n     0.3   1.6   1e-6\n       1     3      -\n";
        assert_eq!(text(&curves, &[0.0, 0.1 + 0.2, 1.0]), expected);
        assert_eq!(text(&curves, &[]).lines().count(), 2 + 11);
        let back = [[0.0, 0.0], [2.0, 2.0], [1.0, 5.0]];
        assert_eq!((interpolated(&back, 1.5), interpolated(&back, 2.5)), (Some(1.5), None));
    }

    #[test]
    fn single_places_make_a_row_each() {
        let curves = runs(&[("a", &[[1.0, 2.0], [1.4, 4.0]]), ("b", &[[1.2, 7.0]])], true);
        let rows: Vec<String> = text(&curves, &[]).lines().skip(2).map(str::to_owned).collect();
        assert_eq!(rows, ["       1  2  -", "     1.2  3  7", "     1.4  4  -"]);
    }

    /// Three runs of one label end at the same time; a fourth one of another does, too.
    #[test]
    fn runs_that_end_at_the_same_x_have_a_row_each() {
        let curves = runs(
            &[
                ("a", &[[1.0, 2.0], [1.0, 3.0], [1.0, 5.0], [2.0, 7.0]]),
                ("b", &[[1.0, 4.0]]),
            ],
            true,
        );
        for at in [&[][..], &[1.0, 2.0]] {
            let rows: Vec<String> = text(&curves, at).lines().skip(2).map(str::to_owned).collect();
            assert_eq!(
                rows,
                ["       1  2  4", "       1  3  -", "       1  5  -", "       2  7  -"]
            );
        }
    }
}
