//! Tests `bsmpm validate` with a stub solver.

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
fn a_matrix_with_mistakes_is_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    for (part, by, reported) in [
        ("tolerance = 1e-9", "tolerence = 1e-9", "tolerence"),
        (
            "run       = \"f-bar\"",
            "run       = \"g-bar\"",
            "there is no run \"g-bar\"",
        ),
        ("reference = 0.975", "", "a tolerance needs a reference"),
        ("column   = \"penetration\"\nmax", "max", "is needed"),
        ("name  = \"fine\"", "name  = \"f-bar\"", "the same: f-bar"),
        ("name  = \"fine\"", "name  = \"../fine\"", "no name of a directory"),
        ("at        = 0.4875", "at = 0.5\noperation = \"mean\"", "take a window"),
        (
            "at        = 0.4875",
            "at = 0.5\nwhere = { value = 0.5 }",
            "exclude each other",
        ),
        ("at        = 0.4875", "where = { column = \"time\" }", "needs a value"),
        ("reference = 0.975", "reference = 0.0", "other than 0"),
        (
            "at        = 0.4875",
            "operation = \"deviation\"",
            "a deviation is against a run",
        ),
        (
            "at        = 0.4875",
            "at = 0.5\nagainst = \"fine\"",
            "a deviation is against a run",
        ),
        ("max      = 0.1", "max      = 0.1\nmin = 0.2", "min is above its max"),
        ("max      = 0.1", "", "known to fail, and cannot"),
        ("min = 1.9,", "min = 2.9,", "known needs a band"),
        (
            "max      = 0.1",
            "max = 0.1\noperation = \"reach\"\nat = 0.1",
            "neither at nor where",
        ),
        (
            "column   = \"penetration\"\nmax",
            "kink = { x = \"time\", y = \"p_over_c\", elastic = 0.0 }\nmax",
            "not 0",
        ),
        (
            "depth    = \"full\"\nmin",
            "depth = \"short\"\nmin",
            "its run \"fine\" is full",
        ),
        (
            "file    = \"curve.png\"",
            "file    = \"../curve.png\"",
            "ends with .png",
        ),
        (
            "runs    = [\"f-bar\"]",
            "curves = { \"f-bar\" = [\"f-bar\"] }\nx_values = [1.0, 2.0]",
            "has 1 runs",
        ),
        (
            "[[study.figure]]",
            "[[study.plot]]\nrun = \"fine\"\nfield = \"colour\"\n[[study.figure]]",
            "no field",
        ),
    ] {
        prepare(dir.path(), &MATRIX.replacen(part, by, 1));
        let output = validate(dir.path(), &[]);
        let message = String::from_utf8(output.stderr.clone()).unwrap();
        assert!(
            output.status.code() == Some(65) && message.contains(reported),
            "{output:?}"
        );
        assert!(!dir.path().join("calls.txt").exists());
    }
}

const STOPPED: &str = r#"
[[study]]
title = "A footing that stops"
case  = "nowhere.toml"
depth = "short"

[[study.run]]
name     = "half"
case     = "case.toml"
set      = ["stop=80"]
may_stop = true

[[study.run]]
name = "stiffer"
set  = ["stiffer=1"]

[[study.run]]
name  = "whole"
case  = "case.toml"
depth = "full"

[[study.row]]
quantity  = "time where it is 0.5 deep"
run       = "half"
column    = "time"
where     = { column = "penetration", value = 0.51 }
reference = 0.255
tolerance = 1e-9

[[study.row]]
quantity  = "mean depth"
run       = "half"
column    = "penetration"
operation = "mean"
where     = { from = 0.11, to = 0.31 }
scale     = 10.0
reference = 4.2
tolerance = 1e-9

[[study.row]]
quantity = "deeper, reported"
run      = "half"
column   = "p_over_c"
at       = 0.5

[[study.row]]
quantity = "deeper, judged"
run      = "half"
column   = "p_over_c"
where    = { column = "penetration", value = 1.0 }
min      = 0.0

[[study.row]]
quantity  = "largest to its end"
run       = "half"
column    = "penetration"
operation = "max"
max       = 9.0

[[study.row]]
quantity = "at its end"
run      = "half"
column   = "penetration"
max      = 9.0

[[study.row]]
quantity = "no kink"
run      = "half"
kink     = { x = "time", y = "penetration", elastic = 0.1 }
max      = 9.0

[[study.row]]
quantity  = "where it stops"
run       = "half"
column    = "penetration"
operation = "reach"
min       = 2.0
known     = { why = "it is a stub", min = 0.9, max = 1.0 }

[[study.row]]
quantity  = "how even it is"
run       = "half"
column    = "penetration"
operation = "spread"
where     = { from = 0.1, to = 0.2 }
reference = 0.6666666667
tolerance = 1e-9

[[study.row]]
quantity  = "how far from a stiffer one"
run       = "half"
column    = "penetration"
operation = "deviation"
against   = "stiffer"
where     = { from = 0.1, to = 0.2 }
reference = 0.25
tolerance = 1e-9

[[study.row]]
quantity  = "how far where that is not"
run       = "half"
column    = "time"
operation = "deviation"
against   = "stiffer"
where     = { column = "penetration", from = 0.1, to = 0.2 }
reference = 0.2
tolerance = 1e-9

[[study.row]]
quantity  = "of a run that is not short"
run       = "whole"
column    = "penetration"
operation = "max"
max       = 0.1
"#;

#[test]
fn rows_are_taken_from_a_run_as_far_as_it_came() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path(), STOPPED);
    let output = validate(dir.path(), &["--short"]);
    let text = printed(&output);
    assert_eq!(
        (output.status.code(), text.lines().last()),
        (Some(77), Some("5 passed, 4 failed")),
        "{text}"
    );
    let row = |quantity: &str| text.lines().find(|line| line.contains(quantity)).unwrap().to_owned();
    assert!(row("mean depth").contains(" 4.2 "), "{text}");
    assert!(
        row("deeper, reported").contains(" none ") && row("deeper, reported").contains(" not reached "),
        "{text}"
    );
    assert!(
        row("deeper, judged").contains("FAILED, not reached") && row("judged").contains("penetration 0.95"),
        "{text}"
    );
    assert!(row("deeper, reported").contains("stopped at t = 0.4750"), "{text}");
    // What has no end says nothing about the whole, and that a solver gives up is no failure load.
    assert!(
        row("largest to its end").contains("FAILED, not reached") && row("at its end").contains("FAILED, not reached")
    );
    assert!(
        row("no kink").contains("no kink before its end") && row("no kink").contains(" FAILED "),
        "{text}"
    );
    assert!(
        row("where it stops").contains("known failure") && row("how even it is").contains(" passed "),
        "{text}"
    );
    // At the same penetration the stiffer one is at 1.25 times the time, a fifth of it away from ours.
    assert!(
        row("from a stiffer one").contains(" passed ") && row("where that is not").contains(" passed "),
        "{text}"
    );
    let table = fs::read_to_string(dir.path().join("out/table.csv")).unwrap();
    assert!(table.contains("\"passed\",\"80\""), "{table}");
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
