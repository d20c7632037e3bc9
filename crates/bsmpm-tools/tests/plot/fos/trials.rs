//! Tests that parallel jobs do not change a search.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process, test_kill_process};
use serde_json::Value;

use super::{Bench, SLOPE, text};

#[test]
fn trials_that_are_there_are_kept_until_something_changes() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    let made = |options: &[&str]| {
        let before = bench.calls();
        assert!(bench.fos_with("1", options).status.success());
        bench.calls() - before
    };
    let all = made(&[]);
    assert_eq!(made(&[]), 0);
    // A narrower band takes what is there.
    assert!((1..all).contains(&made(&["--width", "0.01"])));
    // A trial that was broken off.
    let manifest = bench.path("slope.fos/trials/0.5.out/run.json");
    let whole = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, whole.replace("\"exit_code\": 0", "\"exit_code\": null")).unwrap();
    assert_eq!((made(&[]), made(&[]), made(&["--force"])), (1, 0, all));
    bench.write(
        "slope.toml",
        &SLOPE.replace("cohesion       = \"10 kPa\"", "cohesion       = \"11 kPa\""),
    );
    assert_eq!((made(&[]), made(&["--set", "stabilisation.method=none"])), (all, all));
}

#[test]
fn the_number_of_jobs_changes_the_clock_and_nothing_else() {
    for (behaviour, numbers) in [("kink=1.373", ["2", "4"]), ("kink=1.373 stops=1.45", ["3", "8"])] {
        let bench = Bench::new(SLOPE, behaviour);
        let found = |jobs: &str| {
            let output = bench.fos_with(jobs, &["--force"]);
            assert!(output.status.success(), "{output:?}");
            let mut found = bench.found();
            assert_eq!(found["jobs"].to_string(), jobs);
            without_times(&mut found);
            let reported: Vec<String> = text(&output.stderr).lines().map(without_seconds).collect();
            (found, reported, fs::read(bench.path("slope.fos/fos.png")).unwrap())
        };
        let alone = found("1");
        assert!(alone.0["trials"].as_array().unwrap().len() == alone.1.len());
        for jobs in numbers {
            assert!(found(jobs) == alone, "{behaviour}, {jobs} jobs");
        }
        // All of them are there now.
        let before = bench.calls();
        assert!(bench.fos_with("4", &[]).status.success());
        assert_eq!(bench.calls(), before);
    }
}

#[test]
fn a_search_that_is_asked_to_end_takes_its_runs_along() {
    let bench = Bench::new(SLOPE, "kink=1.373 lasts=0.1");
    let mut search = bench.command("2", &[]).spawn().unwrap();
    let pids = || fs::read_to_string(bench.path("pids")).unwrap_or_default();
    let begun = Instant::now();
    while pids().lines().count() < 2 || !pids().ends_with('\n') {
        assert!(search.try_wait().unwrap().is_none(), "it ended by itself");
        assert!(begun.elapsed() < Duration::from_secs(120), "two trials have not begun");
        thread::sleep(Duration::from_millis(10));
    }
    kill_process(Pid::from_child(&search), Signal::TERM).unwrap();
    assert_eq!(search.wait().unwrap().signal(), Some(Signal::TERM.as_raw()));
    for pid in pids().lines() {
        let pid = Pid::from_raw(pid.parse().unwrap()).unwrap();
        assert!(test_kill_process(pid).is_err(), "{pid:?} goes on");
    }
}

/// Takes out of what was found all that the clock and the number of jobs may change.
fn without_times(found: &mut Value) {
    let object = found.as_object_mut().unwrap();
    object.remove("jobs").zip(object.remove("seconds")).unwrap();
    for trial in object["trials"].as_array_mut().unwrap() {
        let trial = trial.as_object_mut().unwrap();
        trial.remove("seconds").zip(trial.remove("cpu_seconds")).unwrap();
    }
}

/// A line of a trial without its seconds.
fn without_seconds(line: &str) -> String {
    line.split(", ").filter(|part| !part.ends_with(" s")).collect()
}
