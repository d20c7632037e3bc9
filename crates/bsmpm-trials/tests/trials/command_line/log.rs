//! The log: rank 0, stderr, one line a step.

use crate::support::cases::COLUMN;
use crate::support::{Output, Scratch};
use serde_json::Value;

fn steps_reported(output: &Output) -> Vec<u64> {
    let number = |line: &str| line.strip_prefix("step ")?.split_whitespace().next()?.parse().ok();
    output.stderr.lines().filter_map(number).collect()
}

#[test]
fn every_step_is_one_line_on_stderr_from_one_rank() {
    for ranks in [1, 2, 3] {
        let scratch = Scratch::with_case(COLUMN);
        let output = scratch.mpirun(ranks, &["case.toml"]).expect(0);
        assert_eq!(steps_reported(&output), [1, 2, 3, 4, 5], "{output:#?}");
        assert_eq!(output.stdout, "");
        assert_eq!(output.stderr.lines().count(), 7, "five steps, the end and the indicators: {output:#?}");
        assert!(!output.stderr.contains('\u{1b}') && !output.stderr.contains('\r'), "no bar without a terminal");
    }
}

#[test]
fn quiet_says_nothing_of_a_good_run() {
    let scratch = Scratch::with_case(COLUMN);
    assert_eq!(scratch.mpirun(2, &["case.toml", "-q"]).expect(0).said(), "");
    scratch.mpirun(2, &["case.toml", "-q", "-v"]).expect(2);
    let failing = [
        "--force",
        "--set",
        "solver.nonlinear=broyden",
        "--set",
        "solver.max_iterations=1",
        "--set",
        "solver.tolerance=1e-15",
    ];
    let output = scratch.mpirun(2, &[&["case.toml", "-q"], &failing[..]].concat()).expect(80);
    assert_eq!(output.stderr.lines().count(), 1, "an error is said all the same: {output:#?}");
}

#[test]
fn verbose_says_more() {
    let scratch = Scratch::with_case(COLUMN);
    let plain = scratch.mpirun(2, &["case.toml"]).expect(0);
    let verbose = scratch.mpirun(2, &["case.toml", "-v", "--force"]).expect(0);
    assert!(verbose.stderr.lines().count() > plain.stderr.lines().count(), "{verbose:#?}");
    assert_eq!(steps_reported(&verbose), [1, 2, 3, 4, 5]);
}

#[test]
fn a_json_log_is_one_object_a_line() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch.mpirun(2, &["case.toml", "--log-format", "json"]).expect(0);
    let lines: Vec<Value> = output.stderr.lines().map(|line| serde_json::from_str(line).expect(line)).collect();
    let steps: Vec<&Value> = lines.iter().filter(|line| line["event"] == "step").collect();
    let numbers: Vec<u64> = steps.iter().map(|line| line["step"].as_u64().unwrap()).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 5]);
    for key in ["time", "dt", "iterations", "residual", "wall"] {
        assert!(steps.iter().all(|line| line[key].is_number()), "{key}: {steps:?}");
    }
    assert_eq!(output.stdout, "");
}

#[test]
fn warnings_of_the_case_are_reported_once_and_kept() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch.mpirun(2, &["case.toml", "--set", "output.every=2"]).expect(0);
    output.says_once("beyond the end of the run");
    let warnings = crate::support::results::manifest(&scratch.path("case.out")).warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
}

/// A full disk or a reader that went away is no reason to fail, let alone to report a bug.
#[test]
fn streams_that_take_nothing_do_not_change_the_exit_code() {
    let scratch = Scratch::with_case(COLUMN);
    let code = |arguments: &[&str]| scratch.job(None, &[&["case.toml"], arguments].concat()).unheard().run().code;
    assert_eq!(code(&[]), Some(0));
    assert_eq!(code(&["--check"]), Some(0));
    assert_eq!(code(&["--set", "grid.cell=-1"]), Some(65));
    assert_eq!(code(&["--nonsense"]), Some(2));
    assert_eq!(code(&["--max-memory", "1kB"]), Some(71));
    assert_eq!(code(&[]), Some(73));
    assert_eq!(
        code(&[
            "--force",
            "--set",
            "solver.nonlinear=broyden",
            "--set",
            "solver.max_iterations=1",
            "--set",
            "solver.tolerance=1e-15"
        ]),
        Some(80)
    );
}
