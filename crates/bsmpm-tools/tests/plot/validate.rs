//! Tests `bsmpm validate` with a stub solver.

mod mistakes;
mod stopped;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

use crate::quasi_static::FOOTING;
use crate::still::Still;

/// The solver: it notes what it was asked for and hands out the run, as far as t = 0.475 where it is to stop, and with
/// 0.8 times the penetration where it is to be stiffer.
const STUB: &str = r#"#!/bin/sh
echo "$@" >> calls.txt
case "$*" in *explode*) echo 'it blew up'; exit 70;; esac
for last; do :; done
mkdir -p "$last" && cp -r made/. "$last" && cd "$last"
arguments=$(printf '"%s",' "$@")
sed -i "0,/\"still.toml\"/s|\"still.toml\"|${arguments%,}|" run.json
case "$*" in *stiffer=*)
    awk -F, -v OFS=, '/^[a-z]/ { for (i = 1; i <= NF; i++) if ($i == "penetration") at = i } /^[0-9]/ { $at *= 0.8 } 1' \
        history.csv > part && mv part history.csv;;
esac
case "$*" in *stop=*)
    code=${*#*stop=}
    code=${code%% *}
    sed -i "s/\"exit_code\": 0/\"exit_code\": $code/" run.json
    head -n 22 history.csv > part && mv part history.csv
    exit "$code";;
esac
"#;

/// A footing's run with its end at pseudo-time 1, and the solver that copies it.
fn prepare(directory: &Path, matrix: &str) {
    if !directory.join("made").exists() {
        Still {
            method: "f-bar",
            steps: 40,
            spacing: 0.5,
            ..FOOTING
        }
        .write(&directory.join("made"), &[])
        .unwrap();
    }
    fs::write(directory.join("case.toml"), "title = \"stub\"\n").unwrap();
    fs::write(directory.join("matrix.toml"), matrix).unwrap();
    fs::write(directory.join("solver"), STUB).unwrap();
    fs::set_permissions(directory.join("solver"), fs::Permissions::from_mode(0o755)).unwrap();
}

fn validate(directory: &Path, options: &[&str]) -> Output {
    let fixed = ["validate", "matrix.toml", "-o", "out"];
    let arguments = [&fixed[..], options, &["--", "./solver"]].concat();
    Command::new(env!("CARGO_BIN_EXE_bsmpm"))
        .current_dir(directory)
        .args(arguments)
        .output()
        .unwrap()
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
quantity = "penetration, reported"
run      = "f-bar"
column   = "penetration"

[[study.row]]
quantity = "too deep"
run      = "f-bar"
column   = "penetration"
max      = 0.1
known    = { why = "it is meant to be", min = 1.9, max = 2.1 }

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
    assert!(
        text.contains("known failure") && text.contains("it is meant to be") && !text.contains("fine run"),
        "{text}"
    );
    let calls = fs::read_to_string(dir.path().join("calls.txt")).unwrap();
    assert_eq!(calls.lines().count(), 1);
    assert!(
        calls.starts_with("case.toml --set solver.background=1e-3 --set stabilisation.method=f-bar "),
        "{calls}"
    );
    let made = dir.path().join("out");
    let document = fs::read_to_string(made.join("table.md")).unwrap();
    assert!(
        document.contains("| A footing: penetration at half time | [`case.toml`](../case.toml) |"),
        "{document}"
    );
    assert!(
        document.contains("known failure: it is meant to be") && !document.contains("reported"),
        "{document}"
    );
    assert_eq!(fs::read_to_string(made.join("table.csv")).unwrap().lines().count(), 4);
    assert!(made.join("curve.png").exists());
}

#[test]
fn a_failed_row_and_a_failed_run_fail_the_validation() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), MATRIX);
    let output = validate(dir.path(), &[]);
    assert_eq!(
        (output.status.code(), printed(&output).lines().last()),
        (Some(77), Some("1 passed, 1 failed"))
    );
    // Together with the errors the counts are the last line, too.
    assert!(output.stderr.is_empty(), "{output:?}");
    prepare(dir.path(), &MATRIX.replace("stabilisation.method=f-bar", "explode=1"));
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert_eq!(output.status.code(), Some(77));
    assert!(text.contains("exit code 70") && text.contains("it blew up"), "{text}");
    // What is known to be too deep is not known to blow up.
    assert_eq!(text.lines().last(), Some("0 passed, 2 failed"));
}

#[test]
fn what_is_known_to_fail_fails_in_its_band_and_nowhere_else() {
    let dir = tempfile::tempdir().unwrap();
    for (part, by, last, reported) in [
        (
            "min = 1.9, max = 2.1",
            "min = 2.1, max = 2.2",
            "1 passed, 1 failed",
            " FAILED ",
        ),
        (
            "min = 1.9, max = 2.1",
            "min = 1.0, max = 1.9",
            "1 passed, 1 failed",
            " FAILED ",
        ),
        (
            "max      = 0.1",
            "max      = 2.0",
            "1 passed, 1 failed",
            "FAILED, passes now",
        ),
        (
            "column   = \"penetration\"\nmax",
            "column   = \"nothing\"\nmax",
            "1 passed, 1 failed",
            " FAILED ",
        ),
        (
            "stabilisation.method=f-bar\"]",
            "stop=80\"]\nmay_stop = true",
            "1 passed, 1 failed",
            "FAILED, not reached",
        ),
    ] {
        let matrix = MATRIX
            .replacen(part, by, 1)
            .replace("0.4875\nreference = 0.975", "0.2\nreference = 0.4");
        prepare(dir.path(), &matrix);
        let text = printed(&validate(dir.path(), &["--short"]));
        let row = text.lines().find(|line| line.contains("too deep")).unwrap();
        assert!(row.contains(reported) && text.lines().last() == Some(last), "{text}");
    }
}

