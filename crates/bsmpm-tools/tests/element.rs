//! Tests `bsmpm element`.

use std::fs;
use std::path::{Path, PathBuf};

use bsmpm_io::table;
use bsmpm_tools::Error;
use bsmpm_tools::element::{ElementArguments, run};

const CASE: &str = "../../cases/element_tests.toml";

fn arguments(case: &Path, output: &Path) -> ElementArguments {
    let tests = Vec::new();
    let set = Vec::new();
    ElementArguments {
        case: case.to_owned(),
        tests,
        material: None,
        output: Some(output.to_owned()),
        set,
    }
}

#[test]
fn the_example_gives_the_strengths_that_its_comments_tell() {
    let directory = tempfile::tempdir().unwrap();
    let (table, files) = run(&arguments(Path::new(CASE), directory.path()), |_| {}).unwrap();
    assert_eq!((files.len(), table.lines().count()), (8, 7), "{table}");
    assert!(files.iter().all(|file| fs::metadata(file).unwrap().len() > 1000));
    let read = |name: &str| table::read(&directory.path().join(format!("{name}.csv"))).unwrap();
    let sin = 35_f64.to_radians().sin();
    for (name, cell) in [("drained-100", 1e5), ("drained-200", 2e5)] {
        let found = read(name);
        assert_eq!(
            (found.unit("deviator"), found.unit("strain-yy")),
            (Some("Pa"), Some("-"))
        );
        let last = *found.get("deviator").unwrap().last().unwrap();
        assert!((last / (2.0 * sin / (1.0 - sin) * cell) - 1.0).abs() < 1e-9, "{last}");
        assert!(
            found
                .get("stress-xx")
                .unwrap()
                .iter()
                .all(|stress| (stress + cell).abs() < 1e-3)
        );
    }
    let undrained = read("undrained");
    let water = undrained.get("pore-pressure").unwrap();
    let volume = undrained.get("volume-strain").unwrap();
    assert!(water[100] == 0.0 && water[120] > 0.0 && (volume[200] - volume[100]).abs() < 1e-14);
    let oedometer = read("oedometer");
    let x = oedometer.get("stress-xx").unwrap();
    let y = oedometer.get("stress-yy").unwrap();
    // From p = 10 kPa on, K0 = ν/(1 - ν) of what is added, but for the volume: Kirchhoff's stress follows the law.
    let volume = oedometer.get("volume-strain").unwrap();
    let kirchhoff = |of: &[f64], row: usize| of[row] * volume[row].exp() + 1e4;
    assert!((kirchhoff(x, 300) / kirchhoff(y, 300) - 1.0 / 3.0).abs() < 1e-9);
    assert!((y[100] + 4e5).abs() < 1e-3 && (y[200] + 1e5).abs() < 1e-3 && (y[300] + 8e5).abs() < 1e-3);
}

#[test]
fn one_test_of_another_material_by_options() {
    let directory = tempfile::tempdir().unwrap();
    let mut arguments = arguments(Path::new(CASE), directory.path());
    arguments.tests = vec!["drained-100".to_owned()];
    arguments.material = Some("clay".to_owned());
    arguments.set = vec!["material.clay.cohesion=20 kPa".to_owned()];
    let (table, files) = run(&arguments, |_| {}).unwrap();
    assert!(
        files.len() == 2 && table.contains("clay") && !table.contains("sand"),
        "{table}"
    );
    let found = table::read(&files[0]).unwrap();
    let last = *found.get("deviator").unwrap().last().unwrap();
    let volume = found.get("volume-strain").unwrap();
    assert!((last * volume[100].exp() / 4e4 - 1.0).abs() < 1e-9, "{last}");
    arguments.tests = vec!["drained".to_owned()];
    assert!(matches!(run(&arguments, |_| {}), Err(Error::Usage { reason }) if reason.contains("drained-100")));
}

