//! Tests hydrostatic water.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{all_frames, at, history, last_frame, manifest};

/// Level ground below a level of 12 m, its top at 7 m.
const GROUND: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
end = 1.0
steps = 4
[grid]
lower = [-1, 2]
upper = [3, 12]
cell = "1 m"
degree = "quadratic"
[material.soil]
model = "mohr-coulomb"
young = "100 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction_angle = 30.0
unit_weight = "17 kN/m3"
saturated_unit_weight = "20 kN/m3"
[[body]]
material = "soil"
polygon = [[-1, 2], [3, 2], [3, 9], [-1, 9]]
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[water]
level = 12.0
[initial]
k0 = 0.5
equilibrium = "plastic"
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[stabilisation]
method = "consistent-f-bar"
[output]
every = 0.5
fields = ["pore-pressure"]
[[history]]
quantity = "max-displacement"
[[history]]
quantity = "pore-pressure"
at = [1, 5.5]
"#;
const SLOPE: &str = "polygon = [[-1, 2], [3, 2], [3, 5], [0, 9], [-1, 9]]";
const LEVEL: &str = "polygon = [[-1, 2], [3, 2], [3, 9], [-1, 9]]";
const TIGHT: &str = "[solver]\ntolerance = 1e-14\nforce_tolerance = 1e-10\n";
/// Pa  of the water over the ground's height
const PRESSURE: f64 = 9810.0 * 7.0;

/// sigma_v' = -gamma' z, nothing moves, the pressure is that of the depth.
#[test]
fn submerged_level_ground_has_its_buoyant_weight_and_rests() {
    let scratch = Scratch::with_case(GROUND);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = manifest(&scratch.path("out")).initial.expect("a stress at the start");
    assert!(found.unbalance < 1e-12 && found.yielding == 0, "{found:?}");
    let moved = at(&history(&scratch.path("out")), "max-displacement", 1.0);
    assert!(moved < 1e-12, "{moved}");
    for frame in all_frames(&scratch.path("out")) {
        let stress = frame.real("stress", 6).unwrap();
        let pore = frame.real("pore_pressure", 1).unwrap();
        for (p, place) in frame.position.iter().enumerate() {
            let [side, vertical, shear] = [stress[6 * p], stress[6 * p + 1], stress[6 * p + 3]];
            // Points on thirds hold the mean of the linear stress in a cell, not its value.
            let buoyant = (20_000.0 - 9810.0) * (9.0 - place[1]);
            assert!(
                (vertical + buoyant).abs() < 1e-8 * PRESSURE + 0.05 * 10_190.0,
                "{place:?} {vertical}"
            );
            assert!(
                (side - 0.5 * vertical).abs() < 1e-8 * PRESSURE && shear.abs() < 1e-8 * PRESSURE,
                "{place:?}"
            );
            assert!(
                (pore[p] - 9810.0 * (12.0 - place[1])).abs() < 1e-8 * PRESSURE,
                "{place:?} {}",
                pore[p]
            );
        }
    }
}

/// Points that the level cuts are wet as far as they lie below it, also where the surface cuts their cells, of bodies
/// whose points keep their places in the cell then and of such whose do not.
#[test]
fn the_ground_rests_with_its_weight_wherever_the_level_cuts_points() {
    let reaction = "[[history]]\nquantity = \"reaction\"\nface = \"bottom\"\n";
    let polygon = GROUND.to_owned();
    let cuboid = changed(&polygon, LEVEL, "box = { lower = [-1, 2], upper = [3, 9] }");
    for (shape, top, level) in [
        (&polygon, 9.0, 6.55),
        (&polygon, 8.9, 8.9),
        (&polygon, 8.8, 8.4),
        (&cuboid, 9.0, 7.2),
        (&cuboid, 8.8, 8.4),
        (&cuboid, 8.1, 8.05),
    ] {
        let ground = shape.replace(", 9]", &format!(", {top}]")) + reaction + TIGHT;
        let scratch = Scratch::with_case(&changed(&ground, "level = 12.0", &format!("level = {level}")));
        scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
        let found = at(&history(&scratch.path("out")), "reaction-y", 1.0);
        let weight = 4.0 * (17_000.0 * (top - level) + (20_000.0 - 9810.0) * (level - 2.0));
        println!("top {top} m, level {level} m: {found} of {weight} N");
        assert!((found / weight - 1.0).abs() < 1e-9, "{top}, {level}: {found} {weight}");
    }
}

