//! Tests that a signal to any process stops all ranks.

use crate::support::cases::{COLUMN, endless, long_step};
use crate::support::results::{all_finite, all_frames, history, last_frame, manifest, steps};
use crate::support::{Running, Scratch};
use bsmpm_io::manifest::Status;
use std::time::Duration;

/// s  Far more than anything here takes that is not to go on for ever.
const HANGS: u64 = 60;

/// Whom a signal reaches.
#[derive(Clone, Copy, Debug)]
enum To {
    Launcher,
    Rank(usize),
}

impl To {
    #[track_caller]
    fn send(self, name: &str, running: &Running) {
        match self {
            Self::Launcher => running.signal(name),
            Self::Rank(rank) => running.signal_rank(name, rank),
        }
    }
}

/// Steps that the run in `case.out` has reported so far.
fn made(scratch: &Scratch) -> usize {
    let text = std::fs::read_to_string(scratch.path("case.out/steps.csv")).unwrap_or_default();
    text.lines().count().saturating_sub(2)
}

/// A run that has made a few steps, in a new directory.
fn under_way(scratch: &Scratch, ranks: Option<usize>) -> Running {
    let _ = std::fs::remove_dir_all(scratch.path("case.out"));
    let mut running = scratch.job(ranks, &["case.toml", "-v"]).within(HANGS).start();
    running.until("its tenth step", || made(scratch) >= 10);
    running.until("the frame of the start", || {
        scratch.path("case.out/frames.pvd").exists()
    });
    running
}

/// What a run that was stopped must have left: all of its last converged state, and nothing beyond.
#[track_caller]
fn stopped(scratch: &Scratch) {
    let directory = scratch.path("case.out");
    all_finite(&directory);
    let manifest = manifest(&directory);
    assert_eq!((manifest.status, manifest.exit_code), (Status::Stopped, Some(75)));
    assert_eq!(manifest.failure, None);
    let steps = steps(&directory);
    let history = history(&directory);
    let last = *steps.get("step").unwrap().last().unwrap();
    assert_eq!(manifest.summary.steps as f64, last);
    assert_eq!(*history.get("step").unwrap().last().unwrap(), last);
    assert_eq!(
        manifest.summary.iterations as f64,
        steps.get("iterations").unwrap().iter().sum::<f64>()
    );
    assert_eq!(
        last_frame(&directory).step as f64,
        last,
        "the last state is in the last frame"
    );
    assert!(!scratch.path("case.out/.lock").exists());
}

#[test]
fn usr1_to_any_process_stops_all_ranks_at_one_state_with_75() {
    let scratch = Scratch::with_case(&endless());
    let ways = [
        (None, To::Launcher),
        (Some(1), To::Launcher),
        (Some(2), To::Launcher),
        (Some(2), To::Rank(0)),
        (Some(2), To::Rank(1)),
        (Some(3), To::Rank(2)),
    ];
    for (ranks, to) in ways {
        let running = under_way(&scratch, ranks);
        to.send("USR1", &running);
        running.end().expect(75).says_once("The run was stopped by a signal");
        stopped(&scratch);
    }
}

#[test]
fn term_and_int_stop_as_usr1_does() {
    let scratch = Scratch::with_case(&endless());
    for name in ["TERM", "INT"] {
        for (ranks, to) in [(None, To::Launcher), (Some(2), To::Rank(1))] {
            let running = under_way(&scratch, ranks);
            to.send(name, &running);
            let output = running.end().expect(75);
            output.says_once("The run was stopped by a signal (Ctrl-C or kill).");
            output.says_once("case.toml --restart auto");
            stopped(&scratch);
        }
    }
}

/// The state is the one before the step, which is given up within one of its thousands of iterations.
#[test]
fn a_step_that_takes_long_is_given_up() {
    for (ranks, to) in [(None, To::Launcher), (Some(2), To::Rank(1))] {
        let scratch = Scratch::with_case(&long_step());
        let mut running = scratch.job(ranks, &["case.toml"]).within(HANGS).start();
        running.until("its second step", || made(&scratch) == 2);
        std::thread::sleep(Duration::from_millis(500)); // into the third
        to.send("USR1", &running);
        running.end().expect(75);
        stopped(&scratch);
        assert_eq!(made(&scratch), 2);
    }
}

