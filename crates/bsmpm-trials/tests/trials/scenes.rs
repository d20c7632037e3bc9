//! Tests of footings, loads, layers and initial stress on several ranks.

use crate::support::cases::{SLIDING_BLOCK, changed};
use crate::support::results::{all_finite, at, differences, history, last_frame, manifest};
use crate::support::{Scratch, shipped};

/// An elastic block between everything that may hold or load it; the strip crosses the bounds of all slabs.
const LOADED: &str = r#"geometry = "plane-strain"

[analysis]
type  = "quasi-static"
steps = 8

[grid]
lower = [-2.0, 1.0]
upper = [6.0, 6.0]
cell  = "1 m"
degree = "quadratic"

[material.soil]
model       = "elastic"
young       = { value = "1 MPa", at_y = 5.0, per_metre = "0.5 MPa/m" }
poisson     = 0.3
unit_weight = "20 kN/m3"

[[body]]
material = "soil"
polygon = [[-2.0, 1.0], [6.0, 1.0], [6.0, 4.0], [4.0, 5.0], [-2.0, 5.0]]
points_per_cell = 2

[gravity]
acceleration = [0.0, -9.81]

[boundary]
bottom = "fixed"
left   = "roller"

[initial]
gravity = "elastic"

[[prescribed]]
face = "right"
displacement = [-0.2, 0.0]
components = "normal"

[footing]
from = [-1.5, 5.0]
to   = [2.5, 5.0]
displacement = [0.1, -0.4]
interface = "rough"

[[traction]]
from   = [3.0, 5.0]
to     = [4.0, 5.0]
stress = ["5 kPa", "-20 kPa"]
ramp   = 0.5

[[point_load]]
at    = [5.0, 4.5]
force = [0.0, "-10 kN/m"]
ramp  = 1.0

[solver]
tolerance       = 1e-14
force_tolerance = 1e-9

[output]
times = [1.0]

[[history]]
quantity = "footing-force"
[[history]]
quantity = "footing-pressure"
[[history]]
quantity = "penetration"
[[history]]
quantity = "slip"
[[history]]
quantity = "heave"
[[history]]
quantity = "reaction"
face = "bottom"
[[history]]
quantity = "reaction"
face = "right"
name = "right"
"#;

/// Runs a case on 1, 2, 3 and 4 ranks and hands back the largest relative difference of any field from the first.
fn spread(scratch: &Scratch, case: &str, further: &[&str]) -> f64 {
    let frames = [1, 2, 3, 4].map(|ranks| {
        let directory = format!("{ranks}.out");
        let arguments = [&[case, "-q", "--force", "-o", &directory], further].concat();
        scratch.job(Some(ranks), &arguments).within(240).run().expect(0);
        last_frame(&scratch.path(&directory))
    });
    let of = |frame| {
        differences(frame, &frames[0])
            .into_iter()
            .map(|(_, difference)| difference)
            .fold(0.0, f64::max)
    };
    frames[1..].iter().map(of).fold(0.0, f64::max)
}

#[test]
fn strips_loads_layers_and_initial_stress_are_the_same_on_1_2_3_and_4_ranks() {
    let scratch = Scratch::with_case(LOADED);
    let spread = spread(&scratch, "case.toml", &[]);
    assert!(spread <= 1e-8, "{spread:.1e}");
    let histories = ["1.out", "4.out"].map(|directory| history(&scratch.path(directory)));
    for (column, other) in histories[0].values.iter().zip(&histories[1].values) {
        let largest = column.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // Slips are differences of nearly equal numbers.
        assert!(
            column.iter().zip(other).all(|(a, b)| (a - b).abs() <= 1e-6 * largest),
            "{column:?} {other:?}"
        );
    }
}

