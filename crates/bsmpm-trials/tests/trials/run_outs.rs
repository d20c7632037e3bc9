//! Tests run-outs of dense granular flow.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{differences, history, last_frame, manifest};

/// Dam break of dry grains, 2 m long and 1 m high.
const DAM_BREAK: &str = r#"
geometry = "plane-strain"
accuracy = "draft"
analysis = { type = "dynamic", end = 2.0 }
gravity  = { acceleration = [0.0, -9.81] }
boundary = { bottom = "fixed", left = "roller" }
grid     = { lower = [0.0, 0.0], upper = [6.0, 1.2] }
[material.grains]
model   = "mu-i"
young   = "5 MPa"
poisson = 0.3
density = 1500
mu_s = 0.32
mu_2 = 0.60
inertial_number = 0.4
grain_diameter = "5 mm"
grain_density = 2500
[[body]]
material = "grains"
box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
[[history]]
quantity = "front"
[[history]]
quantity = "runout"
percentile = 99
name = "r99"
[[history]]
quantity = "energy"
"#;

/// Run-out (L - L0)/L0 of a column of aspect ratio 1/2: 2.2 times that, the scaling law for mu(I) of Lagrée, Staron
/// and Popinet (2011).
const RUN_OUT: f64 = 1.1;

/// How far the points and the front have run out over the length at the start, and the excess energy at the bed.
#[derive(Debug)]
struct RunOut {
    /// -  of 99 % of the points
    points: f64,
    /// -
    front: f64,
    /// -  `wall-velocity`
    excess: f64,
}

fn run_out(further: &[&str]) -> RunOut {
    let scratch = Scratch::with_case(DAM_BREAK);
    scratch.mpirun(2, &[&["case.toml", "-q"], further].concat()).expect(0);
    let history = history(&scratch.path("case.out"));
    let manifest = manifest(&scratch.path("case.out"));
    let relative = |column: &str| history.get(column).unwrap().last().unwrap() / 2.0 - 1.0;
    let closure = manifest.indicators["energy-closure"].value;
    assert!(closure < 1e-4, "{closure}");
    let excess = manifest.indicators["wall-velocity"].value;
    let found = RunOut {
        points: relative("r99"),
        front: relative("front"),
        excess,
    };
    println!("{further:?}: {found:.3?}");
    found
}

#[test]
fn the_run_out_of_a_dam_break_is_right_at_draft_and_nearer_at_standard() {
    let [draft, standard] = ["accuracy=draft", "accuracy=standard"].map(|accuracy| run_out(&["--set", accuracy]));
    let errors = [&draft, &standard].map(|found| (found.points / RUN_OUT - 1.0).abs());
    assert!(
        errors[0] < 0.1 && errors[1] < 0.05 && errors[1] < errors[0],
        "{errors:?}"
    );
    for found in [&draft, &standard] {
        assert!(found.excess < 0.05, "{found:?}");
        // The tip, thinner than a cell, runs ahead.
        assert!((0.05..0.25).contains(&(found.front / RUN_OUT - 1.0)), "{found:?}");
    }
}

#[test]
fn with_their_own_velocities_the_front_runs_out_a_third_too_far() {
    let own = run_out(&["--set", "analysis.wall_velocity=own"]);
    assert!(own.front / RUN_OUT > 1.25 && own.excess > 0.15, "{own:?}");
}

/// Grains of a 65th of the height, as in two of the three columns that the authors publish with Basilisk: the front.
#[test]
fn the_front_of_coarse_grains_is_right_at_draft_and_standard() {
    for accuracy in ["accuracy=draft", "accuracy=standard"] {
        let found = run_out(&["--set", accuracy, "--set", "material.grains.grain_diameter='15.4 mm'"]);
        assert!((found.front / RUN_OUT - 1.0).abs() < 0.08, "{found:?}");
    }
}

#[test]
fn a_flow_on_a_fixed_bed_is_the_same_on_1_2_3_and_4_ranks_and_over_a_restart() {
    let scratch = Scratch::with_case(&changed(DAM_BREAK, "end = 2.0", "end = 0.3"));
    let frames = [1, 2, 3, 4].map(|ranks| {
        let directory = format!("{ranks}.out");
        scratch.mpirun(ranks, &["case.toml", "-q", "-o", &directory]).expect(0);
        last_frame(&scratch.path(&directory))
    });
    for frame in &frames[1..] {
        for (field, difference) in differences(frame, &frames[0]) {
            assert!(difference <= 1e-6, "{field} differs by {difference:.1e}");
        }
    }
    for ranks in [1, 3] {
        scratch.goes_on(ranks, &["5", "12"]);
    }
}

#[test]
fn the_choice_for_flow_is_noted_and_refused_without_inertia() {
    let scratch = Scratch::with_case(DAM_BREAK);
    let noted = scratch.direct(&["case.toml", "--check"]).expect(0);
    let said = noted.said();
    assert!(
        said.contains("analysis.wall_velocity") && !said.contains("quantity = \"runout\" with percentile"),
        "{said}"
    );
    scratch.write("front.toml", changed(DAM_BREAK, "percentile = 99\n", ""));
    let front = scratch.direct(&["front.toml", "--check"]).expect(0).said();
    assert!(front.contains("quantity = \"runout\" with percentile"), "{front}");
    let sand = "model = \"mohr-coulomb\"\nfriction_angle = 20\ncohesion = 0.0\nyoung = \"5 MPa\"\npoisson = 0.3\ndensity = 1500\n";
    let (before, after) = DAM_BREAK.split_once("model   = \"mu-i\"").unwrap();
    let after = after.split_once("grain_density = 2500\n").unwrap().1;
    scratch.write("sand.toml", format!("{before}{sand}{after}"));
    let said = scratch.direct(&["sand.toml", "--check"]).expect(0).said();
    assert!(!said.contains("wall_velocity"), "{said}");
    let still = changed(
        DAM_BREAK,
        "\"dynamic\", end = 2.0",
        "\"quasi-static\", wall_velocity = \"own\"",
    );
    scratch.write("still.toml", still);
    let refused = scratch.direct(&["still.toml", "--check"]).expect(65);
    assert!(
        refused.stderr.contains("error E0218: analysis.wall_velocity: "),
        "{}",
        refused.stderr
    );
}
