//! Tests that malformed cases end with exit code 65 and write nothing.

use crate::support::Scratch;
use crate::support::cases::{COLUMN, changed};

#[test]
fn a_malformed_case_ends_with_65_and_its_line_and_key_and_leaves_nothing() {
    let line = 1 + COLUMN[..COLUMN.find("poisson").unwrap()].matches('\n').count();
    let scratch = Scratch::with_case(&changed(COLUMN, "poisson = 0.3", "poissson = 0.3"));
    let output = scratch.job(Some(2), &["case.toml"]).within(30).run().expect(65);
    let place = format!("case.toml:{line}:");
    let reported: Vec<&str> = output.stderr.lines().filter(|line| line.starts_with(&place)).collect();
    assert_eq!(reported.len(), 1, "one error in line {line}: {output:#?}");
    assert!(
        reported[0].contains(" material.soil.poissson: ") && reported[0].contains("did you mean `poisson`?"),
        "{output:#?}"
    );
    output.says_once("nothing was run or written");
    assert_eq!(output.stdout, "");
    assert_eq!(scratch.entries(), ["case.toml"]);
}

#[test]
fn what_is_no_text_of_a_case_ends_with_65() {
    let scratch = Scratch::new();
    scratch.write("case.toml", vec![b'#'; (1 << 24) + 1]);
    let output = scratch.mpirun(2, &["case.toml"]).expect(65);
    output.says_once("16 MiB");
    output.says_once("nothing was run or written");
    assert_eq!(scratch.entries(), ["case.toml"]);
}

#[test]
fn all_errors_of_a_case_and_its_overrides_are_reported_in_one_go() {
    let text = changed(
        &changed(COLUMN, "poisson = 0.3", "poisson = 0.6"),
        "steps = 5",
        "steps = 1.5",
    );
    let scratch = Scratch::with_case(&changed(&text, "type  = ", "typ = "));
    let output = scratch.mpirun(2, &["case.toml", "--set", "grid.cell=-1"]).expect(65);
    for key in [
        " analysis.typ: ",
        " analysis.steps: ",
        " material.soil.poisson: ",
        "--set grid.cell=-1: error E0010: grid.cell: ",
    ] {
        output.says_once(key);
    }
    assert_eq!(scratch.entries(), ["case.toml"]);
}
