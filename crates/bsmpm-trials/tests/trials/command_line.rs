//! Tests arguments, refusals and exit codes.

mod bad_cases;
mod directory;
mod hostile;
mod log;
mod newcomer;
mod petsc_options;

use crate::support::Scratch;
use crate::support::cases::{COLUMN, changed};
use crate::support::results::{history, manifest, steps};
use bsmpm_io::manifest::Status;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

#[test]
fn help_and_version_are_said_once_and_are_no_error() {
    let scratch = Scratch::new();
    for (flag, says) in [
        ("--help", "Usage:"),
        ("--version", concat!("bsmpm-par ", env!("CARGO_PKG_VERSION"))),
    ] {
        let output = scratch.mpirun(2, &[flag]).expect(0);
        output.says_once(says);
        assert_eq!(output.stderr, "");
        scratch.direct(&[flag]).expect(0).says_once(says);
    }
}

#[test]
fn a_wrong_command_line_is_refused_once_with_2_and_leaves_nothing() {
    let scratch = Scratch::with_case(COLUMN);
    let wrong: [(&[&str], &str); 12] = [
        (&["case.toml", "--frobnicate"], "--frobnicate"),
        (&[], "required arguments"),
        (&["case.toml", "other.toml"], "other.toml"),
        (&["case.toml", "--set"], "--set"),
        (&["case.toml", "--max-steps", "many"], "many"),
        (&["case.toml", "--max-steps", "-3"], "'-3'"),
        (&["case.toml", "--max-wall", "90"], "HH:MM:SS"),
        (&["case.toml", "--max-memory", "a lot"], "a lot is no size"),
        (&["case.toml", "--log-format", "xml"], "xml"),
        (&["case.toml", "--frames", "vtkhdf"], "E0703"),
        (&["case.toml", "--threads", "0"], "0 is not in 1..=1024"),
        (&["case.toml", "--restart", "auto", "--force"], "cannot be used with"),
    ];
    for (arguments, says) in wrong {
        let output = scratch.mpirun(2, arguments).expect(2);
        assert_eq!(
            output.count("error:") + output.count("bsmpm-par: "),
            1,
            "said once: {output:#?}"
        );
        assert!(
            output.stderr.contains(says) && output.stdout.is_empty(),
            "{says}: {output:#?}"
        );
        assert_eq!(scratch.entries(), ["case.toml"], "{arguments:?}");
    }
}

#[test]
fn a_case_that_cannot_be_read_is_refused_once_with_66() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path("folder.toml")).unwrap();
    for name in ["missing.toml", "folder.toml", "/dev/zero"] {
        scratch.mpirun(2, &[name]).expect(66).says_once(name);
        scratch.direct(&[name]).expect(66).says_once(name);
    }
    assert_eq!(scratch.entries(), ["folder.toml"]);
}

#[test]
fn a_name_that_is_no_utf_8_is_a_name_like_any_other() {
    let scratch = Scratch::with_case(COLUMN);
    let name = OsStr::from_bytes(b"case \xff.toml");
    std::fs::rename(scratch.path("case.toml"), scratch.path("").join(name)).unwrap();
    scratch
        .job(Some(2), &["-q", "-o", "out"])
        .argument(name.as_bytes())
        .run()
        .expect(0);
    assert_eq!(manifest(&scratch.path("out")).case.file, "case \u{fffd}.toml");
}

#[test]
fn check_prints_the_sizes_once_and_writes_nothing() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch.mpirun(2, &["case.toml", "--check"]).expect(0);
    let line = |name: &str| {
        let lines: Vec<&str> = output.stdout.lines().filter(|line| line.starts_with(name)).collect();
        assert_eq!(lines.len(), 1, "{name}: {output:#?}");
        lines[0].to_owned()
    };
    assert!(line("points").ends_with(" 64") && line("cells").ends_with(" 20") && line("nodes").ends_with(" 42"));
    assert!(line("unknowns").contains(" 84") && line("nominal steps").ends_with(" 5"));
    assert!(line("memory").contains("2 rank"));
    assert_eq!(scratch.entries(), ["case.toml"]);
    scratch
        .mpirun(2, &["case.toml", "--check", "--set", "material.soil.poisson=0.7"])
        .expect(65);
}

