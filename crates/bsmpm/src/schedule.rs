//! End times of the nominal steps, which include every output time, and interpolation of tables over time.

use std::ops::{Add, Mul, Sub};

/// Relative tolerance (of dt) within which a step ends at a wanted time.
const SAME: f64 = 1e-6;

/// The time interval of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeInterval {
    /// Time at the start of the step (s).
    pub start: f64,
    /// Step size (s).
    pub dt: f64,
}

impl TimeInterval {
    /// Returns the time at the end of the step (s).
    pub fn end(&self) -> f64 {
        self.start + self.dt
    }
}

/// A time (s, or pseudo-time) and the value given for it.
pub type Row<T> = (f64, T);

/// Interpolates `rows` of increasing times linearly at time `t` >= 0, with the value `start` at time 0. `None` after
/// the last row.
pub fn between<T>(rows: &[Row<T>], start: T, t: f64) -> Option<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    let next = rows.partition_point(|(time, _)| *time < t);
    let before = if next == 0 { (0.0, start) } else { rows[next - 1] };
    let after = rows.get(next)?;
    let is_later = after.0 > before.0;
    Some(if is_later {
        before.1 + (after.1 - before.1) * ((t - before.0) / (after.0 - before.0))
    } else {
        after.1
    })
}

/// Returns whether the interpolated value turns sharply in a step, including its start and excluding its end: the slope
/// changes by more than half of the steeper slope. `rows` and `start` as in [`between`]; the last value is kept
/// afterwards.
pub fn turns<T>(rows: &[Row<T>], start: T, size: impl Fn(T) -> f64, interval: TimeInterval) -> bool
where
    T: Copy + Sub<Output = T> + Mul<f64, Output = T>,
{
    let end = interval.end();
    let slack = SAME * (end - interval.start);
    let times = interval.start - slack..end - slack;
    for (k, &row) in rows.iter().enumerate().filter(|(_, row)| times.contains(&row.0)) {
        let before = if k == 0 { (0.0, start) } else { rows[k - 1] };
        let comes = slope(before, row);
        let goes = slope(row, *rows.get(k + 1).unwrap_or(&(f64::MAX, row.1)));
        if size(goes - comes) > 0.5 * f64::max(size(comes), size(goes)) {
            return true;
        }
    }
    false
}

/// Returns the slope of the value from one row to the next.
fn slope<T>(from: Row<T>, to: Row<T>) -> T
where
    T: Sub<Output = T> + Mul<f64, Output = T>,
{
    (to.1 - from.1) * (to.0 - from.0).max(f64::MIN_POSITIVE).recip()
}

/// Growing steps that start from dt.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Ratio of a step to the previous one (-), above 1.
    pub factor: f64,
    /// Largest step, at least dt (s); infinite for unlimited growth.
    pub most: f64,
    /// Ascending times from which steps start with dt again (s).
    pub restarts: Vec<f64>,
}

impl Growth {
    /// Returns the last time at or before `t` at which steps start with dt (s).
    fn start(&self, t: f64, slack: f64) -> f64 {
        let begun = self.restarts.partition_point(|&start| start <= t + slack);
        begun.checked_sub(1).map_or(0.0, |last| self.restarts[last])
    }

    /// Returns the number of steps after which the largest step is reached, and their total time (s).
    fn bound(&self, dt: f64) -> (f64, f64) {
        (
            (self.most / dt).ln() / self.factor.ln(),
            (self.most - dt) / (self.factor - 1.0),
        )
    }

    /// Returns the real number of steps within `time` (s) from their start.
    fn steps(&self, dt: f64, time: f64) -> f64 {
        let (steps, bound) = self.bound(dt);
        if time > bound {
            return steps + (time - bound) / self.most;
        }
        (time * (self.factor - 1.0) / dt).ln_1p() / self.factor.ln()
    }

    /// Returns the time that `steps` steps take (s).
    fn time(&self, dt: f64, steps: f64) -> f64 {
        let (most, bound) = self.bound(dt);
        if steps > most {
            return bound + (steps - most) * self.most;
        }
        dt * (steps * self.factor.ln()).exp_m1() / (self.factor - 1.0)
    }
}

