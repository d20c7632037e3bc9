//! Tests of cases and command lines that have no factor of safety.

use super::{Bench, CLAY, SLOPE, text};
use std::process::Command;
use std::{env, fs};

#[test]
fn a_case_without_a_factor_of_safety_is_refused_before_anything_runs() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    let strip = "footing={ from = [0.0, 10.0], to = [2.0, 10.0], displacement = [0.0, -0.1] }";
    let wall = "rigid=[{ name = \"wall\", polygon = [[34, 0], [36, 0], [36, 4]], displacement = [-0.1, 0.0] }]";
    for (set, reported) in [
        (
            vec!["solver.tolerance=2e-3"],
            "E0823: solver.tolerance = 2e-3 is too large",
        ),
        (
            vec!["solver.force_tolerance=1e-2"],
            "E0823: solver.force_tolerance = 1e-2",
        ),
        (vec!["analysis.type=dynamic"], "E0810"),
        (
            vec!["material.soil={ model = \"elastic\", young = 1e8, poisson = 0.3, density = 2e3 }"],
            "E0816",
        ),
        (
            vec![
                "analysis.type=quasi-static-rate",
                "material.soil={ model = \"sensitive-clay\", young = 1e8, poisson = 0.49, density = 2e3, cohesion = 5e4, \
                  sensitivity = 4, softening_strain = 10, rate_parameter = 0.1, reference_rate = 1e-4 }",
            ],
            "E0813",
        ),
        (vec!["initial.k0=0.5", "gravity.ramp=0.0", CLAY], "E0812"),
        (
            vec![
                "material.soil={ model = \"mohr-coulomb-softening\", young = 1e8, poisson = 0.3, density = 2e3, cohesion = 1e4, \
                  friction_angle = 25, residual_friction_angle = 35, residual_cohesion = 1e4, softening_strain = 0.1 }",
            ],
            "E0811",
        ),
        (vec!["stage=[{ at = 0.5, reset_displacements = true }]"], "E0814"),
        (vec!["gravity.acceleration=[0.0, 0.0]"], "E0817"),
        (vec!["gravity.ramp=2.0"], "E0819"),
        (
            vec!["point_load=[{ at = [2.0, 9.0], force = [0.0, -1e3], amplitude = [[0.5, 1.0]] }]"],
            "E0818",
        ),
        (vec![strip], "E0822"),
        (vec![wall], "E0821"),
        (vec!["grid.cel=1.0"], "grid.cel"),
    ] {
        let options: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
        let output = bench.fos(&options);
        let said = text(&output.stderr);
        assert!(
            output.status.code() == Some(65) && said.contains(reported),
            "{set:?}: {output:?}"
        );
    }
    let stage = "stage=[{ at = 0.5, name = \"dug\", reset_displacements = true }]";
    let output = bench.fos(&["--set", stage, "--stage", "start"]);
    let said = text(&output.stderr);
    assert!(output.status.code() == Some(65) && said.contains("E0636"), "{output:?}");
    let output = bench.fos(&["--set", stage, "--stage", "dig"]);
    assert!(
        output.status.code() == Some(2) && text(&output.stderr).contains("\"dug\", \"start\", \"end\""),
        "{output:?}"
    );
    let output = bench.fos(&["--set", "solver.tolerance=1e-2", "--set", "gravity.ramp=2.0"]);
    let lines: Vec<String> = text(&output.stderr).lines().map(str::to_owned).collect();
    assert!(
        lines[0].starts_with("bsmpm: error E0823: ") && lines[1].starts_with("error E0819: "),
        "{lines:?}"
    );
    assert!(
        lines.len() == 3 && lines[2].ends_with("no factor of safety; nothing was run"),
        "{lines:?}"
    );
    fs::remove_file(bench.path("slope.toml")).unwrap();
    assert_eq!(bench.fos(&[]).status.code(), Some(66));
    assert!(bench.calls() == 0 && !bench.path("slope.fos").exists());
}

#[test]
fn a_wrong_command_line_is_refused_with_2() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    for options in [
        &["--from", "2", "--to", "1"][..],
        &["--from", "0.1"],
        &["--to", "101"],
        &["--to", "nan"],
        &["--width", "0"],
        &["--width", "5"],
        &["--width", "wide"],
        &["--stage", "end", "--from", "0.5", "--to", "0.9"],
        &["--stage", "nowhere"],
        &["--set", "strength_reduction.factor=2"],
        &["--set", "strength_reduction={factor = 2}"],
        &["--unknown"],
    ] {
        assert_eq!(bench.fos(options).status.code(), Some(2), "{options:?}");
    }
    let without = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bsmpm"));
        command
            .current_dir(bench.folder.path())
            .args(arguments)
            .output()
            .unwrap()
            .status
            .code()
    };
    assert_eq!(without(&["fos"]), Some(2));
    assert_eq!(without(&["fos", "slope.toml", "--jobs", "0"]), Some(2));
    assert_eq!(without(&["fos", "slope.toml", "--", "./nowhere/bsmpm-par"]), Some(74));
    assert_eq!(bench.calls(), 0);
}
