//! Tests pseudo-static analyses, and the critical seismic coefficient.

use super::factor_of_safety::searched;
use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};
use bsmpm_tools::fos::{FosArguments, PushedSide};

/// A saturated layer, 2 m thick and 40 m long, that an inertia of 0.2 times its weight pushes to the left.
const GROUND: &str = r#"
    geometry = "plane-strain"
    analysis = { type = "quasi-static", steps = 4 }
    gravity  = { acceleration = [-1.962, -9.81], ramp = 1.0 }
    boundary = { bottom = "fixed", left = "roller", right = "roller" }
    grid     = { lower = [0.0, 0.0], upper = [40.0, 2.5], cell = 0.5, degree = "quadratic" }
    initial  = { k0 = 0.5 }
    water    = { level = 2.0 }
    body     = [{ material = "soil", box = { lower = [0, 0], upper = [40, 2] }, points_per_cell = 2 }]
    history  = [
        { quantity = "stress", at = [20.0, 0.75], surface = true },
        { quantity = "pore-pressure", at = [20.0, 0.75], name = "water" },
    ]
    [material.soil]
    model       = "elastic"
    young       = "1 GPa"
    poisson     = 0.3
    unit_weight = "18 kN/m3"
    saturated_unit_weight = "20 kN/m3"
"#;

#[test]
fn inertia_begins_at_the_state_at_rest_and_changes_neither_weight_nor_water() {
    let scratch = Scratch::with_case(GROUND);
    scratch.direct(&["case.toml", "-q", "-o", "out"]).expect(0);
    let history = history(&scratch.path("out"));
    let of = |column: &str, time: f64| at(&history, column, time);
    // 1.25 m below the surface: 20 kN/m3 of the ground, 9.81 of the water, and a shear stress of 0.2 times the weight.
    let weight = -20e3 * 1.25;
    let water = 9.81e3 * 1.25;
    assert_eq!(of("stress-xy", 0.0), 0.0);
    assert!((of("stress-xx", 0.0) / of("stress-yy", 0.0) - 0.5).abs() < 1e-9);
    for time in [0.5, 1.0] {
        // Half a cell of water above the ground is 0.4 % of the effective stress there.
        assert!(
            (of("stress-yy", time) / (weight + water) - 1.0).abs() < 0.005,
            "{}",
            of("stress-yy", time)
        );
        assert!(
            (of("stress-xy", time) / (0.2 * time * weight) - 1.0).abs() < 0.005,
            "{}",
            of("stress-xy", time)
        );
        assert!(
            (of("water", time) / of("water", 0.0) - 1.0).abs() < 1e-6,
            "{}",
            of("water", time)
        );
    }
    [1, 3].iter().for_each(|&ranks| scratch.goes_on(ranks, &["2"]));
}

/// A layer of clay, 2 m thick and 20 m long, on a rough base.
const LAYER: &str = r#"
    geometry = "plane-strain"
    analysis = { type = "quasi-static", steps = 10 }
    gravity  = { acceleration = [0.0, -9.81], ramp = 1.0 }
    boundary = { bottom = "fixed" }
    grid     = { lower = [-1.0, 0.0], upper = [21.0, 2.5], cell = 0.25, degree = "quadratic" }
    body     = [{ material = "clay", box = { lower = [0, 0], upper = [20, 2] }, points_per_cell = 3 }]
    stabilisation = { method = "consistent-f-bar" }
    [material.clay]
    model       = "mohr-coulomb"
    young       = "10 MPa"
    poisson     = 0.3
    cohesion    = "18 kPa"
    friction_angle    = 0
    dilation_angle    = 0
    unit_weight = "20 kN/m3"
"#;

/// An elastic block on a base with friction, with pore pressure of 0.4 times its weight.
const BLOCK: &str = r#"
    geometry = "plane-strain"
    analysis = { type = "quasi-static", steps = 5 }
    gravity  = { acceleration = [0.0, -9.81], ramp = 1.0 }
    boundary = { bottom = { friction_coefficient = 0.75 } }
    grid     = { lower = [0, 0], upper = [3, 1], cell = "125 mm", degree = "quadratic" }
    body     = [{ material = "soil", box = { lower = [0.5, 0], upper = [1.5, 0.5] }, points_per_cell = 2 }]
    material.soil = { model = "elastic", young = 1e7, poisson = 0.3, density = 2e3, ru = 0.4 }
"#;

fn critical(text: &str, [from, to]: [f64; 2], pushed: PushedSide) -> [Option<f64>; 3] {
    let scratch = Scratch::with_case(text);
    let from = Some(from);
    let to = Some(to);
    let seismic = Some(pushed);
    let arguments = FosArguments {
        from,
        to,
        seismic,
        jobs: Some(2),
        ..FosArguments::of(scratch.path("case.toml"))
    };
    let (found, _) = searched(arguments, &scratch.path("out"));
    let finding = &found["critical_seismic_coefficient"];
    assert!(!finding.is_null() && found["factor_of_safety"].is_null(), "{found}");
    ["last_stable", "first_failed", "estimate"].map(|key| finding[key].as_f64())
}

/// The shear strength of the base over the weight: 18/(20 x 2) = 0.45. Found: 0.459 in 8 cells over the height, and
/// 0.475 in 4.
#[test]
fn a_layer_of_clay_slides_at_the_strength_of_its_base_over_its_weight() {
    let [.., estimate] = critical(LAYER, [0.3, 0.5], PushedSide::Left);
    println!("{estimate:?}");
    assert!(
        estimate.is_some_and(|found| (found / 0.45 - 1.0).abs() < 0.03),
        "{estimate:?}"
    );
}

/// The coefficient of friction, with pore pressure 0.75 (1 - 0.4) = 0.45.
#[test]
fn a_block_slides_at_its_friction_on_the_effective_weight() {
    for (ratio, exact) in [("0.4", 0.45), ("0.0001", 0.75)] {
        let text = changed(BLOCK, "ru = 0.4", &format!("ru = {ratio}"));
        let [stable, failed, _] = critical(&text, [0.2, 0.8], PushedSide::Right);
        println!("{stable:?} {failed:?}");
        let stable = stable.unwrap();
        let failed = failed.unwrap();
        assert!(
            stable < 1.01 * exact && exact < 1.01 * failed && failed - stable < 0.0101,
            "{stable} {failed}"
        );
    }
}
