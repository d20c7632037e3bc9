//! Tests freely moving rigid bodies.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};

/// A block of 20 kN/m with friction in the middle of elastic ground, which spreads beneath it.
const BLOCK: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 4 }
grid     = { lower = [-2.0, 0.0], upper = [3.0, 3.0], cell = 0.25, degree = "quadratic" }
boundary = { bottom = "fixed" }
[material.soil]
model   = "elastic"
young   = "10 MPa"
poisson = 0.45
[[body]]
material = "soil"
box = { lower = [-2.0, 0.0], upper = [2.0, 1.0] }
points_per_cell = 3
[[rigid]]
name = "block"
polygon = [[-0.5, 1.0], [0.5, 1.0], [0.5, 2.0], [-0.5, 2.0]]
friction_coefficient = MU
free = ["x", "y", "rotation"]
force = [0.0, -20e3]
ramp = 1.0
[[history]]
quantity = "rigid-force"
rigid = "block"
[[history]]
quantity = "rigid-displacement"
rigid = "block"
"#;

/// With a friction of 0.1 all points slide away from the middle, and nothing resisted a motion along the base: the
/// first step had no equilibrium. The settlement lies between that with much friction and 1 % more.
#[test]
fn a_block_finds_its_equilibrium_on_ground_that_spreads_beneath_it() {
    let scratch = Scratch::new();
    let settled = |friction: &str, ranks: usize| {
        scratch.write("case.toml", changed(BLOCK, "MU", friction));
        scratch
            .mpirun(ranks, &["case.toml", "-q", "-o", "out", "--force"])
            .expect(0);
        assert_eq!(
            manifest(&scratch.path("out")).summary.cutbacks,
            0,
            "friction {friction}"
        );
        let history = history(&scratch.path("out"));
        let [x, y] = ["rigid-force-x", "rigid-force-y"].map(|column| at(&history, column, 1.0));
        assert!(x.abs() < 1e-3 && (y / 20e3 - 1.0).abs() < 1e-6, "{x} {y}");
        ["rigid-displacement-x", "rigid-displacement-y"].map(|column| at(&history, column, 1.0))
    };
    let rough = settled("1.0", 1);
    let smooth = settled("0.1", 1);
    println!(
        "settlement {:.4e} m with friction 1, {:.4e} m with 0.1, aside {:.1e} m",
        rough[1], smooth[1], smooth[0]
    );
    // 1.008 was found; the block may be anywhere between two points of its base that slide in opposite directions.
    assert!((1.0..1.015).contains(&(smooth[1] / rough[1])), "{smooth:?} {rough:?}");
    assert!(smooth[0].abs() < 0.05 * smooth[1].abs(), "{smooth:?}");
    let two = settled("0.1", 2);
    assert!((two[1] / smooth[1] - 1.0).abs() < 1e-6, "{two:?} {smooth:?}");
}

/// Without friction nothing holds the block along its base, and pushed beyond its friction it slides: no equilibrium.
#[test]
fn a_block_that_nothing_holds_is_named() {
    let scratch = Scratch::with_case(&changed(BLOCK, "MU", "0.0"));
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "out"])
        .expect(80)
        .says_once("error E0751: ");
    scratch.write(
        "case.toml",
        changed(&changed(BLOCK, "MU", "0.1"), "[0.0, -20e3]", "[3e3, -20e3]"),
    );
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "slides"])
        .expect(80)
        .says_once("its friction is exhausted");
}

/// A block of 36 kPa on sand and clay with weight, whose pressure spreads it.
#[test]
fn a_block_settles_on_plastic_ground_that_spreads() {
    let soil = "model   = \"elastic\"\nyoung   = \"10 MPa\"\npoisson = 0.45";
    let plastic = "model = \"mohr-coulomb\"\nyoung = \"10 MPa\"\npoisson = 0.45\nfriction_angle = 20\n\
                   dilation_angle = 0\ncohesion = \"10 kPa\"\n\
                   unit_weight = \"18 kN/m3\"";
    let case = changed(&changed(BLOCK, soil, plastic), "MU", "0.1");
    let case = changed(&case, "-20e3", "-36e3") + "[gravity]\nacceleration = [0.0, -9.81]\nramp = 1.0\n";
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = history(&scratch.path("out"));
    assert!((at(&found, "rigid-force-y", 1.0) / 36e3 - 1.0).abs() < 1e-6);
}

/// A rigid mass of twice the column's that is released on it. Right: x tan x = 1/2, the period 2 pi H/(x c) = 0.481 s,
/// and an amplitude that stays.
const COLUMN: &str = r#"
geometry = "plane-strain"
analysis = { type = "dynamic", end = 2.5, dt = 0.004 }
grid     = { lower = [0.0, 0.0], upper = [0.4, 2.4], cell = 0.1, degree = "quadratic" }
gravity  = { acceleration = [0.0, -1.0] }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
[material.elastic]
model   = "elastic"
young   = 1.6e6
poisson = 0.0
density = 1000.0
[[body]]
material = "elastic"
box = { lower = [0.0, 0.0], upper = [0.4, 2.0] }
points_per_cell = 3
[[rigid]]
name = "mass"
polygon = [[0.0, 2.0], [0.4, 2.0], [0.4, 2.2], [0.0, 2.2]]
free = ["y"]
mass = 1600.0
[[history]]
quantity = "rigid-displacement"
rigid = "mass"
"#;

