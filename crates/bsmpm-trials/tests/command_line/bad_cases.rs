//! Every malformed case ends a run on two ranks with 65, its place and its key, said once, and leaves nothing.

use crate::support::Scratch;
use crate::support::cases::{COLUMN, changed};

/// A part of the case, what it becomes, and what is said of it: its key and a part of the message. The error stands in
/// the line in which the replaced part begins, unless `up` counts back to its table.
struct Row(&'static str, &'static str, &'static str, &'static str, usize);

const ROWS: [Row; 20] = [
    Row("poisson = 0.3", "poissson = 0.3", "material.soil.poissson", "did you mean `poisson`?", 0),
    Row("poisson = 0.3", "poisson = \"0.3\"", "material.soil.poisson", "expected a number", 0),
    Row("poisson = 0.3", "poisson = 0.5", "material.soil.poisson", "0.5 is out of range", 0),
    Row("poisson = 0.3", "poisson = nan", "material.soil.poisson", "no finite number", 0),
    Row("young   = \"1 MPa\"", "young = -1", "material.soil.young", "allowed: young > 0", 0),
    Row("young   = \"1 MPa\"", "young = \"1 Mpa\"", "material.soil.young", "did you mean `MPa`?", 0),
    Row("young   = \"1 MPa\"", "young = \"1 m\"", "material.soil.young", "expected a stress", 0),
    Row("young   = \"1 MPa\"\n", "", "material.soil.young", "missing", 2),
    Row("steps = 5", "steps = 0", "analysis.steps", "allowed: 1 <= steps", 0),
    Row("steps = 5", "steps = 5\nend = \"1 s\"", "analysis.end", "pseudo-time without unit", 0),
    Row("order = \"quadratic\"", "order = \"quartic\"", "grid.order", "quartic", 0),
    Row("cell  = \"1 m\"", "cell = 0", "grid.cell", "allowed: cell > 0", 0),
    Row("cell  = \"1 m\"", "cell = [1, 1e-9]", "grid.cell", "cells along y", 0),
    Row("cell  = \"1 m\"", "cell = 0.3", "grid.cell", "no whole number", 0),
    Row("upper = [4.0, 4.0]", "upper = [4.0, 6.0]", "body.0.box.upper", "outside the grid", 0),
    Row("upper = [4.0, 4.0]", "upper = [4.0, 0.0]", "body.0.box.upper", "the body is empty", 0),
    Row("material = \"soil\"", "material = \"sand\"", "body.0.material", "there is no [material.sand]", 0),
    Row("bottom = \"fixed\"\n", "", "boundary", "nothing holds the bodies along y", 1),
    Row("face = \"bottom\"", "face = \"botom\"", "history.1.face", "did you mean `bottom`?", 0),
    Row("[gravity]", "[stage]", "stage", "not available yet", 0),
];

#[test]
fn every_malformed_case_ends_with_65_and_its_line_and_key_and_leaves_nothing() {
    for Row(part, by, key, says, up) in ROWS {
        let text = changed(COLUMN, part, by);
        let inside = if by.contains('\n') { by.rfind('\n').map_or(0, |at| at + 1) } else { 0 };
        let at = COLUMN.find(part).unwrap() + inside;
        let line = 1 + text[..at].matches('\n').count() - up;
        let scratch = Scratch::with_case(&text);
        let output = scratch.job(Some(2), &["case.toml"]).within(30).run().expect(65);
        let place = format!("case.toml:{line}:");
        let told: Vec<&str> = output.stderr.lines().filter(|line| line.starts_with(&place)).collect();
        assert_eq!(told.len(), 1, "one error in line {line}: {output:#?}");
        assert!(told[0].contains(&format!(" {key}: ")) && told[0].contains(says), "{key}, {says}: {output:#?}");
        output.says_once("nothing was run or written");
        assert_eq!(output.stdout, "");
        assert_eq!(scratch.entries(), ["case.toml"], "{key}");
    }
}

#[test]
fn what_is_no_text_of_a_case_ends_with_65() {
    let large = [b'#'; (1 << 20) + 1];
    let texts: [(&[u8], &str); 5] = [
        (b"", "the file is empty"),
        (b"\x7fELF\x02\x01\x00", "NUL"),
        (b"title = \"\xff\"", "is no UTF-8"),
        (b"title = ", "case.toml:1:"),
        (&large, "1048576"),
    ];
    for (bytes, says) in texts {
        let scratch = Scratch::new();
        scratch.write("case.toml", bytes);
        let output = scratch.mpirun(2, &["case.toml"]).expect(65);
        assert!(output.count(says) == 1 && output.count("nothing was run or written") == 1, "{says}: {output:#?}");
        assert_eq!(scratch.entries(), ["case.toml"]);
    }
}

#[test]
fn all_errors_of_a_case_and_its_overrides_are_told_in_one_go() {
    let text = changed(&changed(COLUMN, "poisson = 0.3", "poisson = 0.6"), "steps = 5", "steps = 1.5");
    let scratch = Scratch::with_case(&changed(&text, "type  = ", "typ = "));
    let output = scratch.mpirun(2, &["case.toml", "--set", "grid.cell=-1"]).expect(65);
    for key in [" analysis.typ: ", " analysis.steps: ", " material.soil.poisson: ", " grid.cell: "] {
        output.says_once(key);
    }
    assert_eq!(scratch.entries(), ["case.toml"]);
}

#[test]
fn a_wrong_override_ends_with_65_and_is_cited() {
    let wrong = [
        ("grid.cell=-1", "grid.cell: ", "allowed: cell > 0"),
        ("grid.cel=1", "grid.cel: ", "did you mean `cell`?"),
        ("grid.cell", "", "expected KEY=VALUE"),
        ("body.7.points_per_cell=2", "body.7.points_per_cell: ", "beyond the list of 1"),
        ("material.soil.young=[", "material.soil.young: ", "no valid TOML"),
    ];
    for (set, key, says) in wrong {
        let scratch = Scratch::with_case(COLUMN);
        let output = scratch.mpirun(2, &["case.toml", "--set", set]).expect(65);
        output.says_once(&format!("--set {set}: {key}"));
        output.says_once(says);
        assert_eq!(scratch.entries(), ["case.toml"]);
    }
}
