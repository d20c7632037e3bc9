//! Tests axisymmetric runs.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{agree, at, history, manifest};
use std::f64::consts::PI;

/// A cylinder of soil that stands on a fixed base under its weight and a ring of load; a rigid cone comes down on it.
const CASE: &str = r#"
geometry = "axisymmetric"
[analysis]
type = "dynamic"
end = 0.06
dt = 0.002
[grid]
lower = [0, 0]
upper = [1.5, 1.5]
cell = 0.125
degree = "quadratic"
[material.soil]
model = "drucker-prager"
young = "2 MPa"
poisson = 0.3
density = 1800
friction_angle = 30
cohesion = "1 kPa"
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [1, 1] }
points_per_cell = 2
[[rigid]]
name = "cone"
polygon = [[0.0, 1.0], [0.4, 1.2], [0.4, 1.4], [-0.4, 1.4], [-0.4, 1.2]]
friction_coefficient = 0.3
displacement = [0.0, -0.06]
[[traction]]
from = [0.75, 1.0]
to = [1.0, 1.0]
stress = [0.0, "-1 kPa"]
ramp = 0.06
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.5
[boundary]
left = "roller"
bottom = "fixed"
right = "free"
[stabilisation]
method = "consistent-f-bar"
[solver]
tolerance = 1e-12
force_tolerance = 1e-9
[output]
every = 0.03
[[history]]
quantity = "mass"
[[history]]
quantity = "reaction"
face = "bottom"
[[history]]
quantity = "rigid-force"
rigid = "cone"
[[history]]
quantity = "rigid-work"
rigid = "cone"
[[history]]
quantity = "momentum"
[[history]]
quantity = "kinetic-energy"
[[history]]
quantity = "energy"
"#;

#[test]
fn a_body_of_revolution_is_the_same_on_1_2_and_3_ranks_and_over_restarts() {
    let scratch = Scratch::with_case(CASE);
    for ranks in [1, 2, 3] {
        scratch.goes_on(ranks, &["17"]);
        agree(&scratch.path(&format!("whole{ranks}")), &scratch.path("whole1"));
    }
    let table = history(&scratch.path("whole1"));
    let units = ["mass", "reaction-y", "rigid-force-y", "momentum-y", "energy-external"].map(|name| table.unit(name));
    assert_eq!(units, ["kg", "N", "N", "kg m/s", "J"].map(Some));
    let of = |name: &str, t: f64| at(&table, name, t);
    assert!((of("mass", 0.06) / (1800.0 * PI) - 1.0).abs() < 1e-12);
    // k0 leaves 0.8 % in so few cells.
    assert!(
        (of("reaction-y", 0.0) / (1800.0 * PI * 9.81) - 1.0).abs() < 0.01,
        "{}",
        of("reaction-y", 0.0)
    );
    assert!(of("rigid-force-y", 0.06) > 100.0 && of("rigid-work", 0.06) > 0.0);
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| of(name, 0.06).abs());
    assert!(closure < 1e-5 * external, "{closure:e} of {external:e}");
    let reported = manifest(&scratch.path("whole1"));
    assert_eq!(
        (reported.case.geometry.as_str(), reported.frame_units["volume"].as_str()),
        ("axisymmetric", "m3/rad")
    );
    let whole = reported
        .choices
        .iter()
        .find(|choice| choice.key == "geometry")
        .expect("what forces are of");
    assert!(whole.reason.contains("of the whole circle"));
}

/// A disc that is pressed elastically: its work is the body's energy, its force the pressure times the area, and that
/// of the base.
#[test]
fn forces_and_works_of_a_disc_are_of_the_whole_of_it() {
    let pressed = changed(
        CASE,
        "type = \"dynamic\"\nend = 0.06\ndt = 0.002",
        "type = \"quasi-static\"\nsteps = 4",
    );
    let pressed = changed(&pressed, "model = \"drucker-prager\"", "model = \"elastic\"");
    let pressed = changed(&pressed, "friction_angle = 30\ncohesion = \"1 kPa\"\n", "");
    let (before, _) = pressed.split_once("[[rigid]]").unwrap();
    let (_, after) = pressed.split_once("[boundary]").unwrap();
    let (after, _) = after.split_once("[output]").unwrap();
    let footing =
        "[footing]\nfrom = [0.0, 1.0]\nto = [0.5, 1.0]\ndisplacement = [0.0, -0.001]\ninterface = \"smooth\"\n";
    let wanted =
        ["footing-force", "footing-pressure", "energy"].map(|name| format!("[[history]]\nquantity = \"{name}\"\n"));
    let base = "[[history]]\nquantity = \"reaction\"\nface = \"bottom\"\n";
    let work = "[[history]]\nquantity = \"work\"\nof = \"footing\"\n";
    let scratch = Scratch::with_case(&format!(
        "{before}{footing}[boundary]{after}{}{base}{work}",
        wanted.concat()
    ));
    scratch.mpirun(2, &["case.toml", "-q", "-o", "disc"]).expect(0);
    let table = history(&scratch.path("disc"));
    let of = |name: &str| at(&table, name, 1.0);
    let force = of("footing-force");
    let pressure = of("footing-pressure");
    assert!(
        force > 100.0 && (pressure * PI * 0.25 / force - 1.0).abs() < 1e-12,
        "{force} {pressure}"
    );
    assert!((of("reaction-y") / force - 1.0).abs() < 1e-6);
    assert!(
        (of("work") / (0.5 * force * 1e-3) - 1.0).abs() < 0.02,
        "{} {}",
        of("work"),
        0.5 * force * 1e-3
    );
    assert!((of("energy-elastic") / of("work") - 1.0).abs() < 0.02);
}

