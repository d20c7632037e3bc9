//! The curves as a table of text: a row for every x, a column for every curve.

use super::runs::Runs;
use crate::picture::axes::label;
use crate::picture::ticks::{Ticks, range};
use crate::record::short;
use crate::report::{ReportTable, or_dash};

/// How many rows there are about when nobody says which.
const ROWS: f64 = 10.0;
/// The share of a curve's length by which an x may lie beyond its end: that of rounding.
const NEAR: f64 = 1e-9;

/// The table, its columns right-aligned; where a curve does not reach, there is a dash.
pub(super) fn text(runs: &Runs, at: &[f64]) -> String {
    let at = if at.is_empty() { places(runs) } else { at.to_vec() };
    let heading = label(&runs.x.0, &runs.x.1);
    let heading = if heading.is_empty() { "x".to_owned() } else { heading };
    let mut table = ReportTable::of(&at);
    table.right(heading, |&x| written(x));
    for (name, places) in &runs.curves {
        table.right(name, |&x| or_dash(interpolated(places, x).map(written)));
    }
    format!("{}\n{}", label(&runs.y.0, &runs.y.1), table.text(""))
}

/// Round numbers along the curves; of runs that are single places, where these are.
fn places(runs: &Runs) -> Vec<f64> {
    let mut all: Vec<f64> = runs.curves.iter().flat_map(|curve| &curve.1).map(|place| place.0).collect();
    if runs.last {
        all.sort_by(f64::total_cmp);
        all.dedup();
        return all;
    }
    match range(all.iter().copied()) {
        Some((low, high)) if high > low => Ticks::between(low, high, ROWS).values,
        ends => ends.iter().map(|ends| ends.0).collect(),
    }
}

/// The curve at `x`, where it comes there first: linear between its places.
fn interpolated(places: &[(f64, f64)], x: f64) -> Option<f64> {
    let (low, high) = range(places.iter().map(|place| place.0))?;
    let near = NEAR * (high - low).max(x.abs());
    if let Some(place) = places.iter().find(|place| (place.0 - x).abs() <= near) {
        return Some(place.1);
    }
    let pairs = places.windows(2).map(|pair| (pair[0], pair[1]));
    let (from, to) = pairs.into_iter().find(|(from, to)| from.0.min(to.0) <= x && x <= from.0.max(to.0))?;
    Some(from.1 + (to.1 - from.1) * (x - from.0) / (to.0 - from.0))
}

/// A number to six digits.
fn written(value: f64) -> String {
    let rounded = short(value);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) { format!("{rounded:e}") } else { rounded.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(curves: &[(&str, &[(f64, f64)])], last: bool) -> Runs {
        let curves = curves.iter().map(|(name, places)| ((*name).to_owned(), places.to_vec())).collect();
        let axis = |label: &str, unit: &str| (label.to_owned(), unit.to_owned());
        Runs { title: String::new(), x: axis("Time", "s"), y: axis("Runout", "m"), curves, last, notes: Vec::new() }
    }

    #[test]
    fn curves_are_interpolated_as_far_as_they_reach() {
        let curves = runs(&[("long", &[(0.0, 1.0), (1.0, 3.0)]), ("short", &[(0.0, 0.0), (0.3, 1e-6)])], false);
        let expected =
            "Runout (m)\nTime (s)  long  short\n       0     1      0\n     0.3   1.6   1e-6\n       1     3      -\n";
        assert_eq!(text(&curves, &[0.0, 0.1 + 0.2, 1.0]), expected);
        assert_eq!(text(&curves, &[]).lines().count(), 2 + 11);
        let back = [(0.0, 0.0), (2.0, 2.0), (1.0, 5.0)];
        assert_eq!((interpolated(&back, 1.5), interpolated(&back, 2.5)), (Some(1.5), None));
    }

    #[test]
    fn single_places_make_a_row_each() {
        let curves = runs(&[("a", &[(1.0, 2.0), (1.4, 4.0)]), ("b", &[(1.2, 7.0)])], true);
        let rows: Vec<String> = text(&curves, &[]).lines().skip(2).map(str::to_owned).collect();
        assert_eq!(rows, ["       1  2  -", "     1.2  3  7", "     1.4  4  -"]);
    }
}
