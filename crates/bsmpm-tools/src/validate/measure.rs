//! Numbers of histories: values, orders of convergence, extrapolations, failure loads.

use std::collections::BTreeMap;

use super::matrix::{Kink, Operation, Order, Row};
use super::runs::Outcome;

/// Relative distance at which two times are the same.
const SAME: f64 = 1e-9;
/// The branch after a kink: from this many times the elastic displacement ..
const BENT: f64 = 5.0;
/// .. to this many times; so early that the geometry has not changed yet.
const FALLEN: f64 = 20.0;

/// A number, and what its reader should know.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub value: f64,
    pub remark: Option<String>,
}

/// The number of a row; `Err` says why there is none.
pub(super) fn value(row: &Row, outcomes: &BTreeMap<String, Outcome>) -> Result<Measured, String> {
    if let Some(order) = &row.order {
        return observed_order(order, &values(order, outcomes)?);
    }
    if let Some(order) = &row.extrapolated {
        return extrapolated(order, &values(order, outcomes)?);
    }
    if let Some(kink) = &row.kink {
        let (x, y) = (column(outcomes, &kink.run, &kink.x)?, column(outcomes, &kink.run, &kink.y)?);
        return failure(kink, &x.into_iter().zip(y).collect::<Vec<_>>());
    }
    let (run, name) = (row.run.as_deref().unwrap_or_default(), row.column.as_deref().unwrap_or_default());
    let values = column(outcomes, run, name)?;
    let value = match (row.operation, row.at) {
        (Operation::Max, _) => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
        (Operation::Min, _) => values.into_iter().fold(f64::INFINITY, f64::min),
        (Operation::Last, at) => at_time(outcomes, run, &values, at)?,
    };
    Ok(Measured { value: row.scale * value, remark: None })
}

fn column(outcomes: &BTreeMap<String, Outcome>, run: &str, name: &str) -> Result<Vec<f64>, String> {
    let outcome = outcomes.get(run).ok_or_else(|| format!("{run} was not run"))?;
    let history = outcome.history.as_ref().ok_or_else(|| format!("{run} left no history"))?;
    history.get(name).map(<[f64]>::to_vec).ok_or_else(|| format!("{run} has no column {name}"))
}

/// The value at a time, between the rows linearly; without a time the last one.
fn at_time(outcomes: &BTreeMap<String, Outcome>, run: &str, values: &[f64], at: Option<f64>) -> Result<f64, String> {
    let times = column(outcomes, run, "time")?;
    let Some(at) = at else { return values.last().copied().ok_or_else(|| format!("{run} has no row")) };
    let next = times.partition_point(|time| *time < at * (1.0 - SAME));
    match (next, times.get(next)) {
        (_, None) => Err(format!("not reached: {run} came to {:.4}", times.last().copied().unwrap_or(0.0))),
        (0, Some(_)) => Ok(values[0]),
        (_, Some(time)) if (time - at).abs() <= SAME * at.abs() => Ok(values[next]),
        (_, Some(time)) => {
            let share = (at - times[next - 1]) / (time - times[next - 1]);
            Ok(values[next - 1] + share * (values[next] - values[next - 1]))
        }
    }
}

fn values(order: &Order, outcomes: &BTreeMap<String, Outcome>) -> Result<Vec<f64>, String> {
    order
        .runs
        .iter()
        .map(|run| {
            if outcomes.get(run).is_some_and(|outcome| outcome.stopped.is_some()) {
                return Err(format!("{run} stopped"));
            }
            at_time(outcomes, run, &column(outcomes, run, &order.column)?, order.at)
        })
        .collect()
}

/// Slope of log error over log size: least squares over all sizes, and of the last two in the remark.
fn observed_order(order: &Order, values: &[f64]) -> Result<Measured, String> {
    let exact = order.exact.ok_or("an order needs `exact`")?;
    let places: Vec<(f64, f64)> =
        order.sizes.iter().zip(values).map(|(size, value)| (size.ln(), (value - exact).abs().ln())).collect();
    let count = places.len() as f64;
    let mean = places.iter().fold((0.0, 0.0), |sum, place| (sum.0 + place.0 / count, sum.1 + place.1 / count));
    let (mut product, mut square) = (0.0, 0.0);
    for (size, error) in &places {
        product += (size - mean.0) * (error - mean.1);
        square += (size - mean.0).powi(2);
    }
    let [.., before, last] = &places[..] else { return Err("an order needs two sizes".into()) };
    let pair = (before.1 - last.1) / (before.0 - last.0);
    Ok(Measured { value: product / square, remark: Some(format!("last two sizes: {pair:.2}")) })
}

