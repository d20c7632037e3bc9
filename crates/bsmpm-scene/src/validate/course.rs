//! Validates what follows time: ramps, amplitudes and rows that begin with a time.

use super::site::AroundStrip;
use crate::case::Shares;
use crate::record::{Field, ListRow};
use crate::report::Report;
use bsmpm::tensor::Vector;

/// Ramp and amplitude of a load, of which one holds.
pub(super) fn course(
    ramp: &Field<f64>,
    amplitude: &Field<Vec<ListRow>>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<(f64, Shares)> {
    if !amplitude.is_given() {
        let path = ramp.path();
        let ramp = ramp.get()?;
        if let Some(end) = around.end.filter(|end| ramp > *end) {
            report.warn(format!(
                "W0402: {path}: the load grows until t = {ramp}, but the analysis ends at t = {end}, so the load \
                 never acts in full. Reduce `ramp`, or increase analysis.end."
            ));
        }
        return Some((ramp, Vec::new()));
    }
    let rows = in_time(amplitude, around, report)?;
    Some((
        0.0,
        rows.into_iter()
            .map(|row| (row[0], Vector::from_element(row[1])))
            .collect(),
    ))
}

/// Rows of what acts in time; warned of what of them the steps do not meet.
fn in_time(key: &Field<Vec<ListRow>>, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Vec<Vec<f64>>> {
    let rows: Vec<Vec<f64>> = increasing(key, report)?.map(<[f64]>::to_vec).collect();
    let path = key.path();
    warn_of_late(path, rows.iter().map(|row| row[0]), around.end, report);
    coarse(path, rows.iter().map(|row| row[0]), around.dt, report);
    Some(rows)
}

/// The largest load of a path along each axis, by size, and the shares of it; an axis along which nothing acts has
/// those of one along which something does.
pub(super) fn path(
    key: &Field<Vec<ListRow>>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<([f64; 3], Shares)> {
    let rows = in_time(key, around, report)?;
    let largest = [0, 1, 2].map(|axis| {
        let components = rows.iter().map(|row| component(row, axis));
        components.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a })
    });
    let acting = [0, 1, 2].into_iter().find(|axis| largest[*axis] != 0.0).unwrap_or(0);
    let of = [0, 1, 2].map(|axis| if largest[axis] == 0.0 { acting } else { axis });
    let shares = rows.iter().map(|row| {
        let shares = of.map(|axis| part_of(component(row, axis), largest[axis]));
        (row[0], Vector::from(shares))
    });
    Some((largest, shares.collect()))
}

/// A value in parts of the largest one; 0 where that is 0.
fn part_of(value: f64, largest: f64) -> f64 {
    if largest == 0.0 { 0.0 } else { value / largest }
}

/// Component along an axis of a row with a time and a vector; 0 along an axis that it does not give.
pub(super) fn component(row: &[f64], axis: usize) -> f64 {
    row.get(1 + axis).copied().unwrap_or(0.0)
}

/// Warns of the first time of rows that is after the end of the analysis.
pub(super) fn warn_of_late(
    path: &str,
    mut times: impl Iterator<Item = f64>,
    end: Option<f64>,
    report: &mut Report<'_>,
) {
    let Some(end) = end else { return };
    if let Some(t) = times.find(|t| *t > end) {
        report.warn(format!(
            "W0403: {path}: the row at t = {t} is after the end of the analysis at t = {end}, so its values are \
             never reached. Increase analysis.end, or delete the row."
        ));
    }
}

/// Warns of steps that are longer than the time between two rows.
pub(super) fn coarse(path: &str, times: impl Iterator<Item = f64> + Clone, dt: Option<f64>, report: &mut Report<'_>) {
    let intervals = times.clone().skip(1).zip(times).map(|(later, earlier)| later - earlier);
    let interval = intervals.fold(f64::INFINITY, f64::min);
    if let Some(dt) = dt.filter(|dt| interval < 0.999 * dt) {
        report.warn(format!(
            "W0404: {path}: rows are {interval} apart in time, but a step is {dt} long, so peaks between two steps \
             are missed. Set analysis.dt = {interval}."
        ));
    }
}

/// Says that the first number of a row, called `name`, is not larger than that of the row before.
pub(super) fn not_increasing(name: &str, value: f64, before: f64) -> String {
    format!(
        "E0402: {name} = {value} in this row is not larger than {before} in the row before. Sort the rows by {name}, \
         and delete repeated rows."
    )
}

/// Rows whose first number, a time, increases; at least one.
pub(super) fn increasing<'a>(
    key: &'a Field<Vec<ListRow>>,
    report: &mut Report<'_>,
) -> Option<impl Iterator<Item = &'a [f64]> + use<'a>> {
    let rows = key.value()?;
    if rows.is_empty() {
        key.error("E0435: this list of rows is empty. Give at least one row.", report);
        return None;
    }
    if let Some(late) = (1..rows.len()).find(|&k| rows[k].numbers[0] <= rows[k - 1].numbers[0]) {
        let name = match key.name() {
            "line" => "x",
            "curve" => "the suction",
            _ => "t",
        };
        let [value, before] = [late, late - 1].map(|row| rows[row].numbers[0]);
        report.error(rows[late].origin, key.path(), not_increasing(name, value, before));
        return None;
    }
    Some(rows.iter().map(|row| &row.numbers[..]))
}
