//! Tests that retired keys and values have a warning or an error that names what replaces them.

use super::{FULL, STATIC, set, valid};
use bsmpm_scene::differences;

#[test]
fn words_of_retired_keys_that_change_nothing_are_read_with_a_warning() {
    let plain = valid(STATIC, &[]);
    for (set, reported) in [
        (
            "solver.background_kind=strain",
            "W0001: solver.background_kind: this key has no effect any more, because the artificial stiffness \
             always resists strain. Delete the key.",
        ),
        (
            "solver.background_kind=laplacian",
            "W0001: solver.background_kind: this key has no effect any more, because the artificial stiffness \
             always resists strain. Delete the key.",
        ),
        (
            "solver.background_cells=occupied",
            "W0001: solver.background_cells: this key has no effect any more, because all occupied cells always have \
             the artificial stiffness. Delete the key.",
        ),
    ] {
        let case = valid(STATIC, &[set]);
        let further: Vec<_> = case
            .warnings
            .iter()
            .filter(|warning| !plain.warnings.contains(warning))
            .collect();
        assert_eq!(further, [reported]);
        assert_eq!((&case.solver, &case.notes), (&plain.solver, &plain.notes), "{set}");
        assert_eq!(
            differences(&case.text, &plain.text).unwrap(),
            [],
            "a run goes on with or without it"
        );
    }
}

#[test]
fn words_of_retired_keys_that_were_removed_are_refused_with_what_replaces_them() {
    for (key, word) in [
        ("solver.background_kind", "ghost-penalty"),
        ("solver.background_kind", "curvature"),
        ("solver.background_cells", "partly-filled"),
    ] {
        for text in [STATIC, FULL] {
            let errors = set(text, &[&format!("{key}={word}")]).unwrap_err();
            let [error] = &errors[..] else { panic!("{errors:?}") };
            let reported = format!(
                "the value \"{word}\" does not exist any more; the last version with this value was bsmpm 0.1.0, commit \
                 c1b20825. Delete the key: solver.extension = \"linear\", the default in quasi-static analysis, replaces it."
            );
            assert_eq!((error.key.as_str(), &error.message), (key, &reported));
            assert_eq!(error.removed.map(|removed| removed.word), Some(word));
        }
    }
    let errors = set(STATIC, &["solver.background_kind=bending"]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].message.contains("expected one of \"strain\""),
        "{errors:?}"
    );
    assert_eq!(errors[0].removed, None);
    let errors = set(STATIC, &["solver.background_sort=strain"]).unwrap_err();
    assert!(
        errors.iter().all(|error| !error.message.contains("background_kind")),
        "not recommended: {errors:?}"
    );
}

#[test]
fn a_linear_solver_by_petscs_names_is_refused_with_what_replaces_it() {
    for (text, table) in [
        (STATIC, "solver.linear={ ksp = \"cg\", pc = \"jacobi\" }"),
        (FULL, "solver.linear={ ksp = \"cg\", pc = \"jacobi\" }"),
        (STATIC, "solver.linear.factor=mumps"),
    ] {
        let errors = set(text, &[table]).unwrap_err();
        let [error] = &errors[..] else { panic!("{errors:?}") };
        let reported = "the value { ksp, pc, factor } does not exist any more; the last version with this value was \
                        bsmpm 0.1.0, commit 7816fb16. Use a word, such as linear = \"direct\". PETSc options follow \
                        `--` on the command line.";
        assert_eq!(
            (error.key.as_str(), error.message.as_str()),
            ("solver.linear", reported)
        );
        assert!(error.removed.is_some());
    }
}

#[test]
fn the_f_bar_method_of_zhao_is_refused_with_what_replaces_it() {
    let errors = set(STATIC, &["stabilisation.method=f-bar-zhao"]).unwrap_err();
    let [error] = &errors[..] else { panic!("{errors:?}") };
    let reported = "the value \"f-bar-zhao\" does not exist any more; the last version with this value was bsmpm 0.1.0, \
                    commit 7816fb16. Use \"consistent-f-bar\", or \"f-bar\", which averages the volume changes of each \
                    step.";
    assert_eq!(
        (error.key.as_str(), error.message.as_str()),
        ("stabilisation.method", reported)
    );
    assert_eq!(error.removed.map(|removed| removed.word), Some("f-bar-zhao"));
}
