//! Tests free-field boundaries.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{agree, at, history};

/// Two layers, of which the upper one yields and the lower one is damped, that rise by a step in their middle, on a
/// base that absorbs; they shake both ways.
const SLOPE: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.15
dt = 0.005
[grid]
lower = [1, 2]
upper = [9, 8]
cell = 0.5
degree = "quadratic"
[material.stiff]
model = "elastic"
young = "100 MPa"
poisson = 0.25
density = 2000
damping = { ratio = 0.02, frequency = 3 }
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
box = { lower = [1, 2], upper = [9, 4] }
points_per_cell = 2
[[body]]
material = "soft"
polygon = [[1, 4], [9, 4], [9, 5], [6, 5], [4, 6], [1, 6]]
points_per_cell = 2
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.5
[boundary]
left = "free-field"
right = "free-field"
bottom = "absorbing"
[shaking]
acceleration = [[0.025, 2.0, 0.5], [0.075, -2.0, -0.5], [0.1, 0, 0]]
[stabilisation]
method = "modified-f-bar"
[output]
accept = ["energy-loss"]    # the average of the elastic strain takes nearly half of it
[[history]]
quantity = "reaction"
face = "left"
[[history]]
quantity = "velocity"
at = [1, 6]
[[history]]
quantity = "energy"
"#;

#[test]
fn ground_beside_a_free_field_is_the_same_on_any_number_of_ranks_and_over_restarts() {
    let scratch = Scratch::with_case(SLOPE);
    for ranks in [1, 3] {
        scratch.goes_on(ranks, &["1", "12"]);
    }
    agree(&scratch.path("whole3"), &scratch.path("whole1"));
    let found = history(&scratch.path("whole1"));
    // Earth pressure at rest of both layers, k0 = 0.5.
    let [upper, lower] = [1800.0, 2000.0].map(|density| 9.81 * density);
    let at_rest = 0.5 * (0.5 * upper * 4.0 + upper * 4.0 + 0.5 * lower * 4.0);
    assert!(
        (at(&found, "reaction-x", 0.0) / at_rest - 1.0).abs() < 0.1,
        "{}",
        at(&found, "reaction-x", 0.0)
    );
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 0.15).abs());
    assert!(closure < 1e-6 * external, "{closure:e} of {external:e}");
    assert!(at(&found, "velocity-x", 0.05).abs() > 0.01, "it shakes");
    scratch.write(
        "case.toml",
        changed(
            SLOPE,
            "right = \"free-field\"\nbottom = \"absorbing\"",
            "right = \"roller\"\nbottom = \"roller\"",
        ),
    );
    scratch
        .mpirun(1, &["case.toml", "--check"])
        .expect(65)
        .says_once("error E0246: ");
}

/// Level ground on which a stage places a lift, away from the sides, before it shakes.
const BUILT: &str = r#"
geometry = "plane-strain"
analysis = { type = "dynamic", end = 0.2, dt = 0.01 }
grid = { lower = [0, 0], upper = [12, 6], cell = 1, degree = "quadratic" }
gravity = { acceleration = [0, -9.81] }
initial = { k0 = 0.5 }
boundary = { left = "free-field", right = "free-field", bottom = "absorbing" }
stage = [{ name = "built", at = 0.05, add = ["lift"] }]
shaking = { acceleration = [[0.1, 0, 0], [0.12, 2.0, 0.5], [0.16, 0, 0]] }
stabilisation = { method = "consistent-f-bar" }
[material.soft]
model = "mohr-coulomb"
young = "40 MPa"
poisson = 0.3
friction_angle = 25
dilation_angle = 0
cohesion = "20 kPa"
density = 1800
[[body]]
material = "soft"
box = { lower = [0, 0], upper = [12, 4] }
points_per_cell = 2
[[body]]
name = "lift"
material = "soft"
polygon = [[3, 4], [9, 4], [8, 5], [4, 5]]
points_per_cell = 2
[[history]]
quantity = "reaction"
face = "bottom"
[[history]]
quantity = "velocity"
at = [6, 0.5]
[[history]]
quantity = "displacement"
at = [6, 0.5]
[[history]]
quantity = "energy"
"#;

/// What sides and base hold is found again, with the lift's weight, and the columns beside go on: nothing drifts once
/// its waves have left. The same on any ranks and over restarts, one of them right after the stage. A base that held
/// the building may absorb after it.
#[test]
fn ground_beside_a_free_field_is_built_and_then_shakes() {
    let scratch = Scratch::with_case(BUILT);
    for ranks in [1, 2] {
        scratch.goes_on(ranks, &["5", "2"]);
    }
    agree(&scratch.path("whole2"), &scratch.path("whole1"));
    let found = history(&scratch.path("whole1"));
    assert!(at(&found, "velocity-x", 0.15).abs() > 0.01, "it shakes");
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&found, name, 0.2).abs());
    assert!(closure < 1e-5 * external, "{closure:e} of {external:e}");
    // Ground that holds too little by 2e-4 of the lift sinks by 4e-5 m/s.
    let rests = ["analysis.end=4", "shaking.acceleration=[[9, 0, 0], [10, 1, 0]]"];
    let fixed = "stage.0={ name = \"built\", at = 0.05, add = [\"lift\"], boundary = { bottom = \"absorbing\" } }";
    for (name, set) in [("rests", &[][..]), ("held", &["boundary.bottom=fixed", fixed])] {
        let set = rests.iter().chain(set).flat_map(|set| ["--set", *set]);
        scratch
            .mpirun(
                1,
                &["case.toml", "-q", "-o", name]
                    .into_iter()
                    .chain(set)
                    .collect::<Vec<_>>(),
            )
            .expect(0);
        let found = history(&scratch.path(name));
        let [before, after] = [3.0, 4.0].map(|time| at(&found, "displacement-y", time));
        println!("{name}: {before:e} and {after:e} m");
        assert!(before < -1e-4 && (after - before).abs() < 1e-7, "{before:e} {after:e}");
    }
    for (wrong, reported) in [
        ("stage.0.at=0.15", "let [shaking] begin later"),
        (
            "body.1.polygon=[[0.5, 4], [9, 4], [8, 5], [4, 5]]",
            "error E0628: stage.0.add: ",
        ),
    ] {
        scratch
            .mpirun(1, &["case.toml", "--check", "--set", wrong])
            .expect(65)
            .says_once(reported);
    }
}