/// Times (s) and values of the extremes of a column.
fn extremes(scratch: &Scratch, name: &str, column: &str) -> Vec<[f64; 2]> {
    let found = history(&scratch.path(name));
    let [t, u] = ["time", column].map(|column| found.get(column).expect("a column").to_vec());
    let is_extreme = |k: &usize| (u[*k] - u[k - 1]) * (u[k + 1] - u[*k]) <= 0.0;
    (1..u.len() - 1).filter(is_extreme).map(|k| [t[k], u[k]]).collect()
}

/// By backward Euler it lost 12 % a period.
#[test]
fn a_mass_on_a_column_keeps_its_amplitude() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let extremes = extremes(&scratch, "out", "rigid-displacement-y");
    let swings: Vec<f64> = extremes
        .windows(2)
        .map(|pair| (pair[1][1] - pair[0][1]).abs())
        .collect();
    let halves = swings.len() - 1;
    let loss = 1.0 - (swings[halves] / swings[0]).powf(2.0 / halves as f64);
    let period = 2.0 * (extremes[halves + 1][0] - extremes[0][0]) / (halves + 1) as f64;
    println!(
        "loss {:.2} % a period of {period:.4} s, over {halves} half periods",
        100.0 * loss
    );
    // 0.8 % of it, and a period of 0.479 s, were found.
    assert!(halves >= 8 && (0.0..0.02).contains(&loss), "{swings:?}");
    assert!((period / 0.481 - 1.0).abs() < 0.01, "{period}");
}

#[test]
fn a_mass_that_oscillates_goes_on_after_a_restart_to_the_bit() {
    let scratch = Scratch::with_case(&changed(COLUMN, "end = 2.5", "end = 0.2"));
    for ranks in [1, 3] {
        scratch.goes_on(ranks, &["7", "30"]);
    }
}

/// Two pistons on their ways towards each other through soil.
const PISTONS: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 10 }
grid     = { lower = [0.0, 0.0], upper = [4.0, 3.0], cell = 0.25, degree = "quadratic" }
boundary = { left = "roller", bottom = "fixed", right = "roller" }
[material.soil]
model   = "elastic"
young   = "1 MPa"
poisson = 0.3
[[body]]
material = "soil"
box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }
points_per_cell = 2
[[rigid]]
name = "left"
polygon = [[0.5, 1.5], [1.5, 1.5], [1.5, 2.0], [0.5, 2.0]]
path = [[1.0, 0.6, 0.0]]
[[rigid]]
name = "right"
polygon = [[2.0, 1.5], [3.0, 1.5], [3.0, 2.0], [2.0, 2.0]]
displacement = [0.0, 0.0]
"#;

#[test]
fn paths_that_make_rigid_bodies_overlap_are_refused() {
    let scratch = Scratch::with_case(PISTONS);
    let output = scratch.direct(&["case.toml", "--check"]).expect(65);
    output.says_once("rigid bodies `left` and `right` overlap at t = 0.8");
    scratch.write("case.toml", changed(PISTONS, "0.6, 0.0", "0.45, 0.0"));
    scratch.direct(&["case.toml", "--check"]).expect(0);
    // Drawn so and moved as one they are parts of one shape.
    let one = changed(
        &changed(PISTONS, "[2.0, 1.5]", "[1.4, 1.5]"),
        "[2.0, 2.0]",
        "[1.4, 2.0]",
    );
    scratch.write(
        "case.toml",
        changed(&one, "displacement = [0.0, 0.0]", "path = [[1.0, 0.6, 0.0]]"),
    );
    scratch.direct(&["case.toml", "-q", "-o", "one"]).expect(0);
}

#[test]
fn a_free_body_that_runs_into_another_one_ends_the_run() {
    let case = changed(
        PISTONS,
        "type = \"quasi-static\", steps = 10",
        "type = \"dynamic\", end = 1.0, dt = 0.05",
    );
    let case = changed(&case, "poisson = 0.3", "poisson = 0.3\ndensity = 1800");
    let moves = "free = [\"x\"]\nmass = 100.0\nstart_velocity = [1.0, 0.0]";
    let scratch = Scratch::with_case(&changed(&case, "path = [[1.0, 0.6, 0.0]]", moves));
    scratch.direct(&["case.toml", "--check"]).expect(0);
    let output = scratch.direct(&["case.toml", "-q", "-o", "out"]).expect(80);
    output.says_once("error E0752: ");
    output.says_once("Keep `left` and `right` apart");
}

