//! Indicator of scatter in force histories, theory-manual equation (T10.13).

use bsmpm::model::Regime;
use bsmpm_io::manifest::Indicator;
use bsmpm_io::table::Columns;
use bsmpm_scene::observables::Aspect;
use bsmpm_scene::{Case, History};

/// Fewer differences are not judged.
const LEAST: usize = 8;
/// Steps that differ by less are equal.
const EQUAL: f64 = 1e-6;
/// Components of a force below this part of its largest one are next to nothing.
const SMALL: f64 = 0.1;
/// Usual noise.
const USUAL: f64 = 0.02;

/// That of the force that has most, over its largest magnitude; none without forces of a quasi-static analysis, or in
/// few steps.
pub(super) fn of(case: &Case, history: &Columns) -> Option<Indicator> {
    if case.analysis.regime != Regime::QuasiStatic {
        return None;
    }
    let times = history.get("time")?;
    let forces = case
        .histories
        .iter()
        .filter(|history| history.quantity.observable.has(Aspect::Force));
    let noises = forces.filter_map(|force| Some((noise(force, times, history)?, force.name.as_str())));
    let (value, name) = noises.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Indicator::new(value, "-", &format!("`{name}`"), [0.0, USUAL]))
}

/// The largest of its components, each over its own magnitude; those that are next to nothing are not judged.
fn noise(force: &History, times: &[f64], history: &Columns) -> Option<f64> {
    let names = force.columns().into_iter().map(|column| column.name);
    let columns: Vec<&[f64]> = names.filter_map(|name| history.get(&name)).collect();
    let largest = columns.iter().map(|values| magnitude(values)).fold(0.0, f64::max);
    let judged = columns.into_iter().filter(|values| magnitude(values) > SMALL * largest);
    judged
        .filter_map(|values| Some(deviation(times, values)? / magnitude(values)))
        .reduce(f64::max)
}

fn magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Standard deviation of the errors of values.
fn deviation(times: &[f64], values: &[f64]) -> Option<f64> {
    let rows = times.windows(5).zip(values.windows(5));
    let mut differences: Vec<f64> = rows
        .filter(|(times, _)| are_even(times))
        .map(|(_, five)| fourth(five))
        .collect();
    if differences.len() < LEAST {
        return None;
    }
    differences.sort_by(f64::total_cmp);
    Some(differences[differences.len() / 2] / 0.6745 / 70.0_f64.sqrt())
}

fn are_even(times: &[f64]) -> bool {
    let step = times[1] - times[0];
    times
        .windows(2)
        .all(|pair| (pair[1] - pair[0] - step).abs() <= EQUAL * step)
}

/// Magnitude of the fourth difference.
fn fourth(five: &[f64]) -> f64 {
    (five[0] - 4.0 * five[1] + 6.0 * five[2] - 4.0 * five[3] + five[4]).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|step| 0.1 * step as f64).collect()
    }

    #[test]
    fn a_smooth_curve_with_kinks_has_no_noise() {
        let curve: Vec<f64> = times(60).iter().map(|t| (2.0 * t).min(3.0) + (0.5 * t).sin()).collect();
        let found = deviation(&times(60), &curve).unwrap();
        assert!(found < 1e-4, "{found}");
    }

    #[test]
    fn independent_errors_are_found() {
        // Values of a linear congruential generator, uniform in -0.5 to 0.5: a standard deviation of 0.289.
        let mut state = 1_u64;
        let mut error = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let curve: Vec<f64> = times(2000).iter().map(|t| 0.3 * t + error()).collect();
        let found = deviation(&times(2000), &curve).unwrap();
        assert!((found / 0.289 - 1.0).abs() < 0.1, "{found}");
    }

    #[test]
    fn steps_of_unlike_length_and_few_rows_are_not_judged() {
        let doubled: Vec<f64> = (0..40).map(|step: i32| 1.1_f64.powi(step)).collect();
        assert_eq!(deviation(&doubled, &doubled), None);
        assert_eq!(deviation(&times(11), &times(11)), None);
    }
}
