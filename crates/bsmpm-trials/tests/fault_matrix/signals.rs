//! Tests that signals and time limits stop a run, and that it continues without changed results.

use crate::ground::{Ground, INTERVAL, results, same, spread};
use crate::support::Running;
use crate::support::driver::Depth;
use crate::support::results::manifest;
use crate::table::{Tried, trials};
use bsmpm_io::manifest::Status;
use std::time::Instant;

/// Sends something that is to stop the run with that code; the seconds until it has stopped. No step is made twice
/// then.
fn stopped(ground: &Ground, step: u64, code: i32, send: impl Fn(&Running), variables: &[(&str, &str)]) -> f64 {
    let whole = ground.whole(2);
    let trial = ground.trial(2);
    let running = trial.under_way(step, spread(step as usize, 5), variables);
    let begun = Instant::now();
    send(&running);
    running.end().expect(code);
    let seconds = begun.elapsed().as_secs_f64();
    let left = manifest(&trial.directory());
    assert_eq!((left.status, left.exit_code), (Status::Stopped, Some(75)));
    assert_eq!(trial.becomes(&whole), 0, "steps are lost");
    seconds
}

/// A step in the first part of the run, so that it is not over when the signal arrives.
fn any_step(ground: &Ground, index: usize) -> u64 {
    1 + (spread(index, 4) * 0.6 * ground.whole(2).steps as f64) as u64
}

/// USR1 to the launcher.
pub fn usr1(ground: &Ground, count: usize) -> Tried {
    let one = |index| {
        stopped(
            ground,
            any_step(ground, index),
            75,
            |running: &Running| running.signal("USR1"),
            &[],
        )
    };
    let tried = trials(count, one);
    tried.figure(|seconds| format!("stopped after {seconds} s at most"))
}

/// USR1 to one rank only.
pub fn usr1_to_a_rank(ground: &Ground, count: usize) -> Tried {
    let one = |index| {
        let send = |running: &Running| running.signal_rank("USR1", index % 2);
        stopped(ground, any_step(ground, index), 75, send, &[])
    };
    trials(count, one).figure(|seconds| format!("stopped after {seconds} s at most"))
}

/// USR2, after which the run goes on; there is a frame more.
pub fn usr2(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(count, |index| {
        let trial = ground.trial(2);
        let step = 1 + (spread(index, 6) * 0.8 * whole.steps as f64) as u64;
        let running = trial.under_way(step, spread(index, 7), &[]);
        running.signal("USR2");
        running.end().expect(0);
        let found = results(&trial.directory());
        same(&found, &whole.results);
        trial.is_clean();
        (found.len() - whole.results.len()) as f64
    });
    tried.figure(|frames| format!("{frames} frame more at most"))
}

/// TERM to mpirun where it leaves the time: it waits a second before it signals the ranks, and another before it kills
/// them. Its own code is 1.
pub fn term(ground: &Ground, count: usize) -> Tried {
    let patient = [("OMPI_MCA_odls_base_sigkill_timeout", "1")];
    let soon = |index| 1 + (spread(index, 17) * 4.0) as u64;
    let tried = trials(count, |index| {
        stopped(ground, soon(index), 1, |running| running.signal("TERM"), &patient)
    });
    tried.figure(|seconds| format!("stopped after {seconds} s at most"))
}

/// TERM to mpirun that kills the ranks at once.
pub fn term_in_a_hurry(ground: &Ground, count: usize) -> Tried {
    let hasty = [("OMPI_MCA_odls_base_sigkill_timeout", "0")];
    abrupt(ground, count, &hasty, |running| running.signal("TERM"))
}

/// Two TERM to mpirun.
pub fn term_twice(ground: &Ground, count: usize) -> Tried {
    let hasty = [("OMPI_MCA_odls_base_sigkill_timeout", "0")];
    abrupt(ground, count, &hasty, |running| {
        running.signal("TERM");
        running.signal("TERM");
    })
}

fn abrupt(ground: &Ground, count: usize, variables: &[(&str, &str)], send: impl Fn(&Running)) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(count, |index| {
        let trial = ground.trial(2);
        let step = (spread(index, 8) * 0.9 * whole.steps as f64) as u64;
        let running = trial.under_way(step, spread(index, 9), variables);
        let begun = Instant::now();
        send(&running);
        running.end();
        let seconds = begun.elapsed().as_secs_f64();
        let lost = trial.becomes(&whole);
        assert!(lost <= INTERVAL, "{lost} steps are lost");
        seconds
    });
    tried.figure(|seconds| format!("gone after {seconds} s at most"))
}

/// A limit of time, again and again until the end: each time the job is over before its limit, and the time that it
/// takes to launch a program which does nothing. Two seconds at first, more where no step can be made in that.
pub fn max_wall(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let launching = ground
        .trial(2)
        .scratch
        .mpirun(2, &["--version"])
        .expect(0)
        .elapsed
        .as_secs_f64();
    let mut jobs = 0;
    let tried = trials(count, |_| {
        let trial = ground.trial(2);
        let mut limit = 2_u32;
        let mut over = f64::NEG_INFINITY;
        loop {
            let before = trial.made();
            let output = trial.start(&["--max-wall", &format!("00:00:{limit:02}")], &[]).end();
            jobs += 1;
            if output.code == Some(0) {
                break;
            }
            let seconds = output.elapsed.as_secs_f64();
            output.expect(75);
            over = over.max(seconds - launching - f64::from(limit));
            assert!(
                over <= 0.0,
                "{seconds} s for {limit} s, beside {launching} s to launch it"
            );
            limit += u32::from(trial.made() == before);
        }
        // On a fast machine the run may be over before; the whole case takes longer.
        assert!(
            over.is_finite() || ground.depth == Depth::Short,
            "the run was over before any limit"
        );
        trial.becomes(&whole);
        f64::from(limit)
    });
    tried.figure(|limit| format!("{jobs} jobs, the limits up to {limit} s"))
}
