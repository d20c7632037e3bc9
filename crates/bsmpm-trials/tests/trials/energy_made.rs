//! Tests that a dynamic run that creates energy ends with exit code 80.

use crate::support::results::{history, manifest};
use crate::support::{Scratch, shipped};
use bsmpm_io::manifest::Status;

/// The short collapse with associated flow, in which F-bar makes energy from the start.
const DILATANT: [&str; 4] = [
    "--set",
    "stabilisation.method=f-bar",
    "--set",
    "material.rods.dilation_angle=21.9",
];

fn arguments<'a>(directory: &'a str, further: &[&'a str]) -> Vec<&'a str> {
    [&["case.toml", "-q", "-o", directory][..], &DILATANT, further].concat()
}

#[test]
fn it_ends_with_80_and_a_word_of_its_own_on_1_and_2_ranks_and_after_a_restart() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let ended = scratch.direct(&arguments("1.out", &[])).expect(80);
    assert!(ended.stderr.contains("E0753: "), "{}", ended.stderr);
    let [one, two, on] = ["1.out", "2.out", "on.out"].map(|directory| scratch.path(directory));
    let failure = std::fs::read_to_string(one.join("failure.json")).unwrap();
    assert!(
        failure.contains("E0753: ") && failure.contains("stabilisation"),
        "{failure}"
    );
    scratch.mpirun(2, &arguments("2.out", &[])).expect(80);
    // The guard goes on with what it knew, to the bit.
    scratch.direct(&arguments("on.out", &["--max-steps", "7"])).expect(75);
    scratch.direct(&arguments("on.out", &["--restart", "auto"])).expect(80);
    assert_eq!(
        std::fs::read(one.join("failure.json")).unwrap(),
        std::fs::read(on.join("failure.json")).unwrap()
    );
    let [one, two, on] = [one, two, on].map(|path| (manifest(&path), history(&path).get("time").unwrap().to_vec()));
    assert_eq!(one.1, two.1);
    assert_eq!(one.1, on.1);
    let growth = |run: &bsmpm_io::manifest::Manifest| run.indicators["energy-growth"].value;
    assert!(one.0.status == Status::Failed && growth(&one.0) > 0.05 && one.0.indicators["energy-growth"].unusual);
    assert!((growth(&one.0) - growth(&two.0)).abs() <= 1e-6);
    assert_eq!(growth(&one.0), growth(&on.0));
}

#[test]
fn the_shipped_collapse_does_not() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    scratch
        .direct(&["case.toml", "-q", "-o", "out", "--max-steps", "400"])
        .expect(75);
    let growth = manifest(&scratch.path("out")).indicators["energy-growth"].clone();
    assert!(growth.value <= 0.005 && !growth.unusual, "{growth:?}"); // measured 0.0013, in the first steps
}
