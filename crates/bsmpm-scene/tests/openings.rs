//! Tests that presets find holes, notches and re-entrant corners, and refine cells there.

use bsmpm_scene::{Case, NarrowestOpening};

/// A quarter of a plate with a hole of 1 m, in cells of 0.1 m.
const PLATE: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 1 }
grid = { lower = [0.0, 0.0], upper = [5.0, 4.0], cell = 0.1, degree = "quadratic" }
boundary = { left = "roller", bottom = "roller" }
[material.elastic]
model = "elastic"
young = "20 MPa"
poisson = 0.2
[[body]]
material = "elastic"
points_per_cell = 2
box = { lower = [0.0, 0.0], upper = [4.0, 4.0] }
subtract = [{ circle = { centre = [0.0, 0.0], radius = 0.5 } }]
[[traction]]
from = [4.0, 0.0]
to = [4.0, 4.0]
stress = [1e3, 0.0]
ramp = 1.0
"#;

/// A block with a hole of 1 m across in cells of 0.25 m.
const BLOCK: &str = r#"
geometry = "3d"
analysis = { type = "quasi-static", steps = 1 }
grid = { lower = [0.0, 0.0, 0.0], upper = [3.0, 3.0, 2.0], cell = 0.25, degree = "quadratic" }
boundary = { left = "roller", front = "roller", bottom = "roller" }
gravity = { acceleration = [0.0, 0.0, -9.81] }
[material.elastic]
model = "elastic"
young = "20 MPa"
poisson = 0.2
unit_weight = "20 kN/m3"
[[body]]
material = "elastic"
points_per_cell = 2
box = { lower = [0.0, 0.0, 0.0], upper = [3.0, 3.0, 2.0] }
subtract = []
"#;

#[track_caller]
fn valid(text: &str, set: &[&str]) -> Case {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    Case::from_text("case.toml", text, &set).unwrap_or_else(|errors| panic!("{set:?}: {errors:#?}"))
}

/// Width (m) and cells across; too few of them are warned of.
#[track_caller]
fn found(text: &str, set: &[&str]) -> Option<(f64, f64)> {
    let case = valid(text, set);
    let is_warned = case
        .warnings
        .iter()
        .any(|warning| warning.contains("the hole or notch"));
    let NarrowestOpening {
        width, cells, least, ..
    } = case.opening?;
    assert_eq!(is_warned, cells < least, "{set:?}: {cells} cells");
    Some((width, cells))
}

#[track_caller]
fn is_about(text: &str, set: &[&str], [width, cells]: [f64; 2]) {
    let (found_width, found_cells) = found(text, set).unwrap_or_else(|| panic!("{set:?}: none"));
    assert!(
        (found_width / width - 1.0).abs() < 0.02,
        "{set:?}: {found_width} m for {width}"
    );
    assert!(
        (found_cells / cells - 1.0).abs() < 0.02,
        "{set:?}: {found_cells} cells for {cells}"
    );
}

#[test]
fn cells_across_holes_of_all_shapes_are_counted() {
    is_about(PLATE, &[], [1.0, 10.0]);
    is_about(PLATE, &["grid.cell=0.25"], [1.0, 4.0]);
    is_about(PLATE, &["geometry=axisymmetric"], [1.0, 10.0]);
    // In the middle of the plate, and cells of two sizes: those beside the hole count.
    is_about(
        PLATE,
        &["body.0.subtract=[{ circle = { centre = [2.0, 2.0], radius = 0.25 } }]"],
        [0.5, 5.0],
    );
    let knots = "grid={ lower = [0.0, 0.0], upper = [5.0, 4.0], knots = { x = [0, 0.25, 0.5, 0.75, 1, 2, 3, 4, 5], \
                 y = [0, 0.25, 0.5, 0.75, 1, 2, 3, 4] }, degree = \"quadratic\" }";
    is_about(PLATE, &[knots], [1.0, 4.0]);
    // A slot, and a pit from the surface, half of which is there.
    is_about(
        PLATE,
        &["body.0.subtract=[{ box = { lower = [1.0, 1.0], upper = [3.0, 1.4] } }]"],
        [0.4, 4.0],
    );
    is_about(
        PLATE,
        &["body.0.subtract=[{ box = { lower = [-1.0, 3.0], upper = [0.3, 500.0] } }]"],
        [0.6, 6.0],
    );
    // A semicircular notch in a side, as a circle, and as a polygon, of which the width is less by up to 13 %.
    is_about(
        PLATE,
        &["body.0.subtract=[{ circle = { centre = [2.0, 4.0], radius = 0.5 } }]"],
        [0.99, 9.9],
    );
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 / 16.0 * std::f64::consts::TAU / 2.0).sin_cos();
        format!("[{}, {}]", 2.0 + 0.5 * cos, 4.0 - 0.5 * sin)
    };
    let notch: Vec<String> = (0..=16).map(corner).collect();
    is_about(
        PLATE,
        &[&format!("body.0.subtract=[{{ polygon = [{}] }}]", notch.join(", "))],
        [0.87, 8.7],
    );
    // An inclined crack: 1.41 m by 0.14 m.
    let crack = "body.0.subtract=[{ polygon = [[1.0, 1.0], [1.1, 0.9], [2.1, 1.9], [2.0, 2.0]] }]";
    is_about(PLATE, &[crack], [0.02_f64.sqrt(), 2.0_f64.sqrt()]);
    // A notch in the outline of a body.
    let outline = "body=[{ material = \"elastic\", points_per_cell = 2, polygon = [[0, 0], [4, 0], [4, 4], [2.3, 4], \
                   [2.3, 2], [2, 2], [2, 4], [0, 4]] }]";
    is_about(PLATE, &[outline], [0.3, 3.0]);
}