#[test]
fn usr2_writes_a_frame_and_a_checkpoint_and_changes_nothing_else() {
    let scratch = Scratch::with_case(&endless());
    for (ranks, to) in [(None, To::Launcher), (Some(2), To::Launcher), (Some(2), To::Rank(1))] {
        let mut running = under_way(&scratch, ranks);
        assert_eq!(all_frames(&scratch.path("case.out")).len(), 1, "that of the start");
        to.send("USR2", &running);
        let frames = || std::fs::read_dir(scratch.path("case.out/frames")).unwrap().count();
        running.until("a frame", || frames() > 1);
        let then = made(&scratch);
        running.until("more steps", || made(&scratch) > then + 10);
        to.send("USR1", &running);
        let output = running.end().expect(75);
        stopped(&scratch);
        let directory = scratch.path("case.out");
        let count = output.count("Writing a frame and a checkpoint");
        assert_eq!(
            all_frames(&directory).len(),
            2 + count,
            "start, on request, end: {output:#?}"
        );
        assert_eq!(
            output.count("Checkpoint of step"),
            1 + count,
            "on request, end: {output:#?}"
        );
        let interrupted = history(&directory);
        let last = interrupted.get("step").unwrap().last().unwrap().to_string();
        let whole = ["case.toml", "-q", "-o", "whole", "--force", "--max-steps", &last];
        scratch.job(ranks, &whole).run().expect(75);
        assert_eq!(interrupted.values, history(&scratch.path("whole")).values, "to the bit");
    }
}

/// mpirun waits so long before TERM, as long again before KILL, and reads no words meanwhile; its own code is 1 then.
#[test]
fn term_to_mpirun_stops_cleanly_where_it_leaves_the_time_and_spoils_nothing_where_it_does_not() {
    for (seconds, is_enough) in [("5", true), ("1", false), ("0", false)] {
        let scratch = Scratch::with_case(&endless());
        let job = scratch.job(Some(2), &["case.toml", "-q"]).within(HANGS);
        let mut running = job.variable("OMPI_MCA_odls_base_sigkill_timeout", seconds).start();
        running.until("its tenth step", || made(&scratch) >= 10);
        running.signal("TERM");
        running.end().expect(1);
        if is_enough {
            stopped(&scratch);
        }
        let directory = scratch.path("case.out");
        assert!([Status::Stopped, Status::Running].contains(&manifest(&directory).status));
        assert!(!all_frames(&directory).is_empty());
        scratch
            .mpirun(2, &["case.toml", "-q", "--force", "--max-steps", "1"])
            .expect(75);
    }
}

/// The first one cannot be agreed on while another rank stands still; the second does what it does to any program.
#[test]
fn a_second_term_or_int_ends_a_run_at_once() {
    let scratch = Scratch::with_case(&endless());
    for (first, second, code) in [("TERM", "TERM", 143), ("INT", "TERM", 143), ("TERM", "INT", 130)] {
        let running = under_way(&scratch, Some(2));
        running.signal_rank("STOP", 1);
        running.signal_rank(first, 0);
        std::thread::sleep(Duration::from_millis(200)); // two of a kind count as one until the first is taken
        running.signal_rank(second, 0);
        running.end().expect(code);
        assert_eq!(manifest(&scratch.path("case.out")).status, Status::Running);
    }
    let running = under_way(&scratch, None);
    ["STOP", "INT", "TERM", "CONT"]
        .into_iter()
        .for_each(|name| running.signal(name));
    assert_eq!(running.end().code, None, "ended by a signal");
    let running = under_way(&scratch, Some(2));
    running.signal("TERM");
    running.signal("TERM");
    running.end();
    scratch
        .mpirun(2, &["case.toml", "-q", "--force", "--max-steps", "1"])
        .expect(75);
}

/// A reader that goes away, as `head` does, costs the run nothing but its words.
#[test]
fn a_run_whose_words_nobody_reads_any_more_goes_on_to_the_same_end() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.job(None, &["case.toml", "-o", "heard"]).run().expect(0);
    scratch.job(None, &["case.toml"]).abandoned().run().expect(0);
    let heard = scratch.path("heard");
    let alone = scratch.path("case.out");
    assert_eq!(history(&heard).values, history(&alone).values);
    assert_eq!(last_frame(&heard), last_frame(&alone));
    assert_eq!(manifest(&alone).status, Status::Finished);
}
