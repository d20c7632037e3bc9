//! Tests of runs with killed processes.

use crate::ground::{Ground, INTERVAL, spread};
use crate::support::Running;
use crate::table::{Tried, trials};
use std::time::Instant;

/// s  within which a job whose rank was killed is gone
const GONE: f64 = 10.0;

/// Kills, waits for the end, and lets the run go on: the seconds that the end took.
fn killed(ground: &Ground, index: usize, code: Option<i32>, kill: impl Fn(&Running)) -> f64 {
    let whole = ground.whole(2);
    let trial = ground.trial(2);
    let step = (spread(index, 1) * 0.95 * whole.steps as f64) as u64;
    let running = trial.under_way(step, spread(index, 2), &[]);
    let begun = Instant::now();
    kill(&running);
    let output = running.end();
    let seconds = begun.elapsed().as_secs_f64();
    assert!(seconds <= GONE, "{seconds} s");
    assert!(code.is_none() || output.code == code, "{output:?}");
    let lost = trial.becomes(&whole);
    assert!(lost <= INTERVAL, "{lost} steps are lost");
    seconds
}

/// One of the ranks.
pub fn rank(ground: &Ground, count: usize) -> Tried {
    let tried = trials(count, |index| {
        killed(ground, index, Some(137), |running| {
            running.signal_rank("KILL", index % 2)
        })
    });
    tried.figure(|seconds| format!("dead after {seconds} s at most"))
}

/// The launcher, whose ranks are on their own then.
pub fn launcher(ground: &Ground, count: usize) -> Tried {
    let tried = trials(count, |index| {
        killed(ground, index, None, |running| running.signal("KILL"))
    });
    tried.figure(|seconds| format!("gone after {seconds} s at most"))
}

/// Launcher and ranks at once.
pub fn all(ground: &Ground, count: usize) -> Tried {
    let tried = trials(count, |index| killed(ground, index, None, Running::kill));
    tried.figure(|seconds| format!("gone after {seconds} s at most"))
}

/// The rank that writes, in each phase of a checkpoint: `count` times nine.
pub fn writer(ground: &Ground, count: usize) -> Tried {
    let phases = [
        "opened",
        "midway",
        "written",
        "closed",
        "synced",
        "recorded",
        "named",
        "committed",
        "kept",
    ];
    let whole = ground.whole(2);
    let tried = trials(count * phases.len(), |index| {
        let phase = phases[index % phases.len()];
        let round = index / phases.len();
        let step = INTERVAL * (2 + round as u64 % (whole.steps / INTERVAL - 1));
        let trial = ground.trial(2);
        let fault = format!("kill:phase={phase},step={step}");
        trial.start(&[], &[("BSMPM_FAULT", &fault)]).end().expect(137);
        trial.becomes(&whole);
        let usable = if ["committed", "kept"].contains(&phase) {
            step
        } else {
            step - INTERVAL
        };
        assert_eq!(trial.resumed_from(), usable, "{phase}");
        (step - usable) as f64
    });
    tried.figure(|lost| format!("{lost} steps are lost at most"))
}

/// A panic on the first and on the last rank.
pub fn panic(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(count, |index| {
        let rank = index % 2;
        let step = 1 + (spread(index, 3) * 0.9 * whole.steps as f64) as u64;
        let trial = ground.trial(2);
        let begun = Instant::now();
        let output = trial
            .start(&[], &[("BSMPM_FAULT", &format!("panic:rank={rank},step={step}"))])
            .end()
            .expect(70);
        output.says_once(&format!("panic on rank {rank}"));
        let lost = trial.becomes(&whole);
        assert!(lost <= INTERVAL, "{lost} steps are lost");
        begun.elapsed().as_secs_f64() - whole.seconds
    });
    tried.figure(|_| "code 70, one message".to_owned())
}
