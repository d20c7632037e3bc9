//! `bsmpm validate`, with a stub for the solver: it hands out a run that was made before.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use crate::quasi_static::FOOTING;
use crate::still::Still;

/// A footing's run with its end at pseudo-time 1, and a solver that copies it and notes what it was asked for.
fn prepare(directory: &Path, matrix: &str) {
    if !directory.join("made").exists() {
        Still { method: "f-bar", steps: 40, spacing: 0.5, ..FOOTING }.write(&directory.join("made"), &[]).unwrap();
    }
    fs::write(directory.join("case.toml"), "title = \"stub\"\n").unwrap();
    fs::write(directory.join("matrix.toml"), matrix).unwrap();
    let stub = "#!/bin/sh\necho \"$@\" >> calls.txt\ncase \"$*\" in *explode*) echo 'it blew up'; exit 70;; esac\n\
                for last; do :; done\nmkdir -p \"$last\" && cp -r made/. \"$last\"\n";
    fs::write(directory.join("solver"), stub).unwrap();
    fs::set_permissions(directory.join("solver"), fs::Permissions::from_mode(0o755)).unwrap();
}

fn validate(directory: &Path, options: &[&str]) -> Output {
    let fixed = ["validate", "matrix.toml", "-o", "out"];
    let arguments = [&fixed[..], options, &["--", "./solver"]].concat();
    Command::new(env!("CARGO_BIN_EXE_bsmpm")).current_dir(directory).args(arguments).output().unwrap()
}

fn printed(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

const MATRIX: &str = r#"
[[study]]
title = "A footing"
case  = "case.toml"
set   = ["solver.background=1e-3"]
depth = "short"

[[study.run]]
name = "f-bar"
set  = ["stabilisation.method=f-bar"]

[[study.run]]
name  = "fine"
depth = "full"

[[study.row]]
quantity  = "penetration at half time"
run       = "f-bar"
column    = "penetration"
at        = 0.4875
reference = 0.975
source    = "the path"
tolerance = 1e-9

[[study.row]]
quantity = "penetration, told"
run      = "f-bar"
column   = "penetration"

[[study.row]]
quantity = "too deep"
run      = "f-bar"
column   = "penetration"
max      = 0.1
known    = "it is meant to be"

[[study.row]]
quantity = "of the fine run"
run      = "fine"
column   = "penetration"
depth    = "full"
min      = 100.0

[[study.figure]]
file    = "curve.png"
x       = "penetration"
y       = "p_over_c"
x_label = "z"
y_label = "p/c"
runs    = ["f-bar"]
lines   = [[5.14, "lower bound"]]
"#;

#[test]
fn rows_are_judged_and_written_with_their_figures() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), MATRIX);
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(text.lines().last(), Some("1 passed, 0 failed"));
    assert!(text.contains("FAIL, known") && text.contains("it is meant to be") && !text.contains("fine run"), "{text}");
    let calls = fs::read_to_string(dir.path().join("calls.txt")).unwrap();
    assert_eq!(calls.lines().count(), 1);
    assert!(calls.starts_with("case.toml --set solver.background=1e-3 --set stabilisation.method=f-bar "), "{calls}");
    let made = dir.path().join("out");
    assert!(fs::read_to_string(made.join("table.md")).unwrap().contains("| penetration at half time | 0.975 |"));
    assert_eq!(fs::read_to_string(made.join("table.csv")).unwrap().lines().count(), 4);
    assert!(made.join("curve.png").exists());
}

#[test]
fn a_failed_row_and_a_failed_run_fail_the_validation() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), MATRIX);
    let output = validate(dir.path(), &[]);
    assert_eq!((output.status.code(), printed(&output).lines().last()), (Some(77), Some("1 passed, 1 failed")));
    prepare(dir.path(), &MATRIX.replace("stabilisation.method=f-bar", "explode=1"));
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert_eq!(output.status.code(), Some(77));
    assert!(text.contains("exit code 70") && text.contains("it blew up"), "{text}");
}

#[test]
fn only_some_studies_are_run_when_asked() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), MATRIX);
    let output = validate(dir.path(), &["--only", "slope"]);
    assert_eq!(printed(&output).trim(), "0 passed, 0 failed");
    assert!(!dir.path().join("calls.txt").exists());
}

#[test]
fn a_matrix_with_mistakes_is_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    for (part, by, told) in [
        ("tolerance = 1e-9", "tolerence = 1e-9", "tolerence"),
        ("run       = \"f-bar\"", "run       = \"g-bar\"", "there is no run \"g-bar\""),
        ("reference = 0.975", "", "a tolerance needs a reference"),
        ("column   = \"penetration\"\nmax", "max", "is needed"),
    ] {
        prepare(dir.path(), &MATRIX.replacen(part, by, 1));
        let output = validate(dir.path(), &[]);
        let message = String::from_utf8(output.stderr.clone()).unwrap();
        assert!(output.status.code() == Some(65) && message.contains(told), "{output:?}");
        assert!(!dir.path().join("calls.txt").exists());
    }
}