/// Nominal step, end of the run, and the times that steps must hit exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    dt: f64,
    growth: Option<Growth>,
    wanted: Vec<f64>, // ascending; the last one is the end
}

impl Schedule {
    /// Creates the schedule of the nominal step `dt`, the `end` of the run and further `times` to hit (s); times
    /// outside (0, end) are ignored.
    pub fn new(dt: f64, end: f64, times: impl IntoIterator<Item = f64>) -> Self {
        let mut wanted: Vec<f64> = times.into_iter().filter(|t| *t > 0.0 && *t < end - SAME * dt).collect();
        wanted.push(end);
        wanted.sort_by(f64::total_cmp);
        wanted.dedup_by(|later, earlier| (*later - *earlier) < SAME * dt);
        Self {
            dt,
            growth: None,
            wanted,
        }
    }

    /// Makes the steps grow. Between two wanted times there are as few steps as possible, none longer than the step
    /// there in the sequence dt, dt·factor, ... from the start or last restart. Each step is longer than the one before
    /// by the same factor, up to the largest step.
    pub fn growing(self, growth: Growth) -> Self {
        Self {
            growth: Some(growth),
            ..self
        }
    }

    /// Returns the end of the run (s).
    pub fn end(&self) -> f64 {
        self.wanted[self.wanted.len() - 1]
    }

    /// Returns the nominal step (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Returns the end of the nominal step that starts at `t` (s); `None` once the end is reached. Depends on `t`
    /// alone, so that a restarted run takes the same steps.
    pub fn next(&self, t: f64) -> Option<f64> {
        let reached = self.wanted.partition_point(|&wanted| wanted <= t + SAME * self.dt);
        let target = *self.wanted.get(reached)?;
        let from = if reached == 0 { 0.0 } else { self.wanted[reached - 1] };
        if let Some(growth) = &self.growth {
            return Some(self.grown(growth, t, from, target));
        }
        let steps = ((t - from) / self.dt + SAME).floor() + 1.0;
        let station = from + steps * self.dt;
        Some(if station > target - SAME * self.dt {
            target
        } else {
            station
        })
    }

