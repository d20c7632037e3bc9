//! Tests of restarts with another case than that of the checkpoint.

use super::OFTEN;
use crate::support::cases::{SLIDING_BLOCK, changed};
use crate::support::results::{history, manifest};
use crate::support::{Scratch, entries};
use std::path::Path;

#[test]
fn another_case_is_refused_by_the_keys_that_differ_and_nothing_is_touched() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(2, &["case.toml", "-q", "--max-steps", "5"]).expect(75);
    let content = || {
        ["run.json", "history.csv", "steps.csv"].map(|name| std::fs::read(scratch.path("case.out").join(name)).unwrap())
    };
    let before = content();
    let listed = entries(&scratch.path("case.out/checkpoint"));
    let file = "case.out/checkpoint/step_000000005.h5";
    for restart in ["auto", file] {
        let other = ["case.toml", "--set", "body.0.points_per_cell=3", "--restart", restart];
        let output = scratch.mpirun(2, &other).expect(76);
        output.says_once("body.0.points_per_cell was ");
        assert!(output.said().contains(", and is 3"), "{output:#?}");
    }
    assert_eq!(
        (content(), entries(&scratch.path("case.out/checkpoint"))),
        (before, listed)
    );
    scratch
        .mpirun(2, &["case.toml", "--restart", "nowhere.h5", "-o", "new"])
        .expect(76)
        .says_once("nowhere.json");
    assert!(!scratch.path("new").exists());
}

/// A checkpoint of an earlier version: the case in it has the key, where this version has written a comment.
#[test]
fn a_checkpoint_of_a_case_with_a_removed_option_is_refused_and_one_of_a_case_with_a_retired_key_is_read() {
    for (key, refused) in [
        (
            "background_kind = \"ghost-penalty\"",
            Some("background_kind = \"ghost-penalty\""),
        ),
        (
            "background_kind = \"curvature\"",
            Some("background_kind = \"curvature\""),
        ),
        (
            "background_cells = \"partly-filled\"",
            Some("background_cells = \"partly-filled\""),
        ),
        ("linear = { ksp = \"cg\" }", Some("linear = { ksp, pc, factor }")),
        ("background_kind = \"laplacian\"", None),
        ("background_cells = \"occupied\"", None),
    ] {
        let [commented, given] = lines_with_one_checksum(&key.replace('"', "\\\""));
        let line = commented.replace("\\\"", "\"");
        let scratch = Scratch::with_case(&changed(SLIDING_BLOCK, "[solver]\n", &format!("[solver]\n{line}\n")));
        scratch.mpirun(1, &["case.toml", "-q", "--max-steps", "5"]).expect(75);
        let file = scratch.path("case.out/checkpoint/step_000000005.h5");
        forge(&file, &commented, &given);
        scratch.write("case.toml", SLIDING_BLOCK);
        let from = ["case.toml", "-o", "new", "--restart", file.to_str().unwrap()];
        if let Some(value) = refused {
            let output = scratch.mpirun(2, &from).expect(76);
            output.says_once(&format!("uses `solver.{value}`, which was removed after bsmpm 0.1.0"));
            assert!(!scratch.path("new/history.csv").exists());
        } else {
            scratch.mpirun(1, &from).expect(0);
        }
    }
}

/// A line that is a comment, and the same with the key given. HDF5 guards the text with Fletcher's checksum, the sum of
/// all 16-bit words and that of the sums up to each word: changes of -3, +6 and -3 at equal distances leave both alone.
fn lines_with_one_checksum(key: &str) -> [String; 2] {
    let distance = 2 * key.len().div_ceil(2) + 6;
    [["#", "a", "d"], [" ", "g", "a"]].map(|[first, second, third]| {
        let start = format!("{first} {key} # ");
        format!("{start:-<distance$}{second}{third:->distance$}")
    })
}

/// Writes `by` in place of `part` into a checkpoint, and its record again.
fn forge(file: &Path, part: &str, by: &str) {
    assert_eq!(part.len(), by.len());
    let mut bytes = std::fs::read(file).unwrap();
    let at = bytes
        .windows(part.len())
        .position(|window| window == part.as_bytes())
        .expect("the case is in it");
    bytes[at..at + part.len()].copy_from_slice(by.as_bytes());
    std::fs::write(file, &bytes).unwrap();
    let text = std::fs::read_to_string(file.with_extension("json")).unwrap();
    let mut record: serde_json::Value = serde_json::from_str(&text).unwrap();
    record["record"]["blake3"] = blake3::hash(&bytes).to_string().into();
    let body = record["record"].to_string();
    let text = format!(
        "{{\"blake3\":\"{}\",\"record\":{body}}}\n",
        blake3::hash(body.as_bytes())
    );
    std::fs::write(file.with_extension("json"), text).unwrap();
}

#[test]
fn a_run_goes_on_with_a_later_end_and_says_what_has_changed() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    let end = at_end(&scratch);
    let run = ["case.toml", "--set", OFTEN, "-o", "part"];
    scratch.mpirun(2, &[&run[..], &["-q"]].concat()).expect(0);
    let later = format!("analysis.end={}", 1.5 * end);
    let output = scratch
        .mpirun(2, &[&run[..], &["--set", &later, "--restart", "auto"]].concat())
        .expect(0);
    output.says_once("W0732: the case has changed since the checkpoint: analysis.end was");
    scratch
        .mpirun(2, &["case.toml", "-q", "-o", "whole", "--set", &later])
        .expect(0);
    let part = history(&scratch.path("part"));
    let whole = history(&scratch.path("whole"));
    assert_eq!(part.get("time").unwrap().last(), whole.get("time").unwrap().last());
    let changed = &manifest(&scratch.path("part")).restarts[0].changed;
    assert!(
        changed.len() == 1 && changed[0].starts_with("analysis.end was"),
        "{changed:?}"
    );
}

/// The end of the sliding block's case.
fn at_end(scratch: &Scratch) -> f64 {
    scratch.mpirun(1, &["case.toml", "-q", "-o", "short"]).expect(0);
    *history(&scratch.path("short")).get("time").unwrap().last().unwrap()
}

const CLAY: &str = "[material.clay]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\ndensity = 2000\n\n[[body]]";

#[test]
fn materials_in_another_order_are_another_case() {
    let scratch = Scratch::with_case(&SLIDING_BLOCK.replacen("[[body]]", CLAY, 1));
    scratch.mpirun(2, &["case.toml", "-q", "--max-steps", "5"]).expect(75);
    let clay = CLAY.strip_suffix("[[body]]").unwrap();
    scratch.write(
        "case.toml",
        SLIDING_BLOCK.replacen("[material.rubber]", &format!("{clay}[material.rubber]"), 1),
    );
    let output = scratch.mpirun(2, &["case.toml", "-q", "--restart", "auto"]).expect(76);
    output.says_once("material was rubber, clay, and is clay, rubber");
}