#[test]
fn only_some_studies_are_run_when_asked() {
    let dir = tempfile::tempdir().unwrap();
    let other = MATRIX
        .replace("\"A footing\"", "\"Another\"")
        .replace("curve.png", "other.png");
    prepare(dir.path(), &format!("{MATRIX}{other}"));
    let output = validate(dir.path(), &["--short", "--only", "Another"]);
    assert_eq!(
        printed(&output).lines().last(),
        Some("1 passed, 0 failed"),
        "{output:?}"
    );
    assert_eq!(
        fs::read_to_string(dir.path().join("calls.txt"))
            .unwrap()
            .lines()
            .count(),
        1
    );
}

#[test]
fn where_nothing_is_judged_nothing_passes() {
    let dir = tempfile::tempdir().unwrap();
    for (matrix, options) in [
        (MATRIX.to_owned(), &["--only", "slope"][..]),
        (
            MATRIX.replacen("depth = \"short\"", "depth = \"full\"", 1),
            &["--short"],
        ),
        (
            MATRIX
                .replace("tolerance", "#")
                .replace("known ", "#")
                .replace("max ", "#")
                .replace("min ", "#"),
            &[],
        ),
    ] {
        prepare(dir.path(), &matrix);
        let output = validate(dir.path(), options);
        let message = String::from_utf8(output.stderr.clone()).unwrap();
        assert!(
            output.status.code() == Some(2) && message.contains("E0807") && message.contains("studies are: A footing"),
            "{output:?}"
        );
        assert!(!dir.path().join("calls.txt").exists());
    }
}

#[test]
fn runs_that_are_there_are_made_again_only_when_something_has_changed() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    prepare(dir.path(), MATRIX);
    let calls = |options: &[&str]| {
        let before = fs::read_to_string(path("calls.txt")).map_or(0, |text| text.lines().count());
        validate(dir.path(), &[&["--short"], options].concat());
        fs::read_to_string(path("calls.txt")).unwrap().lines().count() - before
    };
    assert_eq!((calls(&[]), calls(&[]), calls(&["--force"]), calls(&[])), (1, 0, 1, 0));
    // By what stands in the case, not by when it was written.
    let old = fs::metadata(path("case.toml")).unwrap().modified().unwrap() - Duration::from_secs(60);
    fs::write(path("case.toml"), "title = \"stub\"\n").unwrap();
    assert_eq!(calls(&[]), 0);
    fs::write(path("case.toml"), "title = \"another\"\n").unwrap();
    fs::File::options()
        .write(true)
        .open(path("case.toml"))
        .unwrap()
        .set_modified(old)
        .unwrap();
    assert_eq!((calls(&[]), calls(&[])), (1, 0));
    // The solver is another one, or what it is given.
    fs::File::options()
        .write(true)
        .open(path("solver"))
        .unwrap()
        .set_modified(old)
        .unwrap();
    assert_eq!((calls(&[]), calls(&[])), (1, 0));
    fs::write(
        path("matrix.toml"),
        MATRIX.replace("background=1e-3", "background=1e-4"),
    )
    .unwrap();
    assert_eq!((calls(&[]), calls(&[])), (1, 0));
    // A run that was broken off.
    let manifest = path("out/runs/a-footing/f-bar.out/run.json");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, text.replace("\"exit_code\": 0", "\"exit_code\": 75")).unwrap();
    assert_eq!((calls(&[]), calls(&[])), (1, 0));
    fs::write(&manifest, text.replace("\"exit_code\": 0", "\"exit_code\": null")).unwrap();
    assert_eq!((calls(&[]), calls(&[])), (1, 0));
    // Without a solver nothing is lost.
    fs::rename(path("solver"), path("gone")).unwrap();
    assert_eq!(validate(dir.path(), &["--short"]).status.code(), Some(74));
    fs::rename(path("gone"), path("solver")).unwrap();
    assert_eq!(calls(&[]), 0);
}

#[test]
fn a_picture_that_cannot_be_drawn_leaves_the_other_studies_alone() {
    let dir = tempfile::tempdir().unwrap();
    let bad = MATRIX.replace("y       = \"p_over_c\"", "y = \"depth\"");
    let good = MATRIX
        .replace("\"A footing\"", "\"Another\"")
        .replace("curve.png", "other.png");
    let body = "[[study.plot]]\nrun = \"f-bar\"\nfield = \"plastic-strain\"\ntimes = [1.0]\nrange = [0.0, 1.0]\n";
    prepare(dir.path(), &format!("{bad}{good}{body}"));
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert!(
        text.contains("curve.png is not drawn: E0803: ") && text.contains("no column `depth`"),
        "{text}"
    );
    assert_eq!(
        (output.status.code(), text.lines().last()),
        (Some(77), Some("2 passed, 1 failed")),
        "{text}"
    );
    let out = dir.path().join("out");
    assert!(!out.join("curve.png").exists() && out.join("other.png").exists());
    assert!(
        out.join("f-bar_plastic-strain_1.png").exists(),
        "{:?}",
        fs::read_dir(&out).unwrap().collect::<Vec<_>>()
    );
}
