//! Estimates steps and disk space without a run.

use bsmpm_scene::model::{frame_times, schedule};
use bsmpm_scene::{Case, Every, Regime};
use serde::Serialize;

/// Nominal steps beyond which they are not counted one by one.
const COUNTED: f64 = 1e6;
/// Bytes of a point in a frame, in quasi-static analysis and in dynamics, where it has a velocity.
const FRAME: [u64; 2] = [147, 171];
/// Bytes of a point in a checkpoint, the same.
const CHECKPOINT: [u64; 2] = [272, 304];
/// Bytes of a point in a checkpoint where water flows, besides: pore pressure and its gradient.
const WET: u64 = 24;
/// Bytes of a row of `steps.csv` with its share of the log, and of a number of `history.csv`.
const ROW: [u64; 2] = [110, 20];

/// Bytes of what a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Bytes {
    /// of a frame
    pub frame: u64,
    /// of a checkpoint
    pub checkpoint: u64,
    /// of the tables, for each step
    pub step: u64,
}

impl Bytes {
    /// As they are known before anything was written.
    pub fn of(case: &Case) -> Self {
        let dynamic = usize::from(case.analysis.regime == Regime::Dynamic);
        let points = case.points();
        let numbers: u64 = case
            .histories
            .iter()
            .map(|history| history.columns().len() as u64)
            .sum();
        Self {
            frame: points * FRAME[dynamic],
            checkpoint: points * (CHECKPOINT[dynamic] + if case.flow.is_some() { WET } else { 0 }),
            step: ROW[0] + ROW[1] * numbers,
        }
    }
}

/// Nominal number of steps.
pub(super) fn steps(case: &Case) -> f64 {
    let whole = case.analysis.end / case.analysis.dt;
    if whole > COUNTED {
        return whole.ceil();
    }
    let schedule = schedule(case);
    std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).count() as f64
}

/// Frames in so many steps, those of the start and of the end among them.
pub(super) fn frames(case: &Case, steps: f64) -> u64 {
    let near = 1e-6 * case.analysis.dt;
    let mut times: Vec<f64> = frame_times(case)
        .into_iter()
        .filter(|&t| t < case.analysis.end - near)
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < near);
    let counted = match case.output.every {
        Some(Every::Steps(every)) => (steps / every as f64).floor() as u64,
        _ => 0,
    };
    let last = matches!(case.output.every, Some(Every::Steps(every)) if (steps % every as f64) == 0.0);
    1 + times.len() as u64 + counted + u64::from(!last)
}

/// Checkpoints that are there at the end of a run of so many steps and seconds.
pub(super) fn checkpoints(case: &Case, steps: f64, seconds: f64) -> u64 {
    let wanted = &case.output.checkpoint;
    let counted = wanted.every_steps.map_or(0.0, |every| steps / every as f64);
    let made = (seconds / wanted.wall).floor() + counted.floor();
    (made as u64)
        .saturating_add(u64::from(wanted.at_end))
        .min(wanted.keep.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_short_cases_are_counted() {
        let column = include_str!("../../../../cases/short/column_collapse.toml");
        let case = Case::from_text("column", column, &[]).unwrap();
        // At the start, every 20 ms, at six times of which one is such a one and one is the end.
        assert_eq!(
            (
                steps(&case),
                frames(&case, steps(&case)),
                checkpoints(&case, 1214.0, 60.0)
            ),
            (1214.0, 35, 0)
        );
        let set = ["output.checkpoint={ every_steps = 100, keep = 3 }".to_owned()];
        let case = Case::from_text("column", column, &set).unwrap();
        assert_eq!(checkpoints(&case, 1214.0, 60.0), 3);
        let slope = include_str!("../../../../cases/short/slope_stability.toml");
        let case = Case::from_text("slope", slope, &[]).unwrap();
        assert_eq!((steps(&case), frames(&case, 10.0)), (10.0, 11));
    }
}