/// The same points, stresses and displacements, of a cut slope below water and of one of buoyant weight.
#[test]
fn a_submerged_slope_is_one_of_buoyant_weight() {
    let slope = changed(GROUND, LEVEL, SLOPE).replace("[initial]\nk0 = 0.5\nequilibrium = \"plastic\"\n", TIGHT);
    let slope = changed(&slope, "-9.81]", "-9.81]\nramp = 1.0");
    let dry = changed(&slope, "[water]\nlevel = 12.0\n", "");
    let dry = dry
        .replace("saturated_unit_weight = \"20 kN/m3\"\n", "")
        .replace("17 kN/m3", "10.19 kN/m3");
    let dry = dry
        .replace("fields = [\"pore-pressure\"]", "")
        .replace("at = [1, 5.5]", "at = [1, 5.5]\nname = \"none\"");
    let scratch = Scratch::with_case(&slope);
    scratch.write("dry.toml", &dry);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "wet"]).expect(0);
    scratch.mpirun(1, &["dry.toml", "-q", "-o", "dry"]).expect(0);
    let [wet, dry] = ["wet", "dry"].map(|name| last_frame(&scratch.path(name)));
    let [wet, dry] = [&wet, &dry].map(|frame| frame.real("stress", 6).unwrap().to_vec());
    let largest = wet
        .iter()
        .zip(&dry)
        .map(|(wet, dry)| (wet - dry).abs())
        .fold(0.0, f64::max);
    println!("submerged and buoyant: {largest} Pa of {PRESSURE}");
    assert!(wet.len() == dry.len() && largest < 1e-8 * PRESSURE, "{largest}");
    let [wet, dry] = ["wet", "dry"].map(|name| at(&history(&scratch.path(name)), "max-displacement", 1.0));
    println!("moved {wet:e} and {dry:e} m");
    assert!(dry > 1e-5 && (wet - dry).abs() < 1e-8 * dry, "{wet} {dry}");
}

/// The level falls through the ground, on two ranks and with a restart between.
#[test]
fn a_level_that_falls_is_followed_and_goes_on_to_the_bit() {
    let falling = changed(GROUND, "level = 12.0", "level_path = [[0.0, 12.0], [1.0, 4.0]]") + TIGHT;
    let scratch = Scratch::with_case(&falling);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "two"]).expect(0);
    let [one, two] = ["one", "two"].map(|name| history(&scratch.path(name)));
    for (t, level) in [(0.0, 12.0), (0.5, 8.0), (1.0, 4.0)] {
        // The point next to y = 5.5 is in the middle of its cell.
        let expected = 9810.0 * f64::max(0.0, level - 5.5);
        let found = at(&one, "pore-pressure", t);
        assert!((found - expected).abs() < 0.01 * 9810.0, "{t}: {found} {expected}");
    }
    let [one, two] = [&one, &two].map(|table| at(table, "max-displacement", 1.0));
    assert!(one > 1e-4 && (one - two).abs() < 1e-8 * one, "{one} {two}");
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(1, &[&part[..], &["--max-steps", "2"]].concat())
        .expect(75);
    scratch.mpirun(1, &part).expect(0);
    let text = |name: &str| std::fs::read_to_string(scratch.path(name).join("history.csv")).unwrap();
    assert!(text("one") == text("part"));
}

/// Ground whose points carry 0.3 of the weight above them as a pore pressure.
fn by_ratio() -> String {
    let case = changed(GROUND, "[water]\nlevel = 12.0\n", "");
    changed(&case, "saturated_unit_weight = \"20 kN/m3\"", "ru = 0.3")
}

/// sigma_v' = -(1 - r_u) gamma z, nothing moves.
#[test]
fn level_ground_by_a_ratio_has_the_rest_of_its_weight_and_rests() {
    let scratch = Scratch::with_case(&by_ratio());
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = manifest(&scratch.path("out")).initial.expect("a stress at the start");
    assert!(found.unbalance < 1e-12 && found.yielding == 0, "{found:?}");
    assert!(at(&history(&scratch.path("out")), "max-displacement", 1.0) < 1e-12);
    let frame = last_frame(&scratch.path("out"));
    let stress = frame.real("stress", 6).unwrap();
    let pore = frame.real("pore_pressure", 1).unwrap();
    for (p, place) in frame.position.iter().enumerate() {
        let [side, vertical] = [stress[6 * p], stress[6 * p + 1]];
        let weight = 17_000.0 * (9.0 - place[1]);
        assert!(
            (vertical + 0.7 * weight).abs() < 0.05 * 17_000.0,
            "{place:?} {vertical}"
        );
        assert!(
            (side - 0.5 * vertical).abs() < 1e-8 * weight,
            "{place:?} {side} {vertical}"
        );
        assert!((pore[p] - 0.3 * weight).abs() < 1e-8 * weight, "{place:?} {}", pore[p]);
    }
}

/// A slope whose points carry it, on two ranks and with a restart between.
#[test]
fn a_slope_by_a_ratio_moves_the_same_on_two_ranks_and_goes_on_to_the_bit() {
    let slope = changed(&by_ratio(), LEVEL, SLOPE).replace("[initial]\nk0 = 0.5\nequilibrium = \"plastic\"\n", TIGHT);
    let slope = changed(&slope, "-9.81]", "-9.81]\nramp = 1.0");
    let scratch = Scratch::with_case(&slope);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "two"]).expect(0);
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(1, &[&part[..], &["--max-steps", "2"]].concat())
        .expect(75);
    scratch.mpirun(1, &part).expect(0);
    let text = |name: &str| std::fs::read_to_string(scratch.path(name).join("history.csv")).unwrap();
    assert!(text("one") == text("part"));
    let [one, two] = ["one", "two"].map(|name| at(&history(&scratch.path(name)), "max-displacement", 1.0));
    assert!(one > 1e-4 && (one - two).abs() < 1e-8 * one, "{one} {two}");
}