#[test]
fn a_case_that_needs_more_memory_than_allowed_is_refused_once_with_71() {
    let scratch = Scratch::with_case(COLUMN);
    scratch
        .mpirun(2, &["case.toml", "--max-memory", "10kB"])
        .expect(71)
        .says_once("or increase `--max-memory`.");
    assert_eq!(scratch.entries(), ["case.toml"]);
    scratch
        .mpirun(2, &["case.toml", "--max-memory", "1GiB", "-q"])
        .expect(0);
}

#[test]
fn overrides_take_effect_and_are_in_the_manifest() {
    let scratch = Scratch::with_case(COLUMN);
    let set = [
        "--set",
        "analysis.dt=0.5",
        "--set",
        "output.every=0.5",
        "--set",
        "material.soil.young=2 MPa",
    ];
    scratch.mpirun(2, &[&["case.toml", "-q"], &set[..]].concat()).expect(0);
    let directory = scratch.path("case.out");
    assert_eq!(history(&directory).get("time").unwrap(), [0.0, 0.5, 1.0]);
    let manifest = manifest(&directory);
    assert!(
        manifest.case.text.contains("2 MPa") && !manifest.case.text.contains("1 MPa"),
        "{}",
        manifest.case.text
    );
    assert!(
        manifest.argv.iter().any(|argument| argument == "analysis.dt=0.5"),
        "{:?}",
        manifest.argv
    );
}

#[test]
fn max_steps_stops_with_75_after_as_many_steps() {
    let scratch = Scratch::with_case(COLUMN);
    for (most, code, status) in [
        (3, 75, Status::Stopped),
        (0, 75, Status::Stopped),
        (5, 0, Status::Finished),
    ] {
        scratch
            .mpirun(2, &["case.toml", "-q", "--force", "--max-steps", &most.to_string()])
            .expect(code);
        let directory = scratch.path("case.out");
        let manifest = manifest(&directory);
        assert_eq!(
            (manifest.status, manifest.exit_code.map(i32::from)),
            (status, Some(code))
        );
        let checkpoint = (code == 75).then(|| format!("checkpoint/step_{most:09}.h5"));
        assert_eq!((manifest.summary.steps, manifest.checkpoint), (most, checkpoint));
        assert_eq!(steps(&directory).get("step").unwrap().len() as u64, most);
        let last = crate::support::results::last_frame(&directory);
        assert_eq!(last.step, most, "the last state is in the last frame");
    }
}

#[test]
fn max_wall_stops_with_75() {
    let scratch = Scratch::with_case(&changed(COLUMN, "steps = 5", "steps = 1000000"));
    scratch
        .mpirun(2, &["case.toml", "-q", "--max-wall", "00:00:01"])
        .expect(75);
    let manifest = manifest(&scratch.path("case.out"));
    assert_eq!((manifest.status, manifest.exit_code), (Status::Stopped, Some(75)));
    assert!(manifest.summary.steps > 0);
}

#[test]
fn a_failed_check_ends_with_77_and_says_so_once() {
    let check = "\n[[check]]\nquantity = \"height\"\nmin = 100.0\n\n[[check]]\nquantity = \"height\"\nmax = 4.0\n";
    let scratch = Scratch::with_case(&format!("{COLUMN}{check}"));
    let output = scratch.mpirun(2, &["case.toml", "-q"]).expect(77);
    output.says_once("height");
    let manifest = manifest(&scratch.path("case.out"));
    assert_eq!((manifest.status, manifest.exit_code), (Status::Failed, Some(77)));
    let passed: Vec<bool> = manifest.checks.iter().map(|check| check.passed).collect();
    assert_eq!(passed, [false, true]);
    assert!(
        manifest.checks[0]
            .value
            .is_some_and(|height| height > 3.0 && height < 4.0),
        "{:?}",
        manifest.checks
    );
}

/// A launcher of another MPI starts N runs that do not know of each other.
#[test]
fn n_serial_copies_are_refused_with_78() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch
        .job(None, &["case.toml"])
        .variable("PMI_SIZE", "4")
        .run()
        .expect(78);
    output.says_once("error E0773: mpirun started 4 separate processes");
    assert_eq!(scratch.entries(), ["case.toml"]);
}