#[test]
fn what_is_no_hole_is_not_taken_for_one() {
    let unloaded = ["traction=[]", "gravity.acceleration=[0, -9.81]"];
    let none = |set: &[&str]| assert_eq!(found(PLATE, &[&unloaded, set].concat()), None, "{set:?}");
    // A side that is cut off, a step, and a trench whose sides slope at 45 degrees.
    none(&["body.0.subtract=[{ box = { lower = [3.0, -1.0], upper = [5.0, 5.0] } }]"]);
    none(&["body.0.subtract=[{ box = { lower = [2.0, 3.0], upper = [5.0, 5.0] } }]"]);
    none(&["body.0.subtract=[{ polygon = [[1.5, 4.0], [2.0, 3.5], [2.2, 3.5], [2.7, 4.0]] }]"]);
    // What another body or a rigid body fills.
    let circle = "circle = { centre = [0.0, 0.0], radius = 0.5 }";
    let body = |shape: &str| format!("{{ material = \"elastic\", points_per_cell = 2, {shape} }}");
    let plate = body(&format!(
        "box = {{ lower = [0.0, 0.0], upper = [4.0, 4.0] }}, subtract = [{{ {circle} }}]"
    ));
    none(&[&format!("body=[{plate}, {}]", body(circle))]);
    none(&[&format!(
        "rigid=[{{ name = \"pipe\", {circle}, displacement = [0.01, 0.0] }}]"
    )]);
    // Unless it is removed.
    let core = format!("name = \"core\", {circle}");
    let removed = format!("body=[{plate}, {}]", body(&core));
    is_about(
        PLATE,
        &[&removed, "stage=[{ at = 0.5, remove = [\"core\"] }]"],
        [1.0, 10.0],
    );
    // A wide pit has many cells across, and is not warned of.
    is_about(
        PLATE,
        &["body.0.subtract=[{ box = { lower = [1.0, 3.0], upper = [3.0, 5.0] } }]"],
        [2.0, 20.0],
    );
}

#[test]
fn holes_in_space_are_counted_too() {
    let with = |shape: &str| format!("body.0.subtract=[{{ {shape} }}]");
    let sphere = with("sphere = { centre = [0, 0, 2], radius = 0.5 }");
    // Half of it is open: the widest place that is found is 3 % narrower.
    is_about(BLOCK, &[&sphere], [0.97, 3.87]);
    is_about(BLOCK, &[&sphere, "grid.cell=0.125"], [0.97, 7.73]);
    let hole = with("extrude = { circle = { centre = [1.5, 1.5], radius = 0.5 }, along = \"z\", from = 1, to = 300 }");
    is_about(BLOCK, &[&hole], [1.0, 4.0]);
    is_about(
        BLOCK,
        &[&with("box = { lower = [1.0, 1.0, 1.5], upper = [1.5, 2.0, 3.0] }")],
        [0.5, 2.0],
    );
    let turned = with("revolve = { polygon = [[0, 0.5], [0.5, 0.5], [0.5, 3], [0, 3]], about = [1.5, 1.5] }");
    is_about(BLOCK, &[&turned], [1.0, 4.0]);
    assert_eq!(
        found(BLOCK, &[&with("box = { lower = [-1, 2, -1], upper = [4, 4, 3] }")]),
        None
    );
    assert_eq!(found(BLOCK, &[]), None);
}

/// The warning names the body, the number, the bound and the key.
#[test]
fn too_few_cells_are_warned_of() {
    let with = |cells: &str, points: &str| {
        valid(PLATE, &[cells, points])
            .warnings
            .iter()
            .any(|of| of.contains("notch"))
    };
    assert!(with("grid.cell=0.2", "body.0.points_per_cell=3") && !with("grid.cell=0.15", "body.0.points_per_cell=3"));
    assert!(with("grid.cell=0.15", "body.0.points_per_cell=2") && !with("grid.cell=0.1", "body.0.points_per_cell=2"));
    let warnings = valid(PLATE, &["grid.cell=0.2"]).warnings;
    let warning = warnings
        .iter()
        .find(|warning| warning.contains("hole or notch"))
        .unwrap();
    assert_eq!(
        warning,
        "W0227: body.0.subtract.0: the hole or notch, 1 m wide, has 5.0 cells across, but needs at least 8. Stresses \
         at its edge are off by more than 10 %. Use smaller cells there."
    );
    assert!(warning.len() <= 200, "{}", warning.len());
}

