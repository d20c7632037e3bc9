//! Tests PETSc options after `--`.

use crate::support::Scratch;
use crate::support::cases::COLUMN;
use crate::support::results::{differences, last_frame, manifest, steps};

#[test]
fn options_after_two_dashes_reach_the_solver() {
    let scratch = Scratch::with_case(COLUMN);
    let options = ["--", "-ksp_type", "cg", "-pc_type", "jacobi", "-ksp_rtol", "1e-12"];
    for ranks in [1, 2] {
        scratch
            .mpirun(ranks, &[&["case.toml", "-q", "--force"], &options[..]].concat())
            .expect(0);
        let steps = steps(&scratch.path("case.out"));
        let linear = steps.get("linear_iterations").unwrap();
        let nonlinear = steps.get("iterations").unwrap();
        let many = linear
            .iter()
            .zip(nonlinear)
            .all(|(linear, nonlinear)| *linear > 5.0 * nonlinear);
        assert!(many, "conjugate gradients take many iterations: {linear:?}");
    }
}

/// Lines that begin with `start`.
fn lines(text: &str, start: &str) -> usize {
    text.lines().filter(|line| line.trim_start().starts_with(start)).count()
}

/// The default solver, too, is KSP's: its reports are of the run's systems only, and the manifest counts the same.
#[test]
fn ksp_reports_every_solve_of_a_default_run() {
    let scratch = Scratch::with_case(COLUMN);
    let options = ["--", "-ksp_view", "-ksp_monitor", "-ksp_converged_reason"];
    for ranks in [1, 2] {
        let output = scratch
            .mpirun(ranks, &[&["case.toml", "-q", "--force"], &options[..]].concat())
            .expect(0);
        let manifest = manifest(&scratch.path("case.out"));
        let steps = steps(&scratch.path("case.out"));
        let linear = &manifest.linear["stiffness"];
        assert_eq!((&*linear.ksp, &*linear.pc), ("preonly", "shell (dissection)"));
        let solves = linear.reasons["CONVERGED_ITS"];
        assert_eq!(linear.reasons.len(), 1, "{linear:?}");
        assert_eq!(
            solves as f64,
            steps.get("linear_iterations").unwrap().iter().sum::<f64>()
        );
        let reported = [
            "type: preonly",
            "dissection",
            "Linear solve converged due to CONVERGED_ITS",
            "1 KSP Residual norm",
        ];
        for text in reported {
            assert_eq!(lines(&output.stdout, text) as u64, solves, "{text}");
        }
        assert_eq!(
            lines(&output.stdout, "type: shell") as u64,
            2 * solves,
            "the preconditioner and the matrix"
        );
    }
}

/// A Krylov method takes the program's own factor as its preconditioner, with which it has next to nothing to do.
#[test]
fn conjugate_gradients_take_the_default_preconditioner() {
    let scratch = Scratch::with_case(COLUMN);
    for ranks in [1, 2] {
        let run = |name: &str, options: &[&str]| {
            scratch
                .mpirun(ranks, &[&["case.toml", "-q", "--force", "-o", name], options].concat())
                .expect(0);
            (manifest(&scratch.path(name)), last_frame(&scratch.path(name)))
        };
        let (whole, expected) = run("direct", &[]);
        let (manifest, found) = run("cg", &["--", "-ksp_type", "cg"]);
        let linear = &manifest.linear["stiffness"];
        assert_eq!((&*linear.ksp, &*linear.pc), ("cg", "shell (dissection)"));
        assert!(
            linear.reasons.len() == 1 && linear.reasons.contains_key("CONVERGED_RTOL"),
            "{linear:?}"
        );
        let iterations = manifest.summary.linear_iterations;
        let solves = linear.reasons["CONVERGED_RTOL"];
        assert!(
            iterations > solves && iterations <= 4 * solves,
            "{iterations} iterations in {solves} solves"
        );
        assert_eq!(whole.summary.steps, manifest.summary.steps);
        let worst = differences(&found, &expected);
        assert!(worst.iter().all(|(_, difference)| *difference < 1e-6), "{worst:?}");
    }
}