    /// Returns the same between the wanted times `from` and `target`, for growing steps.
    fn grown(&self, growth: &Growth, t: f64, from: f64, target: f64) -> f64 {
        let start = growth.start(from, SAME * self.dt);
        let [first, last, now] = [from, target, t].map(|time| growth.steps(self.dt, time - start));
        let count = (last - first - SAME).ceil().max(1.0);
        let each = (last - first) / count;
        let done = ((now - first) / each + SAME).floor() + 1.0;
        if done >= count {
            target
        } else {
            start + growth.time(self.dt, first + done * each)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stations(schedule: &Schedule) -> Vec<f64> {
        std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).collect()
    }

    #[test]
    fn the_papers_collapse_takes_2428_steps_and_hits_its_frames() {
        let frames = [0.109, 0.235, 0.3, 0.351, 0.42, 0.607];
        let found = stations(&Schedule::new(0.25e-3, 0.607, frames));
        assert_eq!(found.len(), 2428);
        assert!(frames.iter().all(|frame| found.contains(frame)));
    }

    /// Each step over the one before it, the wanted times passed over.
    fn ratios(stations: &[f64]) -> Vec<f64> {
        let steps: Vec<f64> = std::iter::once(0.0)
            .chain(stations.iter().copied())
            .zip(stations)
            .map(|(from, to)| to - from)
            .collect();
        steps.windows(2).map(|pair| pair[1] / pair[0]).collect()
    }

    #[test]
    fn steps_grow_to_their_bound_and_hit_what_is_wanted() {
        let growth = Growth {
            factor: 1.2,
            most: 50.0,
            restarts: Vec::new(),
        };
        let schedule = Schedule::new(1.0, 1000.0, [100.0]).growing(growth);
        let found = stations(&schedule);
        assert!(found.contains(&100.0) && found.last() == Some(&1000.0));
        let longest = std::iter::once(&0.0)
            .chain(&found)
            .zip(&found)
            .map(|(from, to)| to - from)
            .fold(0.0, f64::max);
        assert!(
            (found[0] - 1.0).abs() < 0.1 && found[0] <= 1.0 + 1e-9 && longest <= 50.0 + 1e-9,
            "{found:?}"
        );
        // 100 = (1.2^16.7 - 1)/0.2: 17 steps; the bound of 50 is reached at 245, after 21.5 from the start.
        assert_eq!(found.iter().position(|&t| t == 100.0), Some(16));
        assert!(
            ratios(&found)[..15]
                .iter()
                .all(|ratio| *ratio > 1.15 && *ratio < 1.2 + 1e-9),
            "{:?}",
            ratios(&found)
        );
        assert_eq!(found.len(), 17 + 20);
    }

    #[test]
    fn growing_steps_are_a_function_of_time_alone() {
        let growth = |restarts: Vec<f64>| Growth {
            factor: 1.3,
            most: f64::INFINITY,
            restarts,
        };
        let schedule = Schedule::new(1e-3, 6.3e8, [86_400.0, 3e8]).growing(growth(Vec::new()));
        let found = stations(&schedule);
        assert!(
            found.len() < 120 && found.windows(2).all(|pair| pair[0] < pair[1]),
            "{}",
            found.len()
        );
        // From every one of them on, as from the start.
        for (k, &t) in found.iter().enumerate().take(found.len() - 1) {
            assert_eq!(schedule.next(t), Some(found[k + 1]));
        }
        let again = Schedule::new(1.0, 1e4, [5e3]).growing(growth(vec![5e3]));
        let found = stations(&again);
        let at = found.iter().position(|&t| t == 5e3).unwrap();
        let first = found[0];
        let after = found[at + 1] - 5e3;
        assert!(
            (after / first - 1.0).abs() < 0.3 && after <= 1.0 + 1e-9,
            "{first} {after}"
        );
    }

    #[test]
    fn rows_are_linear_between_and_tell_where_they_end() {
        let rows = [(0.0, 2.0), (1.0, 4.0), (3.0, 0.0)];
        assert_eq!(
            [0.0, 0.5, 1.0, 2.0, 3.0, 3.1].map(|t| between(&rows, 0.0, t)),
            [Some(2.0), Some(3.0), Some(4.0), Some(2.0), Some(0.0), None]
        );
        assert_eq!(between(&rows[1..], 0.0, 0.25), Some(1.0));
    }

    #[test]
    fn rows_turn_where_a_slope_changes_by_half_and_not_where_they_follow_a_curve() {
        let turn = |rows: &[(f64, f64)], start: f64, end: f64| {
            let interval = TimeInterval { start, dt: end - start };
            turns(rows, 0.0, f64::abs, interval)
        };
        let ramp = [(1.0, 2.0), (2.0, 3.2), (3.0, 3.2), (3.1, 9.0)];
        let found = [
            (0.0, 1.0),
            (1.0, 2.0),
            (1.5, 2.5),
            (2.0, 2.9),
            (2.2, 3.0),
            (3.0, 3.1),
            (3.1, 5.0),
            (3.2, 5.0),
        ];
        assert_eq!(
            found.map(|(start, end)| turn(&ramp, start, end)),
            [false, false, true, true, false, true, true, false]
        );
        // A row on the end of a step, but for round-off, is of the next one.
        assert!(!turn(&ramp, 1.0, 2.0 + 1e-15) && turn(&ramp, 2.0 + 1e-15, 2.5));
        let wave: Vec<(f64, f64)> = (0..=40).map(|k| f64::from(k) * 0.05).map(|t| (t, t.sin())).collect();
        assert!(!turn(&wave, 0.01, 1.3) && turn(&wave, 1.3, 1.7) && !turn(&wave, 1.7, 1.99));
        assert!(!turn(&[(0.0, 0.0), (0.0, 0.0)], 0.0, 1.0) && turn(&[(0.0, 1.0)], 0.0, 1.0));
    }

    #[test]
    fn a_wanted_time_between_two_steps_shortens_one() {
        assert_eq!(stations(&Schedule::new(1.0, 3.0, [1.25])), [1.0, 1.25, 2.25, 3.0]);
    }
}