/// A piston on a column between rollers is one motion along a line, as in plane strain: the bodies' masses are of the
/// whole circle.
#[test]
fn a_free_piston_falls_on_a_round_column_as_on_a_plane_one() {
    let elastic = changed(CASE, "model = \"drucker-prager\"", "model = \"elastic\"");
    let elastic = changed(&elastic, "friction_angle = 30\ncohesion = \"1 kPa\"\n", "");
    let elastic = changed(
        &changed(&elastic, "upper = [1.5, 1.5]", "upper = [1.0, 1.5]"),
        "\"free\"",
        "\"roller\"",
    );
    // The exponents of F-bar differ, 1/3 here, 1/2 in a plane, and points do not integrate hoop stress exactly.
    let elastic = changed(&elastic, "\"consistent-f-bar\"", "\"none\"");
    let elastic = changed(&changed(&elastic, "poisson = 0.3", "poisson = 0"), "k0 = 0.5", "k0 = 0");
    let (before, _) = elastic.split_once("[[rigid]]").unwrap();
    let (_, after) = elastic.split_once("[gravity]").unwrap();
    let (after, _) = after.split_once("[[history]]").unwrap();
    let piston = "[[rigid]]\nname = \"piston\"\npolygon = [[-1.5, 1.005], [1.5, 1.005], [1.5, 1.205], [-1.5, 1.205]]\n";
    let reported = ["force", "displacement", "velocity"]
        .map(|of| format!("[[history]]\nquantity = \"rigid-{of}\"\nrigid = \"piston\"\n"));
    let of = |mass: &str| {
        format!(
            "{before}{piston}free = [\"y\"]\n{mass}\n[gravity]{after}{}",
            reported.concat()
        )
    };
    let scratch = Scratch::with_case(&of(&format!("density = {}", 500.0 / 0.45)));
    let plane = changed(&of("mass = 500"), "\"axisymmetric\"", "\"plane-strain\"");
    std::fs::write(scratch.path("plane.toml"), plane).unwrap();
    scratch.mpirun(2, &["case.toml", "-q", "-o", "round"]).expect(0);
    scratch.mpirun(1, &["plane.toml", "-q", "-o", "plane"]).expect(0);
    let [round, plane] = ["round", "plane"].map(|name| history(&scratch.path(name)));
    for (name, whole) in [
        ("rigid-force-y", PI),
        ("rigid-displacement-y", 1.0),
        ("rigid-velocity-y", 1.0),
    ] {
        let [round, plane] = [&round, &plane].map(|table| at(table, name, 0.06));
        assert!((round / (whole * plane) - 1.0).abs() < 1e-9, "{name}: {round} {plane}");
    }
    assert!(at(&round, "rigid-force-y", 0.06) > 0.0, "it has come down on the soil");
}

/// Undrained ground under an even load: no more water at the axis than elsewhere, and no dimple in the surface there
/// (with evenly spaced points 2 kPa of 50 and 5.3e-5 m).
#[test]
fn undrained_ground_stays_even_at_the_axis() {
    let case = r#"
geometry = "axisymmetric"
analysis = { type = "consolidation", end = "10 s", steps = 1 }
grid = { lower = [0, 0], upper = [3, 2.5], cell = 0.25, degree = "quadratic" }
material.soil = { model = "elastic", young = "10 MPa", poisson = 0.3, drainage = "undrained", porosity = 0.5 }
body = [{ material = "soil", box = { lower = [0, 0], upper = [3, 2] }, points_per_cell = 3 }]
traction = [{ from = [0, 2], to = [3, 2], stress = [0, "-50 kPa"] }]
boundary = { left = "roller", right = "roller", bottom = "roller" }
stabilisation = { method = "consistent-f-bar" }
output = { every = "10 s" }
history = [
    { quantity = "displacement", at = [0, 2], name = "top" },
    { quantity = "excess-pressure", at = [0.04, 1], name = "axis" },
]
"#;
    let scratch = Scratch::with_case(case);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "even"]).expect(0);
    let table = history(&scratch.path("even"));
    let water = at(&table, "axis", 10.0);
    let dimple = at(&table, "top-y", 10.0);
    assert!((water / 50e3 - 1.0).abs() <= 1e-3, "{water}");
    assert!(dimple.abs() <= 1e-5, "{dimple}");
}