/// The text without its cells, points and steps, for a preset.
fn preset(word: &str) -> String {
    let text = PLATE
        .replace(", cell = 0.1, degree = \"quadratic\"", "")
        .replace(", steps = 1", "");
    text.replace("points_per_cell = 2\n", "")
        .replace("analysis", &format!("accuracy = \"{word}\"\nanalysis"))
}

#[test]
fn presets_make_small_cells_at_holes() {
    for (word, cells) in [("draft", 8.0), ("standard", 12.0), ("reference", 24.0)] {
        let set = [
            "grid.upper=[20.0, 20.0]",
            "body.0.box.upper=[19.0, 19.0]",
            "traction.0.from=[19, 0]",
            "traction.0.to=[19, 19]",
        ];
        is_about(&preset(word), &set, [1.0, cells]);
        let case = valid(&preset(word), &set);
        let note = case
            .notes
            .iter()
            .any(|note| note.reason.contains("across the hole or notch body.0.subtract.0"));
        assert!(note && case.warnings.is_empty(), "{:?} {:?}", case.notes, case.warnings);
        // Steps follow the plate's cells: nothing moves at the hole.
        assert!((case.analysis.dt * if word == "reference" { 20.0 } else { 10.0 } - 1.0).abs() < 1e-12);
    }
    // Where cells are squares because of a band_width, all of them are as small.
    let softening = "material.elastic={ model = \"mohr-coulomb-softening\", young = 1e7, poisson = 0.3, friction_angle = 30, \
                     cohesion = 1e3, residual_friction_angle = 25, residual_cohesion = 0, softening_strain = 0.1, band_width = 0.1 }";
    let case = valid(&preset("draft"), &[softening]);
    assert!(
        case.grid.axes.iter().all(|axis| axis.longest() <= 0.126),
        "{:?}",
        case.grid.axes
    );
}

#[test]
fn presets_make_small_cells_at_steep_re_entrant_corners_alone() {
    let cells = |polygon: &str, more: &[&str]| {
        let body = format!("body=[{{ material = \"elastic\", polygon = {polygon} }}]");
        let case = valid(
            &preset("draft"),
            &[&[&body, "traction=[]", "gravity.acceleration=[0, -9.81]"], more].concat(),
        );
        let shortest = case.grid.shortest();
        (0.4 / shortest * 10.0).round() / 10.0
    };
    // Cells are a tenth of 4 m, and half of that at the foot of a vertical cut and of a slope of 63 degrees.
    assert!(cells("[[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]", &[]) >= 1.9);
    assert!(cells("[[0, 0], [4, 0], [4, 2], [3, 2], [2, 4], [0, 4]]", &[]) >= 1.9);
    // Slopes of 45 and 27 degrees, and a convex body.
    assert!(cells("[[0, 0], [4, 0], [4, 2], [3.5, 2], [1.5, 4], [0, 4]]", &[]) < 1.1);
    assert!(cells("[[0, 0], [4, 0], [4, 3], [3, 3], [1, 4], [0, 4]]", &[]) < 1.1);
    assert!(cells("[[0, 0], [4, 0], [1, 4], [0, 4]]", &[]) < 1.1);
    // A wall that a rigid body stands in front of has no free corner.
    let wall = "rigid=[{ name = \"wall\", polygon = [[2, 2], [6, 2], [6, 6], [2, 6]], displacement = [0, -1e-9] }]";
    let open = cells("[[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]", &[]);
    let held = valid(
        &preset("draft"),
        &[
            "body=[{ material = \"elastic\", polygon = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]] }]",
            "traction=[]",
            wall,
        ],
    );
    let notes = held
        .notes
        .iter()
        .filter(|note| note.reason.contains("re-entrant"))
        .count();
    assert!(open > 1.0 && notes == 0, "{:?}", held.notes);
}

/// A pit that is dug in a stage has its corner from then on; so has ground beside a wall of another body.
#[test]
fn corners_of_stages_and_of_several_bodies_are_found() {
    let body = |name: &str, lower: &str, upper: &str| {
        format!("{{ name = \"{name}\", material = \"elastic\", box = {{ lower = {lower}, upper = {upper} }} }}")
    };
    let all = [
        body("below", "[0.0, 0.0]", "[4.0, 2.0]"),
        body("beside", "[0.0, 2.0]", "[2.0, 4.0]"),
        body("pit", "[2.0, 2.0]", "[4.0, 4.0]"),
    ];
    let set = [
        format!("body=[{}]", all.join(", ")),
        "traction=[]".to_owned(),
        "gravity.acceleration=[0, -9.81]".to_owned(),
    ];
    let corners = |more: &[&str]| {
        let set: Vec<&str> = set.iter().map(String::as_str).chain(more.iter().copied()).collect();
        let case = valid(&preset("draft"), &set);
        case.notes
            .iter()
            .filter(|note| note.reason.contains("re-entrant corner [2.0, 2.0]"))
            .count()
    };
    assert_eq!(corners(&[]), 0);
    assert_eq!(corners(&["stage=[{ at = 0.5, remove = [\"pit\"] }]"]), 1);
    assert_eq!(corners(&["stage=[{ at = 0.5, add = [\"pit\"] }]"]), 1);
}