/// A heap whose base alone holds it, by friction, and spreads: all nodes of the base slide, away from the middle.
const HEAP: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 2 }
grid     = { lower = [0.0, 0.0], upper = [8.0, 4.0], cell = 0.5, degree = "quadratic" }
gravity  = { acceleration = [0.0, -9.81] }
initial  = { k0 = 0.9, equilibrium = "plastic" }
boundary = { bottom = { friction_coefficient = 0.1 } }
[material.soil]
model       = "mohr-coulomb"
young       = "10 MPa"
poisson     = 0.3
cohesion    = "10 kPa"
friction_angle    = 25.0
dilation_angle    = 0.0
unit_weight = "18 kN/m3"
[[body]]
material = "soil"
polygon = [[1.0, 0.0], [7.0, 0.0], [5.0, 2.0], [3.0, 2.0]]
points_per_cell = 3
[[history]]
quantity = "max-displacement"
[[history]]
quantity = "reaction"
face = "bottom"
"#;

#[test]
fn a_heap_on_a_base_with_friction_alone_has_an_equilibrium_at_the_start() {
    let scratch = Scratch::with_case(HEAP);
    for ranks in [1, 2] {
        scratch
            .mpirun(ranks, &["case.toml", "-q", "-o", "out", "--force"])
            .expect(0);
        let found = history(&scratch.path("out"));
        let [moved, x, y] = ["max-displacement", "reaction-x", "reaction-y"].map(|column| at(&found, column, 1.0));
        println!("{ranks} ranks: moved {moved:.1e} m, reaction {x:.2} and {y:.1} N");
        // Before, the start ended with "is every body held?".
        assert!(
            moved < 1e-5 && x.abs() < 1e-3 * y && (y / 144e3 - 1.0).abs() < 1e-3,
            "{moved} {x} {y}"
        );
    }
}

/// Still water presses on soil, and not on rigid bodies: 9.81 kN/m3 times 0.25 m2 of each below the table are missing.
#[test]
fn the_buoyancy_that_a_rigid_body_lacks_is_warned_of() {
    let wet = "poisson = 0.3\nunit_weight = \"18 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"";
    let case = changed(PISTONS, "poisson = 0.3", wet) + "[water]\nlevel = 1.75\n[gravity]\nacceleration = [0, -9.81]\n";
    let scratch = Scratch::with_case(&changed(&case, "path = [[1.0, 0.6, 0.0]]", "displacement = [0.0, 0.0]"));
    let output = scratch.direct(&["case.toml", "--check"]).expect(0);
    output.says_once("warning W0429: water: [water] exerts no pressure on rigid bodies");
    output.says_once("(at the start: `left` 2.4525 kN/m, `right` 2.4525 kN/m)");
}

/// Of ground without strength friction alone is divided, and the run says so.
#[test]
fn strength_reduction_names_the_friction_that_it_divides() {
    let scratch = Scratch::with_case(&(changed(BLOCK, "MU", "0.5") + "[strength_reduction]\nfactor = 2.0\n"));
    let output = scratch.direct(&["case.toml", "--check"]).expect(0);
    output.says_once("rigid.0.friction_coefficient = 0.25 (divided by strength_reduction.factor = 2)");
    assert!(!output.stderr.contains("W0601") && !output.stdout.contains("W0601"));
}

/// Two blocks 0.4 m apart, one of which moves: the other one moves from 0.23 s on, as splines reach 1.5 cells of 0.1 m,
/// and would be touched at 0.4 s.
const APPROACHING: &str = r#"
geometry = "plane-strain"
analysis = { type = "dynamic", end = 0.5, dt = 0.002 }
grid = { lower = [0.0, 0.0], upper = [4.0, 4.0], cell = 0.1 }
material.rubber = { model = "elastic", young = "1 MPa", poisson = 0.3, density = 1000 }
[[body]]
material = "rubber"
box = { lower = [1.0, 1.0], upper = [1.5, 1.5] }
points_per_cell = 3
velocity = [1.0, 0.0]
[[body]]
material = "rubber"
box = { lower = [1.9, 1.0], upper = [2.4, 1.5] }
points_per_cell = 3
"#;

#[test]
fn bodies_that_approach_each_other_are_warned_of_with_the_distance() {
    let scratch = Scratch::with_case(APPROACHING);
    let warned = |set: &[&str]| {
        let set: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
        scratch
            .direct(&[&["case.toml", "--check"], &set[..]].concat())
            .expect(0)
            .stdout
    };
    let near = "W0229: body.0 and body.1 come closer than a cell at t = 0.30";
    assert!(warned(&[]).contains(near), "{}", warned(&[]));
    assert!(warned(&[]).contains("From 1.5 cells (0.15 m) on they push"));
    for apart in [
        "body.0.velocity=[-1, 0]",
        "body.1.velocity=[1, 0]",
        "body.0.velocity=[0, 2]",
        "analysis.end=0.2",
    ] {
        assert!(!warned(&[apart]).contains("W0229"), "{apart}");
    }
    // One falls onto the other, which lies on the bottom.
    let falls = [
        "gravity={ acceleration = [0, -9.81] }",
        "boundary.bottom=fixed",
        "body.0.velocity=[0, 0]",
    ];
    let below = "body.1.box={ lower = [0.5, 0], upper = [2, 0.5] }";
    assert!(warned(&[&falls[..], &[below]].concat()).contains("W0229"));
    assert!(!warned(&falls).contains("W0229"));
}
