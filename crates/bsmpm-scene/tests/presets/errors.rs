//! Tests that what a preset cannot choose is an error with a place.

use super::{COLUMN, FOOTING, read};
use bsmpm_scene::{Error, Place};

/// What a word cannot choose it reports, with what that would follow from; where that is an error itself, this is the
/// only one. What is given needs no choice.
#[test]
fn what_cannot_be_chosen_is_reported_at_the_word() {
    let only = |text: &str, overrides: &[&str]| {
        let mut errors = read(text, overrides).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:?}");
        errors.remove(0)
    };
    let without = |line: &str| {
        assert!(COLUMN.contains(line), "{line}");
        COLUMN.replace(line, "")
    };
    let weightless = only(&without("unit_weight    = \"20.4 kN/m3\"\n"), &[]);
    assert!(weightless.code.as_deref() == Some("E0310"), "{weightless}");
    let bodiless = only(&without("box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }\n"), &[]);
    assert!(bodiless.code.as_deref() == Some("E0014"), "{bodiless}");
    let in_time = ["analysis.type=consolidation", "analysis.growth=1.2"];
    let errors = read(COLUMN, &in_time).unwrap_err();
    let is_of_steps = |error: &Error| error.key == "accuracy" && error.code.as_deref() == Some("E0254");
    assert!(errors.iter().any(is_of_steps), "{errors:?}");
    let given = read(COLUMN, &[&in_time[..], &["analysis.dt=1e-3"]].concat())
        .err()
        .unwrap_or_default();
    assert!(!given.iter().any(is_of_steps), "{given:?}");
}

/// Errors of what was filled in stand at the word; what cannot be filled in is missed as ever.
#[test]
fn errors_have_a_place() {
    let errors = read(COLUMN, &["accuracy=fine"]).unwrap_err();
    assert!(
        errors
            .iter()
            .any(|error| error.key == "accuracy" && error.message.contains("\"draft\"")),
        "{errors:?}"
    );
    let wide = COLUMN.replace("upper = [0.55, 0.1025]", "upper = [1e8, 0.1025]");
    let line = 1 + COLUMN.lines().position(|line| line.starts_with("accuracy")).unwrap();
    let at_the_word = |error: &Error| matches!(error.place, Place::Line { line: found, .. } if found == line);
    let errors = read(&wide, &[]).unwrap_err();
    assert!(
        errors
            .iter()
            .any(|error| error.key == "grid.cell" && at_the_word(error)),
        "{errors:?}"
    );
    let without = COLUMN.replace("lower = [0.0, 0.0]\nupper = [0.55, 0.1025]\n", "");
    let errors = read(&without, &[]).unwrap_err();
    let keys: Vec<&str> = errors.iter().map(|error| error.key.as_str()).collect();
    assert_eq!(keys, ["grid.lower", "grid.upper"], "{errors:?}");
}

/// So many breakpoints are the author's to ask for.
#[test]
fn a_strip_too_small_for_its_grid_is_an_error() {
    let tiny = ["footing.from=[4.0, 10.0]", "footing.to=[4.00001, 10.0]"];
    let errors = read(FOOTING, &tiny).unwrap_err();
    assert!(
        errors.iter().any(|error| error.code.as_deref() == Some("E0253")),
        "{errors:?}"
    );
}
