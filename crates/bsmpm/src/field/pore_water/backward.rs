//! Time integration of pore-water flow: second-order backward difference, theory-manual equation (T8.10), or backward
//! Euler.

use crate::field::pore_water::crossed::PreviousFlow;
use crate::field::pore_water::flow::{Course, Motion};
use crate::model::{Model, Regime};
use crate::points::Points;
use crate::schedule::TimeInterval;

/// Largest ratio of a step to the step before for which the second-order difference is used. It is stable below 1 +
/// sqrt 2, but decaying solutions overshoot more, the closer the ratio is to that bound.
pub const LONGEST: f64 = 1.6;

/// Coefficients of the time integration of flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differences {
    /// Factor of the change in the last step (-).
    pub last: f64,
    /// Factor of the flow at the end of this step (-).
    pub now: f64,
    /// Length of the last step; 0 for backward Euler (s).
    pub before: f64,
}

impl Differences {
    /// Backward Euler, of first order.
    pub const EULER: Self = Self {
        last: 0.0,
        now: 1.0,
        before: 0.0,
    };

    /// Returns the second-order coefficients for a step `dt` after a step `before` (s); backward Euler if the ratio
    /// exceeds [`LONGEST`].
    pub fn of_second_order(dt: f64, before: f64) -> Self {
        let ratio = dt / before;
        if ratio <= LONGEST {
            Self {
                last: ratio * ratio / (1.0 + 2.0 * ratio),
                now: (1.0 + ratio) / (1.0 + 2.0 * ratio),
                before,
            }
        } else {
            Self::EULER
        }
    }

    /// Returns the coefficients of the step `interval` after the flow `before` of the last step, if any.
    pub fn of<K, const D: usize>(
        model: &Model<K, D>,
        points: &Points<D>,
        before: Option<&PreviousFlow>,
        interval: TimeInterval,
    ) -> Self {
        let goes_on = is_smooth(model) && points.content_change.is_some() && !turns(model, interval);
        before.filter(|_| goes_on).map_or(Self::EULER, |flowed| {
            Self::of_second_order(interval.end() - interval.start, flowed.dt)
        })
    }

    /// Returns the equivalent rate of the step `interval` for a prescribed `rate`. With it the total inflow equals the
    /// integral of `rate`, whatever its course.
    pub fn of_rate(&self, rate: &Course, interval: TimeInterval) -> f64 {
        let before = self.last * rate.integral(interval.start - self.before, interval.start);
        (rate.integral(interval.start, interval.end()) - before) / (self.now * interval.dt)
    }
}

/// Returns whether a condition that drives the flow changes abruptly in a step. The last step then gives no
/// information.
fn turns<K, const D: usize>(model: &Model<K, D>, interval: TimeInterval) -> bool {
    let of_water = model.water.as_ref().is_some_and(|water| {
        water.ambient.turns(interval) || water.flow.as_ref().is_some_and(|flow| flow.turns(interval))
    });
    of_water || model.boundary.turns(interval)
}

/// Returns whether the flow is smooth from step to step: quasi-static, permeable, fully saturated, and without seepage
/// faces or runoff.
pub fn is_smooth<K, const D: usize>(model: &Model<K, D>) -> bool {
    let Some(flow) = model.water.as_ref().and_then(|water| water.flow.as_ref()) else {
        return false;
    };
    let lets_through = flow.soils.iter().flatten().any(|soil| soil.permeability.is_some());
    let flows = lets_through && flow.motion == Motion::Flows;
    model.regime == Regime::QuasiStatic && flows && !flow.retains() && !flow.is_one_way()
}

#[cfg(test)]
mod tests {
    use super::Differences;
    use crate::field::pore_water::flow::Course;
    use crate::schedule::TimeInterval;

    #[test]
    fn they_are_exact_of_a_parabola_on_steps_of_any_length() {
        let zeta = |t: f64| 3.0 - 2.0 * t + 0.7 * t * t;
        for (before, dt) in [(1.0, 1.0), (0.4, 0.5), (2.0, 0.1), (1e-3, 1.5e-3)] {
            let Differences { last, now, .. } = Differences::of_second_order(dt, before);
            let [first, second, third] = [0.3, 0.3 + before, 0.3 + before + dt].map(zeta);
            let rate = -2.0 + 1.4 * (0.3 + before + dt);
            let error = third - second - last * (second - first) - now * dt * rate;
            assert!(error.abs() < 1e-15, "{before} {dt} {error:e}");
        }
        assert_eq!(Differences::of_second_order(2.0, 1.0), Differences::EULER);
    }

    #[test]
    fn all_that_has_come_in_is_the_integral_of_a_rate_on_steps_of_any_length() {
        let rate = Course(vec![(1.0, 0.0), (2.0, 3.0), (2.1, -1.0), (4.0, 0.5)]);
        let mut t = 0.0;
        let mut before = [0.0, 0.0];
        let mut inward = 0.0;
        for dt in [0.7, 1.0, 0.31, 0.4, 0.6, 1.5, 0.5] {
            let of = if before[0] > 0.0 {
                Differences::of_second_order(dt, before[0])
            } else {
                Differences::EULER
            };
            let step = of.last * before[1] + of.now * dt * of.of_rate(&rate, TimeInterval { start: t, dt });
            (t, before, inward) = (t + dt, [dt, step], inward + step);
            assert!((inward - rate.integral(0.0, t)).abs() < 1e-14, "{t} {inward}");
        }
        // Triangles and trapezia by hand, and 0.5 from the last row on.
        assert!((rate.integral(0.0, 5.0) - (1.5 + 0.1 - 0.475 + 0.5)).abs() < 1e-14);
    }
}
