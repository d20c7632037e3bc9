//! Tests of the log at a terminal, in a batch job and as JSON.

use crate::support::cases::{COLUMN, endless};
use crate::support::results::manifest;
use crate::support::{Output, Scratch, program};
use serde_json::Value;
use std::process::{Command, Stdio};

/// Makes the first step fail, in several attempts.
const HARD: [&str; 6] = [
    "--set",
    "solver.nonlinear=broyden",
    "--set",
    "solver.max_iterations=1",
    "--set",
    "solver.tolerance=1e-15",
];

fn steps_reported(output: &Output) -> Vec<u64> {
    let number = |line: &str| line.strip_prefix("step ")?.split_whitespace().next()?.parse().ok();
    output.stderr.lines().filter_map(number).collect()
}

/// Lines of progress.
fn progress(text: &str) -> usize {
    text.matches(" elapsed, about ").count()
}

/// What a command prints on a terminal, and its exit code.
fn at_a_terminal(scratch: &Scratch, line: &str) -> (String, Option<i32>) {
    let mut command = Command::new("script");
    command
        .args(["--quiet", "--return", "--command", line, "/dev/null"])
        .current_dir(scratch.path(""));
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("TERM", "xterm");
    let output = command.stdin(Stdio::null()).output().unwrap();
    (
        String::from_utf8_lossy(&output.stdout).into_owned(),
        output.status.code(),
    )
}

#[test]
fn a_short_run_without_a_terminal_prints_its_summary_from_one_rank() {
    for ranks in [1, 2, 3] {
        let scratch = Scratch::with_case(COLUMN);
        let output = scratch.mpirun(ranks, &["case.toml"]).expect(0);
        output.says_once("Finished at t = 1: 5 steps in ");
        output.says_once("Results: case.out");
        output.says_once("`bsmpm plot case.out`");
        assert_eq!(output.stdout, "");
        assert_eq!(output.stderr.lines().count(), 3, "{output:#?}");
        assert!(
            !output.stderr.contains('\u{1b}') && !output.stderr.contains('\r'),
            "no terminal: {output:#?}"
        );
    }
}

/// A line after 10 s, and the next one after two minutes more.
#[test]
fn a_batch_job_prints_a_line_now_and_then() {
    let scratch = Scratch::with_case(&endless());
    let output = scratch.mpirun(2, &["case.toml", "--max-wall", "00:00:14"]).expect(75);
    assert_eq!(
        (progress(&output.stderr), steps_reported(&output).len()),
        (1, 0),
        "{output:#?}"
    );
    output.says_once("stopped by --max-wall");
}

#[test]
fn a_terminal_shows_one_line_that_is_overwritten_also_through_mpirun() {
    let direct = format!("'{}' case.toml --force --max-steps 400", program());
    for line in [direct.clone(), format!("mpirun --oversubscribe -n 2 {direct}")] {
        let scratch = Scratch::with_case(&endless());
        let (text, code) = at_a_terminal(&scratch, &line);
        assert_eq!(code, Some(75), "{text}");
        let drawn: Vec<&str> = text.split("\u{1b}[K\r").filter(|part| progress(part) > 0).collect();
        assert!(
            drawn.iter().all(|part| !part.contains('\n') && part.len() < 80),
            "{text}"
        );
        assert!(!drawn.is_empty() && drawn.last().unwrap().contains("step "), "{text}");
        assert!(
            text.contains("Stopped at t = ") && text.contains("To continue: "),
            "{text}"
        );
        let (off, _) = at_a_terminal(&scratch, &format!("{line} --progress off"));
        assert_eq!(progress(&off), 0, "{off}");
        let (dumb, _) = at_a_terminal(&scratch, &format!("TERM=dumb {line}"));
        assert!(!dumb.contains('\u{1b}'), "{dumb}");
    }
}

