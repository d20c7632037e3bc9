//! How water that flows is followed in time: by backward differences of second order on steps of any length, or by
//! backward Euler where the step before tells nothing of this one.
//!
//! `zeta - zeta^n - last (zeta^n - zeta^n-1) = now dt (what comes in under the pressure at the end)`, which is exact of
//! a zeta that is a parabola of time (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, III.5).

use crate::model::{Model, Regime};
use crate::points::Points;
use crate::water::flow::{Flow, Motion};

/// A step over the one before it, above which that tells nothing: the differences are stable below 1 + sqrt 2; steps
/// that were cut grow back by 2.
const LONGEST: f64 = 2.1;

/// What a step makes of the last one and of its own flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differences {
    /// -  part of what the last step took in that this one takes in, too
    pub last: f64,
    /// -  part of the step that flows at its end count for
    pub now: f64,
}

impl Differences {
    /// Backward Euler, of first order.
    pub const EULER: Self = Self { last: 0.0, now: 1.0 };

    /// Of second order, for a step of `dt` after one of `before`, s.
    pub fn of_second_order(dt: f64, before: f64) -> Self {
        let ratio = dt / before;
        if ratio <= LONGEST {
            Self { last: ratio * ratio / (1.0 + 2.0 * ratio), now: (1.0 + ratio) / (1.0 + 2.0 * ratio) }
        } else {
            Self::EULER
        }
    }

    /// Those of the model's step from `t` to `end`, s, by what the points carry.
    pub fn of<K, const D: usize>(model: &Model<K, D>, points: &Points<D>, (t, end): (f64, f64)) -> Self {
        let goes_on = |flow: &Flow<D>| is_smooth(model) && points.content_change.is_some() && !flow.turns((t, end));
        let flow = model.water.as_ref().and_then(|water| water.flow.as_ref()).filter(|flow| goes_on(flow));
        let before = flow.and(points.surface.flowed.as_ref());
        before.map_or(Self::EULER, |flowed| Self::of_second_order(end - t, flowed.dt))
    }
}

/// Whether the flow of a step tells of the next one's: not where pores fill, surfaces open and close, inertia makes
/// waves, or nothing flows.
pub fn is_smooth<K, const D: usize>(model: &Model<K, D>) -> bool {
    let flow = model.water.as_ref().and_then(|water| water.flow.as_ref());
    let flows = |flow: &Flow<D>| {
        let some = flow.soils.iter().flatten().any(|soil| soil.permeability.is_some());
        some && flow.motion == Motion::Flows
    };
    let is_smooth = |flow: &Flow<D>| flows(flow) && !flow.retains() && !flow.is_one_way();
    model.regime == Regime::QuasiStatic && flow.is_some_and(is_smooth)
}

#[cfg(test)]
mod tests {
    use super::Differences;

    #[test]
    fn they_are_exact_of_a_parabola_on_steps_of_any_length() {
        let zeta = |t: f64| 3.0 - 2.0 * t + 0.7 * t * t;
        for (before, dt) in [(1.0, 1.0), (0.4, 0.5), (2.0, 0.1), (1e-3, 2e-3)] {
            let Differences { last, now } = Differences::of_second_order(dt, before);
            let [first, second, third] = [0.3, 0.3 + before, 0.3 + before + dt].map(zeta);
            let rate = -2.0 + 1.4 * (0.3 + before + dt);
            let error = third - second - last * (second - first) - now * dt * rate;
            assert!(error.abs() < 1e-15, "{before} {dt} {error:e}");
        }
        assert_eq!(Differences::of_second_order(2.5, 1.0), Differences::EULER);
    }
}
