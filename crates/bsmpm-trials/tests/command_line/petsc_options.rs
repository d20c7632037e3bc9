//! Options of PETSc come after `--` and from nowhere else, and none of them writes or reads a file.

use crate::support::Scratch;
use crate::support::cases::COLUMN;
use crate::support::results::steps;

#[test]
fn options_after_two_dashes_reach_the_solver() {
    let scratch = Scratch::with_case(COLUMN);
    let options = ["--", "-ksp_type", "cg", "-pc_type", "jacobi", "-ksp_rtol", "1e-12"];
    for ranks in [1, 2] {
        scratch.mpirun(ranks, &[&["case.toml", "-q", "--force"], &options[..]].concat()).expect(0);
        let steps = steps(&scratch.path("case.out"));
        let (linear, nonlinear) = (steps.get("linear_iterations").unwrap(), steps.get("iterations").unwrap());
        let many = linear.iter().zip(nonlinear).all(|(linear, nonlinear)| *linear > 5.0 * nonlinear);
        assert!(many, "conjugate gradients take many iterations: {linear:?}");
    }
}

/// Without a tolerance of their own the methods must still solve well enough to be trusted; the first row is the example
/// of the documentation.
#[test]
fn iterative_methods_work_by_their_names_alone() {
    let options: [&[&str]; 4] = [
        &["--", "-ksp_type", "cg", "-pc_type", "gamg"],
        &["--", "-ksp_type", "gmres", "-pc_type", "bjacobi"],
        &["--set", "solver.linear={ ksp = \"cg\", pc = \"jacobi\" }"],
        &["--set", "solver.linear={ ksp = \"minres\", pc = \"none\" }"],
    ];
    for options in options {
        let scratch = Scratch::with_case(COLUMN);
        scratch.mpirun(2, &[&["case.toml", "-q"], options].concat()).expect(0);
        assert!(steps(&scratch.path("case.out")).get("cutbacks").unwrap().iter().all(|cuts| *cuts == 0.0));
    }
}

#[test]
fn methods_that_petsc_does_not_know_are_refused_once_before_anything_is_written() {
    for options in [["-ksp_type", "bogus"], ["-pc_type", "bogus"], ["-pc_factor_mat_solver_type", "bogus"]] {
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
    scratch.mpirun(2, &["case.toml", "-q", "--", "-log_view"]).expect(0).says_once("PETSc Performance Summary");
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
        assert!(options.iter().any(|option| output.stderr.contains(option)), "{output:#?}");
        assert_eq!(scratch.entries(), ["case.toml"], "{options:?}");
    }
}

#[test]
fn petscrc_files_and_variables_have_no_effect() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.write(".petscrc", "-log_view :pwned\n-ksp_type bogus\n");
    let home = scratch.path("");
    let job = scratch.job(Some(2), &["case.toml", "-q"]).variable("HOME", home.to_str().unwrap());
    let output = job.variable("PETSC_OPTIONS", "-log_view :pwned2 -ksp_type bogus").run().expect(0);
    assert_eq!(output.said(), "");
    assert_eq!(scratch.entries(), [".petscrc", "case.out", "case.toml"]);
}
