//! Tests that a run whose indicator exceeds its limit ends with exit code 82.

use crate::support::Scratch;
use crate::support::cases::slope;
use crate::support::results::manifest;

/// An artificial stiffness that carries a part of the slope's weight.
const HELD: [&str; 2] = ["--set", "solver.background=1.0"];
const ACCEPTING: [&str; 2] = ["--set", "output.accept=[\"background-work\"]"];
const CHECKED: [&str; 2] = ["--set", "check=[{ quantity = \"max-displacement\", max = 1e-4 }]"];
const NAME: &str = "background-work";

#[test]
fn a_run_beyond_a_limit_ends_with_82_unless_its_case_accepts_that() {
    let scratch = Scratch::with_case(&slope(0.0));
    for ranks in [1, 3] {
        let arguments = [&["case.toml", "-o", "out", "--force"][..], &HELD].concat();
        scratch.mpirun(ranks, &arguments).expect(82).says_once("error I0028: ");
        let found = manifest(&scratch.path("out"));
        let indicator = &found.indicators[NAME];
        assert!(
            indicator.code == "I0028"
                && indicator.failed
                && !indicator.accepted
                && indicator.limits == Some([0.0, 0.1]),
            "{indicator:?}"
        );
        assert_eq!(found.exit_code, Some(82));
    }
    // It has come to its end, and is not begun again.
    let again = [&["case.toml", "-o", "out", "--restart", "auto"][..], &HELD].concat();
    scratch.direct(&again).expect(82);
    assert_eq!(manifest(&scratch.path("out")).summary.steps, 10);
    let accepting = [&["case.toml", "-o", "accepted"][..], &HELD, &ACCEPTING].concat();
    scratch
        .direct(&accepting)
        .expect(0)
        .says_once("(limit: below 10 %, accepted by output.accept)");
    let indicator = &manifest(&scratch.path("accepted")).indicators[NAME];
    assert!(indicator.failed && indicator.accepted, "{indicator:?}");
}

#[test]
fn a_check_that_fails_comes_before_an_indicator() {
    let scratch = Scratch::with_case(&slope(0.0));
    let both = [&["case.toml", "-o", "both"][..], &HELD, &CHECKED].concat();
    scratch.direct(&both).expect(77).says_once("error I0028: ");
}

#[test]
fn only_indicators_that_have_a_limit_can_be_accepted() {
    let scratch = Scratch::with_case(&slope(0.0));
    let arguments = [
        "case.toml",
        "-o",
        "out",
        "--set",
        "output.accept=[\"pressure-noise-plane\"]",
    ];
    let output = scratch.direct(&arguments).expect(65);
    assert!(
        output.said().contains("output.accept") && output.said().contains("wall-velocity"),
        "{}",
        output.said()
    );
}
