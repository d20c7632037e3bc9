//! Tests that a matrix with mistakes is refused.

use super::{MATRIX, prepare, validate};

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
