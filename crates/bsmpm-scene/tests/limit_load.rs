//! `[analysis] purpose = "limit-load"`: what it chooses, refuses and warns of.

use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, Error, Quantity};

const SAND: &str = include_str!("../../../cases/limit_load/strip_on_sand.toml");
const CLAY: &str = include_str!("../../../cases/limit_load/strip_on_clay.toml");
const PUNCH: &str = include_str!("../../../cases/limit_load/punch_on_clay.toml");

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text("case.toml", text, &overrides.iter().map(ToString::to_string).collect::<Vec<_>>())
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    read(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

fn refused(text: &str, overrides: &[&str], words: &str) {
    let errors = read(text, overrides).err().unwrap_or_else(|| panic!("{overrides:?} is valid"));
    assert!(errors.iter().any(|error| error.to_string().contains(words)), "{words}: {errors:#?}");
}

fn warned(case: &Case, words: &str) -> bool {
    case.warnings.iter().any(|warning| warning.contains(words))
}

#[test]
fn it_chooses_points_steps_tolerances_and_the_method_of_the_flow_rule() {
    for (text, method) in [(SAND, Stabilisation::None), (CLAY, Stabilisation::ConsistentFBar)] {
        for accuracy in ["draft", "standard", "reference"] {
            let case = valid(text, &[&format!("accuracy={accuracy}")]);
            assert_eq!((case.stabilisation, case.grid.order, case.bodies[0].points_per_cell), (method, 2, 2));
            assert_eq!(case.solver.background, 2e-5);
            assert!((case.analysis.dt - 1.0 / 40.0).abs() < 1e-15 && case.solver.force_tolerance <= 1e-4);
        }
        let by_hand = ["stabilisation.method=f-bar", "analysis.steps=10", "body.0.points_per_cell=3"];
        let case = valid(text, &by_hand);
        assert_eq!((case.stabilisation, case.bodies[0].points_per_cell), (Stabilisation::FBar, 3));
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
    assert!((moved(&case) - 5e-4 * 0.25).abs() < 1e-3 * moved(&case), "{}", moved(&case));
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
    assert_eq!((&*load.name, &load.columns[..]), ("footing", &[("N_gamma".to_owned(), 1.0)][..]));
    assert_eq!(load.width, Some(2.0), "the roller cuts it in its middle");
    // Without a history of its own there is one more column.
    let case = valid(PUNCH, &[]);
    let load = &case.limit_load.as_ref().expect("a search").loads[0];
    assert_eq!((&*load.name, load.width), ("punch", Some(2.0)));
    assert_eq!(load.columns, [("punch-load-y".to_owned(), 1.0)], "the soil pushes it up, against its way");
    assert!(matches!(case.histories.last().expect("a history").quantity, Quantity::Rigid { body: 0, .. }));
}

#[test]
fn what_has_no_limit_load_is_refused() {
    refused(SAND, &["footing.displacement=[0.0, 0.0]", "footing.base=rough"], "nothing moves");
    refused(SAND, &["solver.force_tolerance=1e-3"], "limit loads are wrong");
    refused(SAND, &["strength_reduction.factor=1.2"], "[strength_reduction] chooses a stiffness");
    let hardening =
        "material.clay={ model = \"von-mises\", young = 5e6, poisson = 0.49, yield_stress = 2e4, hardening = 1e5 }";
    refused(CLAY, &[hardening], "depends on its strain");
    refused(PUNCH, &["rigid.0.rotation=[[1.0, 5.0]]"], "rotates or is free");
    let in_time = "analysis={ type = \"quasi-static-in-time\", end = 1.0, purpose = \"limit-load\" }";
    refused(CLAY, &[in_time], "needs type = \"quasi-static\"");
}

#[test]
fn settings_with_which_limit_loads_are_wrong_are_warned_of() {
    assert!(valid(SAND, &[]).warnings.is_empty(), "{:?}", valid(SAND, &[]).warnings);
    assert!(warned(&valid(SAND, &["body.0.points_per_cell=3"]), "lock soil that dilates"));
    assert!(warned(&valid(SAND, &["material.sand.dilation=0.0"]), "no unique limit load"));
    let averaged = "stabilisation.method=consistent-f-bar";
    assert!(warned(&valid(SAND, &[averaged]), "32 % too low"));
    // Also without the purpose, and not with cohesion.
    let plain = "analysis={ type = \"quasi-static\" }";
    assert!(warned(&valid(SAND, &[averaged, plain]), "32 % too low"));
    assert!(!warned(&valid(SAND, &[averaged, "material.sand.cohesion=\"20 kPa\""]), "32 % too low"));
    // gamma B = 40 kPa.
    let small = valid(SAND, &["material.sand.cohesion=\"0.5 kPa\""]);
    assert!(warned(&small, "1.3e-2 of the weight"), "{:?}", small.warnings);
    assert_eq!(small.limit_load.expect("a search").small_cohesions, ["sand"]);
    assert!(!warned(&valid(SAND, &["material.sand.cohesion=\"10 kPa\""]), "of the weight"));
}
