//! Tests the choice and protection of the output directory.

use crate::support::Scratch;
use crate::support::cases::COLUMN;
use crate::support::results::manifest;

#[test]
fn the_output_goes_where_it_is_asked_for_and_nowhere_else() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    assert_eq!(scratch.entries(), ["case.out", "case.toml"]);
    scratch.mpirun(2, &["case.toml", "-q", "--output", "deep/er"]).expect(0);
    assert_eq!(scratch.entries(), ["case.out", "case.toml", "deep"]);
    assert!(scratch.path("deep/er/run.json").is_file());
}

#[test]
fn a_directory_that_holds_a_run_is_refused_once_with_73_and_left_as_it_is() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(1, &["case.toml", "-q"]).expect(0);
    let before = std::fs::read(scratch.path("case.out/run.json")).unwrap();
    for ranks in [1, 2] {
        let output = scratch.mpirun(ranks, &["case.toml"]).expect(73);
        output.says_once("--force");
        assert!(output.stderr.contains("case.out"), "{output:#?}");
    }
    assert_eq!(std::fs::read(scratch.path("case.out/run.json")).unwrap(), before);
}

#[test]
fn force_deletes_what_the_older_run_wrote_and_nothing_else() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let old = manifest(&scratch.path("case.out")).outputs;
    assert!(
        old.iter().any(|output| output.path == "frames/step_000000004.vtu"),
        "{old:?}"
    );
    scratch.write("case.out/notes.txt", "mine");
    scratch.write("case.out/frames/view.pvsm", "mine");
    scratch
        .mpirun(2, &["case.toml", "-q", "--force", "--set", "output.every=1.0"])
        .expect(0);
    assert_eq!(
        crate::support::entries(&scratch.path("case.out/frames")),
        ["step_000000000.vtu", "step_000000005.vtu", "view.pvsm"]
    );
    assert_eq!(std::fs::read(scratch.path("case.out/notes.txt")).unwrap(), b"mine");
    // A frame that no run.json names is somebody's: it stays, and the run is refused.
    scratch.write("case.out/frames/step_000000009.vtu", "mine");
    scratch
        .mpirun(2, &["case.toml", "-q", "--force"])
        .expect(73)
        .says_once("step_000000009.vtu");
    assert!(scratch.path("case.out/frames/step_000000005.vtu").is_file());
}

#[test]
fn an_output_path_that_is_no_directory_or_cannot_be_made_is_refused_once_with_73() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.write("file", "mine");
    for (directory, flag) in [
        ("file", "-q"),
        ("file", "--force"),
        ("file/below", "-q"),
        ("/proc/below", "-q"),
    ] {
        let output = scratch.mpirun(2, &["case.toml", "-o", directory, flag]).expect(73);
        assert_eq!(output.count("bsmpm-par:"), 1, "{output:#?}");
        assert!(output.stderr.contains(directory), "{output:#?}");
    }
    assert_eq!(std::fs::read(scratch.path("file")).unwrap(), b"mine");
}

#[test]
fn of_a_wrong_case_and_an_occupied_directory_force_deletes_nothing() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(1, &["case.toml", "-q"]).expect(0);
    for arguments in [
        &["--set", "grid.cell=-1"][..],
        &["--check"],
        &["--max-memory", "1kB"],
        &["--", "-nonsense"],
    ] {
        let output = scratch.mpirun(2, &[&["case.toml", "--force"], arguments].concat());
        assert!(matches!(output.code, Some(0 | 2 | 65 | 71)), "{output:#?}");
        assert!(
            scratch.path("case.out/frames/step_000000005.vtu").is_file(),
            "{arguments:?}"
        );
    }
}