#[test]
fn the_footings_histories_are_true() {
    let scratch = Scratch::with_case(LOADED);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let directory = scratch.path("case.out");
    all_finite(&directory);
    let history = history(&directory);
    let manifest = manifest(&directory);
    let last = |name: &str| *history.get(name).unwrap().last().unwrap();
    assert!((last("penetration") - 0.4).abs() < 1e-12);
    // Up is what the ground pushes with: weight, traction, point load and the footing.
    let weight = 20e3 * (8.0 * 3.0 + 7.0);
    let vertical = weight + 20e3 + 10e3;
    let pressure = last("footing-pressure");
    assert!(
        (last("reaction-y") / (vertical + 4.0 * pressure) - 1.0).abs() < 1e-3,
        "{} {}",
        last("reaction-y"),
        pressure
    );
    assert!(last("right-x") < 0.0, "the face pushes to the left");
    assert!(last("footing-force") > 0.0 && last("slip") < 1e-2);
    let initial = manifest.initial.expect("the stress at the start is reported");
    assert!(initial.unbalance < 1e-8 && initial.yielding == 0, "{initial:?}");
    assert!(manifest.summary.largest_slip.is_some_and(|slip| slip < 1e-2));
    assert!(
        manifest
            .summary
            .largest_accumulated_slip
            .is_some_and(|slip| slip > 1e-6 && slip < 4e-3)
    );
    assert!(
        manifest
            .choices
            .iter()
            .any(|choice| choice.key == "penalty of rigid strips")
    );
}

#[test]
fn nothing_moves_under_its_own_stress_at_the_start() {
    let rest = LOADED.split("[[prescribed]]").next().unwrap();
    let case = format!("{rest}\n[[history]]\nquantity = \"max-displacement\"\n")
        .replace("left   =", "right  = \"roller\"\nleft   =");
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let history = history(&scratch.path("case.out"));
    let moved = history.get("max-displacement").unwrap();
    assert!(moved.iter().all(|&moved| moved < 1e-6), "{moved:?}"); // the layer settles by 2 cm under gravity
}

/// A weightless elastic block of 7 x 7 cells of 0.1 m between a roller and a face that moves; `lower` is the grid's
/// left.
fn platen(lower: f64, upper: f64) -> String {
    format!(
        r#"geometry = "plane-strain"
[analysis]
type  = "quasi-static"
steps = 1
[grid]
lower = [{lower:?}, 0.0]
upper = [{upper:?}, 0.7]
cell  = 0.1
degree = "quadratic"
[material.rubber]
model   = "elastic"
young   = "1 MPa"
poisson = 0.0
[[body]]
material = "rubber"
box = {{ lower = [{lower:?}, 0.0], upper = [{upper:?}, 0.7] }}
points_per_cell = 2
[boundary]
bottom = "roller"
left   = "roller"
[[prescribed]]
face = "right"
displacement = [-0.02, 0.0]
components = "normal"
[[traction]]
from = [{upper:?}, 0.1]
to   = [{upper:?}, 0.6]
stress = [0.0, -1.0]
[[history]]
quantity = "reaction"
face = "left"
"#
    )
}

#[test]
fn a_face_moves_the_body_wherever_the_grid_starts() {
    // (lower + 7 h) - lower is above 7 h for the second grid, below it for the third, and equal for the first.
    let places = [(0.0, 0.7), (-6.0, -5.3), (1.3, 2.0)];
    let reactions = places.map(|(lower, upper)| {
        let scratch = Scratch::with_case(&platen(lower, upper));
        scratch.mpirun(1, &["case.toml", "-q"]).expect(0);
        *history(&scratch.path("case.out"))
            .get("reaction-x")
            .unwrap()
            .last()
            .unwrap()
    });
    assert!(reactions[0] > 18e3, "E eps H = 20 kN/m at small strain: {reactions:?}");
    assert!(
        reactions
            .iter()
            .all(|reaction| (reaction / reactions[0] - 1.0).abs() < 1e-6),
        "{reactions:?}"
    );
}

