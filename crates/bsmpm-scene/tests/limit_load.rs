//! Tests cases of limit load analyses.

use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, Error, HistorySubject};

const SAND: &str = include_str!("../../../cases/limit_load/strip_on_sand.toml");
const CLAY: &str = include_str!("../../../cases/limit_load/strip_on_clay.toml");
const PUNCH: &str = include_str!("../../../cases/limit_load/punch_on_clay.toml");

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text(
        "case.toml",
        text,
        &overrides.iter().map(ToString::to_string).collect::<Vec<_>>(),
    )
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    read(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

fn refused(text: &str, overrides: &[&str], words: &str) {
    let errors = read(text, overrides)
        .err()
        .unwrap_or_else(|| panic!("{overrides:?} is valid"));
    assert!(
        errors.iter().any(|error| error.to_string().contains(words)),
        "{words}: {errors:#?}"
    );
}

fn warned(case: &Case, words: &str) -> bool {
    case.warnings.iter().any(|warning| warning.contains(words))
}

#[test]
fn it_chooses_points_steps_tolerances_and_the_method_of_the_flow_rule() {
    for (text, method) in [(SAND, Stabilisation::None), (CLAY, Stabilisation::ConsistentFBar)] {
        for accuracy in ["draft", "standard", "reference"] {
            let case = valid(text, &[&format!("accuracy={accuracy}")]);
            assert_eq!(
                (case.stabilisation, case.grid.order, case.bodies[0].points_per_cell),
                (method, 2, 2)
            );
            assert_eq!(case.solver.background, 2e-5);
            assert!((case.analysis.dt - 1.0 / 40.0).abs() < 1e-15 && case.solver.force_tolerance <= 1e-4);
        }
        let by_hand = [
            "stabilisation.method=f-bar",
            "analysis.steps=10",
            "body.0.points_per_cell=3",
        ];
        let case = valid(text, &by_hand);
        assert_eq!(
            (case.stabilisation, case.bodies[0].points_per_cell),
            (Stabilisation::FBar, 3)
        );
        assert_eq!((1.0 / case.analysis.dt).round(), 10.0);
    }
}

/// The product of stiffness and displacement stays, and nothing moves by more than 5e-4 of the smallest cell (0.25 m).
#[test]
fn the_ground_becomes_stiff_as_the_displacement_becomes_small() {
    let plain = valid(CLAY, &["analysis={ type = \"quasi-static\" }"]);
    let case = valid(CLAY, &[]);
    let sought = case.limit_load.as_ref().expect("a search");
    let moved = |case: &Case| case.footing.as_ref().expect("a footing").path.farthest();
    let young = |case: &Case| case.materials[0].material.elastic().young;
    assert!(plain.limit_load.is_none());
    assert!(
        (moved(&case) - 5e-4 * 0.25).abs() < 1e-3 * moved(&case),
        "{}",
        moved(&case)
    );
    assert!((moved(&case) * sought.stiffness / moved(&plain) - 1.0).abs() < 1e-12);
    assert!((young(&case) / sought.stiffness / young(&plain) - 1.0).abs() < 1e-12);
    // What moves as little as that already keeps its stiffness.
    let small = valid(CLAY, &["footing.displacement=[0.0, -1e-5]"]);
    assert_eq!(small.limit_load.expect("a search").stiffness, 1.0);
}

#[test]
fn loads_are_columns_of_the_history() {
    let case = valid(SAND, &[]);
    let load = &case.limit_load.as_ref().expect("a search").loads[0];
    assert_eq!(
        (&*load.name, &load.columns[..]),
        ("footing", &[("N_gamma".to_owned(), 1.0)][..])
    );
    let width = load.width.expect("a width");
    assert_eq!(
        (width.length, width.modelled),
        (2.0, 0.5),
        "the roller cuts it in its middle"
    );
    assert!((width.cells - 8.0).abs() < 1e-9, "{width:?}");
    // Without a history of its own there is one more column.
    let case = valid(PUNCH, &[]);
    let load = &case.limit_load.as_ref().expect("a search").loads[0];
    let width = load.width.expect("a width");
    assert_eq!(
        (&*load.name, width.length, width.modelled),
        ("punch", 2.0, 0.5),
        "half of it lies beyond the roller"
    );
    assert!((width.cells - 8.0).abs() < 1e-9, "{width:?}");
    assert_eq!(
        load.columns,
        [("punch-load-y".to_owned(), 1.0)],
        "the soil pushes it up, against its motion"
    );
    assert_eq!(
        case.histories.last().expect("a history").quantity.subject,
        HistorySubject::Rigid(0)
    );
}

/// A footing that moves along its base has a force along its motion, and a pressure if it moves along its normal.
#[test]
fn the_load_of_a_footing_that_moves_sideways_is_its_force_along_its_motion() {
    let case = valid(SAND, &["footing.displacement=[0.03, -0.04]"]);
    let load = &case.limit_load.as_ref().expect("a search").loads[0];
    let columns: Vec<&str> = load.columns.iter().map(|(name, _)| &**name).collect();
    assert_eq!(columns, ["footing-load-x", "footing-load-y"]);
    assert!(
        (load.columns[0].1 - 0.6).abs() < 1e-12 && (load.columns[1].1 + 0.8).abs() < 1e-12,
        "{load:?}"
    );
    // It moves by less than a thousandth of a cell, so that its end stays on its grid line.
    assert!(
        case.warnings.iter().all(|warning| !warning.starts_with("W0226")),
        "{:?}",
        case.warnings
    );
}

#[test]
fn motions_along_which_no_limit_load_is_found_are_refused() {
    let graded = "grid={ lower = [0.0, 0.0], upper = [6.0, 3.5], cell = [0.4, 0.25], degree = \"quadratic\" }";
    refused(CLAY, &[graded], "E0448");
    let stops = "footing={ from = [0.0, 3.0], to = [1.0, 3.0], interface = \"smooth\", path = [[0.5, 0.0, -0.2], [1.0, 0.0, -0.2]] }";
    refused(CLAY, &[stops], "E0449");
    let back = "footing={ from = [0.0, 3.0], to = [1.0, 3.0], interface = \"smooth\", path = [[0.5, 0.0, -0.2], [1.0, 0.0, -0.1]] }";
    refused(CLAY, &[back], "E0449");
    let wall =
        "prescribed.0={ from = [0.0, 2.0], to = [0.0, 3.0], displacement = [0.1, 0.0], components = \"normal\" }";
    refused(CLAY, &[wall], "E0450: analysis.purpose: boundary `left`");
    // What cannot be read is no second error.
    let errors = read(CLAY, &["footing.displacement=\"down\""]).expect_err("an error");
    assert!(
        errors.iter().all(|error| !error.to_string().contains("E0442")),
        "{errors:#?}"
    );
}

#[test]
fn what_has_no_limit_load_is_refused() {
    refused(
        SAND,
        &["footing.displacement=[0.0, 0.0]", "footing.interface=rough"],
        "E0442",
    );
    refused(SAND, &["solver.force_tolerance=1e-3"], "E0451");
    refused(SAND, &["strength_reduction.factor=1.2"], "E0445");
    let hardening =
        "material.clay={ model = \"von-mises\", young = 5e6, poisson = 0.49, yield_stress = 2e4, hardening = 1e5 }";
    refused(CLAY, &[hardening], "E0446");
    refused(PUNCH, &["rigid.0.rotation=[[1.0, 5.0]]"], "E0447");
    let clay = "kappa_star = 0.05, lambda_star = 0.2, critical_state_ratio = 1.0, preconsolidation = \"50 kPa\"";
    let clay = format!("material.clay={{ model = \"cam-clay\", young = 5e6, poisson = 0.3, {clay} }}");
    assert!(read(CLAY, &[&clay]).is_err());
    let in_time = "analysis={ type = \"quasi-static-rate\", end = 1.0, purpose = \"limit-load\" }";
    refused(CLAY, &[in_time], "E0443");
}

#[test]
fn settings_with_which_limit_loads_are_wrong_are_warned_of() {
    assert!(valid(SAND, &[]).warnings.is_empty(), "{:?}", valid(SAND, &[]).warnings);
    assert!(warned(&valid(SAND, &["body.0.points_per_cell=3"]), "W0423"));
    assert!(warned(
        &valid(SAND, &["material.sand.dilation_angle=0.0"]),
        "W0425: material.sand"
    ));
    let averaged = "stabilisation.method=consistent-f-bar";
    assert!(warned(&valid(SAND, &[averaged]), "W0426"));
    // Also without the purpose, and not with cohesion.
    let plain = "analysis={ type = \"quasi-static\" }";
    assert!(warned(&valid(SAND, &[averaged, plain]), "W0426"));
    assert!(!warned(
        &valid(SAND, &[averaged, "material.sand.cohesion=\"20 kPa\""]),
        "W0426"
    ));
    // gamma B = 40 kPa.
    let small = valid(SAND, &["material.sand.cohesion=\"0.5 kPa\""]);
    assert!(
        warned(
            &small,
            "W0427: material.sand: the cohesion is small, c / (gamma B) = 1.3e-2"
        ),
        "{:?}",
        small.warnings
    );
    assert_eq!(small.limit_load.expect("a search").small_cohesions, ["sand"]);
    assert!(!warned(&valid(SAND, &["material.sand.cohesion=\"10 kPa\""]), "W0427"));
}
