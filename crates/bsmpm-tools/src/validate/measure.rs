//! Computes numbers of the validation table from histories: values, orders of convergence and extrapolations.

use std::collections::BTreeMap;

use super::course::{Spot, mean, reached, window};
use super::kink::failure;
use super::matrix::{MatrixKink, MatrixPlace, MatrixRow, MeasuredOrder, Operation};
use super::measured::{Lack, MeasuredNumber};
use super::runs::MatrixOutcome;
use crate::line::FittedLine;

/// The number of a row, or why there is none.
pub(super) fn value(row: &MatrixRow, outcomes: &BTreeMap<String, MatrixOutcome>) -> Result<MeasuredNumber, Lack> {
    if let Some(order) = &row.order {
        return Ok(observed_order(order, &values(order, outcomes)?)?);
    }
    if let Some(order) = &row.extrapolated {
        return Ok(extrapolated(order, &values(order, outcomes)?)?);
    }
    let run = row.run.as_deref().unwrap_or_default();
    if let Some(kink) = &row.kink {
        return Ok(failure(kink, &curve(outcomes, run, kink)?)?);
    }
    let values = column(outcomes, run, row.column.as_deref().unwrap_or_default())?;
    let value = match (row.operation, &row.place) {
        (
            Operation::Last,
            Some(MatrixPlace {
                column,
                value: Some(value),
                ..
            }),
        ) => spot(outcomes, run, column, *value)?.of(&values),
        (Operation::Last, _) => at_time(outcomes, run, &values, row.at)?,
        (Operation::Reach, _) => values[values.len() - 1],
        (Operation::Deviation, place) => deviation(row, &part(outcomes, run, &values, place.as_ref())?, outcomes)?,
        (operation, place) => over(operation, &part(outcomes, run, &values, place.as_ref())?),
    };
    Ok(MeasuredNumber {
        value: row.scale.unwrap_or(1.0) * value,
        remark: None,
    })
}

fn column(outcomes: &BTreeMap<String, MatrixOutcome>, run: &str, name: &str) -> Result<Vec<f64>, String> {
    let outcome = outcomes.get(run).ok_or_else(|| format!("{run} was not run"))?;
    let history = outcome
        .run
        .history
        .as_ref()
        .ok_or_else(|| format!("{run} left no history"))?;
    let values = history.get(name).ok_or_else(|| format!("{run} has no column {name}"))?;
    if values.is_empty() {
        Err(format!("{run} has no row"))
    } else {
        Ok(values.to_vec())
    }
}

/// The load-displacement curve of a run.
fn curve(outcomes: &BTreeMap<String, MatrixOutcome>, run: &str, kink: &MatrixKink) -> Result<Vec<[f64; 2]>, String> {
    let across = column(outcomes, run, &kink.x)?;
    let up = column(outcomes, run, &kink.y)?;
    Ok(across.into_iter().zip(up).map(<[f64; 2]>::from).collect())
}

/// The last row of a run that stopped is not that of the others.
fn ended(outcomes: &BTreeMap<String, MatrixOutcome>, run: &str) -> Result<(), Lack> {
    match outcomes.get(run).is_some_and(|outcome| outcome.stopped.is_some()) {
        true => Err(Lack::NotReached(format!("not reached: {run} stopped"))),
        false => Ok(()),
    }
}

/// Where a column of a run first reaches a value.
fn spot(outcomes: &BTreeMap<String, MatrixOutcome>, run: &str, name: &str, value: f64) -> Result<Spot, Lack> {
    let across = column(outcomes, run, name)?;
    reached(&across, value).ok_or_else(|| {
        let last = across.last().copied().unwrap_or(f64::NAN);
        Lack::NotReached(format!("not reached: {run} came to {name} {last:.4}"))
    })
}

/// The part of a history that a window leaves, to the end of the run unless it says where: the other column, and the
/// values.
fn part(
    outcomes: &BTreeMap<String, MatrixOutcome>,
    run: &str,
    values: &[f64],
    place: Option<&MatrixPlace>,
) -> Result<Vec<[f64; 2]>, Lack> {
    let name = place.map_or("time", |place| &place.column);
    let from = match place.and_then(|place| place.from) {
        Some(from) => spot(outcomes, run, name, from)?,
        None => Spot { row: 0, share: 0.0 },
    };
    let to = match place.and_then(|place| place.to) {
        Some(to) => spot(outcomes, run, name, to)?,
        None => {
            ended(outcomes, run)?;
            let row = values.len() - 1;
            Spot { row, share: 0.0 }
        }
    };
    if (to.row, to.share) < (from.row, from.share) {
        return Err(Lack::Other(format!("the window of {name} ends before it begins")));
    }
    Ok(window(&column(outcomes, run, name)?, values, from, to))
}

/// The largest difference of a part of a history from that of the row's other run at the same place, relative to it.
fn deviation(row: &MatrixRow, part: &[[f64; 2]], outcomes: &BTreeMap<String, MatrixOutcome>) -> Result<f64, Lack> {
    let other = row.against.as_deref().unwrap_or_default();
    let name = row.column.as_deref().unwrap_or_default();
    let values = column(outcomes, other, name)?;
    let across = row.place.as_ref().map_or("time", |place| &place.column);
    let mut largest: f64 = 0.0;
    for [at, value] in part {
        let beside = spot(outcomes, other, across, *at)?.of(&values);
        let apart = (value / beside - 1.0).abs();
        if !apart.is_finite() {
            return Ok(f64::NAN);
        }
        largest = largest.max(apart);
    }
    Ok(largest)
}