#[test]
fn the_footing_on_clay_is_the_same_on_1_2_3_and_4_ranks() {
    let case = shipped("short/strip_footing.toml");
    let scratch = Scratch::new();
    let case = case.to_str().unwrap();
    let further = [
        "--max-steps",
        "20",
        "--set",
        "solver.tolerance=1e-12",
        "--set",
        "solver.force_tolerance=1e-8",
    ];
    let pressures = [1, 2, 3, 4].map(|ranks| {
        let directory = format!("{ranks}.out");
        let arguments = [&[case, "-q", "-o", &directory], &further[..]].concat();
        scratch.job(Some(ranks), &arguments).within(240).run().expect(75);
        *history(&scratch.path(&directory))
            .get("p_over_c")
            .unwrap()
            .last()
            .unwrap()
    });
    // Without extended splines, and with a background that resists every displacement, 6.219.
    assert!(
        (pressures[0] - 6.205).abs() < 0.005,
        "what this coarse grid gave before: {pressures:?}"
    );
    assert!(
        pressures
            .iter()
            .all(|pressure| (pressure / pressures[0] - 1.0).abs() < 1e-6),
        "{pressures:?}"
    );
}

/// The draft preset's graded cells against the paper's discretisation.
#[test]
fn a_draft_of_the_footing_is_within_a_tenth_for_a_four_hundredth_of_the_work() {
    let case = shipped("presets/strip_footing.toml");
    let scratch = Scratch::new();
    let arguments = [
        case.to_str().unwrap(),
        "-q",
        "-o",
        "draft.out",
        "--set",
        "accuracy=draft",
    ];
    scratch.direct(&arguments).expect(0);
    let pressures = history(&scratch.path("draft.out"));
    for (time, of_paper) in [(0.1, 4.97), (0.25, 5.84), (0.5, 6.17), (1.0, 6.65)] {
        let ratio = at(&pressures, "p_over_c", time) / of_paper;
        assert!((0.9..=1.1).contains(&ratio), "z/B = {time}: {ratio}");
    }
    let manifest = manifest(&scratch.path("draft.out"));
    let work = manifest.sizes["points"] as f64 * manifest.summary.residual_evaluations as f64;
    assert!(work < 360_000.0 * 5064.0 / 400.0, "{work}");
}

#[test]
fn the_slope_is_the_same_on_1_2_3_and_4_ranks() {
    let case = shipped("short/slope_stability.toml");
    let further = [
        "--set",
        "solver.tolerance=1e-12",
        "--set",
        "solver.force_tolerance=1e-9",
    ];
    let spread = spread(&Scratch::new(), case.to_str().unwrap(), &further);
    assert!(spread <= 1e-6, "{spread:.1e}");
}

#[test]
fn a_weaker_slope_moves_more() {
    let case = shipped("short/slope_stability.toml");
    let scratch = Scratch::new();
    let moved = ["0.8", "1.35"].map(|factor| {
        let factor = format!("strength_reduction.factor={factor}");
        let paper = ["--set", "stabilisation.method=modified-f-bar"];
        let arguments = [
            case.to_str().unwrap(),
            "-q",
            "--force",
            "-o",
            "slope.out",
            "--set",
            &factor,
        ];
        scratch.mpirun(2, &[&arguments[..], &paper[..]].concat()).expect(0);
        *history(&scratch.path("slope.out"))
            .get("E_delta_over_gamma_H2")
            .unwrap()
            .last()
            .unwrap()
    });
    // Measured before: 0.3874 and 0.589 with another quasi-Newton method, and without extended splines. With them
    // 0.571, as the surface's cells are a little stiffer.
    assert!(
        (moved[0] - 0.387).abs() < 0.002 && (moved[1] - 0.571).abs() < 0.01,
        "{moved:?}"
    );
}