#[test]
fn quiet_keeps_warnings_and_why_a_run_does_not_end_well() {
    let scratch = Scratch::with_case(COLUMN);
    assert_eq!(scratch.mpirun(2, &["case.toml", "-q"]).expect(0).said(), "");
    scratch.mpirun(2, &["case.toml", "-q", "-v"]).expect(2);
    let output = scratch
        .mpirun(2, &[&["case.toml", "-q", "--force"], &HARD[..]].concat())
        .expect(80);
    let lines: Vec<&str> = output.stderr.lines().collect();
    assert!(
        lines.len() == 2 && lines[0].starts_with("bsmpm-par: error E0747: "),
        "the error and its place: {output:#?}"
    );
    let warned = ["case.toml", "-q", "--force", "--", "-ksp_typ", "cg"];
    scratch.mpirun(2, &warned).expect(0).says_once("warning W0701: ");
    let stopped = scratch
        .mpirun(2, &["case.toml", "-q", "--force", "--max-steps", "2"])
        .expect(75);
    assert_eq!(stopped.stderr.lines().count(), 1, "{stopped:#?}");
    stopped.says_once("stopped by --max-steps");
}

#[test]
fn verbose_prints_every_step_and_twice_verbose_every_rejected_attempt() {
    let scratch = Scratch::with_case(COLUMN);
    for arguments in [["-v", "--force"], ["-vv", "--force"]] {
        let verbose = scratch.mpirun(2, &[&["case.toml"], &arguments[..]].concat()).expect(0);
        assert_eq!(steps_reported(&verbose), [1, 2, 3, 4, 5]);
        verbose.says_once("Indicators: ");
        verbose.says_once("Cost: ");
    }
    let rejected = |how: &str| {
        let arguments = [&["case.toml", "--force", how], &HARD[..]].concat();
        scratch
            .mpirun(2, &arguments)
            .expect(80)
            .count("attempt rejected: E0747: ")
    };
    assert_eq!(rejected("-v"), 0);
    assert!(rejected("-vv") > 5);
    assert!(rejected("--log-format=json") > 5, "a log of JSON is complete");
}

/// The command that the log names, as a shell takes it.
#[test]
fn a_run_that_is_stopped_says_how_to_continue() {
    let scratch = Scratch::with_case(COLUMN);
    let set = "title=\"a 'b'\"";
    let arguments = ["case.toml", "-o", "a b", "--set", set, "--max-steps", "2"];
    for ranks in [None, Some(2)] {
        let stopped = scratch
            .job(ranks, &[&arguments[..], &["--force"]].concat())
            .run()
            .expect(75);
        let command = stopped.stderr.split_once("To continue: ").expect("a command").1.trim();
        assert!(command.ends_with("--restart auto"), "{command}");
        let shell = command
            .replace("bsmpm-par", program())
            .replace("mpirun", "mpirun --oversubscribe");
        let mut continued = Command::new("sh");
        continued
            .args(["-c", &shell])
            .current_dir(scratch.path(""))
            .stdin(Stdio::null());
        continued
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
        let output = continued.output().unwrap();
        assert!(output.status.success(), "{command}: {output:?}");
        let manifest = manifest(&scratch.path("a b"));
        assert_eq!(
            (manifest.summary.steps, manifest.restarts.len(), &*manifest.case.title),
            (5, 1, "a 'b'")
        );
    }
}

#[test]
fn a_json_log_is_one_object_a_line() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch.mpirun(2, &["case.toml", "--log-format", "json"]).expect(0);
    let lines: Vec<Value> = output
        .stderr
        .lines()
        .map(|line| serde_json::from_str(line).expect(line))
        .collect();
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
    output.says_once("W0661: output.every");
    let warnings = manifest(&scratch.path("case.out")).warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
}

/// A full disk or a reader that went away is no reason to fail, let alone to report a bug.
#[test]
fn streams_that_take_nothing_do_not_change_the_exit_code() {
    let scratch = Scratch::with_case(COLUMN);
    let code = |arguments: &[&str]| {
        scratch
            .job(None, &[&["case.toml"], arguments].concat())
            .unheard()
            .run()
            .code
    };
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