/// What an operation makes of a part of a history; no number of it may be missing.
fn over(operation: Operation, part: &[[f64; 2]]) -> f64 {
    let values = part.iter().map(|[_, value]| *value);
    if !values.clone().all(f64::is_finite) {
        return f64::NAN;
    }
    let largest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    let smallest = values.fold(f64::INFINITY, f64::min);
    match operation {
        Operation::Max => largest,
        Operation::Min => smallest,
        Operation::Spread => (largest - smallest) / mean(part).abs(),
        Operation::Mean => mean(part),
        Operation::Last | Operation::Reach | Operation::Deviation => part.last().map_or(f64::NAN, |[_, value]| *value),
    }
}

/// The value at a time; without a time that at the end, which the run must have reached.
fn at_time(
    outcomes: &BTreeMap<String, MatrixOutcome>,
    run: &str,
    values: &[f64],
    at: Option<f64>,
) -> Result<f64, Lack> {
    match at {
        Some(at) => Ok(spot(outcomes, run, "time", at)?.of(values)),
        None => {
            ended(outcomes, run)?;
            Ok(values.last().copied().ok_or_else(|| format!("{run} has no row"))?)
        }
    }
}

/// What an order or an extrapolation takes of each of its runs.
fn values(order: &MeasuredOrder, outcomes: &BTreeMap<String, MatrixOutcome>) -> Result<Vec<f64>, Lack> {
    let mut values = Vec::new();
    for run in &order.runs {
        values.push(match &order.kink {
            Some(kink) => failure(kink, &curve(outcomes, run, kink)?)?.value,
            None => {
                let name = order.column.as_deref().unwrap_or_default();
                at_time(outcomes, run, &column(outcomes, run, name)?, order.at)?
            }
        });
    }
    Ok(values)
}

/// Slope of log error over log size: least squares over all sizes; in the remark that of the last two, and the limit
/// that the last three show.
fn observed_order(order: &MeasuredOrder, values: &[f64]) -> Result<MeasuredNumber, String> {
    let exact = order.exact.ok_or("an order needs `exact`")?;
    let places: Vec<[f64; 2]> = order
        .sizes
        .iter()
        .zip(values)
        .map(|(size, value)| [size.ln(), (value - exact).abs().ln()])
        .collect();
    let line = FittedLine::fitted(&places).ok_or("an order needs two sizes")?;
    let [.., before, last] = &places[..] else {
        return Err("an order needs two sizes".into());
    };
    let pair = (before[1] - last[1]) / (before[0] - last[0]);
    let limit = extrapolated(order, values).map_or_else(|reason| reason, |limit| format!("{:.4}", limit.value));
    let remark = format!("last two sizes: {pair:.2}; limit of the last three: {limit}");
    Ok(MeasuredNumber {
        value: line.slope,
        remark: Some(remark),
    })
}

/// Richardson's limit: of the last three sizes, which must shrink by one ratio, with the order that they show; of two
/// sizes with order one, as for limit loads.
fn extrapolated(order: &MeasuredOrder, values: &[f64]) -> Result<MeasuredNumber, String> {
    if let ([coarse, fine], [wide, narrow]) = (values, &order.sizes[..]) {
        return Ok(MeasuredNumber {
            value: fine + (fine - coarse) / (wide / narrow - 1.0),
            remark: Some(format!("from {coarse:.4}, {fine:.4}: order 1 assumed")),
        });
    }
    let [[.., a, b, c], [.., x, y, z]] = [values, &order.sizes] else {
        return Err("an extrapolation needs two or three sizes".into());
    };
    if ((x / y) / (y / z) - 1.0).abs() > 1e-6 {
        return Err("the sizes do not shrink by one ratio".into());
    }
    let ratio = (a - b) / (b - c);
    if ratio <= 1.0 {
        return Err(format!("no convergence: {a:.4}, {b:.4}, {c:.4}"));
    }
    let order = ratio.ln() / (x / y).ln();
    Ok(MeasuredNumber {
        value: c - (b - c) / (ratio - 1.0),
        remark: Some(format!("from {a:.4}, {b:.4}, {c:.4}: order {order:.2}")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(sizes: &[f64], exact: Option<f64>) -> MeasuredOrder {
        MeasuredOrder {
            runs: Vec::new(),
            sizes: sizes.to_vec(),
            column: None,
            kink: None,
            at: None,
            exact,
        }
    }

    #[test]
    fn the_order_and_the_limit_of_a_known_sequence_are_found() {
        let sizes = [0.5, 0.25, 0.125];
        let values: Vec<f64> = sizes.iter().map(|h: &f64| 5.0 + 3.0 * h.powf(1.5)).collect();
        let found = observed_order(&order(&sizes, Some(5.0)), &values).unwrap().value;
        assert!((found - 1.5).abs() < 1e-12);
        let remark = observed_order(&order(&sizes, Some(5.0)), &values)
            .unwrap()
            .remark
            .unwrap();
        assert_eq!(remark, "last two sizes: 1.50; limit of the last three: 5.0000");
        let limit = extrapolated(&order(&sizes, None), &values).unwrap().value;
        assert!((limit - 5.0).abs() < 1e-12);
        assert!(extrapolated(&order(&sizes, None), &[1.0, 2.0, 4.0]).is_err());
    }

    #[test]
    fn the_limit_of_two_sizes_is_that_of_order_one() {
        let sizes = [0.5, 0.125];
        let values = sizes.map(|h| 5.0 + 3.0 * h);
        let limit = extrapolated(&order(&sizes, None), &values).unwrap().value;
        assert!((limit - 5.0).abs() < 1e-12);
    }
}