/// Of a solid the height is z, which a grid that begins elsewhere along y does not change.
#[test]
fn a_strength_by_depth_in_a_solid_is_that_of_the_height_along_z() {
    let directory = tempfile::tempdir().unwrap();
    let case = directory.path().join("case.toml");
    let text = r#"
        geometry = "3d"
        analysis = { type = "quasi-static", steps = 1 }
        grid = { lower = [0, -10, -5], upper = [1, -9, 0], cell = 1, degree = "quadratic" }
        boundary = { bottom = "fixed" }
        [material.clay]
        model = "tresca"
        young = "20 MPa"
        poisson = 0.3
        cohesion = { value = "20 kPa", at_y = 0, per_metre = "2 kPa/m" }
        [[body]]
        material = "clay"
        box = { lower = [0, -10, -5], upper = [1, -9, 0] }
        points_per_cell = 2
        [element.sample]
        height = -3
        stage = [{ test = "triaxial", compression = 0.01 }]
    "#;
    fs::write(&case, text).unwrap();
    let (_, files) = run(&arguments(&case, directory.path()), |_| {}).unwrap();
    let found = table::read(&files[0]).unwrap();
    let last = found.get("deviator").unwrap().last();
    let volume = found.get("volume-strain").unwrap().last();
    let kirchhoff = last.unwrap() * volume.unwrap().exp();
    assert!((kirchhoff / (2.0 * 26e3) - 1.0).abs() < 1e-9, "{kirchhoff}");
}

/// The table ends where the material was left, and the program says so.
#[test]
fn what_a_material_cannot_carry_ends_the_test_with_code_80() {
    let directory = tempfile::tempdir().unwrap();
    let mut arguments = arguments(Path::new(CASE), directory.path());
    arguments.tests = vec!["drained-100".to_owned()];
    arguments.set = vec!["element.drained-100.stage.0.pressure=500 kPa".to_owned()];
    let mut reported = String::new();
    let error = run(&arguments, |line| reported.push_str(line)).unwrap_err();
    assert_eq!(error.exit_code(), 80);
    assert!(
        error.to_string().contains("stress-yy") && reported.contains("drained-100"),
        "{error}, {reported}"
    );
    let found = table::read(&directory.path().join("drained-100.csv")).unwrap();
    let last = *found.get("deviator").unwrap().last().unwrap();
    assert!(last > 2.6e5 && last < 2.7e5, "{last}");
}

#[test]
fn a_case_without_tests_says_how_to_write_one() {
    let directory = tempfile::tempdir().unwrap();
    let case: PathBuf = "../../cases/short/slope_stability.toml".into();
    let error = run(&arguments(&case, directory.path()), |_| {}).unwrap_err();
    assert!(
        error.exit_code() == 2 && error.to_string().contains("[element.NAME]"),
        "{error}"
    );
}

/// A test has its own pressure: it asks neither for the stress of the ground at the start nor for its weight.
#[test]
fn cam_clay_is_tested_without_a_stress_of_the_ground_at_the_start() {
    let directory = tempfile::tempdir().unwrap();
    let case = directory.path().join("case.toml");
    let text = r#"
        geometry = "plane-strain"
        analysis = { type = "quasi-static", steps = 1 }
        grid = { lower = [0, 0], upper = [1, 1], cell = 0.5, degree = "quadratic" }
        boundary = { bottom = "fixed" }
        [material.clay]
        model = "modified-cam-clay"
        young = "10 MPa"
        poisson = 0.3
        kappa_star = 0.02
        lambda_star = 0.12
        critical_state_ratio = 1.0
        preconsolidation = "200 kPa"
        [[body]]
        material = "clay"
        box = { lower = [0, 0], upper = [1, 1] }
        points_per_cell = 2
        [element.cd]
        pressure = "200 kPa"
        stage = [{ test = "triaxial", compression = 1.5 }]
    "#;
    fs::write(&case, text).unwrap();
    run(&arguments(&case, directory.path()), |_| {}).expect("a test that needs no [initial]");
    let found = table::read(&directory.path().join("cd.csv")).unwrap();
    // Drained with M = 1, q = 3 (p - p0) approaches q = M p at q = 3 M p0 / (3 - M) = 300 kPa.
    let last = *found.get("deviator").unwrap().last().unwrap();
    assert!((last / 3e5 - 1.0).abs() < 0.01, "{last}");
    // A run of the case does need them.
    let error = bsmpm_scene::Case::from_text("case.toml", text, &[]).unwrap_err();
    assert_eq!(error[0].code.as_deref(), Some("E0318"), "{error:?}");
}