/// Richardson's limit of the last three sizes, which must shrink by one ratio, with the order that they show.
fn extrapolated(order: &Order, values: &[f64]) -> Result<Measured, String> {
    let ([.., a, b, c], [.., x, y, z]) = (values, &order.sizes[..]) else {
        return Err("an extrapolation needs three sizes".into());
    };
    if ((x / y) / (y / z) - 1.0).abs() > 1e-6 {
        return Err("the sizes do not shrink by one ratio".into());
    }
    let ratio = (a - b) / (b - c);
    if ratio <= 1.0 {
        return Err(format!("no convergence: {a:.4}, {b:.4}, {c:.4}"));
    }
    let order = ratio.ln() / (x / y).ln();
    Ok(Measured {
        value: c - (b - c) / (ratio - 1.0),
        remark: Some(format!("from {a:.4}, {b:.4}, {c:.4}: order {order:.2}")),
    })
}

/// Where the straight line through the beginning of the branch after the kink meets the elastic one, and in the remark where
/// twice the elastic displacement is reached. A run that ended before it bent gives the load at its end.
fn failure(kink: &Kink, curve: &[(f64, f64)]) -> Result<Measured, String> {
    let elastic_end = curve.len() / 5;
    if elastic_end < 2 {
        return Err("too few rows for a kink".into());
    }
    let first = curve[0];
    let elastic = (curve[elastic_end].1 - first.1) / (curve[elastic_end].0 - first.0);
    let times = |many: f64| {
        let beyond = |(x, y): &&(f64, f64)| *x > first.0 && y - first.1 > many * elastic * (x - first.0);
        curve.iter().find(beyond).copied()
    };
    let doubled = times(2.0).map_or("never".to_owned(), |(x, _)| format!("{:.4}", x * kink.scale));
    let last = curve[curve.len() - 1];
    let branch = times(BENT).map(|from| (from, times(FALLEN).unwrap_or(last))).filter(|(from, to)| to.0 > from.0);
    let Some((from, to)) = branch else {
        let remark = format!("no kink before its end; twice the elastic displacement: {doubled}");
        return Ok(Measured { value: last.0 * kink.scale, remark: Some(remark) });
    };
    let steep = (to.1 - from.1) / (to.0 - from.0);
    let meet = (from.1 - first.1 + elastic * first.0 - steep * from.0) / (elastic - steep);
    Ok(Measured { value: meet * kink.scale, remark: Some(format!("twice the elastic displacement: {doubled}")) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(sizes: &[f64], exact: Option<f64>) -> Order {
        Order { runs: Vec::new(), sizes: sizes.to_vec(), column: String::new(), at: None, exact }
    }

    #[test]
    fn the_order_and_the_limit_of_a_known_sequence_are_found() {
        let sizes = [0.5, 0.25, 0.125];
        let values: Vec<f64> = sizes.iter().map(|h: &f64| 5.0 + 3.0 * h.powf(1.5)).collect();
        let found = observed_order(&order(&sizes, Some(5.0)), &values).unwrap().value;
        assert!((found - 1.5).abs() < 1e-12);
        let limit = extrapolated(&order(&sizes, None), &values).unwrap().value;
        assert!((limit - 5.0).abs() < 1e-12);
        assert!(extrapolated(&order(&sizes, None), &[1.0, 2.0, 4.0]).is_err());
    }

    #[test]
    fn a_kink_is_where_both_lines_meet() {
        let kink = Kink { run: String::new(), x: String::new(), y: String::new(), scale: 2.0 };
        let curve: Vec<(f64, f64)> =
            (0..=50).map(|k| f64::from(k) / 50.0).map(|x| (x, x + 100.0 * (x - 0.7).max(0.0))).collect();
        let found = failure(&kink, &curve).unwrap();
        assert!((found.value - 1.4).abs() < 1e-9, "{found:?}");
        assert_eq!(found.remark.as_deref(), Some("twice the elastic displacement: 1.4400"));
        let straight: Vec<(f64, f64)> = (0..=50).map(|k| (f64::from(k) / 50.0, f64::from(k))).collect();
        let found = failure(&kink, &straight).unwrap();
        assert!(found.value == 2.0 && found.remark.unwrap().starts_with("no kink"));
    }
}