#[test]
fn the_manifest_counts_what_ksp_said() {
    let scratch = Scratch::with_case(COLUMN);
    let reports = |code: i32, options: &[&str]| {
        scratch
            .mpirun(2, &[&["case.toml", "-q", "--force"], options].concat())
            .expect(code);
        manifest(&scratch.path("case.out")).linear["stiffness"].clone()
    };
    let linear = reports(0, &["--set", "solver.linear=multigrid"]);
    assert_eq!((&*linear.ksp, &*linear.pc), ("cg", "gamg"));
    assert!(
        linear.reasons.len() == 1 && linear.reasons["CONVERGED_RTOL"] > 0,
        "{linear:?}"
    );
    let linear = reports(80, &["--", "-ksp_type", "cg", "-pc_type", "jacobi", "-ksp_max_it", "2"]);
    assert!(
        linear.reasons.len() == 1 && linear.reasons["DIVERGED_ITS"] > 0,
        "{linear:?}"
    );
}

/// Without a tolerance of their own the methods must still solve well enough to be trusted; the first row is the
/// example of the documentation.
#[test]
fn iterative_methods_work_by_their_names_alone() {
    let options: [&[&str]; 4] = [
        &["--", "-ksp_type", "cg", "-pc_type", "gamg"],
        &["--", "-ksp_type", "gmres", "-pc_type", "bjacobi"],
        &["--", "-ksp_type", "cg", "-pc_type", "jacobi"],
        &["--", "-ksp_type", "minres", "-pc_type", "none"],
    ];
    for options in options {
        let scratch = Scratch::with_case(COLUMN);
        scratch.mpirun(2, &[&["case.toml", "-q"], options].concat()).expect(0);
        assert!(
            steps(&scratch.path("case.out"))
                .get("cutbacks")
                .unwrap()
                .iter()
                .all(|cuts| *cuts == 0.0)
        );
    }
}

#[test]
fn methods_that_petsc_does_not_know_are_refused_once_before_anything_is_written() {
    for options in [
        ["-ksp_type", "bogus"],
        ["-pc_type", "bogus"],
        ["-pc_factor_mat_solver_type", "bogus"],
    ] {
        let scratch = Scratch::with_case(COLUMN);
        let shared = ["case.toml", "--set", "solver.reproducible=false", "--"];
        let output = scratch.mpirun(2, &[&shared[..], &options].concat());
        assert!(matches!(output.code, Some(2 | 65)), "{output:#?}");
        assert_eq!(output.count("bsmpm-par:"), 1, "{output:#?}");
        assert!(output.stderr.contains("bogus"), "{output:#?}");
        assert_eq!(scratch.entries(), ["case.toml"]);
    }
}

#[test]
fn log_view_reports_to_the_terminal() {
    let scratch = Scratch::with_case(COLUMN);
    scratch
        .mpirun(2, &["case.toml", "-q", "--", "-log_view"])
        .expect(0)
        .says_once("PETSc Performance Summary");
    assert_eq!(scratch.entries(), ["case.out", "case.toml"]);
}

#[test]
fn s4_options_that_write_or_read_files_or_start_programs_are_refused_once_with_2() {
    let refused: [&[&str]; 17] = [
        &["-log_view", ":pwned"],
        &["-log_view", "pwned"],
        &["-log_trace", "pwned"],
        &["-options_file", "x"],
        &["-options_view"],
        &["-on_error_attach_debugger"],
        &["-start_in_debugger"],
        &["-ksp_monitor", "ascii:pwned"],
        &["-ksp_view", ":pwned"],
        &["-ksp_view_mat", "binary"],
        &["-ksp_view_rhs", "hdf5"],
        &["-dll_append", "pwned"],
        &["-dll_prepend", "pwned"],
        &["-pc_python_type", "pwned.Pwned"],
        &["-mat_mumps_icntl_22", "1"],
        &["-mat_mumps_ooc_tmpdir", "pwned"],
        &["-ksp_monitor_solution", "vtk"],
    ];
    for options in refused {
        let scratch = Scratch::with_case(COLUMN);
        let output = scratch.mpirun(2, &[&["case.toml", "--"], options].concat()).expect(2);
        assert_eq!(output.count("bsmpm-par:"), 1, "{output:#?}");
        assert!(
            options.iter().any(|option| output.stderr.contains(option)),
            "{output:#?}"
        );
        assert_eq!(scratch.entries(), ["case.toml"], "{options:?}");
    }
}

#[test]
fn petscrc_files_and_variables_have_no_effect() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.write(".petscrc", "-log_view :pwned\n-ksp_type bogus\n");
    let home = scratch.path("");
    let job = scratch
        .job(Some(2), &["case.toml", "-q"])
        .variable("HOME", home.to_str().unwrap());
    let output = job
        .variable("PETSC_OPTIONS", "-log_view :pwned2 -ksp_type bogus")
        .run()
        .expect(0);
    assert_eq!(output.said(), "");
    assert_eq!(scratch.entries(), [".petscrc", "case.out", "case.toml"]);
}
