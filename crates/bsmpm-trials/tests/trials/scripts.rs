//! Tests the scripts, with stubs for system programs.

use crate::support::Scratch;
use crate::support::cases::endless;
use crate::support::processes::{self, Ears};
use crate::support::results::manifest;
use bsmpm_io::manifest::Status;
use bsmpm_trials::executable;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Writes a program of a directory.
fn program(directory: &Path, name: &str, body: &str) {
    let path = directory.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{body}\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// What `scripts/setup` says and its exit code where no package is installed, and apt-get ends with `code` after it has
/// printed what PETSc's package does at its first installation.
fn setup(code: i32) -> (String, Option<i32>) {
    let scratch = Scratch::new();
    let programs = scratch.path("programs");
    std::fs::create_dir(&programs).unwrap();
    program(&programs, "dpkg-query", "exit 1");
    program(&programs, "sudo", "[ \"$1\" = -n ] && shift; exec \"$@\"");
    let says = "echo 'update-alternatives: error: no alternatives for petsc' >&2; echo 'E: an error that matters' >&2";
    let apt = format!("case \"$*\" in *--simulate*) exit 0;; *update*) exit 0;; esac; {says}; exit {code}");
    program(&programs, "apt-get", &apt);
    let path = std::env::var("PATH").unwrap();
    let output = Command::new("bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/setup"))
        .env("PATH", format!("{}:{path}", programs.display()))
        .output()
        .unwrap();
    (
        String::from_utf8_lossy(&output.stderr).into_owned(),
        output.status.code(),
    )
}

/// PETSc's libraries are there, as the tests were built with them.
#[test]
fn setup_says_nothing_of_alternatives_that_a_package_makes_itself() {
    for code in [0, 100] {
        let (said, ended) = setup(code);
        assert!(
            ended == Some(0) && !said.contains("update-alternatives"),
            "{ended:?}: {said}"
        );
        // A user who is not root and has the libraries installs nothing.
        let installs = said.contains("installing gcc");
        let errors = said.matches("E: an error that matters").count();
        let expected = if code == 0 { 1 } else { 2 };
        assert!(!installs || errors == expected, "{said}");
    }
}

/// The first case of the README.
const SLOPE: &str = include_str!("../../../../cases/slope_runout.toml");

/// A cargo that has built already.
const CARGO: &str = r#"echo '"executable":"SOLVER"'; echo '"executable":"COMPANION"'"#;

/// `scripts/run` in a scratch directory, with programs that are built already and two cores.
fn run_script(scratch: &Scratch, arguments: &[&str]) -> Command {
    let programs = scratch.path("programs");
    std::fs::create_dir_all(&programs).unwrap();
    let [solver, companion] = ["bsmpm-par", "bsmpm"].map(|name| executable(name).to_str().unwrap());
    program(
        &programs,
        "cargo",
        &CARGO.replace("SOLVER", solver).replace("COMPANION", companion),
    );
    // As the program of that name, which follows OpenMP.
    program(&programs, "nproc", "echo \"${OMP_NUM_THREADS:-2}\"");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/run");
    // Jobs in the background ignore the signal, and so would all that they start.
    let mut command = Command::new("env");
    command
        .args(["--default-signal=INT", "bash"])
        .arg(&script)
        .args(arguments)
        .current_dir(scratch.path(""));
    command.env(
        "PATH",
        format!("{}:{}", programs.display(), std::env::var("PATH").unwrap()),
    );
    command
}

/// Ctrl-C of a terminal reaches the script alone, which passes on what mpirun forwards.
#[test]
fn an_interrupted_script_stops_the_run_and_says_how_to_continue() {
    let scratch = Scratch::with_case(&endless());
    let command = run_script(&scratch, &["-n", "2", "case.toml"]);
    let mut running = processes::start(command, &[], Ears::Open, Duration::from_secs(120));
    running.until("its tenth step", || {
        std::fs::read_to_string(scratch.path("case.out/steps.csv")).is_ok_and(|text| text.lines().count() > 12)
    });
    running.signal("INT");
    let output = running.end().expect(75);
    output.says_once("stopped by a signal (Ctrl-C or kill)");
    output.says_once("run -n 2 case.toml -o case.out --restart auto");
    assert_eq!(manifest(&scratch.path("case.out")).status, Status::Stopped);
}

/// Of 800 points one rank is as fast as two, of 16,000 points two are faster.
#[test]
fn a_script_takes_as_many_ranks_as_the_check_recommends() {
    for (case, ranks) in [(endless(), 1), (SLOPE.to_owned(), 2)] {
        let scratch = Scratch::with_case(&case);
        let command = run_script(&scratch, &["case.toml", "--max-steps", "1"]);
        processes::start(command, &[], Ears::Open, Duration::from_secs(120))
            .end()
            .expect(75);
        assert_eq!(manifest(&scratch.path("case.out")).ranks, ranks);
    }
}