#[test]
fn a_load_that_starts_away_from_every_body_is_an_error_of_the_case() {
    let case = changed(LOADED, "at    = [5.0, 4.5]", "at    = [5.0, 4.9]");
    let scratch = Scratch::with_case(&case);
    let output = scratch.mpirun(2, &["case.toml", "-q"]);
    assert!(
        output
            .stderr
            .contains("error E0401: point_load.0.at: no body lies at [5.000, 4.900]"),
        "{output:#?}"
    );
    output.expect(65);
}

#[test]
fn a_load_whose_points_leave_the_grid_is_reported_and_ends_the_run() {
    // The block's top is drawn through the top of the grid half a cell above; its points are still below then.
    let case = platen(0.0, 0.7)
        .replace("upper = [0.7, 0.7]\ncell", "upper = [0.7, 0.8]\ncell")
        .replace("steps = 1", "steps = 8")
        .replace("displacement = [-0.02, 0.0]", "displacement = [0.0, 0.0]")
        .replace(
            "from = [0.7, 0.1]\nto   = [0.7, 0.6]",
            "from = [0.1, 0.7]\nto   = [0.6, 0.7]",
        )
        .replace("stress = [0.0, -1.0]", "stress = [0.0, 3e5]\nramp = 1.0");
    let scratch = Scratch::with_case(&case);
    let output = scratch.mpirun(2, &["case.toml", "-q"]);
    assert!(
        output.stderr.contains("of its points lie outside the soil"),
        "{output:#?}"
    );
    output.expect(81);
    let manifest = manifest(&scratch.path("case.out"));
    let reason = manifest.failure.expect("the failure is kept").reason;
    assert!(
        reason.contains("of its points lie outside the soil") && manifest.summary.steps > 0,
        "{reason}"
    );
}

#[test]
fn a_start_that_is_out_of_balance_or_beyond_yield_is_warned_of() {
    // Earth pressure at rest belongs to level ground: on the slope of this body it is off balance.
    let weak = "model = \"mohr-coulomb\"\nfriction_angle = 20\ndilation_angle = 0\ncohesion = \"10 kPa\"";
    let case = changed(
        &changed(LOADED, "model       = \"elastic\"", weak),
        "gravity = \"elastic\"",
        "k0 = 0.1",
    );
    let warnings = |case: &str| {
        let scratch = Scratch::with_case(case);
        scratch.mpirun(2, &["case.toml", "-q", "--max-steps", "1"]);
        manifest(&scratch.path("case.out")).warnings
    };
    let reports = |warnings: &[String], text: &str| warnings.iter().any(|warning| warning.contains(text));
    let far = warnings(&changed(&case, "ramp   = 0.5", "ramp = 0.0"));
    assert!(
        reports(&far, "% of the largest force is unbalanced") && reports(&far, "W0719: "),
        "{far:?}"
    );
    assert!(reports(&far, "W0405: traction.0: "), "{far:?}");
    let near = warnings(LOADED);
    assert!(
        !reports(&near, "unbalanced") && !reports(&near, "W0719: ") && !reports(&near, "from time 0"),
        "{near:?}"
    );
}

