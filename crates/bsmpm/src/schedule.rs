//! Where the nominal steps end: multiples of dt from the last wanted time, and every wanted time exactly; and what is
//! given by rows at times, so that a cut step follows the same course.

use std::ops::{Add, Mul, Sub};

/// Steps this much too long or too short (relative to dt) are taken as hitting a wanted time.
const SAME: f64 = 1e-6;

/// What rows of a time, increasing, and a value have at time `t` >= 0: linear between them, from `start` at time 0 to
/// the first; `None` after the last.
pub fn between<T>(rows: &[(f64, T)], start: T, t: f64) -> Option<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    let next = rows.partition_point(|(time, _)| *time < t);
    let before = if next == 0 { (0.0, start) } else { rows[next - 1] };
    let after = rows.get(next)?;
    let is_later = after.0 > before.0;
    Some(if is_later { before.1 + (after.1 - before.1) * ((t - before.0) / (after.0 - before.0)) } else { after.1 })
}

/// Nominal step, end of the run, and the times that must be hit exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    dt: f64,
    wanted: Vec<f64>, // ascending, the last one is the end
}

impl Schedule {
    /// Nominal step `dt`, end of the run and further times to be hit; those outside (0, end) are ignored.
    pub fn new(dt: f64, end: f64, times: impl IntoIterator<Item = f64>) -> Self {
        let mut wanted: Vec<f64> = times.into_iter().filter(|t| *t > 0.0 && *t < end - SAME * dt).collect();
        wanted.push(end);
        wanted.sort_by(f64::total_cmp);
        wanted.dedup_by(|later, earlier| (*later - *earlier) < SAME * dt);
        Self { dt, wanted }
    }

    /// End of the run.
    pub fn end(&self) -> f64 {
        self.wanted[self.wanted.len() - 1]
    }

    /// Nominal step.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// End of the nominal step that starts at `t`; `None` once the end is reached. A function of `t` alone, so that a
    /// restarted run takes the same steps.
    pub fn next(&self, t: f64) -> Option<f64> {
        let reached = self.wanted.partition_point(|&wanted| wanted <= t + SAME * self.dt);
        let target = *self.wanted.get(reached)?;
        let from = if reached == 0 { 0.0 } else { self.wanted[reached - 1] };
        let steps = ((t - from) / self.dt + SAME).floor() + 1.0;
        let station = from + steps * self.dt;
        Some(if station > target - SAME * self.dt { target } else { station })
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
    fn a_wanted_time_between_two_steps_shortens_one() {
        assert_eq!(stations(&Schedule::new(1.0, 3.0, [1.25])), [1.0, 1.25, 2.25, 3.0]);
    }
}
