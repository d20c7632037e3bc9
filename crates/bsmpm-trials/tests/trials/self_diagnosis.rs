//! Tests warnings of a run about its result.

use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};
use crate::support::{Scratch, shipped};

/// A layer of two by one metres on the floor of its grid.
const LAYER: &str = r#"geometry = "plane-strain"

[analysis]
type  = "quasi-static"
steps = 2

[grid]
lower = [0.0, 0.0]
upper = [2.0, 1.5]
cell  = 0.25
degree = "quadratic"

[material.soil]
model       = "elastic"
young       = "10 MPa"
poisson     = 0.3
unit_weight = "20 kN/m3"

[[body]]
material = "soil"
box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
points_per_cell = 3

[gravity]
acceleration = [0.0, -9.81]

[boundary]
bottom = "fixed"
left   = "roller"
right  = "roller"

[[history]]
quantity = "reaction"
face = "bottom"

[[history]]
quantity = "reaction"
face = "left"
name = "side"
"#;

#[test]
fn the_reaction_to_a_stress_at_the_start_is_there_before_the_first_step() {
    // k0 leaves what the points' quadrature of a linear stress does: 0.7 % in four cells of depth.
    for (initial, off) in [("gravity = \"elastic\"", 1e-8), ("k0 = 0.5", 0.01)] {
        let scratch = Scratch::with_case(&format!("{LAYER}\n[initial]\n{initial}\n"));
        scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
        let history = history(&scratch.path("case.out"));
        let found = [0.0, 1.0].map(|time| at(&history, "reaction-y", time));
        assert!(found.iter().all(|force| (force / 40e3 - 1.0).abs() < off), "{found:?}");
        let sides = [0.0, 1.0].map(|time| at(&history, "side-x", time));
        assert!((sides[0] / sides[1] - 1.0).abs() < 0.02 && sides[0] > 1e3, "{sides:?}");
    }
}

#[test]
fn a_body_that_hangs_on_a_face_is_reported_and_one_that_lies_on_it_is_not() {
    let scratch = Scratch::with_case(LAYER);
    let lies = scratch.direct(&["case.toml"]).expect(0);
    assert!(!lies.stderr.contains("I0016"), "{}", lies.stderr);
    let hangs = scratch
        .direct(&["case.toml", "--force", "--set", "gravity.acceleration=[0.0, 9.81]"])
        .expect(0);
    assert!(
        hangs.stderr.contains("warning I0016: ") && hangs.stderr.contains("\"contact\""),
        "{}",
        hangs.stderr
    );
    let manifest = manifest(&scratch.path("case.out"));
    let pull = &manifest.indicators["support-pull"];
    assert!(pull.unusual && pull.value > 0.9 && !pull.advice.is_empty(), "{pull:?}");
}

/// A layer of one cell slides on a fixed base: its points keep a velocity that is not their motion.
#[test]
fn velocities_beside_a_fixed_face_that_are_no_motion_are_reported() {
    let case = std::fs::read_to_string(shipped("validation/sliding_layer.toml")).unwrap();
    for (mass, reported) in [("lumped", true), ("consistent", false)] {
        let scratch = Scratch::with_case(&case);
        let mass = format!("analysis.mass={mass}");
        scratch
            .mpirun(2, &["case.toml", "-q", "--set", "analysis.end=0.03", "--set", &mass])
            .expect(0);
        let found = &manifest(&scratch.path("case.out")).indicators["wall-velocity"];
        println!("{mass}: {}", found.value);
        assert!(
            found.unusual == reported && !found.advice.is_empty(),
            "{mass}: {found:?}"
        );
    }
}

/// A background as stiff as the body carries half of it.
#[test]
fn a_background_that_carries_the_body_is_reported() {
    let scratch = Scratch::with_case(LAYER);
    scratch.direct(&["case.toml", "-q"]).expect(0);
    let usual = manifest(&scratch.path("case.out")).indicators["background-work"].clone();
    assert!(!usual.unusual && usual.value > 0.0 && usual.value < 1e-3, "{usual:?}");
    let stiff = scratch
        .direct(&["case.toml", "--force", "--set", "solver.background=0.5"])
        .expect(82);
    assert!(stiff.stderr.contains("error I0028: "), "{}", stiff.stderr);
    // Of uniaxial strain under a load that grows from the first step to the second, E int eps:eps / 2 against 1.35 E of
    // the body.
    let share = manifest(&scratch.path("case.out")).indicators["background-work"].value;
    assert!((0.1..0.5).contains(&share), "{share}");
    let none = Scratch::with_case(&format!("{LAYER}\n[solver]\nbackground = 0.0\n"));
    none.direct(&["case.toml", "-q"]).expect(0);
    assert!(
        !manifest(&none.path("case.out"))
            .indicators
            .contains_key("background-work")
    );
}

