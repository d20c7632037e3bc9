//! Tests absorbing and outflow boundaries.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{agree, at, history, manifest};

/// Ground of two layers at rest on a base that absorbs, which shakes as an outcrop would.
const SHAKEN: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.2
dt = 0.005
[grid]
lower = [0, 0]
upper = [6, 7]
cell = 0.5
degree = "quadratic"
[material.stiff]
model = "elastic"
young = "100 MPa"
poisson = 0.25
density = 2000
[material.soft]
model = "mohr-coulomb"
young = "40 MPa"
poisson = 0.3
friction_angle = 25
dilation_angle = 0
cohesion = "2 kPa"
density = 1800
[[body]]
material = "stiff"
box = { lower = [0, 0], upper = [6, 3] }
points_per_cell = 3
[[body]]
material = "soft"
box = { lower = [0, 3], upper = [6, 6] }
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.5
[boundary]
left = "roller"
right = "roller"
bottom = "absorbing"
[shaking]
acceleration = [[0.025, 2.0, 0.5], [0.075, -2.0, -0.5], [0.1, 0, 0]]
[stabilisation]
method = "modified-f-bar"
[[history]]
quantity = "reaction"
face = "bottom"
[[history]]
quantity = "velocity"
at = [3, 6]
[[history]]
quantity = "energy"
"#;

/// A heap that runs off a shelf of its own length.
const SHELF: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.5
dt = 0.005
[grid]
lower = [0, 0]
upper = [1, 0.6]
cell = 0.05
degree = "quadratic"
[material.sand]
model = "mohr-coulomb"
young = "1 MPa"
poisson = 0.3
friction_angle = 25
dilation_angle = 0
cohesion = 0
density = 1600
[[body]]
material = "sand"
box = { lower = [0.5, 0], upper = [0.9, 0.5] }
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[boundary]
left = "outflow"
right = "outflow"
bottom = "fixed"
[stabilisation]
method = "modified-f-bar"
[[history]]
quantity = "mass"
[[history]]
quantity = "outflow"
[[history]]
quantity = "displacement"
at = [0.89, 0.01]
[[history]]
quantity = "displacement"
at = [0.89, 0.4]
name = "lost"
[[history]]
quantity = "energy"
"#;

/// The same to the bit over restarts at `stops`, on one and three ranks to 1e-8.
fn repeats(case: &str, stops: &[&str]) -> Scratch {
    let scratch = Scratch::with_case(case);
    for ranks in [1, 3] {
        scratch.goes_on(ranks, stops);
        let part = scratch.path(&format!("part{ranks}"));
        assert_eq!(manifest(&part).outflow, manifest(&scratch.path("whole1")).outflow);
    }
    agree(&scratch.path("whole3"), &scratch.path("whole1"));
    scratch
}

#[test]
fn ground_on_a_base_that_absorbs_is_the_same_on_any_number_of_ranks_and_over_restarts() {
    let scratch = repeats(SHAKEN, &["7", "20"]);
    let found = history(&scratch.path("whole1"));
    let weight = 9.81 * 6.0 * 3.0 * (2000.0 + 1800.0);
    assert!(
        (at(&found, "reaction-y", 0.0) / weight - 1.0).abs() < 5e-3,
        "{}",
        at(&found, "reaction-y", 0.0)
    );
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 0.2).abs());
    assert!(closure < 1e-6 * external, "{closure:e} of {external:e}");
    assert!(at(&found, "velocity-x", 0.05).abs() > 0.01, "it shakes");
    scratch.write("case.toml", changed(SHAKEN, "[initial]\nk0 = 0.5\n", ""));
    scratch
        .mpirun(1, &["case.toml", "--check"])
        .expect(65)
        .says_once("error E0672: ");
}

#[test]
fn what_leaves_is_counted_and_the_rest_goes_on() {
    let scratch = repeats(SHELF, &["30", "31", "60"]);
    let found = history(&scratch.path("whole1"));
    let mass = at(&found, "mass", 0.5);
    let left = at(&found, "outflow", 0.5);
    assert!(
        left > 0.1 * mass && (mass + left - 320.0).abs() < 1e-9,
        "{mass} kg stay, {left} leave"
    );
    let reported = manifest(&scratch.path("whole1"));
    assert_eq!(reported.outflow.map(|outflow| outflow.mass), Some(left));
    assert!(
        reported
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0713: ") && warning.contains("`lost`"))
    );
    assert_eq!(at(&found, "lost-x", 0.5), 0.0);
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 0.5).abs());
    assert!(closure < 1e-4 * external, "{closure:e} of {external:e}");
}

/// From a height of 0.5 m on it falls for 0.32 s.
#[test]
fn a_run_whose_material_has_all_left_says_so() {
    let scratch = Scratch::with_case(&changed(SHELF, "bottom = \"fixed\"", "bottom = \"outflow\""));
    let output = scratch.mpirun(1, &["case.toml", "-o", "out"]).expect(81);
    output.says_once("error E0742: ");
    output.says_once("Reduce `analysis.end` to before this time");
    let left = manifest(&scratch.path("out")).outflow.expect("some left before").mass;
    assert!((160.0..320.0).contains(&left), "{left} kg of 320");
}