#[test]
fn rows_from_a_file_are_those_of_the_case_on_any_number_of_ranks_and_wrong_ones_are_reported() {
    let shaken = |rows: &str| format!("{SLIDING_BLOCK}\n[shaking]\nacceleration = {rows}\n");
    let inline = Scratch::with_case(&shaken("[[0.01, 3.0, 0.0], [0.03, -2.0, 0.0]]"));
    inline.mpirun(1, &["case.toml", "-q"]).expect(0);
    let named = Scratch::with_case(&shaken("{ file = \"quake.csv\", along = \"x\" }"));
    named.write("quake.csv", "# a record\nt [ms], a [cm/s2]\n10, 300\n30, -200\n");
    named.mpirun(1, &["case.toml", "-q"]).expect(0);
    let of = |scratch: &Scratch| std::fs::read_to_string(scratch.path("case.out/history.csv")).unwrap();
    assert_eq!(of(&inline), of(&named));
    let still = Scratch::with_case(SLIDING_BLOCK);
    still.mpirun(1, &["case.toml", "-q"]).expect(0);
    assert_ne!(of(&inline), of(&still));
    let warnings = manifest(&named.path("case.out")).warnings;
    assert!(
        warnings
            .iter()
            .any(|warning| warning.starts_with("W0670: shaking: the base moves along x"))
    );
    // The case that is kept has the rows, so that a restart needs no file.
    let text = manifest(&named.path("case.out")).case.text;
    assert!(text.contains("300.0 cm/s2") && !text.contains("quake.csv"), "{text}");
    named.write("quake.csv", "t [ms], a [cm/s2]\n10, 300\n30, -100\n");
    named
        .mpirun(1, &["case.toml", "-q", "--restart", "auto"])
        .expect(76)
        .says_once("shaking.acceleration was");
    named.write("quake.csv", "t [ms], a [cm/s2]\n10, 300\n30, fast\n");
    let refused = named.mpirun(2, &["case.toml", "-q", "--force"]).expect(65);
    refused.says_once("error E0028: quake.csv: `fast` in line 3 of the data file");
    let lengths: String = (1..=40).map(|row| format!("{row}, 1\n")).collect();
    named.write("quake.csv", format!("t [m], a [cm/s2]\n{lengths}"));
    named
        .mpirun(1, &["case.toml", "-q", "--force"])
        .expect(65)
        .says_once("error E0021: shaking.acceleration: column 1 of all 40 rows: ");
    std::fs::remove_file(named.path("quake.csv")).unwrap();
    named
        .mpirun(2, &["case.toml", "-q", "--force"])
        .expect(66)
        .says_once("error E0001: quake.csv: ");
}

/// A bar of 2 m by 0.5 m that its left end holds and its right end bends, by a stress that grows with depth.
const BENT: &str = r#"geometry = "plane-strain"
[analysis]
type = "quasi-static"
steps = 1
[grid]
lower = [0.0, 0.0]
upper = [2.5, 1.0]
cell = 0.0625
degree = "quadratic"
[material.steel]
model = "elastic"
young = "1 GPa"
poisson = 0.3
[[body]]
material = "steel"
box = { lower = [0.0, 0.25], upper = [2.0, 0.75] }
points_per_cell = 3
[boundary]
left = "fixed"
[[traction]]
from = [2.0, 0.25]
to = [2.0, 0.75]
stress = { value = ["-300 Pa", "40 Pa"], at_y = 0.75, per_metre = ["800 Pa/m", "320 Pa/m"] }
[[history]]
quantity = "reaction"
face = "left"
[[history]]
quantity = "section-forces"
from = [1.0, 0.25]
to = [1.0, 0.75]
"#;

#[test]
fn a_stress_by_depth_acts_on_a_surface_with_its_force_and_moment() {
    let scratch = Scratch::with_case(BENT);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let rows = history(&scratch.path("case.out"));
    // Along x -300 to +100 Pa over 0.5 m, along y 40 to 200: -50 and 60 N/m in the middle, and 400 (0.5)^2/12 N.
    let off =
        [("reaction-x", 50.0), ("reaction-y", -60.0)].map(|(name, expected)| at(&rows, name, 1.0) / expected - 1.0);
    let bent = [("n", -50.0), ("q", 60.0), ("m", -60.0 - 400.0 * 0.25 / 12.0)];
    let inside = bent.map(|(name, expected)| at(&rows, &format!("section-forces-{name}"), 1.0) / expected - 1.0);
    println!("reactions off by {off:?}, section forces by {inside:?}");
    assert!(
        off.iter().all(|off| off.abs() < 1e-8) && inside.iter().all(|off| off.abs() < 1e-3),
        "{off:?} {inside:?}"
    );
}