/// Sand whose gaps close: at 0.3565 s the tip thins out to less than half a cell.
#[test]
fn a_front_that_goes_back_is_reported_with_what_to_do() {
    let case = std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap();
    let scratch = Scratch::with_case(&changed(
        &case,
        "friction_angle    = 21.9\n",
        "friction_angle    = 21.9\nseparation  = \"gap\"\n",
    ));
    let set = [
        "case.toml",
        "--set",
        "stabilisation.method=modified-f-bar",
        "--set",
        "analysis.end=0.38",
        "--set",
        "check=[]",
    ];
    let reported = scratch
        .direct(&[&set[..], &["--set", "output.times=[]"]].concat())
        .expect(0);
    assert!(reported.stderr.contains("warning I0017: "), "{}", reported.stderr);
    let manifest = manifest(&scratch.path("case.out"));
    assert!(manifest.indicators["front-setback"].value > 0.015);
    // The end is a frame, and no time is singled out for pictures.
    assert!(manifest.picture_times.is_empty());
    assert!(
        manifest
            .indicators
            .values()
            .all(|indicator| !indicator.advice.is_empty())
    );
}

#[test]
fn the_advice_on_an_elastic_start_is_not_to_make_one() {
    let weak = changed(
        LAYER,
        "model       = \"elastic\"",
        "model       = \"tresca\"\ncohesion    = \"0.5 kPa\"",
    );
    let scratch = Scratch::with_case(&format!("{weak}\n[initial]\ngravity = \"elastic\"\n"));
    let reported = scratch.direct(&["case.toml", "--max-steps", "1"]);
    let line = reported
        .stderr
        .lines()
        .find(|line| line.contains("unbalanced"))
        .unwrap_or_default();
    assert!(
        line.contains("W0717: ") && !line.contains("gravity = \"elastic\""),
        "{}",
        reported.stderr
    );
}

/// Four layers that lie on each other are as thick as one body of their height: smoothing along 0.25 m is usual in
/// both.
#[test]
fn smoothing_is_judged_by_the_thickness_of_connected_material() {
    let block = changed(LAYER, "upper = [2.0, 1.5]", "upper = [4.0, 4.5]");
    let block = format!("{block}\n[stabilisation]\nmethod = \"modified-f-bar\"\n");
    let of = |lower: f64, upper: f64| format!("box = {{ lower = [0.0, {lower:?}], upper = [4.0, {upper:?}] }}");
    let body = |lower: f64, upper: f64| {
        format!(
            "[[body]]\nmaterial = \"soil\"\npoints_per_cell = 3\n{}\n",
            of(lower, upper)
        )
    };
    let first = "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }";
    let whole = changed(&block, first, &of(0.0, 4.0));
    let more: String = [1.0, 2.0, 3.0].map(|lower| body(lower, lower + 1.0)).concat();
    let layers = changed(&block, first, &of(0.0, 1.0)) + &more;
    let thickness = |case: &str| {
        let scratch = Scratch::with_case(case);
        scratch.direct(&["case.toml", "-q"]).expect(0);
        let found = manifest(&scratch.path("case.out")).indicators["smoothing-length"].clone();
        assert!((found.value / 0.25 - 1.0).abs() < 1e-12, "{found:?}");
        found.usual[1] / 0.1
    };
    assert_eq!([thickness(&whole), thickness(&layers)], [4.0, 4.0]);
}

/// Thin ground that vibrates about its place under gravity that acts at once has 0.52 of its kinetic energy that way if
/// all points count; nothing slides.
#[test]
fn velocities_beside_a_fixed_face_of_ground_at_rest_are_usual() {
    let dynamic = changed(
        LAYER,
        "type  = \"quasi-static\"\nsteps = 2",
        "type = \"dynamic\"\nend = 0.2\ndt = 5e-3",
    );
    for upper in ["[2.0, 0.25]", "[2.0, 1.0]"] {
        let scratch = Scratch::with_case(&dynamic);
        let set = format!("body.0.box.upper={upper}");
        scratch.direct(&["case.toml", "-q", "--set", &set]).expect(0);
        let found = &manifest(&scratch.path("case.out")).indicators["wall-velocity"];
        println!("{upper}: {}", found.value);
        assert!(!found.unusual, "{upper}: {found:?}");
    }
}
